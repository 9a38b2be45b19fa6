"""Checks of a joint against its scene and against other joints, and its completion."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..base.rotations import cross
from ..errors import SceneError
from ..parts.attachment import Attachment
from ..parts.joint import DRIVE_UNITS, DRIVEN, LINE_KINDS, POINT_KINDS, Joint
from ..parts.locations import Node, joined, point_of, support_of
from ..parts.scene_data import SceneData
from ..parts.support import Motion, Support
from ..parts.validation import LENGTH_TOLERANCE, show
from .frames import cable_frame, has_section, plane_normal
from .placement import SUPPORTED, elements_with_sections, placed_between, report

MAX_GAP = 1e-3
"""Largest gap of a joint that the start closes, as a fraction of the scene's size."""
MIN_UP_SINE = 1e-3
"""Sine of the angle of tangent and up below which they determine no frame."""


def placed_joint(scene: SceneData, joint: Joint) -> Joint:
    """Return the joint complete and checked; a gap is reported. Raises SceneError."""
    joint = placed_between(scene, joint)
    if move_as_one(scene, joint.a, joint.b):
        raise SceneError(joint.where, f"joins {called(scene, joint.a)} to itself", "give it two ends")
    _check_on_ropes(scene, joint)
    _check_friction(scene, joint)
    joint = joint.completed(_completed(scene, joint))
    _check_frames(scene, joint)
    check_other_joints(scene, joint, lambda: LENGTH_TOLERANCE * scene_size(scene, joint))
    check_joint(scene, joint)
    if _is_beyond(scene, joint, gap := _gap(scene, joint), LENGTH_TOLERANCE):
        report(scene, f"{joint.where}: {_apart(scene, joint, gap)}; they are brought together")
    return joint


def _check_on_ropes(scene: SceneData, joint: Joint) -> None:
    """Raise SceneError for a joint that would hold the direction of a rope."""
    held = next((scene.ropes[end.on] for end in (joint.a, joint.b) if end.on in scene.ropes), None)
    if held is None or joint.joint_kind in ("spherical", "distance"):
        return
    if joint.joint_kind != "revolute" or held.dim == 3 or joint.is_driven:
        driven = "driven " * joint.is_driven
        raise SceneError(joint.where, f'a {driven}{joint.joint_kind} joint needs axes, and rope "{held.name}" has none',
                         'take kind="spherical" or "distance"')


def _check_friction(scene: SceneData, joint: Joint) -> None:
    """Raise SceneError for friction of a joint on a rope."""
    for end in (joint.a, joint.b):
        if joint.friction is not None and end.on in scene.ropes:
            raise SceneError(joint.where, f'has friction, but "{end.on}" is a rope, which has no axes',
                             "join it to a small body, and that to the rope by another joint")


def check_joint(scene: SceneData, joint: Joint) -> None:
    """Raise SceneError for a complete joint with a large gap, or with an end that cannot follow it."""
    check_supports(scene, joint)
    if _is_beyond(scene, joint, gap := _gap(scene, joint), MAX_GAP):
        raise SceneError(joint.where, _apart(scene, joint, gap), "let them start as the joint needs them; only a gap "
                         f"of less than {MAX_GAP * scene_size(scene, joint):.3g} m is closed")


def check_drive(scene: SceneData, joint: Joint) -> None:
    """Raise SceneError where a run as drawn would begin with a jump of a driven joint."""
    if joint.prescribed is None:
        return
    name, start = DRIVEN[joint.joint_kind], 0.0
    size = 1.0 if name == "angle" else scene_size(scene, joint)
    if joint.joint_kind == "distance":
        a, b = point_of(scene, joint.a), point_of(scene, joint.b)
        start = float(np.linalg.norm(b - a))
    value = float(joint.prescribed.value(0.0))
    if abs(value - start) > (LENGTH_TOLERANCE if joint.joint_kind != "distance" else MAX_GAP) * size:
        raise SceneError(joint.where, f"{name} is {show(value, DRIVE_UNITS[name])} at t = 0, but the joint starts at "
                         f"{show(start, DRIVE_UNITS[name])}", 'let it start there, or start with initial="equilibrium"')


