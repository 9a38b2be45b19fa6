"""The route of a rope in space as drawn: straight spans between sheaves whose axes have any direction.

A span leaves the groove of a sheave at a fleet angle f. Its tangent point is at the distance rho = R/cos f from the
centre (derive/couplings/tangent_point.py), and the span is across the radius there. From a point at the distance p from
the axis, and z along the axis from the groove, the tangent point is thus that of

    rho² (p² - rho²) = R² (p² - rho² + z²),

at the angle psi from the point with cos psi = rho/p. A span between two sheaves is found by turns: the tangent point on
one is that from the tangent point on the other. In a common plane each turn squares the error.
"""

from __future__ import annotations

from math import acos, asin, atan2, hypot

import numpy as np

from .rope_route import ANGLE_ROUNDING, DrawnRoute, DrawnSpan, RoutePoint, check_length, without_tangent
from .validation import show

LEAST_SPAN = 3.0
"""Length of a span along the groove over R tan f of its fleet angle f, at least, as `fu_fleet_margin` in the engine has
it."""
MAX_TURNS_OF_SEARCH = 500
SEARCH_TOLERANCE = 4e-16
"""Change of the tangent points in a turn of the search, over the distance of the centres."""


def fleet_angles(route: DrawnRoute) -> list[tuple[float, float]]:
    """Return the angles between the plane of each groove and the spans before and after, as drawn in space, rad."""
    after = len(route.sheaves) - len(route.spans) + 1
    found = []
    for k, arc in enumerate(route.sheaves):
        beside = route.spans[k - after], route.spans[k - after + 1]
        found.append((fleet_angle(arc.groove, beside[0]), fleet_angle(arc.groove, beside[1])))
    return found


def fleet_angle(groove: np.ndarray, span: DrawnSpan) -> float:
    """Return the angle between a span as drawn and the plane of a groove, rad."""
    return asin(abs(np.cross(*groove.T) @ span.direction))


def groove_of(axis: tuple[float, float, float]) -> np.ndarray:
    """Return (3, 2): the plane of the groove of a sheave with an axis of any length; x and y about the z axis."""
    z = np.array(axis) / np.linalg.norm(axis)
    across = np.eye(3)[0] if abs(z[0]) <= 0.9 else np.eye(3)[1]
    x = across - z * (z @ across)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x)], axis=1)


def senses_in_space(points: list[RoutePoint], closed: bool) -> list[int]:
    """Return the side to which the polygon through the centres turns at each point, seen along its axis: 0 at ends and
    where that is not known.
    """
    centres = [point.centre for point in points]
    found = [0] * len(points)
    for k in range(0 if closed else 1, len(points) - (not closed)):
        before, after = centres[k] - centres[k - 1], centres[(k + 1) % len(centres)] - centres[k]
        (a, b), (c, d) = before @ points[k].groove, after @ points[k].groove
        turn = a * d - b * c
        found[k] = 0 if abs(turn) <= ANGLE_ROUNDING * hypot(a, b) * hypot(c, d) else 1 if turn > 0 else -1
    return found


def span_in_space(one: RoutePoint, other: RoutePoint, rope_radius: float) -> DrawnSpan:
    """Return the tangent from a point of a route to the next one. Raises ValueError where there is none."""
    apart = float(np.linalg.norm(other.centre - one.centre))
    start, end = one.centre, other.centre
    for _ in range(MAX_TURNS_OF_SEARCH):
        before = start, end
        start = _tangent(one, end, 1, other, apart)
        end = _tangent(other, start, -1, one, apart)
        if float(np.abs([start - before[0], end - before[1]]).max()) <= SEARCH_TOLERANCE * apart:
            break
    length = float(np.linalg.norm(end - start))
    check_length(one, other, length, rope_radius)
    span = DrawnSpan(start, end, length)
    for sheave in (one, other):
        _check_fleet(sheave, span)
    return span


def _check_fleet(sheave: RoutePoint, span: DrawnSpan) -> None:
    """Raise ValueError where a span is too short for its fleet angle at a sheave."""
    rise = abs(float(np.cross(*sheave.groove.T) @ span.direction))
    across = (1 - rise**2) ** 0.5
    if sheave.radius and span.length * across**2 <= LEAST_SPAN * sheave.radius * rise:
        raise ValueError(f"a span of {show(span.length, 'm')} is too short for its fleet angle "
                         f"{show(asin(rise), 'rad')} at {sheave.label}, from which it would slide: its length must be "
                         f"above {LEAST_SPAN:g} R tan f",
                         "turn the axis of the sheave across the span, or move it away")


def _tangent(sheave: RoutePoint, place: np.ndarray, way: int, other: RoutePoint, apart: float) -> np.ndarray:
    """Return the tangent point of the span that leads to a place (way 1) or comes from there (-1)."""
    if not sheave.radius:
        return sheave.centre
    R, arm = sheave.reach[way > 0], place - sheave.centre
    x, y = (arm @ sheave.groove).tolist()
    p = hypot(x, y)
    z = float(np.linalg.norm(arm - sheave.groove @ np.array([x, y])))
    root = (p * p - R * R)**2 - 4 * (R * z)**2
    if p <= R:
        raise ValueError(*without_tangent(sheave, other, apart))
    if root < 0:
        raise ValueError(f"the span between {sheave.label} and {other.label} leaves the groove of {sheave.label} too "
                         f"steeply: {show(z, 'm')} along its axis and {show(p, 'm')} from it",
                         "turn its axis across the span, or move them apart")
    rho = ((p * p + R * R - root**0.5) / 2)**0.5
    angle = atan2(y, x) - way * sheave.sense * acos(min(rho / p, 1.0))
    return sheave.centre + rho * sheave.groove @ np.array([np.cos(angle), np.sin(angle)])
