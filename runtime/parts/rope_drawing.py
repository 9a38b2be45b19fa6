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
from .rope_route import (
    MAX_LAYER,
    DrawnRoute,
    FreeLengths,
    RoutePoint,
    SpanBetween,
    default_senses,
    drawn_route,
    without_wraps,
)
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
    temperature: float | None

    @property
    def warm_length(self) -> float | tuple[float, ...] | None:
        """Return its stress-free length at its temperature, or those of its spans, m."""
        ...

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
    def sheaves(self) -> tuple[Sheave, ...]:
        """Return its sheaves in their order."""
        ...


def drawn(rope: Roped, holders: Holders) -> DrawnRoute:
    """Return the route of a rope, see `Rope.drawn`."""
    points = _points(rope, np.array([place_of(item.end, holders)[:rope.dim] for item in rope.route]))
    if not rope.mass:
        route = _without_mass(rope, points)
        return stretched(rope, route)
    route = _along(rope, points)
    if offsets := _offsets(rope, stretched(rope, route)):
        route = _along(rope, [replace(point, offsets=offsets.get(point.name, (0.0, 0.0))) for point in points])
    return stretched(rope, route)


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
    points = [replace(point, sense=arcs[point.name].sense, offsets=_beyond(point, arcs[point.name].tangent_radius))
              if point.name in arcs else replace(point, offsets=_beyond(point, (ends[k], ends[k]))) if point.name
              else point for k, point in enumerate(_points(rope, centres))]
    points = [replace(point, groove=grooves[point.name]) if grooves and point.name in grooves else point
              for point in points]
    found = _along(rope, points) if rope.mass else _without_mass(rope, points)
    return replace(found, stretch=found.length / route.free_length)


def _beyond(point: RoutePoint, reach: tuple[float, float]) -> tuple[float, float]:
    """Return the offsets of the tangent points of a sheave or a drum with these radii of theirs, m."""
    return reach[0] - point.radius, reach[1] - point.radius


def _may_be_absent(item: RouteItem) -> bool:
    """Return whether a rope without mass need not touch an item as drawn."""
    return isinstance(item, Sheave) and item.side is not None and not item.coefficient and not item.turns


def _without_mass(rope: Roped, points: list[RoutePoint]) -> DrawnRoute:
    absent = [_may_be_absent(item) for item in rope.route]
    return without_wraps(points, absent, rope.radius, rope.closed, _span_between(rope))


def _along(rope: Roped, points: list[RoutePoint]) -> DrawnRoute:
    return drawn_route(points, rope.radius, rope.closed, _span_between(rope))


def _span_between(rope: Roped) -> SpanBetween | None:
    return span_in_space if rope.dim == 3 else None


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


def _offsets(rope: Roped, route: DrawnRoute) -> dict[str, tuple[float, float]]:
    """Return the distances by which bending moves the tangent points away from sheaves where the rope runs on and off,
    m, by name; zero without tension, where they are not known. At low tension they are those of the longest layer for
    which they hold.
    """
    EA, EI = rope.stiffness
    n = len(rope.route)

    def offset(radius: float, span: int) -> float:
        tension = EA * (route.stretch_of(span) - 1)
        return min(EI / tension, (MAX_LAYER * radius)**2) / (2 * radius) if tension > 0 else 0.0

    return {item.name: (offset(item.radius, k - 1 if k or rope.closed else 0),
                        offset(item.radius, k if k < n - 1 or rope.closed else k - 1))
            for k, item in enumerate(rope.route) if isinstance(item, Sheave | Drum)}


def _point(rope: Roped, k: int, centre: np.ndarray, sense: int) -> RoutePoint:
    """Return a point of the route; sense: that of a sheave without a side."""
    item = rope.route[k]
    if not isinstance(item, Sheave | Drum):
        return RoutePoint(f"the {'last' if k else 'first'} anchor", centre)
    sense = SIDES[item.side] if item.side else sense
    return RoutePoint(item.where, centre, item.radius, sense, getattr(item, "turns", 0), item.name,
                      contact=getattr(item, "contact", True))


def stretched(rope: Roped, route: DrawnRoute) -> DrawnRoute:
    """Return a route with the stretch of its rope. Raises ValueError(cause, remedy) for one that is not taut."""
    length = rope.warm_length
    if not isinstance(length, tuple):
        return replace(route, stretch=_stretch(rope, length, route.length))
    spans = tuple(_taut(k, free, span.length) for k, (free, span) in enumerate(
        zip(length, route.spans, strict=True)))
    strains = [span.length / free - 1 for span, free in zip(route.spans, spans, strict=True)]
    zones = tuple(_zones(arc.length, sheave.n_zones, strains[before], strains[after]) for arc, sheave, (before, after)
                  in zip(route.sheaves, rope.sheaves, route.beside_sheaves, strict=True))
    whole = sum(spans) + sum(map(sum, zones))
    return replace(route, stretch=route.length / whole, free=FreeLengths(spans, zones))


def _taut(k: int, free: float, drawn: float) -> float:
    """Return the stress-free length of a span, by its number, within its length as drawn, m. Raises ValueError."""
    if free > (1 + LENGTH_TOLERANCE) * drawn:
        raise ValueError(f"is never taut: the length of its span {k}, {show(free, 'm')}, exceeds that as drawn, "
                         f"{show(drawn, 'm')}, by {show(free - drawn, 'm')}", f"give a smaller length.{k}")
    return min(free, drawn)


def _zones(drawn: float, n: int, before: float, after: float) -> tuple[float, ...]:
    """Return the stress-free lengths of n zones of a wrap of a length as drawn, m, between spans with these strains.

    The logarithm of the tension is linear in the angle, so that all points of the wrap need the same coefficient of
    friction; the tension itself where one of the spans has none.
    """
    share = (np.arange(n) + 0.5) / n
    strain = before * (after / before)**share if before > 0 and after > 0 else before + share * (after - before)
    return tuple((drawn / n / (1 + strain)).tolist())


def _stretch(rope: Roped, length: float | None, drawn: float) -> float:
    """Return drawn over stress-free length; length: that of the rope, drawn: without what is wound, as drawn, m."""
    if length is None:
        assert rope.tension is not None, f"{rope.where} has neither tension nor length"
        return 1 + rope.tension / rope.stiffness[0]
    out, warm = length - rope.length_in_store, " at its temperature" if rope.temperature else ""
    if out <= 0:
        raise ValueError(f"is too short: its length {show(length, 'm')}{warm} is that of the whole rope, and its "
                         f"drums have {show(rope.length_in_store, 'm')} in store",
                         "give a greater length, or tension")
    if out > (1 + LENGTH_TOLERANCE) * drawn:
        wound = f" without {show(rope.length_in_store, 'm')} in store" if rope.length_in_store else ""
        raise ValueError(f"is never taut: its length {show(length, 'm')}{warm}{wound} exceeds that of its route as "
                         f"drawn, {show(drawn, 'm')}, by {show(out - drawn, 'm')}",
                         "give a smaller length, or tension")
    return max(1.0, drawn / out)


def place_of(end: Attachment, holders: Holders) -> np.ndarray:
    """Return (3,): the place as drawn of a complete attachment to a body, to a cable or to the ground, in m."""
    if end.on is None:
        return np.array(end.point)
    on = holders[end.on]
    return on.point(end.arc_length) if isinstance(on, Cable) else on.point(end.point)
