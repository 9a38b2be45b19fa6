"""Drawn shapes of cables: a line, or a smooth curve through points, over their arc-length in m.

A shape has ``length`` and, at arc-lengths (...,), ``point``, ``tangent`` (unit) and ``curvature`` (dt/ds, 1/m), each
(..., 3). Functions raise ``ValueError(cause, remedy)``.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable
from functools import lru_cache
from math import acos, degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.quadrature import gauss
from ..base.rotations import cross
from .validation import Points, items, show, shown, vector

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers

FOLD_SAMPLES = 33
"""Points of an interval at which folds are sought."""
SWING_FACTOR, SWING_ANGLE = 1.2, 1e-3
"""A curve swings if its angle from a chord exceeds the factor times the angle between chords, plus the angle in rad. On
a circle the ratio of the angles is a half with even points, and at most one.
"""

GAUSS_POINTS = 8
QUADRATURE_INTERVALS = 8
"""Between two points: with eight Gauss points in each, exact to rounding."""
MAX_SAMPLES = 4096
SPLINE_TOLERANCE = 1e-9
"""Distance of a sampled function from its spline, over its extent."""
KINK_SEARCH_CHORD, MIN_CHORD = 1e-5, 1e-9
"""Chord over the extent below which a kink is sought, and the shortest chord."""
MIN_CHORD_COSINE = 0.9
"""Of the angle between two chords; a larger angle needs more samples."""
KINK_RATIO = 0.7
"""A kink keeps more than this part of its angle over a third of the way; a bend does not."""
TRANSPORT_STEPS = 32
"""Of the section's axes between two places; the error falls with their 4th power."""


class Line:
    """The straight line between two points."""

    straight = True

    def __init__(self, start: Iterable[float], end: Iterable[float]):
        """start, end: (3,) in m, different."""
        self.start, self.end = np.array(start, dtype=float), np.array(end, dtype=float)
        self.length = float(np.linalg.norm(self.end - self.start))

    def point(self, s: ArrayLike) -> np.ndarray:
        """Return the points at arc-lengths s."""
        ratio = np.asarray(s)[..., None] / self.length  # the weights make both ends exact
        return (1 - ratio) * self.start + ratio * self.end

    def tangent(self, s: ArrayLike) -> np.ndarray:
        """Return the unit tangents at arc-lengths s."""
        return np.broadcast_to((self.end - self.start) / self.length, (*np.shape(s), 3))

    def curvature(self, s: ArrayLike) -> np.ndarray:
        """Return the curvature vectors at arc-lengths s: zero."""
        return np.zeros((*np.shape(s), 3))

    def nearest(self, point: Iterable[float]) -> np.ndarray:
        """Return the arc-length (1,) of the nearest point."""
        return np.clip([np.dot(np.asarray(point) - self.start, self.tangent(0.0))], 0, self.length)


