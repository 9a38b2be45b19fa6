"""Checks of a slide against its scene, and its completion."""

from __future__ import annotations

import math

import numpy as np

from ..errors import SceneError
from ..parts.cable import Cable
from ..parts.end_stops import Buffer
from ..parts.locations import point_of
from ..parts.rigid_body import RigidBody
from ..parts.scene_data import SceneData
from ..parts.slide import Slide
from ..parts.validation import LENGTH_TOLERANCE, show
from .frames import cable_frame, has_section, rope_frame
from .joint_placement import check_up
from .placement import check_without_hinge, elements_with_sections, placed_attachment, report
from .slide_on_rope import Line, check_on_line, check_possible_on_rope, line_of

MAX_GAP = 1e-3
"""Largest distance of a rider that is moved onto its cable at the start, as a fraction of the cable's length."""
MAX_DISTANCE_RATIO = 10.0
"""Largest distance of an alternative place on the cable, over the least distance."""


def placed_slide(scene: SceneData, slide: Slide) -> Slide:
    """Return the slide complete, with its rider on the cable. Raises SceneError."""
    if slide.body is not None and scene.line(slide.body) and slide.body_s is None:
        raise SceneError(slide.where, f"{_carrier(scene, slide)} rides and needs the arc-length of its point",
                         f'give body=("{slide.body}", s)')
    rider = placed_attachment(scene, slide.rider, slide.where, "body: ")
    slide = slide.completed({"body_s": rider.s} if rider.at is None else {"body_s": None, "at": rider.at})
    line = line_of(scene, slide)
    _check_rider(scene, slide)
    s = _start(scene, slide, line) if slide.s is None else slide.s
    check_on_line(scene, slide, line, s)
    if isinstance(line, Cable):
        slide = _framed(scene, slide.completed({"s": min(max(s, 0.0), line.length)}), line)
        check_without_hinge(slide.where, line)
        _check_buffers(slide, line)
    else:
        slide = slide.completed({"s": s})
        check_possible_on_rope(slide, line)
        slide = _framed(scene, slide, line)
    _check_drive(slide, line)
    return _seated(scene, slide, line)


def _check_buffers(slide: Slide, cable: Cable) -> None:
    """Raise SceneError for a buffer that is longer than the cable."""
    for name in ("at_start", "at_end"):
        stop = getattr(slide, name)
        if isinstance(stop, Buffer) and stop.length > cable.length * (1 + LENGTH_TOLERANCE):
            raise SceneError(slide.where, f"{name}: the buffer's length must not exceed that of {cable.where}, "
                             f'{show(cable.length, "m")}, got {show(stop.length, "m")}')


def check_on_cable(scene: SceneData, slide: Slide) -> None:
    """Raise SceneError for a body off its cable because another slide moved it."""
    line = line_of(scene, slide)
    if not isinstance(line, Cable):  # a route is drawn anew where a body has moved
        check_on_line(scene, slide, line, slide.arc_length)
    gap, moved = _gap(scene, slide, line), isinstance(scene.bodies.get(slide.body or ""), RigidBody)
    if gap > (LENGTH_TOLERANCE if moved else MAX_GAP) * line.length:
        raise SceneError(slide.where, _away(scene, slide, line, gap),
                         f"{_carrier(scene, slide)} is on more than one slide: it cannot be moved for each")


def _start(scene: SceneData, slide: Slide, line: Line) -> float:
    """Return the arc-length at which a slide without s starts, m. Raises SceneError for several places."""
    if slide.drive is not None:
        return float(slide.drive.value(0.0))
    point = point_of(scene, slide.rider)
    places = line.nearest_s(point)
    gaps = np.linalg.norm(line.points_at(places) - point, axis=-1)
    if gaps[0] > MAX_GAP * line.length:
        at_nearest = slide.completed({"s": places[0]})
        kind = "cable" if isinstance(line, Cable) else "rope"
        raise SceneError(slide.where, _away(scene, at_nearest, line, gaps[0]) + ", the nearest place",
                         f"draw the {kind} through that point, or move the point to the {kind}")
    if len(near := places[gaps <= max(MAX_DISTANCE_RATIO * gaps[0], LENGTH_TOLERANCE * line.length)]) > 1:
        raise SceneError(slide.where, f'{line.where} passes the point of {_carrier(scene, slide)} at '
                         f"{show(point, 'm')} at s = {' and '.join(f'{s:.6g}' for s in np.sort(near))} m", "give s")
    return float(places[0])


def _check_rider(scene: SceneData, slide: Slide) -> None:
    if slide.body is not None and slide.body == slide.along:
        raise SceneError(slide.where, f"{line_of(scene, slide).where} rides itself",
                         "let another cable ride, or a body")
    for other in scene.slides.values():
        if (other.body, other.along) != (slide.body, slide.along):
            continue
        if other.rider == slide.rider:
            raise SceneError(slide.where,
                             f"puts the same point of {_carrier(scene, slide)} on {line_of(scene, slide).where} as "
                             f'slide "{other.name}"', "leave one of them out, or give them different points "
                             + ("at" if slide.body_s is None else "body_s"))
        if slide.is_driven and other.is_driven and slide.body in scene.bodies:
            raise SceneError(slide.where, f'drives body "{slide.body}" along {line_of(scene, slide).where}, as slide '
                             f'"{other.name}" does', "leave one of the drives out")


def _carrier(scene: SceneData, slide: Slide) -> str:
    """Return the name of the rider in messages."""
    if slide.body is None:
        return "the ground"
    line = scene.line(slide.body)
    return f'body "{slide.body}"' if line is None else line.where


