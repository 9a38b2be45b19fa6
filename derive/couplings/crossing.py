"""Two lines that touch at their closest points: a cable under the bar of a body, a cable that crosses another.

Each line is known at its point by position, slope, curvature r_xx, and the rates of the first two. In the plane the
second line is a bar square to it, which is seen as a point. The points are closest where the way d between them, from
the second to the first, is square to both lines. These conditions say how the points move along their lines with all
the rest. The normal n is square to both slopes, of a sign that is given (``side``), so that the gap keeps its sign
where the lines pass through each other.

The force on the first line is N n, with N = k p^e (1 + damping p') of the penetration p = radii - n.d: the law of Hunt
& Crossley, J. Appl. Mech. 42 (1975) 440-445. k p^e is c_1 p + c_2 p sqrt(|p|), of which one coefficient is zero. It is
odd in p, so that it is smooth across p = 0, where a run ends contact.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import sympy as sp

from ..codegen.program import Program, jacobian

CROSSINGS = {3: "crossing", 2: "planar_crossing"}
PENALTY = ("radii", "side", "linear", "root", "damping", "least")
SOURCE = "Hunt & Crossley 1975; closest points by the implicit function theorem"


class _Lines(NamedTuple):
    """What is known of both lines: the way between the points, and slopes and curvatures of those that have some."""

    d: np.ndarray
    t: np.ndarray
    k: np.ndarray

    @property
    def signs(self) -> list[int]:
        """Return with which sign each point counts in d."""
        return [1, -1][: len(self.t)]


def build(dim: int) -> list[Program]:
    """Return the kernels in space or in the plane."""
    return [closest(dim), contact(dim), force(dim)]


def _lines(p: Program, dim: int, with_curvature: bool = True) -> _Lines:
    """Declare what is known of both lines; of the second in the plane that is its point alone."""
    shape = (dim - 1, dim)
    d = p.input("d", dim, "m", "position of the first point less that of the second")
    t = p.input("t", shape, "1", "slopes of the lines")
    return _Lines(d, t, p.input("k", shape, "1/m", "curvatures r_xx of the lines") if with_curvature else t)


def _solve(p: Program, lines: _Lines, right: Sequence[Sequence[sp.Expr]]) -> list[list[sp.Expr]]:
    """Return the solutions of the conditions' matrix for right sides, each (lines,)."""
    t, k, d, signs = lines.t, lines.k, lines.d, lines.signs
    n = len(t)
    matrix = [[sign * t[i].dot(t[j]) + (k[i].dot(d) if i == j else 0) for j, sign in enumerate(signs)]
              for i in range(n)]
    matrix = [[p.define(f"J_{i}{j}", entry) for j, entry in enumerate(row)] for i, row in enumerate(matrix)]
    if n == 1:
        inverse = p.define("inv_J", 1 / matrix[0][0])
        return [[inverse * each[0]] for each in right]
    (a, b), (c, e) = matrix
    inverse = p.define("inv_J", 1 / p.define("det_J", a * e - b * c))
    return [[inverse * (e * x - b * y), inverse * (a * y - c * x)] for x, y in right]


def closest(dim: int) -> Program:
    """Return the kernel of how far the closest points are away along both lines."""
    p = Program(f"{CROSSINGS[dim]}_closest", "a step of Newton's method to the closest points", SOURCE)
    lines = _lines(p, dim)
    p.stage("conditions of closeness")
    gaps = [p.define(f"h_{i}", t.dot(lines.d)) for i, t in enumerate(lines.t)]
    (step,) = _solve(p, lines, [[-gap for gap in gaps]])
    p.output("step", step, "m", "changes of the arc-lengths of both points, the first's alone in the plane")
    return p


def _normal(p: Program, lines: _Lines, side: sp.Expr) -> np.ndarray:
    """Return the unit vector square to both lines, of the given side."""
    if len(lines.t) == 1:
        x, y = lines.t[0]
        square = np.array([y, -x])
    else:
        square = p.vector("m", np.cross(*lines.t))
    inverse = p.define("inv_m", 1 / p.define("len_m", sp.sqrt(square.dot(square))))
    return p.vector("n", p.define("side_m", side * inverse) * square)