class Spline:
    """The cubic spline through points, twice continuously differentiable; three points give a parabola.

    A cubic spline swings out beside long straight parts. Where it turns away from a chord by more than the chords turn,
    Akima's spline with modified weights replaces it, with a continuous tangent. The parameter is the sum of the chords,
    which avoids loops between uneven points. Gauss quadrature of the speed gives the arc-length. The ends are
    not-a-knot.
    """

    straight = False

    def __init__(self, points: np.ndarray):
        """points: (n, 3) in m, 3 or more, neighbours different."""
        # SciPy would double the time of `import funicular`; straight cables do without.
        from scipy.interpolate import Akima1DInterpolator, CubicSpline

        self.points = np.array(points, dtype=float)
        self.t = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(self.points, axis=0), axis=1))])
        self._take(CubicSpline(self.t, self.points))
        if self._swings():
            self._take(Akima1DInterpolator(self.t, self.points, method="makima"))
        self._refuse_folds()
        parts = np.diff(self.t)[:, None] * np.arange(QUADRATURE_INTERVALS) / QUADRATURE_INTERVALS
        self.t = np.append((self.t[:-1, None] + parts).ravel(), self.t[-1])  # now of the quadrature
        self.s = np.concatenate([[0.0], np.cumsum(self._arc(self.t[:-1], self.t[1:]))])
        self.length = float(self.s[-1])

    def _take(self, r: Any) -> None:
        self._r, self._r_t, self._r_tt = r, r.derivative(), r.derivative(2)

    def _off_the_chords(self) -> tuple[np.ndarray, np.ndarray]:
        """Return parameters (intervals, samples), and the cosine of the angle between curve and chord there."""
        inside = self.t[:-1, None] + np.diff(self.t)[:, None] * np.linspace(0, 1, FOLD_SAMPLES)
        slope = self._r_t(inside)
        chord = np.diff(self.points, axis=0) / np.diff(self.t)[:, None]
        onward = np.einsum("kfi,ki->kf", slope, chord)
        speed = np.linalg.norm(slope, axis=-1)
        return inside, onward / np.maximum(speed, 1e-300)

    def _swings(self) -> bool:
        """Return whether the curve turns away from a chord by more than the chords turn."""
        off = np.arccos(np.clip(self._off_the_chords()[1].min(axis=1), -1, 1))
        chord = np.diff(self.points, axis=0) / np.diff(self.t)[:, None]
        turns = np.arccos(np.clip(np.sum(chord[1:] * chord[:-1], axis=1), -1, 1))
        return bool(np.any(off > SWING_FACTOR * np.maximum(np.append(turns, 0), np.append(0, turns)) + SWING_ANGLE))

    def _refuse_folds(self) -> None:
        """Raise ValueError where the curve turns back between two points."""
        inside, turn = self._off_the_chords()
        interval, where = np.unravel_index(np.argmin(turn), turn.shape)
        if turn[interval, where] > 0:
            return
        angle = degrees(acos(np.clip(turn[interval, where], -1, 1)))
        raise ValueError(
            f"the curve folds on itself between point {interval + 1} at {show(self.points[interval])} and point "
            f"{interval + 2} at {show(self.points[interval + 1], 'm')}: near "
            f"{show(self._r(inside[interval, where]), 'm')} it turns {angle:.0f} degrees off the line between them",
            "give more points there, or look at their order")

    def _arc(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        """Return the lengths (n,) between two parameters (n,) in each interval."""
        places, weights = gauss(GAUSS_POINTS)
        half = 0.5 * (end - start)
        at = 0.5 * (start + end)[:, None] + half[:, None] * places
        return half * (np.linalg.norm(self._r_t(at), axis=-1) @ weights)

    def _parameter(self, s: ArrayLike) -> np.ndarray:
        """Return the parameters of arc-lengths, by Newton's method with the speed as derivative."""
        clipped = np.clip(np.asarray(s, dtype=float), 0, self.length)
        flat = clipped.ravel()
        k = np.clip(np.searchsorted(self.s, flat, side="right") - 1, 0, len(self.t) - 2)
        low, high = self.t[k], self.t[k + 1]
        t = low + (high - low) * (flat - self.s[k]) / (self.s[k + 1] - self.s[k])
        for _ in range(50):
            step = (flat - self.s[k] - self._arc(low, t)) / np.linalg.norm(self._r_t(t), axis=-1)
            t = np.clip(t + step, low, high)
            if np.max(np.abs(step), initial=0.0) <= 1e-14 * self.t[-1]:
                break
        return t.reshape(clipped.shape)

    def point(self, s: ArrayLike) -> np.ndarray:
        """Return the points at arc-lengths s."""
        return self._r(self._parameter(s))

    def tangent(self, s: ArrayLike) -> np.ndarray:
        """Return the unit tangents at arc-lengths s."""
        slope = self._r_t(self._parameter(s))
        return slope / np.linalg.norm(slope, axis=-1, keepdims=True)

    def curvature(self, s: ArrayLike) -> np.ndarray:
        """Return the curvature vectors at arc-lengths s, across the tangent."""
        t = self._parameter(s)
        slope, second = self._r_t(t), self._r_tt(t)
        square = np.sum(slope * slope, axis=-1, keepdims=True)
        return (second - slope * np.sum(slope * second, axis=-1, keepdims=True) / square) / square

    def nearest(self, point: Iterable[float]) -> np.ndarray:
        """Return the arc-lengths (n,) where the distance to ``point`` is a local minimum, to 1e-4 of the length."""
        s = np.linspace(0, self.length, 10001)
        distance = np.concatenate([[np.inf], np.linalg.norm(self.point(s) - np.asarray(point), axis=-1), [np.inf]])
        return s[(distance[1:-1] < distance[:-2]) & (distance[1:-1] <= distance[2:])]


def points(value: Any) -> Points:
    """Return two points (x, y, z) or more in m, neighbours different. Raises ValueError."""
    if (rows := items(value, 2)) is None:
        raise ValueError(f"must be a list of 2 points or more, got {shown(value)}")
    result = []
    for number, row in enumerate(rows, start=1):
        try:
            result.append(vector(row, "m"))
        except ValueError as error:
            raise ValueError(f"{number} {error.args[0]}") from None
    size = np.ptp(np.array(result), axis=0).max()
    for number, (one, other) in enumerate(itertools.pairwise(result), start=1):
        if not np.linalg.norm(np.subtract(other, one)) > 1e-12 * size:
            raise ValueError(f"{number} and {number + 1} are the same point, {show(one, 'm')}", "leave one of them out")
    return tuple(result)


def sample(curve: Callable[[float], Iterable[float]], least: int) -> np.ndarray:
    """Return points (n, 3) of a function of u from 0 to 1, whose spline is the curve to 1e-9 of its extent.

    They are even on a smooth curve, and denser where curvature or speed jump. Raises ValueError for a curve without a
    tangent.
    """
    from scipy.interpolate import CubicSpline  # as above

    def at(u: float) -> tuple[float, ...]:
        try:
            return vector(tuple(curve(float(u))), "m")
        except (ValueError, TypeError) as error:
            raise ValueError(f"curve({u:.6g}) {error.args[0]}", "it takes a number from 0 to 1 and gives x, y, z in m"
                             ) from None

    count = max(16, 4 * least)
    u = np.linspace(0, 1, count + 1)
    known = np.array([at(v) for v in u])
    while True:
        between = 0.5 * (u[1:] + u[:-1])
        new = np.array([at(v) for v in between])
        gap = np.linalg.norm(CubicSpline(u, known)(between) - new, axis=1)
        worst, extent = int(np.argmax(gap)), np.ptp(known, axis=0).max()
        u = np.insert(u, np.arange(1, len(u)), between)
        known = np.insert(known, np.arange(1, len(known)), new, axis=0)
        if gap[worst] <= SPLINE_TOLERANCE * extent:
            return known
        if len(u) > MAX_SAMPLES:
            return _closer(at, np.linspace(0, 1, count + 1))


def _closer(at: Callable[[float], tuple[float, ...]], u: np.ndarray) -> np.ndarray:
    """Return points of a function, denser where the spline over the chords differs from it."""
    from scipy.interpolate import CubicSpline  # as above

    known = np.array([at(v) for v in u])
    extent = np.ptp(known, axis=0).max()
    while True:
        chords = np.linalg.norm(np.diff(known, axis=0), axis=1)
        moves = np.append(True, chords > 1e-12 * extent)  # its speed may be zero on an interval
        u, known, chords = u[moves], known[moves], chords[moves[1:]]
        t = np.append(0.0, np.cumsum(chords))
        between = 0.5 * (u[1:] + u[:-1])
        new = np.array([at(v) for v in between])
        gap = _distances(CubicSpline(t, known), t[:-1], t[1:], new)
        along = np.diff(known, axis=0) / chords[:, None]
        turns = np.append(np.append(False, np.sum(along[1:] * along[:-1], axis=1) < MIN_CHORD_COSINE), False)
        far = (gap > SPLINE_TOLERANCE * extent) | turns[1:] | turns[:-1]
        if not far.any():
            return known
        for k in np.flatnonzero(far & (chords < KINK_SEARCH_CHORD * extent)).tolist():
            _refuse_a_jump(at, u[max(k - 1, 0)], u[min(k + 2, len(u) - 1)], KINK_SEARCH_CHORD * extent)
            _refuse_a_kink(at, u[k], u[k + 1], new[k], gap[k], chords[k] / extent)
        if len(u) > 4 * MAX_SAMPLES:
            worst = int(np.argmax(gap))
            raise ValueError(f"curve winds too much to be followed near u = {between[worst]:.6g}, at "
                             f"{show(new[worst], 'm')}: {len(u)} points are still {gap[worst]:.3g} m away from it",
                             "draw it as several cables")
        places = np.flatnonzero(far) + 1
        u, known = np.insert(u, places, between[far]), np.insert(known, places, new[far], axis=0)


def _distances(spline: Any, low: np.ndarray, high: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return (n,): the distances of points to the spline between two parameters each."""
    t = 0.5 * (low + high)
    for _ in range(6):
        slope = spline(t, 1)
        step = np.sum((points - spline(t)) * slope, axis=1) / np.sum(slope * slope, axis=1)
        t = np.clip(t + step, low, high)
    return np.linalg.norm(spline(t) - points, axis=1)


def _refuse_a_jump(at: Callable[..., Any], low: float, high: float, far: float) -> None:
    """Raise ValueError for a jump of a curve, a gap that does not shrink with the interval of u."""
    for _ in range(50):
        middle = 0.5 * (low + high)
        start, point, end = (np.array(at(v)) for v in (low, middle, high))
        low, high = (low, middle) if np.linalg.norm(point - start) > np.linalg.norm(end - point) else (middle, high)
    if (gap := np.linalg.norm(np.subtract(at(high), at(low)))) > far:
        raise ValueError(f"curve jumps by {gap:.3g} m at u = {low:.6g}, from {show(np.array(at(low)), 'm')}",
                         "draw two cables where it has to be broken")


def _refuse_a_kink(at: Callable[..., Any], low: float, high: float, point: np.ndarray, gap: float,
                   chord: float) -> None:
    """Raise ValueError for a kink of a curve, whose angle does not shrink with the interval, as that of a bend does."""

    def angle(step: float) -> float:
        ends = [np.array(at(v)) for v in (max(low - step, 0.0), low, high, min(high + step, 1.0))]
        before, after = ends[1] - ends[0], ends[3] - ends[2]
        size = np.linalg.norm(before) * np.linalg.norm(after)
        return acos(np.clip(before @ after / size, -1, 1)) if size > 0 else 0.0

    place = f"near u = {0.5 * (low + high):.6g}, at {show(point, 'm')}"
    wide, narrow = angle(4 * (high - low)), angle(high - low)
    if narrow > KINK_RATIO * wide:
        raise ValueError(f"curve has a kink {place}: it turns by {degrees(narrow):.3g} degrees there",
                         "round it off, or join two cables there")
    if chord < MIN_CHORD:
        raise ValueError(f"curve bends too sharply {place}: the spline through its neighbours is {gap:.3g} m away",
                         "draw it as two cables that are joined there")


@lru_cache(maxsize=4096)
def shape_through(points: Points) -> Line | Spline:
    """Return the shape through points: a line if they lie on one, in order."""
    vertices = np.array(points)
    whole = vertices[-1] - vertices[0]
    length = np.linalg.norm(whole)
    if length > 0:
        along = (vertices - vertices[0]) @ whole / length
        off = np.linalg.norm(vertices - vertices[0] - along[:, None] * whole / length, axis=1)
        if off.max() <= 1e-12 * length and np.diff(along).min() > 0:
            return Line(vertices[0], vertices[-1])
    return Spline(vertices)


@lru_cache(maxsize=128)
def has_height(points: Points, up: tuple[float, ...]) -> bool:
    """Return whether ``up`` has a component across the shape through points at its start."""
    tilt = np.linalg.norm(cross(shape_through(points).tangent(0.0), up))
    return bool(tilt > 1e-6 * np.linalg.norm(up))


@lru_cache(maxsize=128)
def transported(points: Points, up: tuple[float, ...], places: tuple[float, ...]) -> np.ndarray:
    """Return the axes of the section along a shape, without rotation about its tangent.

    places: increasing arc-lengths in m from 0. Returns (places, 3, 3): rows are the unit tangent, the height and the
    width axis. At the start the height is the part of ``up`` across the tangent. By double reflection, of order 4 in
    the step (Wang, Jüttler, Zheng & Liu, ACM Trans. Graphics 27 (2008) 2).
    """
    shape = shape_through(points)
    steps = np.arange((len(places) - 1) * TRANSPORT_STEPS + 1) / TRANSPORT_STEPS
    fine = np.interp(steps, np.arange(len(places)), places)
    tangent = shape.tangent(fine)
    height = np.array(up) - np.dot(up, tangent[0]) * tangent[0]
    heights = [height]
    if not shape.straight:
        point = shape.point(fine)
        for k in range(len(fine) - 1):
            height = _reflected(height, tangent[k], point[k + 1] - point[k], tangent[k + 1])
            heights.append(height)
    j = np.broadcast_to(heights, tangent.shape)[::TRANSPORT_STEPS]
    i = tangent[::TRANSPORT_STEPS]
    j = j - np.sum(i * j, axis=1, keepdims=True) * i
    j = j / np.linalg.norm(j, axis=1, keepdims=True)
    return np.stack([i, j, cross(i, j)], axis=1)


def _reflected(height: np.ndarray, tangent: np.ndarray, step: np.ndarray, onward: np.ndarray) -> np.ndarray:
    """Return the height axis after a step: reflected in the plane between the points, then between the tangents."""
    if not step.any():
        return height
    mirror = 2 / np.dot(step, step) * step
    image, turned = height - np.dot(step, height) * mirror, tangent - np.dot(step, tangent) * mirror
    between = onward - turned
    return image - 2 * np.dot(between, image) / np.dot(between, between) * between