def _completed(scene: SceneData, joint: Joint) -> dict[str, Any]:
    """Return the fields that follow from the scene."""
    if joint.joint_kind == "revolute" and joint.axis is None:
        if scene.dim == 3:
            raise SceneError(joint.where, "axis is missing: a revolute joint needs it")
        return {"axis": tuple(plane_normal(scene).tolist())}
    if joint.joint_kind != "distance":
        return {}
    points = point_of(scene, joint.a), point_of(scene, joint.b)
    distance = float(np.linalg.norm(points[1] - points[0]))
    if not distance > 1e-12 * (1 + np.abs(points).max()):
        raise SceneError(joint.where, f"both ends are at {show(points[0], 'm')}: its direction is lost",
                         'take kind="spherical", or draw them apart')
    return {"length": distance} if joint.length is None and joint.distance is None else {}


def scene_size(scene: SceneData, joint: Joint) -> float:
    """Return the largest extent of the scene, m."""
    points = [point_of(scene, joint.a), point_of(scene, joint.b)]
    points += [body.frame[0] for body in scene.bodies.values()]
    lengths = [cable.length for cable in scene.cables.values()]
    lengths += [scene.route_of(scene.ropes[end.on]).length for end in (joint.a, joint.b) if end.on in scene.ropes]
    return max(_extent(points), *lengths, 0.0)


def _is_beyond(scene: SceneData, joint: Joint, gap: float, part: float) -> bool:
    """Return whether a gap in m is larger than this fraction of the scene's size.

    The ends of the joint bound this size from below, which mostly decides without the rest of the scene.
    """
    joined = [point_of(scene, joint.a), point_of(scene, joint.b)]
    joined += [scene.bodies[end.on].frame[0] for end in (joint.a, joint.b) if end.on in scene.bodies]
    return gap > part * _extent(joined) and gap > part * scene_size(scene, joint)


def _extent(points: list[np.ndarray]) -> float:
    """Return the diagonal of the bounding box of points, m."""
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def _gap(scene: SceneData, joint: Joint) -> float:
    """Return the distance of the ends from their places in the joint, m."""
    apart = point_of(scene, joint.b) - point_of(scene, joint.a)
    if joint.joint_kind in LINE_KINDS:
        return float(np.linalg.norm(cross(joint.axes[:, 2], apart)))
    distance = float(np.linalg.norm(apart))
    if joint.joint_kind in POINT_KINDS:
        return distance
    return 0.0 if joint.length is None else abs(distance - joint.length)


def _apart(scene: SceneData, joint: Joint, gap: float) -> str:
    """Return a sentence about a gap."""
    a, b = point_of(scene, joint.a), point_of(scene, joint.b)
    at = f"a at {show(a)} and b at {show(b, 'm')}"
    if joint.joint_kind in POINT_KINDS:
        return f"its ends are {gap:.6g} m apart at the start, {at}"
    if joint.joint_kind in LINE_KINDS:
        return f"its ends are {gap:.6g} m apart across the axis at the start, {at}"
    return f"its ends are {np.linalg.norm(b - a):.6g} m apart at the start, and not {joint.length:.6g} m, {at}"


def _check_frames(scene: SceneData, joint: Joint) -> None:
    """Raise SceneError where a joint needs section axes that its cable lacks and up does not determine."""
    bare = False
    for name in ("a", "b"):
        end = getattr(joint, name)
        if end.on not in scene.cables or has_section(cable := scene.cables[end.on]):
            continue
        bare, tangent = True, cable_frame(cable, end.s)[:, 0]
        if joint.up is not None:
            check_up(joint.up, tangent, f'cable "{cable.name}"', joint.where)
        elif joint.joint_kind not in ("spherical", "distance") and not _tangent_is_enough(joint, name, tangent):
            raise SceneError(joint.where, f'{name}: {_needs(joint)} section axes of cable "{cable.name}", but '
                             f"{cable.element} has a tangent only, {show(tangent)} there",
                             f"give up, a direction off the tangent, or take {elements_with_sections()}")
    if joint.up is not None and not bare:
        raise SceneError(joint.where, "up is given, but no end is on a cable without section axes", "leave it out")


