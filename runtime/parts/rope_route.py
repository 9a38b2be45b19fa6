"""The route of a rope as drawn, in the plane: straight spans between sheaves, tangent to them, and the arcs on them.

With u the direction of a span (unit) and n = u turned to the left by 90 degrees, the rope leaves a sheave of centre c,
radius R and sense s at c - s R n. The centres of two neighbours are thus d = l u + (s2 R2 - s1 R1) n apart, which gives
the length l and u. An end of the rope is a sheave of radius 0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import field
from itertools import pairwise
from math import atan2, hypot, pi, tau

import numpy as np

from ..base.deferred import dataclass
from .validation import show

MIN_WRAP = 1e-3
"""Least wrap angle in rad: a smaller one is a sheave that the rope does not touch."""
MAX_PLAUSIBLE_WRAP = 1.5 * pi
"""Wrap angle without whole turns, in rad, above which the side of a sheave may be wrong."""
MIN_SPAN_RATIO = 0.05
"""Least length of a span over the radii of the sheaves at its ends."""
MAX_LAYER = 0.2
"""Largest length sqrt(EI / T) of the layer of bending beside a sheave over its radius for which the shift EI / (2 T R)
is a good approximation."""
TOUCH_TOLERANCE = 1e-9
"""Depth of a span in the circle of another sheave over its radius; sheaves side by side on one axle may have spans that
coincide in the plane."""
ANGLE_ROUNDING = 1e-9
"""Of a wrap angle, in rad: this much below a whole turn is zero."""


@dataclass(frozen=True, eq=False)
class RoutePoint:
    """An end of a rope or a sheave, as drawn.

    label: its name in messages; centre: (2,) in m; radius: to the axis of the rope, m, 0 at an end; sense: 1 where the
    rope runs counter-clockwise around it, -1 clockwise, 0 at an end or where that is not known; turns: whole turns
    beside the wrap angle of the tangents; name: of the sheave; offsets: of the tangent points where the rope runs on
    and off beyond the radius, m; contact: whether the rope lies on it.
    groove: (dim, 2), unit vectors of the plane of the groove. In space the centre is (3,), and the sense is about the
    axis, to the right of which the second vector follows from the first.
    """

    label: str
    centre: np.ndarray
    radius: float = 0.0
    sense: int = 0
    turns: int = 0
    name: str = ""
    offsets: tuple[float, float] = (0.0, 0.0)
    groove: np.ndarray = field(default_factory=lambda: np.eye(2))
    contact: bool = True

    @property
    def reach(self) -> tuple[float, float]:
        """Return the radii of the tangent points where the rope runs on and off, m."""
        return self.radius + self.offsets[0], self.radius + self.offsets[1]


@dataclass(frozen=True, eq=False)
class DrawnSpan:
    """A straight span: start (dim,) and end (dim,) in m, length in m."""

    start: np.ndarray
    end: np.ndarray
    length: float

    @property
    def direction(self) -> np.ndarray:
        """Return (dim,): the unit vector along the span."""
        made: np.ndarray = (self.end - self.start) / self.length
        return made


SpanBetween = Callable[[RoutePoint, RoutePoint, float], DrawnSpan]


@dataclass(frozen=True, eq=False)
class DrawnArc:
    """The rope on the sheave ``name``: centre (dim,) in m, radius of the rope's axis in m, sense and groove as in
    `RoutePoint`.

    tangent_radius: of the tangent points where the rope runs on and off, m, above the radius for a rope that bends; in
    space the arm of the tension about the axis. angle_on, angle_off: of the two tangent points from the centre, in rad,
    so that angle_off - angle_on is the sense times the wrap angle, whole turns included.
    """

    name: str
    centre: np.ndarray
    radius: float
    sense: int
    angle_on: float
    angle_off: float
    tangent_radius: tuple[float, float]
    groove: np.ndarray = field(default_factory=lambda: np.eye(2))

    @property
    def wrap(self) -> float:
        """Return the wrap angle in rad, positive, or 0 without contact."""
        return self.sense * (self.angle_off - self.angle_on)

    @property
    def length(self) -> float:
        """Return the length of the rope on the sheave, m."""
        return self.radius * self.wrap


@dataclass(frozen=True)
class FreeLengths:
    """Stress-free lengths in m of each span of a route, and of the zones, equal angles, of the wrap on each sheave."""

    spans: tuple[float, ...]
    zones: tuple[tuple[float, ...], ...]


@dataclass(frozen=True, eq=False)
class DrawnRoute:
    """A route as drawn, in the rope's order: one span more than sheaves, or of a closed one as many, the first from the
    first sheave to the next.

    reach: radii of the tangent points of both ends, m, 0 at an anchor. stretch: drawn length over stress-free length,
    the same everywhere unless ``free`` has the stress-free lengths.
    """

    spans: tuple[DrawnSpan, ...]
    sheaves: tuple[DrawnArc, ...]
    reach: tuple[float, float]
    stretch: float = 1.0
    free: FreeLengths | None = None

    @property
    def length(self) -> float:
        """Return the drawn length of the rope, without what is wound on drums, m."""
        return sum(span.length for span in self.spans) + sum(arc.length for arc in self.sheaves)

    @property
    def free_length(self) -> float:
        """Return its stress-free length, m."""
        return self.length / self.stretch

    def free_span(self, k: int) -> float:
        """Return the stress-free length of a span, m."""
        return self.spans[k].length / self.stretch if self.free is None else self.free.spans[k]

    def free_wrap(self, number: int) -> float:
        """Return the stress-free length of the rope on a sheave, m."""
        return self.sheaves[number].length / self.stretch if self.free is None else sum(self.free.zones[number])

    def free_zones(self, number: int, start: float, end: float, n: int) -> np.ndarray:
        """Return (n + 1,): the arc-lengths of the ends of n equal angles of a wrap, from the one of its start to that
        of its end, m.
        """
        if self.free is None:
            return np.linspace(start, end, n + 1)
        zones = np.append(0.0, np.cumsum(self.free.zones[number]))
        shares = np.interp(np.linspace(0.0, 1.0, n + 1), np.linspace(0.0, 1.0, len(zones)), zones / zones[-1])
        return start + (end - start) * shares

    def stretch_of(self, k: int) -> float:
        """Return the stretch of a span, by its number, from the last one on where this is negative."""
        return self.stretch if self.free is None else self.spans[k].length / self.free.spans[k]

    def arc_lengths(self, start: float) -> list[tuple[float, float]]:
        """Return the stress-free arc-lengths of both ends of each span, m; start: that of the first point."""
        found: list[tuple[float, float]] = []
        for k, number, _ in self.sequence():
            found.append((start, start + self.free_span(k)))
            start = found[-1][1] + (0.0 if number is None else self.free_wrap(number))
        return found

    def sequence(self) -> Iterator[tuple[int, int | None, int]]:
        """Yield along the rope the number of each span, that of the sheave after it, and that of the next span.

        The last end of an open rope has no sheave, None; there the next span is the first one.
        """
        n, closed = len(self.spans), len(self.sheaves) == len(self.spans)
        for k in range(n):
            after = (k + 1) % n
            yield k, after if closed else k if after else None, after

    @property
    def beside_sheaves(self) -> list[tuple[int, int]]:
        """Return the numbers of the spans before and after each sheave."""
        found = {number: (k, after) for k, number, after in self.sequence() if number is not None}
        return [found[number] for number in range(len(found))]


def default_senses(centres: np.ndarray) -> list[int]:
    """Return the sides to which the polygon through all centres (n, 2) turns at the inner ones, as senses (n - 2).

    0: the three centres lie on a line to rounding, or two of them coincide.
    """
    before, after = centres[1:-1] - centres[:-2], centres[2:] - centres[1:-1]
    turn = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    size = np.hypot(*before.T) * np.hypot(*after.T)
    return [int(sign) for sign in np.where(np.abs(turn) <= ANGLE_ROUNDING * size, 0, np.sign(turn))]


def drawn_route(points: list[RoutePoint], rope_radius: float = 0.0, closed: bool = False,
                span_between: SpanBetween | None = None) -> DrawnRoute:
    """Return the route along the ends and sheaves of a rope, as drawn.

    rope_radius: a lower bound of the lengths of spans, m; closed: all points are sheaves, and the last one leads to the
    first; span_between: the span from one point to the next, by default that in the plane. Raises ValueError(cause,
    remedy) for an impossible route.
    """
    touched = [point for point in points if point.contact]
    if len(touched) < 2:
        raise ValueError("needs two sheaves or more that it touches as drawn", "leave contact=False out")
    ends = [*pairwise(touched), (touched[-1], touched[0])] if closed else [*pairwise(touched)]
    spans = [(span_between or _span)(one, other, rope_radius) for one, other in ends]
    if len(touched) < len(points):
        spans, ends = _split(points, spans, rope_radius, closed)
    before = [spans[-1], *spans[:-1]] if closed else spans
    after = spans if closed else spans[1:]
    sheaves = [_arc(point, *beside) for point, *beside in zip(points if closed else points[1:-1], before, after,
                                                              strict=False)]
    for span, both in zip(spans, ends, strict=True):
        for point in points:
            if point.radius and point not in both:
                _check_clear(span, *both, point)
    return DrawnRoute(tuple(spans), tuple(sheaves), (points[0].reach[1], points[-1].reach[0]))


def without_wraps(points: list[RoutePoint], may_be_absent: list[bool], rope_radius: float, closed: bool,
                  span_between: SpanBetween | None = None) -> DrawnRoute:
    """Return the route along points, some of which the rope may pass without a wrap: there it has an arc of no angle,
    where it is nearest to the centre. span_between: see `drawn_route`.

    Raises ValueError(cause, remedy) for an impossible route.
    """
    kept, between_points = list(range(len(points))), span_between or _span
    gone: int | None = -1
    while gone is not None:
        gone = next((k for k in kept if may_be_absent[k] and _is_passed(points, kept, k, between_points)), None)
        kept = [k for k in kept if k != gone]
    route = drawn_route([points[k] for k in kept], rope_radius, closed, span_between)
    if len(kept) == len(points):
        return route
    arcs, spans, n = {arc.name: arc for arc in route.sheaves}, [], len(points)
    for number, k in enumerate(kept if closed else kept[:-1]):
        span, after = route.spans[number], kept[(number + 1) % len(kept)]
        between = range(k + 1, after if after > k else after + n)
        at = span.start
        for point in (points[j % n] for j in between):
            along = float((point.centre - span.start) @ span.direction)
            foot = span.start + min(max(along, 0.0), span.length) * span.direction
            spans.append(DrawnSpan(at, foot, float(np.linalg.norm(foot - at))))
            x, y = (span.direction @ point.groove).tolist()
            angle = atan2(y, x) - point.sense * pi / 2
            arcs[point.name] = DrawnArc(point.name, point.centre, point.radius, point.sense, angle, angle,
                                        (point.radius, point.radius), point.groove)
            at = foot
        spans.append(DrawnSpan(at, span.end, float(np.linalg.norm(span.end - at))))
    return DrawnRoute(tuple(spans), tuple(arcs[point.name] for point in points if point.name in arcs), route.reach)


def _is_passed(points: list[RoutePoint], kept: list[int], k: int, span_between: SpanBetween) -> bool:
    """Return whether a rope along some points does not touch one of these: it would not turn to its side there, and the
    line between its neighbours has it on this side.
    """
    at = kept.index(k)
    before, point, after = (points[kept[(at + j) % len(kept)]] for j in (-1, 0, 1))
    one, other = (span_between(*ends, 0.0).direction @ point.groove for ends in ((before, point), (point, after)))
    turn = point.sense * atan2(_cross(one, other), one @ other)  # of half a turn and more it is negative, too
    if turn >= MIN_WRAP or before is after:
        return False
    try:
        line = span_between(before, after, 0.0)
    except ValueError:
        return False  # there is none
    return point.sense * _cross(line.direction @ point.groove, (point.centre - line.start) @ point.groove) > 0


def _cross(one: np.ndarray, other: np.ndarray) -> float:
    return float(one[0] * other[1] - one[1] * other[0])


def _span(one: RoutePoint, other: RoutePoint, rope_radius: float) -> DrawnSpan:
    """Return the tangent from a point of a route to the next one. Raises ValueError where there is none."""
    x, y = (other.centre - one.centre).tolist()
    leaves, arrives = one.sense * one.reach[1], other.sense * other.reach[0]
    apart, across = hypot(x, y), arrives - leaves
    if apart <= abs(across):
        raise ValueError(*without_tangent(one, other, apart))
    length = ((apart - across) * (apart + across)) ** 0.5
    check_length(one, other, length, rope_radius)
    u = np.array([length * x + across * y, length * y - across * x]) / apart**2
    n = np.array([-u[1], u[0]])
    return DrawnSpan(one.centre - leaves * n, other.centre - arrives * n, length)


def _split(points: list[RoutePoint], spans: list[DrawnSpan], rope_radius: float, closed: bool
           ) -> tuple[list[DrawnSpan], list[tuple[RoutePoint, RoutePoint]]]:
    """Return the spans of a route, split beside sheaves without contact, and their ends.

    spans: between the points with contact. Raises ValueError where a sheave is in the way, or not beside its span.
    """
    found: list[DrawnSpan] = []
    first = next(k for k, point in enumerate(points) if point.contact)  # 0 of an open route
    turned = [*points[first:], *points[: first + closed]]
    whole = iter(spans)
    for one, other in pairwise(turned):
        if one.contact:
            span = next(whole)
            start = span.start
        end = span.end if other.contact else _foot(span, other)
        length = float((end - start) @ span.direction)
        check_length(one, other, length, rope_radius)
        found.append(DrawnSpan(start, end, length))
        start = end
    at = len(found) - first if closed else 0  # of the first point
    return found[at:] + found[:at], [*pairwise(turned)][at:] + [*pairwise(turned)][:at]


def _foot(span: DrawnSpan, sheave: RoutePoint) -> np.ndarray:
    """Return the point of a span next to the centre of a sheave without contact. Raises ValueError for contact."""
    x, y = ((sheave.centre - span.start) @ sheave.groove).tolist()
    ux, uy = (span.direction @ sheave.groove).tolist()
    away = sheave.sense * (ux * y - uy * x)
    if away < sheave.reach[0]:
        raise ValueError(f"the rope touches {sheave.label}, which has contact=False: it passes its centre at "
                         f"{show(away, 'm')} on its side, and its radius is {show(sheave.reach[0], 'm')}",
                         "leave contact=False out, move the sheave, or give the other side")
    along = sum(a * b for a, b in zip((sheave.centre - span.start).tolist(), span.direction.tolist(), strict=True))
    foot: np.ndarray = span.start + along * span.direction
    return foot


def check_length(one: RoutePoint, other: RoutePoint, length: float, rope_radius: float) -> None:
    """Raise ValueError for a span between two points that is too short to be modelled."""
    least = max(MIN_SPAN_RATIO * max(one.radius, other.radius), rope_radius)
    if length < least:
        raise ValueError(f"the span from {one.label} to {other.label} must be {show(least, 'm')} or longer, "
                         f"{MIN_SPAN_RATIO:g} of a sheave's radius and the rope's radius, got {show(length, 'm')}",
                         "move them apart")


def without_tangent(one: RoutePoint, other: RoutePoint, apart: float) -> tuple[str, str]:
    """Return cause and remedy for two points of a route without a tangent."""
    large, small = (one, other) if one.radius >= other.radius else (other, one)
    remedy = "move them apart, or take smaller radii"
    if not small.radius:
        return (f"{large.label} contains {small.label}: {show(apart, 'm')} from its centre, and its radius is "
                f"{show(large.radius, 'm')}", remedy)
    if one.sense == other.sense:
        return f"{large.label} contains {small.label}: {_apart(one, other, apart)}", remedy
    return (f"{one.label} and {other.label} overlap, so that the rope cannot pass between them: "
            f"{_apart(one, other, apart)}", f"{remedy}, or lead the rope along one side of both")


def _apart(one: RoutePoint, other: RoutePoint, apart: float) -> str:
    """Return the distance and the radii of two sheaves as text."""
    return (f"their centres are {show(apart, 'm')} apart, and their radii {show(one.radius, 'm')} and "
            f"{show(other.radius, 'm')}")


def _arc(point: RoutePoint, before: DrawnSpan, after: DrawnSpan) -> DrawnArc:
    """Return the rope on a sheave between two spans. Raises ValueError where the rope does not touch it."""
    if not point.contact:
        x, y = ((before.end - point.centre) @ point.groove).tolist()
        at = atan2(y, x)
        return DrawnArc(point.name, point.centre, point.radius, point.sense, at, at, point.reach, point.groove)
    if not point.sense:
        raise ValueError(f"the route runs straight through the centre of {point.label}, which does not tell its side",
                         'give side="left" or "right"')
    one, other = before.direction @ point.groove, after.direction @ point.groove
    turn = point.sense * atan2(_cross(one, other), one @ other) + 0.0  # no -0
    if abs(turn) < MIN_WRAP and not point.turns:
        raise ValueError(f"the rope does not touch {point.label}: its wrap angle must be {show(MIN_WRAP, 'rad')} or "
                         f"more, got {show(turn, 'rad')}", "leave it out, move it into the way of the "
                         "rope, or give contact=False")
    wrap = (turn if turn > -ANGLE_ROUNDING else turn + tau) + tau * point.turns
    x, y = ((before.end - point.centre) @ point.groove).tolist()
    on = atan2(y, x)
    return DrawnArc(point.name, point.centre, point.radius, point.sense, on, on + point.sense * wrap,
                    point.reach, point.groove)


def _check_clear(span: DrawnSpan, one: RoutePoint, other: RoutePoint, sheave: RoutePoint) -> None:
    """Raise ValueError where a span between two points crosses another sheave of the route."""
    start, along = (sheave.centre - span.start) @ sheave.groove, span.direction @ sheave.groove
    s = min(max(float(start @ along) / max(float(along @ along), ANGLE_ROUNDING), 0.0), span.length)
    distance = float(np.linalg.norm(start - s * along))
    aside = float(np.linalg.norm(sheave.centre - span.start - s * span.direction - sheave.groove @ (start - s * along)))
    if aside > TOUCH_TOLERANCE * sheave.radius:
        return  # in space it passes beside the groove
    if distance < (1 - TOUCH_TOLERANCE) * sheave.radius:
        raise ValueError(f"the span from {one.label} to {other.label} crosses {sheave.label}: it passes its centre at "
                         f"{show(distance, 'm')}, within its radius {show(sheave.radius, 'm')}",
                         "move the sheave, or give side= of the sheaves")