def _framed(scene: SceneData, slide: Slide, line: Line) -> Slide:
    """Return the slide with up complete, checked for the vectors that its frame needs."""
    if slide.frame == "point":
        return slide
    cable = line if isinstance(line, Cable) else None
    dim = line.dim if isinstance(line, Cable) else line.rope.dim
    if slide.body in scene.ropes:
        raise SceneError(slide.where, f'frame "{slide.frame}" needs axes of the rider, and rope "{slide.body}" has '
                         "none", 'take frame="point"')
    if slide.frame == "section" and cable is not None and not cable.kind_of_element.director:
        with_axes = '"beam12p"' if cable.dim == 2 else elements_with_sections().removeprefix("element=")
        raise SceneError(slide.where, f'frame "section" needs section axes (r_y) of cable "{cable.name}", but '
                         f"{cable.element} has a tangent only", f'take frame="tangent", or element={with_axes}')
    if slide.body in scene.cables and not has_section(rider := scene.cables[slide.body]):
        raise SceneError(slide.where, f'frame "{slide.frame}" needs section axes of the rider, cable "{rider.name}", '
                         f"but {rider.element} has a tangent only",
                         f'take frame="point", or {elements_with_sections()}')
    if slide.roll == "free" or dim == 2:
        return slide
    frame = cable_frame(cable, slide.arc_length) if cable else rope_frame(scene, slide.along, slide.arc_length)
    up = slide.up
    if up is None:
        size = np.linalg.norm(scene.gravity)
        across = cable.height_direction if cable else tuple(frame[:, 1].tolist())
        up = tuple((-np.array(scene.gravity) / size + 0.0).tolist()) if size > 0 else across
    check_up(up, frame[:, 0], line.where, slide.where)
    return slide.completed({"up": up})


def _check_drive(slide: Slide, line: Line) -> None:
    """Raise SceneError unless a driven slide starts at its place on the cable or rope."""
    if slide.drive is None:
        return
    start, cable = float(slide.drive.value(0.0)), line
    if isinstance(cable, Cable) and not (
            -LENGTH_TOLERANCE * cable.length <= start <= (1 + LENGTH_TOLERANCE) * cable.length):
        raise SceneError(slide.where, f"drive is {show(start, 'm')} at t = 0, off the cable, [0, {cable.length:.9g}] m",
                         f"let it start at s = {show(slide.arc_length, 'm')}")
    if abs(start - slide.arc_length) > LENGTH_TOLERANCE * cable.length:
        raise SceneError(slide.where, f"drive is {show(start, 'm')} at t = 0, but the slide starts at s = "
                         f"{show(slide.arc_length, 'm')}", "let both start at one place")


def _gap(scene: SceneData, slide: Slide, line: Line) -> float:
    """Return the distance in m from the rider's point to its place on the cable or rope."""
    return math.dist(point_of(scene, slide.rider).tolist(), line.point(slide.arc_length).tolist())


def _away(scene: SceneData, slide: Slide, line: Line, gap: float) -> str:
    """Return a sentence about this distance."""
    rider = f'the point of {_carrier(scene, slide)} at {show(point_of(scene, slide.rider), "m")}'
    return f'{rider} is {gap:.6g} m away from {line.where} at s = {slide.arc_length:.9g} m'


def _seated(scene: SceneData, slide: Slide, cable: Line) -> Slide:
    """Return the slide with its rider moved onto the cable or rope. Raises SceneError for a large distance."""
    gap = _gap(scene, slide, cable)
    if gap <= LENGTH_TOLERANCE * cable.length:
        return slide
    where = _away(scene, slide, cable, gap)
    point = point_of(scene, slide.rider)
    body, onto = scene.bodies.get(slide.body or ""), cable.point(slide.arc_length) - point
    body = body if isinstance(body, RigidBody) else None
    if gap > MAX_GAP * cable.length:
        remedy = f"slide from s = {cable.nearest_s(point)[0]:.6g} m"
        if body is not None:
            remedy = f"start the body at position {show(body.position + onto, 'm')}, or {remedy}"
        raise SceneError(slide.where, where, remedy)
    if body is not None:
        scene.put(body.model_copy(update={"position": tuple((body.position + onto).tolist())}))
        message = f'{slide.where}: body "{body.name}" was moved by {gap:.6g} m onto {cable.where}'
    else:
        slide, nearest = _nearest(scene, slide, cable, gap)
        message = f"{slide.where}: {where}{nearest}"
    report(scene, message, 6)
    return slide


def _nearest(scene: SceneData, slide: Slide, cable: Line, gap: float) -> tuple[Slide, str]:
    """Return the slide at the place nearest to its rider's point, and a sentence about the change; a point of another
    cable keeps its place, as cables deform.
    """
    together = "; they are brought together"
    if slide.body_s is not None:
        return slide, together
    places = cable.nearest_s(point_of(scene, slide.rider))
    s = float(places[np.argmin(np.abs(places - slide.arc_length))])
    if not LENGTH_TOLERANCE * cable.length < abs(s - slide.arc_length) <= MAX_DISTANCE_RATIO * gap:
        return slide, together
    slide = slide.completed({"s": min(max(s, 0.0), cable.length) if isinstance(cable, Cable) else s})
    left = _gap(scene, slide, cable)
    near = f"; it starts from the nearest place, s = {slide.arc_length:.9g} m"
    return slide, near if left <= LENGTH_TOLERANCE * cable.length else f"{near}, {left:.6g} m away{together}"