def _law(p: Program, n: np.ndarray, d: np.ndarray, u: np.ndarray, c: np.ndarray) -> dict[str, sp.Expr]:
    """Return penetration, its rate, the force k p^e without damping, and with it."""
    radii, _, linear, root, damping, least = c
    depth = p.define("depth", radii - n.dot(d))
    rate = p.define("rate", -n.dot(u))
    size = p.define("root_p", sp.sqrt(p.define("size_p", sp.sqrt(depth * depth + least * least))))
    elastic = p.define("elastic", depth * (linear + root * size))
    return {"depth": depth, "rate": rate, "elastic": elastic, "root": size,
            "force": p.define("N_law", elastic * (1 + damping * rate))}


def _penalty(p: Program) -> np.ndarray:
    return p.input("c", len(PENALTY), "m, 1, N/m, N/m^1.5, s/m, m",
                   "sum of the radii, sign of the normal, coefficients of p and p^1.5, damping, what |p| is not below")


def contact(dim: int) -> Program:
    """Return the kernel of what is told of a contact at closest points."""
    p = Program(f"{CROSSINGS[dim]}_contact", "penetration and contact force at closest points", SOURCE)
    lines = _lines(p, dim, with_curvature=False)
    u = p.input("u", dim, "m/s", "rate of the way d between the points on their lines")
    c = _penalty(p)
    p.stage("normal")
    n = _normal(p, lines, c[1])
    p.stage("law")
    law = _law(p, n, lines.d, u, c)
    depth, linear, root = law["depth"], c[2], c[3]
    p.output("n", n, "1", "normal, from the second line to the first")
    p.output("p", [depth, law["rate"]], "m, m/s", "penetration, and its rate")
    p.output("N", [law["force"]], "N", "size of the force")
    p.output("U", [depth * depth * (linear / 2 + sp.Rational(2, 5) * root * law["root"])], "J", "energy of k p^e")
    p.output("P", [law["elastic"] * c[4] * law["rate"] ** 2], "W", "power that the damping dissipates")
    return p


def force(dim: int) -> Program:
    """Return the kernel of the force on the first line, and of its derivatives and those of the closest points."""
    p = Program(f"{CROSSINGS[dim]}_force", "contact force, and its derivatives with the closest points moving", SOURCE)
    lines = _lines(p, dim)
    t, k = lines.t, lines.k
    w = p.input("w", t.shape, "1/s", "rates of the slopes")
    u = p.input("u", dim, "m/s", "rate of the way d between the points on their lines")
    c = _penalty(p)
    p.stage("normal")
    n = _normal(p, lines, c[1])
    p.stage("law")
    F = p.vector("F", _law(p, n, lines.d, u, c)["force"] * n)
    p.stage("closest points: derivatives of the arc-lengths by d and by the slopes")
    gaps = [slope.dot(lines.d) for slope in t]
    moving = [*lines.d, *t.ravel()]
    columns = _solve(p, lines, [[-sp.diff(gap, symbol) for gap in gaps] for symbol in moving])
    s_by = np.array([[p.define(f"s{i}_{j}", column[i]) for j, column in enumerate(columns)] for i in range(len(t))])
    p.stage("derivatives of the force where the points stay")
    at_point = jacobian(p, F, [*moving, *u])
    by_d, by_t, by_u = np.split(at_point, [dim, dim + t.size], axis=1)
    p.stage("derivatives of the force along the lines")
    along = [p.vector(f"F_s{i}", sign * by_d @ t[i] + by_t[:, dim * i: dim * (i + 1)] @ k[i] + sign * by_u @ w[i])
             for i, sign in enumerate(lines.signs)]
    total = at_point[:, :len(moving)] + np.stack(along, axis=-1) @ s_by
    p.output("F", F, "N", "force on the first line; its opposite acts on the second")
    p.output("F_d", total[:, :dim], "N/m", "derivatives of F by d, with the closest points moving")
    p.output("F_t", total[:, dim:], "N", "derivatives of F by the slopes, likewise")
    p.output("F_u", by_u, "N s/m", "derivatives of F by u")
    p.output("s_d", s_by[:, :dim], "1", "derivatives of the arc-lengths of the closest points by d")
    p.output("s_t", s_by[:, dim:], "m", "derivatives of these by the slopes")
    return p
