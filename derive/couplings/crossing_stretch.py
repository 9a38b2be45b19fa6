"""The stretch of friction's spring between two lines after a step, without sliding.

Simpson's rule makes the integral of the slip v over the step, with v half-way from cubics through values and rates of
d, of the slopes and of the arc-lengths of the closest points at both ends of the step.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import sympy as sp

from ..codegen.program import Program, jacobian


class Stretch(NamedTuple):
    """Stretch of friction's spring without sliding; what it was before, along what; how far the points have moved; the
    slip of the last step, turned alike; the time since then; the definitions that the stretch depends on the motion of
    the points through, in the order of the chain rule.
    """

    now: np.ndarray
    old: np.ndarray
    along: np.ndarray
    e: np.ndarray
    slip: np.ndarray
    h: sp.Expr
    chain: tuple[np.ndarray, ...]


class Motion(NamedTuple):
    """Rates of the arc-lengths of the closest points, of the slopes there, and of d."""

    s: np.ndarray
    t: np.ndarray
    d: np.ndarray


class _Before(NamedTuple):
    """The data of the last step: d, slopes and arc-lengths; components of the stretch and of its rate."""

    h: sp.Expr
    d: np.ndarray
    d_rate: np.ndarray
    t: np.ndarray
    t_rate: np.ndarray
    s_rate: np.ndarray
    x: np.ndarray
    v: np.ndarray


def _before(p: Program, shape: tuple[int, int]) -> _Before:
    """Declare the data of the last step."""
    lines, dim = shape
    told = "of the last step: along the last line that has a slope, and square to it"
    return _Before(p.input("h", (), "s", "time since the last step; 0 where it is unknown, and rates do not count"),
                   p.input("d_0", dim, "m", "d of the last step"), p.input("d_rate", dim, "m/s", "its rate then"),
                   p.input("t_0", shape, "1", "slopes of the last step at the closest points"),
                   p.input("t_rate", shape, "1/s", "their rates then, with the points moving"),
                   p.input("s_rate", lines, "m/s", "rates of the arc-lengths then"),
                   p.input("x", dim - 1, "m", f"stretch {told}"), p.input("v", dim - 1, "m/s", f"slip {told}"))


def _frame(p: Program, name: str, slopes: np.ndarray, side: sp.Expr, n: np.ndarray | None = None) -> list[np.ndarray]:
    """Return unit vectors in the tangent plane: along the last line that has a slope; in space also square to it."""
    last = slopes[-1]
    inverse = p.define(f"inv_t{name}", 1 / p.define(f"len_t{name}", sp.sqrt(last.dot(last))))
    along = p.vector(f"tau{name}", inverse * last)
    if len(slopes) == 1:
        return [along]
    if n is None:
        square = p.vector(f"m{name}", np.cross(*slopes))
        n = side / p.define(f"len_m{name}", sp.sqrt(square.dot(square))) * square
    return [along, p.vector(f"across{name}", np.cross(n, along))]


def stretch_after(p: Program, d: np.ndarray, t: np.ndarray, signs: Sequence[int], side: sp.Expr, n: np.ndarray,
                  u: np.ndarray, rates: Motion) -> Stretch:
    """Declare the data of the last step; return the stretch that follows.

    d, t, n, u: as the kernels of a crossing take them, with the sign ``side`` of the normal n; signs: with which each
    point counts in d.
    """
    e = p.input("e", len(t), "m", "arc-lengths of the closest points less those of the last step")
    last = _before(p, t.shape)
    p.stage("slip half-way, times the step")
    t_half = np.stack([p.vector(f"t_half{i}", (last.t[i] + t[i]) / 2 + last.h * (last.t_rate[i] - rates.t[i]) / 8)
                       for i in range(len(t))])
    slip = sp.Rational(3, 2) * (d - last.d) - last.h * (last.d_rate + rates.d) / 4
    for i, sign in enumerate(signs):
        slip = slip - sign * (sp.Rational(3, 2) * e[i] - last.h * (last.s_rate[i] + rates.s[i]) / 4) * t_half[i]
    slip = p.vector("slip_half", slip)
    p.stage("stretch of the spring")
    frame, middle = _frame(p, "", t, side, n), _frame(p, "_half", t_half, side)
    old = p.vector("old", sum(x * axis for x, axis in zip(last.x, frame, strict=True)))
    parts = [p.define(f"x_{i}", last.x[i] + (last.h * (last.v[i] + axis.dot(u)) + 4 * middle[i].dot(slip)) / 6)
             for i, axis in enumerate(frame)]
    now = p.vector("x_now", sum(x * axis for x, axis in zip(parts, frame, strict=True)))
    slip_0 = p.vector("slip_old", sum(v * axis for v, axis in zip(last.v, frame, strict=True)))
    return Stretch(now, old, frame[0], e, slip_0, last.h, (now, np.concatenate([t_half.ravel(), slip]), rates.s))


def turned_stretch(p: Program, found: Stretch, slip: np.ndarray, end: tuple[sp.Expr, sp.Expr]) -> np.ndarray:
    """Return the direction, of no particular size, of a stretch that slides as the step ends.

    end: the size r of the stretch then, and a negligible length. With the unit vector m of the direction, r m' is the
    part of the slip that is square to m. Let A be the slip over the step by r, and the direction of the slip a parabola
    with the values at both ends and the mean. For small angles m is then a sum of the first direction and these three,
    with the weights 1, -A^2/12 - A^3/12, A + A^2/2 + A^3/4 and A^2/12 + A^4/24 over their sum. The sum has the series
    of exp(A) up to A^4. Where A is large m is the direction at the end less its lag. The slip of the last step counts
    by its speed over the mean: it has none where it stuck.
    """
    slid = p.input("slid", (), "1", "1 where it slid at the last step, too, else 0")
    r_0 = p.input("r_0", (), "m", "size of the stretch of the last step; any other than 0 where it did not slide")
    turns = p.input("turns", (), "1", "1 where it slides forwards as the step ends, else 0: along the whole slip")
    r, least = end
    size = p.define("r", r + slid * (r_0 - r) / 2 + least)
    change = p.vector("change", found.now - found.old)
    path = p.define("path", turns * p.define("size_path", sp.sqrt(change.dot(change) + least * least)))
    A = p.define("A", path / size)
    speed = p.define("speed_1", sp.sqrt(slip.dot(slip) + least * least))
    old = p.define("old_more", slid * (r - r_0) / (2 * r_0))
    weights = [p.define(f"weight_{k}", each) for k, each in enumerate(
        (-found.h * (A + A**2) / 12, A / 2 + A**2 / 4, path * (A / 12 + A**3 / 24) / speed))]
    lead = weights[0] * found.slip + weights[1] * change + weights[2] * slip
    return p.vector("turned", found.now + old * found.old + lead)


def jacobian_along(p: Program, values: np.ndarray, wrt: Sequence[sp.Symbol], chain: Sequence[np.ndarray],
                   constant: Sequence[sp.Symbol]) -> np.ndarray:
    """Return the partial derivatives of ``values`` (n,) by ``wrt`` (m,) -> (n, m), by the chain rule in stages.

    chain: definitions from which the values follow, each stage from those after it and ``wrt``. A derivative through a
    stage is a product of matrices; `jacobian` alone would carry each column through all definitions.
    """
    later = list(chain)
    found = jacobian(p, values, [*wrt, *(s for stage in later for s in stage)], constant)
    while later:
        stage, *later = later
        m = len(wrt)
        within = jacobian(p, stage, [*wrt, *(s for each in later for s in each)])
        known = np.concatenate([found[:, :m], found[:, m + len(stage):]], axis=1)
        total = known + found[:, m:m + len(stage)] @ within
        found = np.array([[p.define(f"F{i}_{j}", entry) for j, entry in enumerate(row)] for i, row in enumerate(total)])
    return found
