"""Branches beside the elastic law of a cable: a spring in series with a dashpot or with a slider, at a point.

A branch acts on measures m of the point: the strain |r'| - 1 and the curvature r' x r''/r'.r'. A spring K with the
elastic part d of m has the stress n = K d. With a dashpot d' = m' - d/tau, so that over a step in which m changes
linearly from m_0

    d = decay d_0 + share (m - m_0),   decay = exp(-h/tau),   share = (1 - decay) tau/h.

A slider holds (decay = share = 1) up to |n| = limit and slides there. Both are implicit in m and stable at any step.

In space the curvature is a vector across the tangent i. The section does not turn about the tangent from the beginning
of the step, where the tangent is i_0: the smallest rotation from i to i_0 brings the vector kappa to
kappa - i_0.kappa/(1 + i.i_0) (i + i_0).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ..algebra.tangent_frame import cross
from ..codegen.family import CouplingFamily
from ..codegen.program import DirectionalDerivative, Program, jacobian

BRANCHES = {3: "branch", 2: "planar_branch"}
MEASURES = {3: 4, 2: 2}
SOURCE = "Maxwell element; Jenkin element"


def families() -> list[CouplingFamily]:
    """Return the families in space and in the plane."""
    return CouplingFamily.each("branch", "branches beside the law of a cable", BRANCHES, build)


def build(dim: int) -> list[Program]:
    """Return the kernels in space or in the plane."""
    return [measures(dim), force(dim), tangent(dim), hold(dim), slide(dim)]


class _Point:
    """Inputs and stages of a point: its measures."""

    def __init__(self, kernel: str, dim: int, doc: str):
        self.program = p = Program(f"{BRANCHES[dim]}_{kernel}", doc, SOURCE)
        before = p.input("i_0", dim, "1", "tangent at the beginning of the step; not used in the plane")
        self.vectors = np.concatenate([p.input("a", dim, "1", "slope r'"), p.input("b", dim, "1/m", "r''")])
        a, b = np.split(self.vectors, 2)
        p.stage("strain")
        over = p.define("over", a.dot(a) - 1)
        length = p.define("length", sp.sqrt(1 + over))
        inverse = p.define("inv_length", 1 / length)
        strain = p.define("strain", over / (1 + length), derivative_of=length)
        p.stage("curvature")
        square = p.define("inv_square", inverse * inverse)
        if dim == 2:
            self.m = np.array([strain, p.define("kappa", square * (a[0] * b[1] - a[1] * b[0]))])
            return
        kappa, i = p.vector("kappa", square * cross(a, b)), p.vector("i", inverse * a)
        part = p.define(
            "part",
            p.define("along", before.dot(kappa)) * p.define("inv_sum", 1 / p.define("one_and_cos", 1 + i.dot(before))),
        )
        self.m = np.array([strain, *p.vector("m", kappa - part * (i + before))])

    def stress(self) -> np.ndarray:
        """Declare the input n, and return it."""
        return self.program.input("n", len(self.m), "N, N m", "force of the strain, moments of the curvature")

    def forces(self, n: np.ndarray) -> np.ndarray:
        """Stage: the derivatives of n.m by slope and r''."""
        self.program.stage("derivatives of the measures")
        return np.asarray(n.dot(jacobian(self.program, self.m, self.vectors)))


def measures(dim: int) -> Program:
    """Return the kernel of the measures m."""
    point = _Point("measures", dim, "strain and curvature of a point")
    point.program.output("m", point.m, "1, 1/m", "strain, and curvature")
    return point.program


def force(dim: int) -> Program:
    """Return the kernel of the forces on slope and r'' of a stress."""
    point = _Point("force", dim, "forces of a stress on the slope and its derivative")
    point.program.output("g", point.forces(point.stress()), "N, N m", "derivatives of n.m by r' and r''")
    return point.program


def tangent(dim: int) -> Program:
    """Return the kernel of the derivatives of these forces, with the stress that depends on the measures."""
    point = _Point("tangent", dim, "derivatives of the forces by the slope and its derivative")
    p, n = point.program, point.stress()
    D = p.input("D", (len(n), len(n)), "N, N m, N m^2", "derivatives of n by m")
    p.stage("derivatives of the measures")
    J = jacobian(p, point.m, point.vectors)
    J = np.array([[p.define(f"m{k}_{j}", J[k, j]) for j in range(2 * dim)] for k in range(len(n))])
    p.stage("second derivatives of n.m")
    total = n.dot(J)
    second = [
        DirectionalDerivative(p, f"d{j}", dict.fromkeys(point.vectors, 0) | {symbol: 1}).array(total)
        for j, symbol in enumerate(point.vectors)
    ]
    p.output("K", J.T.dot(D).dot(J) + np.stack(second, axis=-1), "N, N m, N m^2", "derivatives of g by r' and r''")
    return p


def _stress(dim: int, kernel: str, doc: str, *more: tuple[str, str, str]) -> tuple[Program, Any]:
    """Return a program, and its inputs m, m_0, d_0 and k, and numbers by name, unit and meaning."""
    p, size = Program(f"{BRANCHES[dim]}_{kernel}", doc, SOURCE), MEASURES[dim]
    found = [p.input("m", size, "1, 1/m", "measures at the end of the step"),
             p.input("m_0", size, "1, 1/m", "measures at the beginning of the step"),
             p.input("d_0", size, "1, 1/m", "elastic part at the beginning of the step"),
             p.input("k", size, "N, N m^2", "stiffness of each measure")]
    return p, found + [p.input(name, (), *about) for name, *about in more]


def hold(dim: int) -> Program:
    """Return the kernel of the stress with a dashpot, or with a slider that holds, and its derivative."""
    p, (m, m_0, d_0, k, decay, share) = _stress(
        dim, "hold", "stress of a spring in series with a dashpot", ("decay", "1", "exp(-h/tau)"),
        ("share", "1", "(1 - decay) tau/h, 1 for h = 0"))
    p.stage("elastic part and stress")
    n = [p.define(f"n{i}", k[i] * (decay * d_0[i] + share * (m[i] - m_0[i]))) for i in range(len(m))]
    p.output("n", n, "N, N m", "stress")
    p.output("D", jacobian(p, np.array(n), m), "N, N m, N m^2", "its derivatives by m")
    return p


def slide(dim: int) -> Program:
    """Return the kernel of the stress with a slider that slides, and its derivative."""
    p, (m, m_0, d_0, k, limit) = _stress(dim, "slide", "stress of a spring in series with a slider that slides",
                                         ("limit", "N, N m", "size of the stress at which the slider slides"))
    p.stage("stress without sliding")
    trial = [p.define(f"trial{i}", k[i] * (d_0[i] + (m[i] - m_0[i]))) for i in range(len(m))]
    size = p.define("size", sp.sqrt(sum(each**2 for each in trial)))
    factor = p.define("factor", limit * p.define("inv_size", 1 / size))
    n = np.array([p.define(f"n{i}", factor * each) for i, each in enumerate(trial)])
    p.output("n", n, "N, N m", "stress")
    p.stage("derivatives")
    p.output("D", jacobian(p, n, m), "N, N m, N m^2", "its derivatives by m")
    return p
