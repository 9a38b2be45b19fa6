"""Which bodies and cables that carry the sheaves and drums of ropes in space may rotate, and their frames."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..parts.attachment import Attachment
from ..parts.modal_body import ModalBody
from ..parts.scene_data import SceneData
from .frames import end_frame, has_section

MAX_ALONG = 0.9
"""Cosine of the angle of the axis of a wheel to the tangent of its cable above which another direction stays across."""


class Carried(NamedTuple):
    """A groove on a body, in its axes, or on a cable, in its frame: (3, 3), the vectors of its plane and its axis as
    columns; up (3,): the direction of the ground in the frame of a cable without sections, else None.
    """

    axes: np.ndarray
    up: np.ndarray | None


def may_turn(scene: SceneData, carrier: str | None) -> bool:
    """Return whether a body or a cable, None for the ground, may rotate, and with it the grooves of wheels on it."""
    return carrier is not None and (carrier in scene.cables or not _translates(scene, carrier, set()))


def carried_groove(scene: SceneData, end: Attachment, plane: np.ndarray) -> Carried:
    """Return the plane (3, 2) of a groove as drawn in the frame of what carries it.

    On a cable without sections the axis stays across the tangent, in the plane of both directions as drawn; where it is
    along the tangent, a vector of the groove does.
    """
    axes = np.column_stack([plane, np.cross(*plane.T)])
    up = None
    if end.on in scene.cables and not has_section(cable := scene.cables[end.on]):
        tangent = cable.slope(end.arc_length)
        is_along = abs(axes[:, 2] @ tangent) > MAX_ALONG * np.linalg.norm(tangent)
        up = axes[:, 0 if is_along else 2]
    return Carried(end_frame(scene, end, None if up is None else up.tolist()).T @ axes, up)


def _translates(scene: SceneData, body: str, known: set[str]) -> bool:
    """Return whether joints keep the orientation of a rigid body, as modes turn points of others; known: bodies on the
    way to it.
    """
    if isinstance(scene.bodies[body], ModalBody):
        return False
    for joint in scene.joints.values():
        ends = [end.on for end in (joint.a, joint.b)]
        if joint.joint_kind in ("prismatic", "weld") and body in ends:
            other = ends[1 - ends.index(body)]
            if other is None or (other in scene.bodies and other not in known
                                 and _translates(scene, other, known | {body})):
                return True
    return False
