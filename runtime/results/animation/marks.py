"""Points and straight connections in a picture: supports, ties, joints, slides, springs, lever arms, loads."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Literal, NamedTuple

import numpy as np

from ...base.rotations import product, rotate, turned_by
from ...model.kinds import COUPLINGS
from ...parts.attachment import Attachment
from ...parts.cable import Cable
from ...parts.crossing import Crossing
from ...parts.joint import Joint
from ...parts.load import DistributedForce, Force, Load, Moment
from ...parts.locations import ends_of, node_of
from ...parts.modal_body import ModalBody
from ...parts.part import Part
from ...parts.rope import Rope
from ...parts.rope_items import Wheel
from ...parts.scene_data import SceneData
from ...parts.signal import Signal
from ...parts.support import Clamp, Motion, Support
from ...parts.validation import Vector, show, vector3
from ...view.animation import Mark, Segment
from .frames import Frames, along, moving, on_rope, one_or_all, place
from .references import slide_reference

ROUNDING_OF_POSITION = 1e-13
MIN_GAP = 1e-6
"""Distance over the size of the scene from which two ends are drawn apart."""
DISTRIBUTED_ARROWS = 9
"""Arrows of a distributed force."""
MAX_ARROW, MIN_ARROW = 0.15, 0.03
"""Bounds of the length of the largest arrow over the size of the scene; between them, the height of the scene."""
MIN_HEIGHT = 1e-3
"""Height over the size of a scene below which it is a straight line, whose arrows have the largest length."""


def still(position: np.ndarray) -> np.ndarray:
    """Return positions (T, 3), or the first as (1, 3) if all are equal up to rounding."""
    moves = np.abs(position - position[:1]).max() > ROUNDING_OF_POSITION * np.abs(position).max()
    return position if moves else position[:1]


def _node(frames: Frames, cable: str, node: int) -> np.ndarray:
    part = frames.scene.cables[cable]
    return frames.value(f"{cable}.nodal_vectors")[:, node, part.kind_of_element.nodal_vectors.index("r")]


def held_points(scene: SceneData) -> Iterator[tuple[str, str, Attachment]]:
    """Yield the points that hold ropes, ends and axles of sheaves and drums, with name and description."""
    for name, rope in scene.ropes.items():
        for item in rope.route:
            is_wheel = isinstance(item, Wheel)
            yield item.given_name or name, f'axle of "{item.given_name}"' if is_wheel else f'end of "{name}"', item.end


def marks(frames: Frames, refs: Frames, size: float) -> Iterator[Mark]:
    """Yield the marked points; refs: see `references`; size: of the scene, in m."""
    scene = frames.scene
    for support in scene.supports:
        kind, what = _support(support)
        node = node_of(scene, support)
        yield Mark(support.label, kind, still(_node(frames, *node)),
                   f'{what} of "{support.cable}" at s = {show(support.s, "m")}', _node(refs, *node)[0])
    for name, tie in scene.ties.items():
        one, _ = ends_of(scene, tie)
        yield Mark(name, "tie", still(_node(frames, *one)), f'tie of "{tie.cable}" and "{tie.to}"',
                   _node(refs, *one)[0])
    for name, joint in scene.joints.items():
        a, b = place(frames, joint.a), place(frames, joint.b)
        yield Mark(name, "joint", still(b), f"{joint.joint_kind} joint of {_on(joint.a)} and {_on(joint.b)}",
                   one_or_all(place(refs, joint.b)))
        if _apart(a, b, size):
            yield Mark(name, "joint", still(a), f"{joint.joint_kind} joint, its end on {_on(joint.a)}",
                       one_or_all(place(refs, joint.a)))
    for name, slide in scene.slides.items():
        yield Mark(name, "slide", still(slide_place(frames, name)),
                   f'slide of {_on(slide.rider)} along "{slide.along}"', slide_reference(frames, name))
    for part in coupling_parts(scene):
        name = part.given_name or part.kind
        if "position" in part.results and not isinstance(part, Rope) and frames.has(f"{name}.position"):
            yield Mark(name, "point", still(frames.value(f"{name}.position")), _point_description(part))
    for name, mass in scene.point_masses.items():
        end = Attachment(on=mass.on, s=mass.s)
        yield Mark(name, "point", still(place(frames, end)), f"{show(mass.mass, 'kg')} on {_on(end)}",
                   one_or_all(place(refs, end)))
    for part, end in _attachments(scene):
        if end.on is None:
            yield Mark(part.given_name or part.kind, "ground", place(frames, end), f"ground end of {part.where}")
    for name, what, end in held_points(scene):
        yield Mark(name, "ground" if end.on is None else "joint", place(frames, end), f"{what} on {_on(end)}",
                   one_or_all(place(refs, end)))
    for name, load in scene.loads.items():
        if isinstance(load, Moment):
            end = _loaded(frames, load)
            yield Mark(name, "point", still(place(frames, end)), f"moment {show(load.value, 'N m')} on {_on(end)}",
                       one_or_all(place(refs, end)))


def coupling_parts(scene: SceneData) -> Iterator[Part]:
    """Yield the parts of couplings, in the order of their kinds."""
    for group in dict.fromkeys(kind.group for kind in COUPLINGS):
        yield from scene.group(group)


def _attachments(scene: SceneData) -> Iterator[tuple[Part, Attachment]]:
    """Yield the attachments that are fields of parts, with their parts."""
    return ((part, value) for part in scene.parts() for _, value in part if isinstance(value, Attachment))


def _point_description(part: Part) -> str:
    """Return the description of a part that acts at a point."""
    if not isinstance(part, Crossing):
        return part.where
    other = "a bar" if part.at is not None else f'"{part.b}"'
    return f'contact of "{part.a}" and {other}'


def _support(support: Support) -> tuple[Literal["pin", "clamp"], str]:
    """Return the kind and the description of the mark of a support."""
    if isinstance(support, Motion):
        return ("pin" if support.rotation is None else "clamp"), "prescribed motion"
    return ("clamp", "clamp") if isinstance(support, Clamp) else ("pin", "pin")


def _on(end: Attachment) -> str:
    return "the ground" if end.on is None else f'"{end.on}"'


def _apart(a: np.ndarray, b: np.ndarray, size: float) -> bool:
    return bool(np.linalg.norm(a - b, axis=-1).max() > MIN_GAP * size)


def slide_place(frames: Frames, name: str) -> np.ndarray:
    """Return the positions (T, 3) of a slide in m: of its cable or rope at s, or of its rider if s is unknown."""
    slide = frames.scene.slides[name]
    if not frames.has(f"{name}.s"):
        return place(frames, slide.rider)
    if slide.along in frames.scene.ropes:
        return on_rope(frames, slide.along, frames.value(f"{name}.s"))
    return moving(frames.scene.cables[slide.along], frames.value(f"{name}.s"),
                  frames.value(f"{slide.along}.nodal_vectors"))


def arrow_length(extents: np.ndarray, size: float) -> float:
    """Return the length in m of the largest arrow in a scene of this size, whose box has the extents (3,), in m."""
    height = np.sort(extents)[1] / size
    return size * (MAX_ARROW if height < MIN_HEIGHT else float(np.clip(height, MIN_ARROW, MAX_ARROW)))


def segments(frames: Frames, refs: Frames, size: float, arrow: float) -> Iterator[Segment]:
    """Yield springs, lever arms, joints whose ends are apart, and loads and flows as arrows.

    refs: see `references`; size: of the scene, arrow: the length of the largest arrow, in m.
    """
    scene = frames.scene
    for part in coupling_parts(scene):
        ends = [value for _, value in part if isinstance(value, Attachment)]
        if len(ends) == 2 and not isinstance(part, Joint):
            kind: Literal["hanger", "spring"] = "hanger" if getattr(part, "only_pulls", False) else "spring"
            yield _between(frames, refs, part.given_name or part.kind, kind, *ends)
    for name, joint in scene.joints.items():
        if _apart(place(frames, joint.a), place(frames, joint.b), size):
            yield _between(frames, refs, name, "joint", joint.a, joint.b)
    yield from levers(frames, refs, size)
    yield from _bars(frames, refs)
    yield from _loads(frames, refs, arrow)
    yield from _flows(frames, refs, arrow)


def _bars(frames: Frames, refs: Frames) -> Iterator[Segment]:
    """Yield the bars that cables cross; a planar bar is a point."""
    for name, crossing in frames.scene.crossings.items():
        if crossing.axis is None or crossing.length is None or crossing.at is None:
            continue
        half = crossing.length * np.array(crossing.axis) / np.linalg.norm(crossing.axis)
        ends = (Attachment(on=crossing.b, at=vector3(np.array(crossing.at) + sign * half)) for sign in (-1, 1))
        yield _between(frames, refs, name, "lever", *ends)


def _between(frames: Frames, refs: Frames, name: str, kind: Literal["spring", "hanger", "lever", "joint"],
             a: Attachment, b: Attachment) -> Segment:
    """Return the straight connection of two ends."""
    return Segment(name, kind, place(frames, a), place(frames, b), _both(place(refs, a), place(refs, b)))


def _both(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Return the reference (2, 3) or (T, 2, 3) of a segment from the references (1 or T, 3) of its ends."""
    return one_or_all(np.stack(np.broadcast_arrays(start, end), axis=1))


