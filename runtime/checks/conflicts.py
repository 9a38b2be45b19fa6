"""Joints that fix or drive what another part fixes or drives already."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..errors import SceneError
from ..parts.attachment import Attachment
from ..parts.joint import DRIVEN, LINE_KINDS, POINT_KINDS, Joint
from ..parts.locations import Node, joined, point_of, support_of
from ..parts.scene_data import SceneData
from ..parts.support import Motion, Support
from ..parts.validation import LENGTH_TOLERANCE, show
from .placement import SUPPORTED


def check_supports(scene: SceneData, joint: Joint) -> None:
    """Raise SceneError where a support or a tie fixes a node to what the joint fixes it to."""
    for end, other in ((joint.a, joint.b), (joint.b, joint.a)):
        if (node := _node(scene, end)) is None:
            continue
        support = support_of(scene, node)
        if other.on is None and support is not None and _fixes_position(support):
            raise SceneError(joint.where, f"fixes {called(end)} to the ground, but it is {SUPPORTED[support.kind]} "
                             "already", "leave one of them out")
        if _node(scene, other) in joined(scene, node):
            raise SceneError(joint.where, f"joins {called(end)} to {called(other)}, but their nodes are joined "
                             "already", "leave one of them out")


def _fixes_position(support: Support) -> bool:
    """Return whether it leaves no direction free."""
    return not isinstance(support, Motion) or (support.displacement is not None and None not in support.displacement)


def _node(scene: SceneData, end: Attachment) -> Node | None:
    if end.on not in scene.cables or (node := scene.cables[end.on].node_at(end.arc_length)) is None:
        return None
    return end.on, node


def check_other_joints(scene: SceneData, joint: Joint, near: Callable[[], float]) -> None:
    """Raise SceneError where two joints between the same bodies conflict: one is a weld, or both fix or drive the same.

    near: returns how near points are, in m, that are the same; it is asked for where joints share their bodies.
    """
    joined = {joint.a.on, joint.b.on}
    for other in scene.joints.values():
        if {other.a.on, other.b.on} != joined:
            continue
        for a, b in ((other.a, other.b), (other.b, other.a)):
            if move_as_one(scene, joint.a, a) and move_as_one(scene, joint.b, b):
                if what := _clash(scene, joint, other, (a, b), near()):
                    raise SceneError(joint.where, what, "leave one of them out")
                break


def _clash(scene: SceneData, joint: Joint, other: Joint, ends: tuple[Attachment, Attachment],
           near: float) -> str | None:
    """Return what is wrong with two joints between the same two bodies; ``ends`` are the other's, in the order of
    joint's.
    """
    between = f"{called(joint.a)} and {called(joint.b)}"
    if "weld" in (joint.joint_kind, other.joint_kind):
        verbs = ["welds" if each.joint_kind == "weld" else f"is a {each.joint_kind} joint between"
                 for each in (joint, other)]
        return f'{verbs[0]} {between}, but joint "{other.name}" {verbs[1]} them, too'
    kinds = {joint.joint_kind, other.joint_kind}
    parallel = np.linalg.norm(np.cross(joint.axes[:, 2], other.axes[:, 2])) <= 1e-9
    same_points = all(np.linalg.norm(point_of(scene, one) - point_of(scene, end)) <= near
                      for one, end in zip((joint.a, joint.b), ends, strict=True))
    if joint.is_driven and other.is_driven and DRIVEN[joint.joint_kind] == DRIVEN[other.joint_kind]:
        if (same_points and kinds == {"distance"}) or (parallel and "distance" not in kinds):
            return f'drives the {DRIVEN[joint.joint_kind]} of {between}, as joint "{other.name}" does'
    if same_points and (kinds <= set(POINT_KINDS) or kinds == {"distance"} or (kinds <= set(LINE_KINDS) and parallel)):
        return f'constrains the same motion of {between} as joint "{other.name}"'
    return None


def move_as_one(scene: SceneData, one: Attachment, other: Attachment) -> bool:
    """Return whether two ends are on one body, both on the ground, or at one place of a cable."""
    if one.on not in scene.cables:
        return one.on == other.on
    tolerance = LENGTH_TOLERANCE * scene.cables[one.on].length
    return one.on == other.on and abs(one.arc_length - other.arc_length) <= tolerance


def called(end: Attachment) -> str:
    """Return what messages call that which an end is on."""
    if end.on is None:
        return "the ground"
    return f'body "{end.on}"' if end.s is None else f'cable "{end.on}" at s = {show(end.s, "m")}'
