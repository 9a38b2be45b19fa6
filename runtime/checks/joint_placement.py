"""Checks of a joint against the scene that it joins, and what it takes from there."""

from __future__ import annotations

import warnings
from itertools import islice
from weakref import WeakKeyDictionary

import numpy as np

from ..errors import FunicularWarning, SceneError
from ..kernels.elements import built_in
from ..parts.cable import EXACT
from ..parts.joint import DRIVEN, LINES, POINTS, UNITS, Joint
from ..parts.locations import point_of
from ..parts.scene_data import SceneData
from ..parts.validation import show
from .conflicts import called, check_other_joints, check_supports, move_as_one
from .frames import cable_frame, has_section
from .placement import placed_between

MOVABLE = 1e-3
"""Ends nearer to each other than this part of the scene's size are brought together at the start."""

UPRIGHT = 1e-3
"""A tangent nearer than this (sine of the angle) to up leaves the frame undefined."""

_BOUNDS: WeakKeyDictionary[SceneData, tuple[int, np.ndarray]] = WeakKeyDictionary()
"""How many bodies of a scene have been looked at, and their bounds."""


def placed_joint(scene: SceneData, joint: Joint) -> Joint:
    """Return the joint with its ends, axis and length complete, after a check of its ends; a gap is reported."""
    joint = placed_between(scene, joint)
    if move_as_one(scene, joint.a, joint.b):
        raise SceneError(joint.where, f"joins {called(joint.a)} to itself", "give it two ends")
    joint = joint.model_copy(update=_completed(scene, joint))
    _check_frames(scene, joint)
    check_other_joints(scene, joint, EXACT * scene_size(scene, joint))
    check_joint(scene, joint)
    gap, where = _gap(scene, joint)
    if gap > EXACT * scene_size(scene, joint):
        message = f"{joint.where}: {where}; they are brought together"
        scene.messages.append(message)
        warnings.warn(message, FunicularWarning, stacklevel=4)
    return joint


def check_joint(scene: SceneData, joint: Joint) -> None:
    """Raise SceneError unless the ends of a complete joint are where it needs them, but for a small gap, and free to
    follow it.
    """
    check_supports(scene, joint)
    gap, where = _gap(scene, joint)
    most = MOVABLE * scene_size(scene, joint)
    if gap > most:
        raise SceneError(joint.where, where, "let them start as the joint needs them; only a gap of less than "
                         f"{most:.3g} m is closed")


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
    if abs(value - start) > (EXACT if joint.joint_kind != "distance" else MOVABLE) * size:
        raise SceneError(joint.where, f"{name} is {show(value, UNITS[name])} at t = 0, but the joint starts at "
                         f"{show(start, UNITS[name])}", 'let it start there, or start with initial="equilibrium"')


def _completed(scene: SceneData, joint: Joint) -> dict:
    """Return what is left out and follows from the scene."""
    if joint.joint_kind == "revolute" and joint.axis is None:
        if scene.dim == 3:
            raise SceneError(joint.where, "axis is missing: a revolute joint needs it")
        return {"axis": (0.0, 0.0, 1.0)}
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
    points = [point_of(scene, joint.a), point_of(scene, joint.b), *_bounds_of_bodies(scene)]
    return max(float(np.linalg.norm(np.ptp(points, axis=0))), *(cable.length for cable in scene.cables.values()), 0.0)


def _bounds_of_bodies(scene: SceneData) -> np.ndarray:
    """Return (2, 3): the least and the largest coordinates of the bodies' origins, in m; (0, 3) without bodies.

    Bodies are looked at once, not for each joint of a chain again: they do not change, and none is taken away.
    """
    count, bounds = _BOUNDS.get(scene, (0, np.zeros((0, 3))))
    if new := [body.point((0.0, 0.0, 0.0)) for body in islice(scene.bodies.values(), count, None)]:
        points = np.vstack([bounds, *new])
        bounds = np.array([points.min(axis=0), points.max(axis=0)])
        _BOUNDS[scene] = len(scene.bodies), bounds
    return bounds


def _gap(scene: SceneData, joint: Joint) -> tuple[float, str]:
    """Return how far in m the ends are from where the joint holds them, and a sentence on it."""
    a, b = point_of(scene, joint.a), point_of(scene, joint.b)
    apart, at = b - a, f"a at {show(a)} and b at {show(b, 'm')}"
    if joint.joint_kind in POINTS:
        gap = float(np.linalg.norm(apart))
        return gap, f"its ends are {gap:.6g} m apart at the start, {at}"
    if joint.joint_kind in LINES:
        gap = float(np.linalg.norm(np.cross(joint.axes[:, 2], apart)))
        return gap, f"its ends are {gap:.6g} m apart across the axis at the start, {at}"
    distance = float(np.linalg.norm(apart))
    length = distance if joint.length is None else joint.length
    return abs(distance - length), f"its ends are {distance:.6g} m apart at the start, and not {length:.6g} m, {at}"


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
    return float(np.linalg.norm(np.cross(axis, tangent))) <= 1e-6


def _needs(joint: Joint) -> str:
    if joint.is_driven or joint.joint_kind in ("weld", "prismatic"):
        return f"a {'driven ' * joint.is_driven}{joint.joint_kind} joint needs"
    return f"a {joint.joint_kind} joint about an axis that is not its tangent needs"


def elements_with_sections() -> str:
    """Return the elements to take instead, for a remedy."""
    return "element=" + " or ".join(f'"{n}"' for n, kind in built_in().items() if kind.director and kind.dim == 3)


def check_up(up: tuple[float, ...], tangent: np.ndarray, what: str, where: str) -> None:
    """Raise SceneError where the direction ``up`` lies along the tangent of ``what``: it completes no frame there."""
    if np.linalg.norm(np.cross(tangent, up)) <= UPRIGHT * np.linalg.norm(up):
        raise SceneError(where, f"up {show(up)} is along the tangent of {what}, {show(tangent)}: the frame is lost",
                         "give a direction across it")
