"""Checks of a joint against the scene that it joins, and what it takes from there."""

from __future__ import annotations

import warnings

import numpy as np

from ..base.rotations import cross
from ..errors import FunicularWarning, SceneError
from ..kernels.elements import built_in
from ..parts.joint import DRIVE_UNITS, DRIVEN, LINE_KINDS, POINT_KINDS, Joint
from ..parts.locations import point_of
from ..parts.scene_data import SceneData
from ..parts.validation import LENGTH_TOLERANCE, show
from .conflicts import called, check_other_joints, check_supports, move_as_one
from .frames import cable_frame, has_section
from .placement import placed_between

MOVABLE = 1e-3
"""Ends nearer to each other than this part of the scene's size are brought together at the start."""

UPRIGHT = 1e-3
"""A tangent nearer than this (sine of the angle) to up leaves the frame undefined."""


def placed_joint(scene: SceneData, joint: Joint) -> Joint:
    """Return the joint with its ends, axis and length complete, after a check of its ends; a gap is reported."""
    joint = placed_between(scene, joint)
    if move_as_one(scene, joint.a, joint.b):
        raise SceneError(joint.where, f"joins {called(joint.a)} to itself", "give it two ends")
    joint = joint.completed(_completed(scene, joint))
    _check_frames(scene, joint)
    check_other_joints(scene, joint, lambda: LENGTH_TOLERANCE * scene_size(scene, joint))
    check_joint(scene, joint)
    if _is_beyond(scene, joint, gap := _gap(scene, joint), LENGTH_TOLERANCE):
        message = f"{joint.where}: {_apart(scene, joint, gap)}; they are brought together"
        scene.messages.append(message)
        warnings.warn(message, FunicularWarning, stacklevel=4)
    return joint


def check_joint(scene: SceneData, joint: Joint) -> None:
    """Raise SceneError unless the ends of a complete joint are where it needs them, but for a small gap, and free to
    follow it.
    """
    check_supports(scene, joint)
    if _is_beyond(scene, joint, gap := _gap(scene, joint), MOVABLE):
        raise SceneError(joint.where, _apart(scene, joint, gap), "let them start as the joint needs them; only a gap "
                         f"of less than {MOVABLE * scene_size(scene, joint):.3g} m is closed")


def check_drive(scene: SceneData, joint: Joint) -> None:
    """Raise SceneError where the drive of a joint makes a run that starts as drawn begin with a jump."""
    if joint.prescribed is None:
        return
    name, start = DRIVEN[joint.joint_kind], 0.0
    size = 1.0 if name == "angle" else scene_size(scene, joint)
    if joint.joint_kind == "distance":
        a, b = point_of(scene, joint.a), point_of(scene, joint.b)
        start = float(np.linalg.norm(b - a))
    value = float(joint.prescribed.value(0.0))
    if abs(value - start) > (LENGTH_TOLERANCE if joint.joint_kind != "distance" else MOVABLE) * size:
        raise SceneError(joint.where, f"{name} is {show(value, DRIVE_UNITS[name])} at t = 0, but the joint starts at "
                         f"{show(start, DRIVE_UNITS[name])}", 'let it start there, or start with initial="equilibrium"')


def _completed(scene: SceneData, joint: Joint) -> dict:
    """Return what is left out and follows from the scene."""
    if joint.joint_kind == "revolute" and joint.axis is None:
        if scene.dim == 3:
            raise SceneError(joint.where, "axis is missing: a revolute joint needs it")
        plane = scene.plane
        return {"axis": (0.0, 0.0, 1.0) if plane is None else tuple(plane.normal.tolist())}
    if joint.joint_kind != "distance":
        return {}
    points = point_of(scene, joint.a), point_of(scene, joint.b)
    distance = float(np.linalg.norm(points[1] - points[0]))
    if not distance > 1e-12 * (1 + np.abs(points).max()):
        raise SceneError(joint.where, f"both ends are at {show(points[0], 'm')}: its direction is lost",
                         'take kind="spherical", or draw them apart')
    return {"length": distance} if joint.length is None and joint.distance is None else {}


def scene_size(scene: SceneData, joint: Joint) -> float:
    """Return the largest extent in m of what is in the scene."""
    points = [point_of(scene, joint.a), point_of(scene, joint.b)]
    points += [body.frame[0] for body in scene.bodies.values()]
    return max(_extent(points), *(cable.length for cable in scene.cables.values()), 0.0)


def _is_beyond(scene: SceneData, joint: Joint, gap: float, part: float) -> bool:
    """Return whether a gap in m is larger than this part of the scene's size.

    What the joint joins is a part of the scene: mostly it is large enough to tell, and all else is not looked at.
    """
    joined = [point_of(scene, joint.a), point_of(scene, joint.b)]
    joined += [scene.bodies[end.on].frame[0] for end in (joint.a, joint.b) if end.on in scene.bodies]
    return gap > part * _extent(joined) and gap > part * scene_size(scene, joint)


def _extent(points: list[np.ndarray]) -> float:
    """Return the length in m of the diagonal of points, along the axes."""
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def _gap(scene: SceneData, joint: Joint) -> float:
    """Return how far in m the ends are from where the joint holds them."""
    apart = point_of(scene, joint.b) - point_of(scene, joint.a)
    if joint.joint_kind in LINE_KINDS:
        return float(np.linalg.norm(cross(joint.axes[:, 2], apart)))
    distance = float(np.linalg.norm(apart))
    if joint.joint_kind in POINT_KINDS:
        return distance
    return 0.0 if joint.length is None else abs(distance - joint.length)


def _apart(scene: SceneData, joint: Joint, gap: float) -> str:
    """Return a sentence on a gap."""
    a, b = point_of(scene, joint.a), point_of(scene, joint.b)
    at = f"a at {show(a)} and b at {show(b, 'm')}"
    if joint.joint_kind in POINT_KINDS:
        return f"its ends are {gap:.6g} m apart at the start, {at}"
    if joint.joint_kind in LINE_KINDS:
        return f"its ends are {gap:.6g} m apart across the axis at the start, {at}"
    return f"its ends are {np.linalg.norm(b - a):.6g} m apart at the start, and not {joint.length:.6g} m, {at}"


def _check_frames(scene: SceneData, joint: Joint) -> None:
    """Raise SceneError where a joint needs more than the tangent of a cable without section axes, and up does not
    complete it.
    """
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
    """Return whether all that the joint holds at this end of a cable is along its tangent."""
    if joint.is_driven or joint.joint_kind in ("weld", "prismatic"):
        return False
    axis = joint.axes[:, 0 if joint.joint_kind == "universal" and end == "b" else 2]
    return float(np.linalg.norm(cross(axis, tangent))) <= 1e-6


def _needs(joint: Joint) -> str:
    if joint.is_driven or joint.joint_kind in ("weld", "prismatic"):
        return f"a {'driven ' * joint.is_driven}{joint.joint_kind} joint needs"
    return f"a {joint.joint_kind} joint about an axis that is not its tangent needs"


def elements_with_sections() -> str:
    """Return the elements to take instead, for a remedy."""
    return "element=" + " or ".join(f'"{n}"' for n, kind in built_in().items() if kind.director and kind.dim == 3)


def check_up(up: tuple[float, ...], tangent: np.ndarray, what: str, where: str) -> None:
    """Raise SceneError where the direction ``up`` lies along the tangent of ``what``: it completes no frame there."""
    if np.linalg.norm(cross(tangent, up)) <= UPRIGHT * np.linalg.norm(up):
        raise SceneError(where, f"up {show(up)} is along the tangent of {what}, {show(tangent)}: the frame is lost",
                         "give a direction across it")
