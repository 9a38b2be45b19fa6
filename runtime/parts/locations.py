"""The locations of the parts of a scene, and their connections."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, cast

import numpy as np

from ..base.rotations import cross
from .attachment import Attachment
from .cable import Cable
from .event import Event
from .fluid import Fluid
from .hanging import hangs
from .load import Force
from .part import Part, about_fields
from .rope import Rope
from .rope_items import RouteItem
from .scene_data import SceneData
from .schemas import Place
from .signal import Signal
from .slide import Slide
from .support import Support, Tie
from .surface import Surface

Node = tuple[str, int]
"""A node of a cable: the cable's name and the node's number."""


def node_of(scene: SceneData, support: Support) -> Node:
    """Return the node of a support of the scene."""
    return support.cable, scene.cables[support.cable].node(support.s)


def ends_of(scene: SceneData, tie: Tie) -> tuple[Node, Node]:
    """Return the nodes of a tie of the scene: that of its cable, then the other one."""
    return ((tie.cable, scene.cables[tie.cable].node(tie.s)), (tie.to, scene.cables[tie.to].node(tie.at)))


def joined(scene: SceneData, node: Node, without: Tie | None = None) -> set[Node]:
    """Return the nodes that ties other than ``without`` join to ``node``, itself included."""
    found, new = {node}, [node]
    while new:
        at = new.pop()
        for tie in scene.ties.values():
            if at[0] not in (tie.cable, tie.to):
                continue
            pair = set(ends_of(scene, tie))
            if tie is not without and at in pair:
                new += pair - found
                found |= pair
    return found


def support_of(scene: SceneData, node: Node) -> Support | None:
    """Return a support of ``node`` or of a node joined to it."""
    nodes = joined(scene, node)
    cables = {cable for cable, _ in nodes}
    return next((s for s in scene.supports if s.cable in cables and node_of(scene, s) in nodes), None)


def point_of(scene: SceneData, end: Attachment) -> np.ndarray:
    """Return (3,): the initial position of a complete attachment, in m."""
    if end.on is None:
        return np.array(end.at)
    if end.on in scene.bodies:
        return scene.bodies[end.on].point(end.point)
    if end.on in scene.ropes:
        return scene.ropes[end.on].point(scene.holders, end.arc_length)
    return scene.cables[end.on].point(end.arc_length)


def grips(scene: SceneData) -> Iterator[tuple[Part, str, Attachment]]:
    """Yield the attachments to points of ropes, with their parts and keywords, "" for that of a force."""
    if not scene.ropes:
        return
    for part in scene.parts():
        if isinstance(part, Force) and part.on in scene.ropes and isinstance(part.s, float):
            yield part, "", Attachment(on=part.on, s=part.s)
        if isinstance(part, Slide) and part.body in scene.ropes:
            yield part, "body", part.rider
        yield from ((part, name, value) for name, value in part
                    if isinstance(value, Attachment) and value.on in scene.ropes)


def velocity_of(scene: SceneData, end: Attachment) -> np.ndarray:
    """Return (3,): the initial velocity of a complete attachment as drawn, in m/s."""
    if end.on is None:
        return np.zeros(3)
    if end.on in scene.bodies:
        body = scene.bodies[end.on]
        turning, arm = body.axes @ body.angular_velocity, body.point(end.point) - body.frame[0]
        return body.velocity + cross(turning, arm)
    cable = scene.cables[end.on]
    return cable.velocity + cross(cable.angular_velocity, cable.point(end.arc_length) - cable.point(0.0))


def on_cables(part: Part, moving: bool = True) -> Iterator[tuple[str, str, float]]:
    """Yield the arc-lengths among the entries of a part: keyword, name of the cable or body, and s in m.

    moving: whether to include arc-lengths that change in a run, such as that of a slide.
    """
    for name, place in about_fields(type(part)).items():
        if isinstance(place, Place) and (moving or not place.moves):
            on, s = getattr(part, place.of), getattr(part, name)
            if on is not None and s is not None and not isinstance(s, Signal):
                yield name, on, s


def attached(scene: SceneData, name: str) -> list[float]:
    """Return the arc-lengths, in m, of a cable at which supports, loads and other parts are attached."""
    acting = [part for part in (*scene.parts(), *scene.attachments()) if not isinstance(part, Event)]
    return [float(s) for part in acting for _, on, s in on_cables(part, moving=False) if on == name]


def connected(scene: SceneData, name: str) -> set[str]:
    """Return the names of the cables and bodies connected with a cable or body, its own name included.

    A part connects all cables and bodies that it names. The ground, its surfaces and fluids connect nothing.
    """
    acting = [part for part in scene.parts() if not isinstance(part, Event | Fluid)
              and not (isinstance(part, Surface) and part.on is None)]
    names = {part.given_name for part in acting if part.given_name is not None}
    links = [names & {part.given_name or "", *part.refers_to()} for part in acting]
    found = {name}
    while more := [link for link in links if link & found and not link <= found]:
        found.update(*more)
    return {each for each in (*scene.cables, *scene.bodies) if each in found}


def _moved(item: RouteItem, moves: Mapping[str, Callable[[float], float]]) -> RouteItem:
    """Return an item of a route at its place on a cable that changes in length, by functions of the arc-length."""
    if item.end.on is None or item.end.on not in moves:
        return item
    return item.held_at(item.end.model_copy(update={"s": moves[item.end.on](item.end.arc_length)}))


def remade(part: Part, changes: Mapping[str, Any]) -> Part:
    """Return a part with other values, by keyword; a cable without its given nodes. Raises SceneError."""
    if isinstance(part, Cable) and part.nodes is not None and "nodes" not in changes:
        changes = {**changes, "nodes": None}
    return part.remade(changes)


def _place_after(cable: Cable, changed: Cable, ratio: float) -> Callable[[float], float] | None:
    """Return the function from an arc-length on a cable to that on the changed one, by their lengths or, of pieces,
    those of each piece; None where all stay.
    """
    if cable.pieces is not None and changed.pieces is not None and len(cable.pieces) == len(changed.pieces):
        before, after = (np.cumsum([0.0, *(piece.length for piece in each)]) for each in (cable.pieces, changed.pieces))
        return None if np.array_equal(before, after) else lambda s: float(np.interp(s, before, after))
    return None if ratio == 1.0 else lambda s: s * ratio


def following(scene: SceneData, changes: Mapping[int, Mapping[str, Any]]) -> dict[int, dict[str, Any]]:
    """Return changes of the parts of a scene with those of arc-lengths and nodes on cables that change in length.

    An arc-length keeps its ratio to the length of the cable, of a cable of pieces its place in the piece, unless it is
    among the changes.

    changes: values by keyword, by the number of the part. A hanging cable that becomes shorter than its span is drawn
    straight. Raises SceneError.
    """
    parts = list(scene.parts())
    moves: dict[str, Callable[[float], float]] = {}
    found = {k: dict(entries) for k, entries in changes.items()}
    for k, entries in found.items():
        if isinstance(part := parts[k], Cable) and entries:
            changed = cast(Cable, remade(part, entries))
            ratio = changed.length / part.length
            if (place := _place_after(part, changed, ratio)) is not None:
                moves[part.name] = place
            if part.nodes is not None and ratio != 1.0:
                entries.setdefault("nodes", [s * ratio for s in part.nodes])
            if changed.shape == "hanging" and not hangs(changed.drawn_length, changed.length):
                entries["shape"] = "straight"
    if not moves:
        return found
    for k, part in enumerate(part.as_made() for part in parts):
        moved: dict[str, Any] = {keyword: moves[on](s) for keyword, on, s in on_cables(part) if on in moves}
        for name, value in part:
            if isinstance(value, Attachment) and value.on in moves and value.s is not None:
                moved[name] = value.model_copy(update={"s": moves[value.on](value.s)})
        if isinstance(part, Rope) and any(item.end.on in moves for item in part.route):
            moved["route"] = [_moved(item, moves) for item in part.route]
        if moved:
            found[k] = moved | found.get(k, {})
    return found