def levers(frames: Frames, refs: Frames, size: float) -> Iterator[Segment]:
    """Yield the lever arms of rigid bodies, from the mass centre to each attachment."""
    scene = frames.scene
    ends = [(name, slide.rider) for name, slide in scene.slides.items()]
    ends += [(part.given_name or part.kind, end) for part, end in _attachments(scene)]
    ends += [(name, end) for name, _, end in held_points(scene)]
    for name, end in ends:
        body = None if end.on is None else scene.bodies.get(end.on)
        if body is None or isinstance(body, ModalBody):
            continue
        centre = Attachment(on=end.on, at=body.centre)
        if _apart(place(frames, centre), place(frames, end), size):
            yield _between(frames, refs, f"{end.on}, {name}", "lever", centre, end)


class _Arrow(NamedTuple):
    """A vector value (T or 1, 3) as an arrow with its head at points (T or 1, 3), and at those of reference."""

    name: str
    at: np.ndarray
    of: np.ndarray
    value: np.ndarray


def _arrow(frames: Frames, refs: Frames, name: str, end: Attachment, value: np.ndarray) -> _Arrow:
    """Return an arrow with its head at an attachment."""
    return _Arrow(name, place(frames, end), place(refs, end), value)


def _arrows(longest: float, found: list[_Arrow]) -> Iterator[Segment]:
    """Yield arrows, scaled to the longest."""
    largest = max((float(np.linalg.norm(each.value, axis=-1).max()) for each in found), default=0.0)
    for name, at, of, value in found if largest > 0 else ():
        arrow = longest / largest * value
        yield Segment(name, "load", at - arrow, at, _both(of - arrow, of))