def _tangent_is_enough(joint: Joint, end: str, tangent: np.ndarray) -> bool:
    """Return whether the joint needs only the tangent of a cable at this end."""
    if joint.is_driven or joint.joint_kind in ("weld", "prismatic"):
        return False
    axis = joint.axes[:, 0 if joint.joint_kind == "universal" and end == "b" else 2]
    return float(np.linalg.norm(cross(axis, tangent))) <= 1e-6


def _needs(joint: Joint) -> str:
    if joint.is_driven or joint.joint_kind in ("weld", "prismatic"):
        return f"a {'driven ' * joint.is_driven}{joint.joint_kind} joint needs"
    return f"a {joint.joint_kind} joint about an axis that is not its tangent needs"


def check_up(up: tuple[float, ...], tangent: np.ndarray, what: str, where: str) -> None:
    """Raise SceneError where the direction ``up`` lies along the tangent of ``what``."""
    if np.linalg.norm(cross(tangent, up)) <= MIN_UP_SINE * np.linalg.norm(up):
        raise SceneError(where, f"up {show(up)} is along the tangent of {what}, {show(tangent)}: the frame is lost",
                         "give a direction across it")


def check_supports(scene: SceneData, joint: Joint) -> None:
    """Raise SceneError where a support or a tie already fixes a node to the other end of the joint."""
    for end, other in ((joint.a, joint.b), (joint.b, joint.a)):
        if (node := _node(scene, end)) is None:
            continue
        support = support_of(scene, node)
        if other.on is None and support is not None and _fixes_position(support):
            raise SceneError(joint.where, f"fixes {called(scene, end)} to the ground, but it is "
                             f"{SUPPORTED[support.kind]} already", "leave one of them out")
        if _node(scene, other) in joined(scene, node):
            raise SceneError(joint.where, f"joins {called(scene, end)} to {called(scene, other)}, but their nodes are "
                             "joined already", "leave one of them out")


def _fixes_position(support: Support) -> bool:
    """Return whether a support leaves no direction free."""
    return not isinstance(support, Motion) or (support.displacement is not None and None not in support.displacement)


def _node(scene: SceneData, end: Attachment) -> Node | None:
    if end.on not in scene.cables or (node := scene.cables[end.on].node_at(end.arc_length)) is None:
        return None
    return end.on, node


def check_other_joints(scene: SceneData, joint: Joint, near: Callable[[], float]) -> None:
    """Raise SceneError where joints between the same bodies conflict: one is a weld, or both fix or drive one motion.

    near: returns the distance of coincident points, m; called only for joints between the same bodies.
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
    """Return the conflict of two joints between the same bodies; ``ends`` of the other one, in the order of joint's."""
    between = f"{called(scene, joint.a)} and {called(scene, joint.b)}"
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
    if one.on in scene.ropes:
        return one.on == other.on and one.s == other.s
    if one.on not in scene.cables:
        return one.on == other.on
    tolerance = LENGTH_TOLERANCE * scene.cables[one.on].length
    return one.on == other.on and abs(one.arc_length - other.arc_length) <= tolerance


def called(scene: SceneData, end: Attachment) -> str:
    """Return the name of the body, cable, rope or ground of an end in messages."""
    if end.on is None:
        return "the ground"
    line = "rope" if end.on in scene.ropes else "cable"
    return f'body "{end.on}"' if end.s is None else f'{line} "{end.on}" at s = {show(end.s, "m")}'
