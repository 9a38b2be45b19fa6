"""Checks of a slide against the scene that it joins, and what it takes from there."""

from __future__ import annotations

import warnings

import numpy as np

from ..errors import FunicularWarning, SceneError
from ..parts.cable import Cable
from ..parts.end_stops import Buffer
from ..parts.locations import point_of
from ..parts.rigid_body import RigidBody
from ..parts.scene_data import SceneData
from ..parts.slide import Slide
from ..parts.validation import EXACT, show
from .frames import cable_frame, has_section
from .joint_placement import check_up, elements_with_sections
from .placement import cable_at, placed_attachment

MOVABLE = 1e-3
"""A rider nearer to its cable than this part of the cable's length is moved onto it at the start."""


def placed_slide(scene: SceneData, slide: Slide) -> Slide:
    """Return the slide with its places and its up complete, its rider on the cable."""
    if slide.body in scene.cables and slide.body_s is None:
        raise SceneError(slide.where, f'cable "{slide.body}" rides and needs the arc-length of its point',
                         f'give body=("{slide.body}", s)')
    rider = placed_attachment(scene, slide.rider, slide.where, "body: ")
    cable = cable_at(scene, slide.along, slide.where, slide.s)
    place = {"body_s": rider.s} if rider.at is None else {"body_s": None, "at": rider.at}
    slide = slide.completed({"s": min(max(slide.s, 0.0), cable.length)} | place)
    _check_rider(scene, slide)
    slide = _framed(scene, slide, cable)
    _check_drive(slide, cable)
    for name in ("at_start", "at_end"):
        stop = getattr(slide, name)
        if isinstance(stop, Buffer) and stop.length > cable.length * (1 + EXACT):
            raise SceneError(slide.where, f"{name}: the buffer's length must not exceed that of cable "
                             f'"{cable.name}", {show(cable.length, "m")}, got {show(stop.length, "m")}')
    _seat(scene, slide, cable)
    return slide


def check_on_cable(scene: SceneData, slide: Slide) -> None:
    """Raise SceneError where a rider is not on its cable any more, since others moved it."""
    gap = _gap(scene, slide)
    if gap > (EXACT if slide.body_s is None else MOVABLE) * scene.cables[slide.along].length:
        raise SceneError(slide.where, _away(scene, slide, gap),
                         f"{_carrier(slide)} is on more than one slide: it cannot be moved for each")


def _check_rider(scene: SceneData, slide: Slide) -> None:
    if slide.body is not None and slide.body == slide.along:
        raise SceneError(slide.where, f'cable "{slide.along}" rides itself', "let another cable ride, or a body")
    for other in scene.slides.values():
        if (other.body, other.along) != (slide.body, slide.along):
            continue
        if other.rider == slide.rider:
            raise SceneError(slide.where,
                             f'puts the same point of {_carrier(slide)} on cable "{slide.along}" as slide '
                             f'"{other.name}"', "leave one of them out, or give them different points "
                             + ("at" if slide.body_s is None else "body_s"))
        both = slide.prescribed is not None and other.prescribed is not None
        if both and slide.body in scene.bodies:
            raise SceneError(slide.where, f'drives body "{slide.body}" along cable "{slide.along}", as slide '
                             f'"{other.name}" does', "leave one of the drives out")


def _carrier(slide: Slide) -> str:
    """Return what the rider's point belongs to, for messages."""
    if slide.body is None:
        return "the ground"
    return f'{"body" if slide.body_s is None else "cable"} "{slide.body}"'


def _framed(scene: SceneData, slide: Slide, cable: Cable) -> Slide:
    """Return the slide with up complete, sure that cable and rider have the vectors that its frame needs."""
    if slide.frame == "point":
        return slide
    if slide.frame == "section" and not cable.kind_of_element.director:
        with_axes = '"beam12p"' if cable.dim == 2 else elements_with_sections().removeprefix("element=")
        raise SceneError(slide.where, f'frame "section" needs section axes (r_y) of cable "{cable.name}", but '
                         f"{cable.element} has a tangent only", f'take frame="tangent", or element={with_axes}')
    if slide.body in scene.cables and not has_section(rider := scene.cables[slide.body]):
        raise SceneError(slide.where, f'frame "{slide.frame}" needs section axes of the rider, cable "{rider.name}", '
                         f"but {rider.element} has a tangent only",
                         f'take frame="point", or {elements_with_sections()}')
    if slide.roll == "free" or cable.dim == 2:
        return slide
    up = slide.up
    if up is None:
        size = np.linalg.norm(scene.gravity)
        up = tuple((-np.array(scene.gravity) / size + 0.0).tolist()) if size > 0 else cable.height_direction
    check_up(up, cable_frame(cable, slide.s)[:, 0], f'cable "{cable.name}"', slide.where)
    return slide.completed({"up": up})


def _check_drive(slide: Slide, cable: Cable) -> None:
    """Raise SceneError unless a driven slide starts where it is, on the cable."""
    if slide.drive is None:
        return
    start = float(slide.drive.value(0.0))
    if not -EXACT * cable.length <= start <= (1 + EXACT) * cable.length:
        raise SceneError(slide.where, f"drive is {show(start, 'm')} at t = 0, off the cable, [0, {cable.length:.9g}] m",
                         f"let it start at s = {show(slide.s, 'm')}")
    if abs(start - slide.s) > EXACT * cable.length:
        raise SceneError(slide.where, f"drive is {show(start, 'm')} at t = 0, but the slide starts at s = "
                         f"{show(slide.s, 'm')}", "let both start at one place")


def _gap(scene: SceneData, slide: Slide) -> float:
    """Return the distance in m from the rider's point to its place on the cable."""
    return float(np.linalg.norm(point_of(scene, slide.rider) - scene.cables[slide.along].point(slide.s)))


def _away(scene: SceneData, slide: Slide, gap: float) -> str:
    """Return a sentence on that distance."""
    rider = f'the point of {_carrier(slide)} at {show(point_of(scene, slide.rider), "m")}'
    return f'{rider} is {gap:.6g} m away from cable "{slide.along}" at s = {slide.s:.9g} m'


def _seat(scene: SceneData, slide: Slide, cable: Cable) -> None:
    """Bring the rider's point onto the cable by a small move, refuse a large one."""
    gap = _gap(scene, slide)
    if gap <= EXACT * cable.length:
        return
    where = _away(scene, slide, gap)
    start = point_of(scene, slide.rider)
    body, onto = scene.bodies.get(slide.body or ""), cable.point(slide.s) - start
    body = body if isinstance(body, RigidBody) else None
    if gap > MOVABLE * cable.length:
        remedy = f"slide from s = {cable.nearest_s(start):.6g} m"
        if body is not None:
            remedy = f"start the body at position {show(body.position + onto, 'm')}, or {remedy}"
        raise SceneError(slide.where, where, remedy)
    if body is None:
        message = f"{slide.where}: {where}; they are brought together"
    else:
        scene.bodies[body.name] = body.model_copy(update={"position": tuple((body.position + onto).tolist())})
        message = f'{slide.where}: body "{body.name}" was moved by {gap:.6g} m onto cable "{cable.name}"'
    scene.messages.append(message)
    warnings.warn(message, FunicularWarning, stacklevel=5)