def _loads(frames: Frames, refs: Frames, longest: float) -> Iterator[Segment]:
    """Yield forces as arrows, and distributed forces in a scale of their own."""
    forces: list[_Arrow] = []
    distributed: list[_Arrow] = []
    for name, load in frames.scene.loads.items():
        scale = _scale(frames, load)
        if isinstance(load, Force) and isinstance(load.s, Signal):
            forces += _moving_arrows(frames, refs, name, load)
        elif isinstance(load, Force):
            end = _loaded(frames, load)
            forces.append(_arrow(frames, refs, name, end, scale * _components(frames, end, load.value, load.follower)))
        elif isinstance(load, DistributedForce):
            first, last = _ends(frames, load.cable)
            start, stop = (given if given is not None else end
                           for given, end in ((load.start, first), (load.stop, last)))
            for s in np.linspace(max(start, first), min(stop, last), DISTRIBUTED_ARROWS):
                end = Attachment(on=load.cable, s=float(s))
                value = scale * _components(frames, end, load.value, load.follower)
                distributed.append(_arrow(frames, refs, name, end, value))
    yield from _arrows(longest, forces)
    yield from _arrows(longest, distributed)


def _moving_arrows(frames: Frames, refs: Frames, name: str, load: Force) -> Iterator[_Arrow]:
    """Yield the axles of a load that moves along a cable, without length off its ends."""
    cable, vectors = frames.scene.cables[load.on], f"{load.on}.nodal_vectors"
    nodal = frames.value(vectors)
    for at, share in load.axles_at(_load_time(frames), cable.length):
        value = np.array([load.value])
        if load.follower:
            value = _along_section(cable, load.value, partial(moving, cable, at, nodal))
        yield _Arrow(name, moving(cable, at, nodal), moving(cable, at, refs.value(vectors)),
                     share[:, None] * _scale(frames, load) * value)


