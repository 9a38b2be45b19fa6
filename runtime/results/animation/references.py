"""Origins of exaggerated displacements: the scene as drawn, and for slides and riders a point that slides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...base.rotations import rotate
from ...parts.attachment import Attachment
from ...parts.rigid_body import RigidBody
from ...parts.scene_data import SceneData
from .frames import Frames, moving


def references(frames: Frames) -> Frames:
    """Return the frames from which displacements are measured, with positions of one instant or of all T.

    Cables are at rest in them. A slide moves along the cable at rest, and its riding bodies move with it and keep their
    orientation: exaggerated displacements then leave a rider on its cable.
    """
    carried = _carried(frames)

    def value(name: str) -> np.ndarray:
        part, _, key = name.rpartition(".")
        if part in frames.scene.slides:
            return frames.value(name)
        if part in carried and key in ("position", "orientation"):
            return carried[part] if key == "position" else frames.value(name)
        return frames.reference(name)[None]

    return replace(frames, value=value)


def slide_reference(frames: Frames, name: str) -> np.ndarray | None:
    """Return the point (T, 3) of the undisplaced cable at a slide; None if its rider cannot follow, and on a rope,
    whose material moves along itself.
    """
    slide = frames.scene.slides[name]
    if not frames.has(f"{name}.s") or slide.along in frames.scene.ropes:
        return None
    s = frames.value(f"{name}.s")
    if slide.rider.on not in _riders(frames.scene) and (s != slide.arc_length).any():
        return None
    return moving(frames.scene.cables[slide.along], s, frames.reference(f"{slide.along}.nodal_vectors")[None])


def _riders(scene: SceneData) -> set[str]:
    """Return the rigid bodies that joints connect to other rigid bodies only: they can follow a slide."""
    bodies = {name for name, body in scene.bodies.items() if isinstance(body, RigidBody)}
    found = set(bodies)
    joints = [{joint.a.on, joint.b.on} for joint in scene.joints.values()]
    while True:
        tied = {name for pair in joints if not pair <= found for name in pair & found if name is not None}
        if not tied:
            return found
        found -= tied


def _carried(frames: Frames) -> dict[str, np.ndarray]:
    """Return the origins (T, 3) of the displacements of riding bodies, m, by name.

    A body on several slides takes the mean of their origins; bodies joined to it follow.
    """
    asked: dict[str, list[np.ndarray]] = {}
    for name, slide in frames.scene.slides.items():
        point = slide_reference(frames, name)
        if point is not None and slide.rider.on in _riders(frames.scene):
            asked.setdefault(slide.rider.on, []).append(point - _arm(frames, slide.rider))
    found = {name: np.mean(points, axis=0) for name, points in asked.items()}
    joints = frames.scene.joints.values()
    while following := [joint for joint in joints if (joint.a.on in found) != (joint.b.on in found)]:
        for joint in following:
            one, other = (joint.a, joint.b) if joint.a.on in found else (joint.b, joint.a)
            if one.on is not None and other.on is not None and other.on not in found:
                found[other.on] = found[one.on] + _arm(frames, one) - _arm(frames, other)
    return found


def _arm(frames: Frames, end: Attachment) -> np.ndarray:
    """Return the vectors (T, 3) in m from the origin of a body to an attachment, along the ground's axes."""
    return rotate(frames.value(f"{end.on}.orientation"), end.point)
