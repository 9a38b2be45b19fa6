"""The path of equilibria x(p) by arc-length continuation (Riks 1979; Crisfield 1981), and the critical points on it.

The load fraction p is an additional unknown, so that the path passes limit points, and unstable states, which are
labelled. Where the number of unstable directions or the sense of the load changes between two states, bisection along
the path finds the critical point.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import block_array

from ..linear.solver import solver
from .stability import Stability, stability
from .static_problem import StaticProblem

MAX_STATES = 1000
MAX_CORRECTIONS = 12
MAX_CORRECTION_GROWTH = 10.0
"""Ratio of a correction to the smallest one before above which the iteration does not converge."""
MIN_PATH_STEP = 1e-8
"""Smallest step along the path, in units of the load fraction or of the scene's size."""
MIN_DIRECTION_COSINE = 0.8
"""Lower bound of the cosine of the angle between the directions of consecutive states."""
CRITICAL_POINT_TOLERANCE = 1e-6
"""Accuracy of critical points, as a load fraction."""


@dataclass
class Point:
    """A state on the path: its load fraction, and the direction of the path. along (unknowns,) and rate are dx and dp
    for a unit of arc-length, over displacements relative to the scene's size, and p; heading (unknowns + 1,) is the
    unit vector of these; advance: the arc-length from the previous point.
    """

    kept: dict[str, np.ndarray]
    fraction: float
    along: np.ndarray
    rate: float
    heading: np.ndarray
    stability: Stability
    advance: float = 0.0

    @property
    def kind(self) -> tuple[int, bool]:
        """Return the number of unstable directions, and whether the load rises along the path."""
        return self.stability.unstable, self.rate > 0


@dataclass
class Critical:
    """A point of the path at which the load turns ("limit"), or another path crosses it ("bifurcation").

    directions: the change of the number of unstable directions beyond it.
    """

    point: Point
    kind: str
    directions: int


def follow(problem: StaticProblem, fraction: float, heading: np.ndarray | None) -> Iterator[Point | Critical]:
    """Yield points and critical points from the static state, at rest at this load fraction, to p = 1 or to the end of
    the path.

    heading: of a `Point`, the sense of the path; None: to higher loads.
    """
    largest = problem.settings.largest_step
    problem.load(fraction)
    point = _point(problem, heading)
    if point is None:
        return
    step = largest / problem.settings.load_steps
    for _ in range(MAX_STATES):
        step = min(step, largest / float(np.max(np.abs(point.heading))))
        following = None
        while step > MIN_PATH_STEP:
            following = _advance(problem, point, step)
            if following is not None and following.fraction >= 1.0:
                following = _at_full_load(problem, point, following)
                if following is not None:
                    yield from _critical(problem, point, following)
                    yield following
                    return
            if following is not None and point.heading @ following.heading > MIN_DIRECTION_COSINE:
                break
            following = None
            step *= 0.25
        if following is None:
            return
        yield from _critical(problem, point, following)
        yield following
        point, step = following, 1.5 * step


def _point(problem: StaticProblem, before: np.ndarray | None, advance: float = 0.0) -> Point | None:
    """Return the static state as a point of the path, in the sense of the heading before."""
    if before is None:
        before = np.append(np.zeros(len(problem.weight)), 1.0)
    try:
        ahead = _bordered(problem, before)(np.append(np.zeros(len(problem.weight)), 1.0))
    except RuntimeError:
        return None
    heading = np.append(problem.weight / problem.size, 1.0) * ahead
    length = np.linalg.norm(heading)
    if not np.isfinite(length):
        return None
    return Point(problem.keep(), problem.fraction, ahead[:-1] / length, float(ahead[-1] / length), heading / length,
                 stability(problem), advance)


def _bordered(problem: StaticProblem, heading: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Return the solver of the tangent with the load as a further unknown, and the advance along the heading as a row,
    which is regular at limit points. Raises RuntimeError where it is singular.
    """
    row = heading * np.append(problem.weight / problem.size, 1.0)
    tangent, load = problem.regular_tangent(), -problem.load_vector()[:, None]
    blocks = [[tangent, load], [row[None, :-1], row[None, -1:]]]
    return solver(np.block(blocks) if isinstance(tangent, np.ndarray) else block_array(blocks, format="csc"))


def _advance(problem: StaticProblem, point: Point, advance: float) -> Point | None:
    """Return the point after a predictor along the heading and Newton's method in the plane normal to it, or None."""
    problem.restore(point.kept)
    problem.move(advance * point.along)
    problem.load(point.fraction + advance * point.rate)
    tolerance, least = problem.settings.tolerance, np.inf
    for _ in range(MAX_CORRECTIONS):
        problem.iterations += 1
        try:
            change = _bordered(problem, point.heading)(np.append(-problem.residual(), 0.0))
        except RuntimeError:
            return None
        size = problem.length(change[:-1])
        if not size < min(MAX_CORRECTION_GROWTH * least, problem.size):
            return None
        problem.move(change[:-1])
        problem.load(problem.fraction + float(change[-1]))
        least = max(min(size, least), tolerance * problem.size)
        if size <= tolerance * problem.size and abs(change[-1]) <= tolerance * max(abs(problem.fraction), advance):
            return _point(problem, point.heading, advance) if problem.on_cables() else None
    return None


def _at_full_load(problem: StaticProblem, point: Point, beyond: Point) -> Point | None:
    """Return the state at p = 1 between two points; None where Newton does not find it there."""
    advance = beyond.advance * (1.0 - point.fraction) / (beyond.fraction - point.fraction)
    if _advance(problem, point, advance) is None:
        return None
    problem.load(1.0)
    if not problem.newton() or problem.distance(point.kept) > 3.0 * beyond.advance * problem.size:
        return None
    return _point(problem, point.heading, advance)


def _critical(problem: StaticProblem, point: Point, following: Point) -> list[Critical]:
    """Return the critical points between a point and the next one, by bisection."""
    found: list[Critical] = []
    intervals = [(point, following)]
    while intervals:
        near, far = intervals.pop()
        if near.kind == far.kind:
            continue
        start = 0.0 if near is point else near.advance
        between = None
        if not _sharp(near, far, start):
            tries = (_advance(problem, point, start + part * (far.advance - start)) for part in (0.5, 0.4, 0.65))
            between = next((each for each in tries if each is not None), None)
        if between is None:
            _add(found, near, far)
        else:
            intervals += [(between, far), (near, between)]
    return found


def _sharp(near: Point, far: Point, start: float) -> bool:
    """Return whether two points are close enough to enclose a single critical point: the load differs by at most the
    arc-length between them times its rate at either end.
    """
    width, rate = far.advance - start, max(abs(near.rate), abs(far.rate))
    accuracy = CRITICAL_POINT_TOLERANCE * max(abs(far.fraction), CRITICAL_POINT_TOLERANCE)
    return width < MIN_PATH_STEP or width * rate <= accuracy


def _add(found: list[Critical], near: Point, far: Point) -> None:
    """Add a critical point; two changes at one load are one: at a limit point the load turns and stability changes."""
    turns = near.kind[1] != far.kind[1]
    more = far.stability.unstable - near.stability.unstable
    if found and abs(far.fraction - found[-1].point.fraction) <= 10 * CRITICAL_POINT_TOLERANCE * abs(far.fraction) and (
            turns != (found[-1].kind == "limit")):
        found[-1] = Critical(found[-1].point, "limit", found[-1].directions + more)
        return
    found.append(Critical(near, "limit" if turns else "bifurcation", more))