def _ends(frames: Frames, name: str) -> tuple[float, float]:
    """Return the arc-lengths of the ends of a cable, or of what a rope has off its drums at all times, m."""
    if name in frames.scene.cables:
        return 0.0, frames.scene.cables[name].length
    s = frames.value(f"{name}.s")
    return float(s[:, 0].max()), float(s[:, -1].min())


def _flows(frames: Frames, refs: Frames, longest: float) -> Iterator[Segment]:
    """Yield velocities of fluids as arrows at the middle of cables and ropes and at the points of bodies with drag."""
    scene = frames.scene
    found: list[_Arrow] = []
    up, time = scene.up, _load_time(frames)
    for name, drag in scene.drags.items():
        fluids = [fluid for fluid in scene.fluids_of(drag) if fluid.moves]
        if not fluids:
            continue
        end = drag.attachment(scene.point_masses)
        if scene.line(drag.on) is not None:
            end = Attachment(on=drag.on, s=float(np.mean(_ends(frames, drag.on))))
        at = np.broadcast_to(place(frames, end), (len(time), 3))
        for fluid in fluids:
            is_there = (at @ up > fluid.bottom(scene.fluids.values())) & (at @ up <= fluid.top)
            found.append(_arrow(frames, refs, f"{fluid.given_name}, {name}", end,
                                is_there[:, None] * fluid.velocity_at(time, at @ up, at)))
    yield from _arrows(longest, found)


def _load_time(frames: Frames) -> np.ndarray:
    """Return the times (T,) of the signals of loads: zero in states of rest."""
    return frames.time if frames.moves else np.zeros(len(frames))


def _scale(frames: Frames, load: Load) -> np.ndarray:
    """Return the factors (T, 1) of a load."""
    return np.asarray(frames.load * load.factor(_load_time(frames), frames.happened))[:, None]


def _loaded(frames: Frames, load: Force | Moment) -> Attachment:
    """Return the point of a load as an attachment."""
    on = frames.scene.bodies.get(load.on)
    if on is None:
        return Attachment(on=load.on, s=load.s if isinstance(load.s, float) else 0.0)
    given = getattr(load, "at", None)
    if isinstance(on, ModalBody):
        return Attachment(on=load.on, at=on.located(given, load.s if isinstance(load.s, float) else None))
    return Attachment(on=load.on, at=(0.0, 0.0, 0.0) if given is None else given)


def _components(frames: Frames, end: Attachment, value: Vector, follower: bool) -> np.ndarray:
    """Return the components (T or 1, 3) along the ground's axes of a force, given along local axes for a follower."""
    if not follower:
        return np.array([value])
    assert end.on is not None
    if (body := frames.scene.bodies.get(end.on)) is not None:
        orientation = frames.value(f"{end.on}.orientation")
        if isinstance(body, ModalBody):
            turns = frames.value(f"{end.on}.modal_coordinates") @ body.attachment_modes(end.point)[2]
            orientation = product(orientation, turned_by(turns))
        return rotate(orientation, value)
    cable, nodal = frames.scene.cables[end.on], frames.value(f"{end.on}.nodal_vectors")
    s = np.array([end.arc_length])
    return _along_section(cable, value, lambda slope: along(cable, s, nodal, slope)[:, 0])


def _along_section(cable: Cable, value: Vector, slope_of: Callable[[int], np.ndarray]) -> np.ndarray:
    """Return the components (T or 1, 3) along the ground's axes of a force along the axes of a section of a cable, by
    its slopes (T or 1, 3).
    """
    tangent = _unit(slope_of(0))
    if cable.dim == 2:
        return value[0] * tangent + value[1] * np.cross(cable.normal, tangent)
    if not cable.kind_of_element.director:
        return value[0] * tangent
    director = "xyz".index(cable.kind_of_element.director[-1])
    width = _unit(np.cross(tangent, slope_of(director)))
    return value[0] * tangent + value[1] * np.cross(width, tangent) + value[2] * width


def _unit(vector: np.ndarray) -> np.ndarray:
    return np.asarray(vector / np.linalg.norm(vector, axis=-1, keepdims=True))
