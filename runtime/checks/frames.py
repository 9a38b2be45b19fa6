"""Frames of joints and slides at the start: columns are unit vectors along the ground's axes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..parts.attachment import Attachment
from ..parts.cable import Cable
from ..parts.joint import Joint
from ..parts.scene_data import SceneData
from ..parts.slide import Slide
from .rope_line import rope_line

TANGENT_LAST = np.eye(3)[:, [1, 2, 0]]
"""Axes of a joint in the frame of a cable: z along the tangent, x along the height, y along the width."""


class JointAxes(NamedTuple):
    """(3, 3) each: the axes of a joint as columns, in the frames of its two ends; equal in the ground's at the start.

    Frame of an end: axes of the body or the ground, on a cable `section_frame`, else `cable_frame`. z is the joint's
    axis.
    """

    a: np.ndarray
    b: np.ndarray


def plane_normal(scene: SceneData) -> np.ndarray:
    """Return (3,): the unit normal of the plane of a planar scene."""
    return np.array([0.0, 0.0, 1.0]) if scene.plane is None else scene.plane.normal


def has_section(cable: Cable) -> bool:
    """Return whether its elements determine the rotation about the tangent, or are planar."""
    return cable.dim == 2 or bool(cable.kind_of_element.director)


def cable_frame(cable: Cable, s: float, up: Sequence[float] | None = None) -> np.ndarray:
    """Return (3, 3): tangent, height and width at ``s`` as the elements draw them, as columns.

    The tangent frame of eq 16 to 18: k perpendicular to the tangent and to ``up``, by default to r_y or the axes of the
    cable.
    """
    tangent = _unit(cable.slope(s))
    width = cable.normal if cable.dim == 2 else _unit(np.cross(tangent, cable.height(s) if up is None else up))
    return np.column_stack([tangent, np.cross(width, tangent), width])


def draws_section(cable: Cable) -> bool:
    """Return whether its elements have sections that shear rotates away from the tangent."""
    return {2: {"r_y"}, 3: {"r_y", "r_z"}}[cable.dim] <= set(cable.kind_of_element.nodal_vectors)


def section_frame(cable: Cable, s: float) -> np.ndarray:
    """Return (3, 3): normal, height along r_y, and width of the section at ``s`` as the elements draw it, as columns.

    Joints hold this frame: a moment on r_x alone would shear the beam locally, the more the finer its elements.
    """
    height = _unit(cable.height(s))
    normal = _unit(np.cross(height, cable.width(s)))
    return np.column_stack([normal, height, np.cross(normal, height)])


def _unit(vector: np.ndarray) -> np.ndarray:
    return np.asarray(vector / np.linalg.norm(vector))


def end_frame(scene: SceneData, end: Attachment, up: Sequence[float] | None = None) -> np.ndarray:
    """Return (3, 3): the frame of a complete end; ``up``: for a cable without section axes."""
    if end.on is None:
        return np.eye(3)
    if end.on in scene.bodies:
        return scene.bodies[end.on].axes
    if end.on in scene.ropes:
        return np.eye(3)  # a rope has no axes, and joints that need some are refused
    cable = scene.cables[end.on]
    return section_frame(cable, end.arc_length) if draws_section(cable) else cable_frame(cable, end.arc_length, up)


def joint_axes(scene: SceneData, joint: Joint) -> JointAxes:
    """Return the axes of a joint of the scene in the frames of its ends."""
    return JointAxes(*(end_frame(scene, end, joint.up).T @ joint.axes for end in (joint.a, joint.b)))


def rope_frame(scene: SceneData, name: str, s: float, up: Sequence[float] | None = None) -> np.ndarray:
    """Return (3, 3): tangent, height and width of a rope as drawn at ``s``, as columns; by default any height."""
    tangent = _unit(rope_line(scene, name).slope(s))
    if scene.ropes[name].dim == 2:
        width = plane_normal(scene)
    else:
        width = _unit(np.cross(tangent, np.eye(3)[np.argmin(np.abs(tangent))] if up is None else up))
    return np.column_stack([tangent, np.cross(width, tangent), width])


def _frame_along(scene: SceneData, slide: Slide) -> np.ndarray:
    if slide.along in scene.ropes:
        return rope_frame(scene, slide.along, slide.arc_length, slide.up)
    along = scene.cables[slide.along]
    if slide.frame == "section" and draws_section(along):
        return section_frame(along, slide.arc_length)
    return cable_frame(along, slide.arc_length, slide.up)


def slide_axes(scene: SceneData, slide: Slide) -> JointAxes:
    """Return the axes that a slide of frame "tangent" or "section" aligns: a in the cable's frame, b in the rider's.

    z along the tangent, x along the height, y along the width. With roll "fixed" the cable's frame is that of
    `cable_frame` with the slide's up, at every s; with roll "free" the rotation about z is free.
    """
    frame = _frame_along(scene, slide)
    return JointAxes(TANGENT_LAST, end_frame(scene, slide.rider).T @ frame @ TANGENT_LAST)
