"""The route of a rope as drawn among the bodies of its scene: its points, and the stretch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Protocol

import numpy as np

from .attachment import Attachment
from .cable import Cable
from .modal_body import ModalBody
from .rigid_body import RigidBody
from .rope_items import SIDES, Drum, RouteItem, Sheave
from .rope_route import MAX_LAYER, DrawnRoute, RoutePoint, default_senses, drawn_route, without_wraps
from .rope_route_space import groove_of, senses_in_space, span_in_space
from .validation import LENGTH_TOLERANCE, show

Holders = Mapping[str, RigidBody | ModalBody | Cable]
"""Bodies and cables by name, see `SceneData.holders`."""


class Roped(Protocol):
    """What the drawing of a rope needs of it, see `Rope`."""

    route: tuple[RouteItem, ...]
    closed: bool
    mass: bool
    tension: float | None
    length: float | None

    @property
    def where(self) -> str:
        """Return its name in messages."""
        ...

    @property
    def dim(self) -> int:
        """Return the dimension of space."""
        ...

    @property
    def radius(self) -> float:
        """Return half the height of its section, m."""
        ...

    @property
    def stiffness(self) -> tuple[float, float]:
        """Return EA in N and EI in N m²."""
        ...

    @property
    def length_in_store(self) -> float:
        """Return the stress-free length on its drums, m."""
        ...

    @property
    def first_arc_length(self) -> float:
        """Return the stress-free arc-length at the start of its first span, m."""
        ...

    @property
    def wheels(self) -> tuple[Sheave | Drum, ...]:
        """Return its sheaves and drums."""
        ...


def drawn(rope: Roped, holders: Holders) -> DrawnRoute:
    """Return the route of a rope, see `Rope.drawn`."""
    points = _points(rope, np.array([place_of(item.end, holders)[:rope.dim] for item in rope.route]))
    if not rope.mass:
        route = _without_mass(rope, points)
        return replace(route, stretch=_stretch(rope, route.length))
    route = _along(rope, points)
    if offsets := _offsets(rope, _stretch(rope, route.length)):
        route = _along(rope, [replace(point, offset=offsets.get(point.name, 0.0)) for point in points])
    return replace(route, stretch=_stretch(rope, route.length))


def span_at(rope: Roped, route: DrawnRoute, s: float) -> int:
    """Return the number of the span with an arc-length, see `Rope.span_at`."""
    ends = route.arc_lengths(rope.first_arc_length)
    for k, (start, end) in enumerate(ends):
        if start < s < end:
            return k
    spans = ", ".join(f"{show(start)} to {show(end, 'm')}" for start, end in ends)
    remedy = f"as drawn its spans have {spans}"
    after = rope.route[1:] + (rope.route[:1] if rope.closed else ())
    for k, (item, (_, start)) in enumerate(zip(after, ends, strict=True)):
        until = ends[k + 1][0] if k + 1 < len(ends) else rope.first_arc_length + route.free_length
        if isinstance(item, Sheave) and start <= s <= until:
            raise ValueError(f"lies on {item.where} as drawn, which has {show(start)} to {show(until, 'm')}, got "
                             f"{show(s, 'm')}", remedy)
    raise ValueError(f"must lie within a span, off the ends and what is wound, got {show(s, 'm')}", remedy)


def drawn_anew(rope: Roped, route: DrawnRoute, centres: np.ndarray,
               grooves: Mapping[str, np.ndarray] | None = None) -> DrawnRoute:
    """Return a drawn route of a rope with its items at other places (n, dim), m, and wheels with other planes of their
    grooves (3, 2) by name: the sides of sheaves, distances of tangent points and stress-free length are kept. Raises
    ValueError(cause, remedy) for an impossible one.
    """
    arcs = {arc.name: arc for arc in route.sheaves}
    ends = dict(zip((0, len(rope.route) - 1), route.reach, strict=True))
    points = [replace(point, sense=arcs[point.name].sense, offset=arcs[point.name].tangent_radius - point.radius)
              if point.name in arcs else replace(point, offset=ends[k] - point.radius) if point.name else point
              for k, point in enumerate(_points(rope, centres))]
    points = [replace(point, groove=grooves[point.name]) if grooves and point.name in grooves else point
              for point in points]
    found = _along(rope, points) if rope.mass else _without_mass(rope, points)
    return replace(found, stretch=found.length / route.free_length)


def _may_be_absent(item: RouteItem) -> bool:
    """Return whether a rope without mass need not touch an item as drawn."""
    return isinstance(item, Sheave) and item.side is not None and not item.coefficient and not item.turns


def _without_mass(rope: Roped, points: list[RoutePoint]) -> DrawnRoute:
    return without_wraps(points, [_may_be_absent(item) for item in rope.route], rope.radius, rope.closed)


def _along(rope: Roped, points: list[RoutePoint]) -> DrawnRoute:
    return drawn_route(points, rope.radius, rope.closed, span_in_space if rope.dim == 3 else None)


def _points(rope: Roped, centres: np.ndarray) -> list[RoutePoint]:
    """Return the points of the route at these centres (n, dim)."""
    if rope.dim == 2:
        senses = (default_senses(np.concatenate([centres[-1:], centres, centres[:1]])) if rope.closed
                  else [0, *default_senses(centres), 0])
        return [_point(rope, k, centres[k], senses[k]) for k in range(len(centres))]
    points = [replace(_point(rope, k, centre, 0), groove=groove_of(getattr(rope.route[k], "axis", (0, 0, 1))))
              for k, centre in enumerate(centres)]
    return [replace(point, sense=point.sense or sense)
            for point, sense in zip(points, senses_in_space(points, rope.closed), strict=True)]


def _offsets(rope: Roped, stretch: float) -> dict[str, float]:
    """Return the distances by which bending moves the tangent points away from sheaves, m, by name; none without
    tension, where they are not known. At low tension they are those of the longest layer for which they hold.
    """
    EA, EI = rope.stiffness
    tension = EA * (stretch - 1)
    if tension <= 0:
        return {}
    return {wheel.name: min(EI / tension, (MAX_LAYER * wheel.radius)**2) / (2 * wheel.radius) for wheel in rope.wheels}


def _point(rope: Roped, k: int, centre: np.ndarray, sense: int) -> RoutePoint:
    """Return a point of the route; sense: that of a sheave without a side."""
    item = rope.route[k]
    if not isinstance(item, Sheave | Drum):
        return RoutePoint(f"the {'last' if k else 'first'} anchor", centre)
    sense = SIDES[item.side] if item.side else sense
    return RoutePoint(item.where, centre, item.radius, sense, getattr(item, "turns", 0), item.name,
                      contact=getattr(item, "contact", True))


def _stretch(rope: Roped, drawn: float) -> float:
    """Return drawn over stress-free length; drawn: the length as drawn, m."""
    if rope.length is None:
        assert rope.tension is not None, f"{rope.where} has neither tension nor length"
        return 1 + rope.tension / rope.stiffness[0]
    out = rope.length - rope.length_in_store
    if out <= 0:
        raise ValueError(f"is too short: its length {show(rope.length, 'm')} is that of the whole rope, and its "
                         f"drums have {show(rope.length_in_store, 'm')} in store",
                         "give a greater length, or tension")
    if out > (1 + LENGTH_TOLERANCE) * drawn:
        wound = f" without {show(rope.length_in_store, 'm')} in store" if rope.length_in_store else ""
        raise ValueError(f"is never taut: its length {show(rope.length, 'm')}{wound} exceeds that of its route as "
                         f"drawn, {show(drawn, 'm')}, by {show(out - drawn, 'm')}",
                         "give a smaller length, or tension")
    return max(1.0, drawn / out)


def place_of(end: Attachment, holders: Holders) -> np.ndarray:
    """Return (3,): the place as drawn of a complete attachment to a body, to a cable or to the ground, in m."""
    if end.on is None:
        return np.array(end.point)
    on = holders[end.on]
    return on.point(end.arc_length) if isinstance(on, Cable) else on.point(end.point)
