"""A rope without mass in the plane: straight parts, tangent to circles, between two ends, with one tension.

A straight part leads from the circle of radius R_1 about c_1 to that of R_2 about c_2; radii have the senses of travel
as signs, and are 0 at an anchor. With d = c_2 - c_1, u along the part and n to the left of it,

    d = l u + (R_2 - R_1) n,

which gives its length l and the angle of u. The drawn length L of the rope is the sum of the l and of arcs, which are
linear in the angles. Where the rope runs by a way w onto wheels at its ends, which do not slip, it leaves with its own
stretch: L0' = -w' L0/L. The trapezoidal rule over a step gives L0 as a function of L and w.

A chain is a sequence of such ropes between which the rope slips on wheels. Their tensions are those of the first one
times ratios by friction. The way by slip, which is the same on both sides of a wheel, follows from that.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..codegen.family import CouplingFamily
from ..codegen.program import Program, jacobian

DIM, NAME = 2, "planar_taut_rope"


def families() -> list[CouplingFamily]:
    """Return the family of ropes without mass in the plane."""
    return CouplingFamily.each("taut_rope", "rope without mass", {DIM: NAME}, build)


def build(dim: int) -> list[Program]:
    """Return the kernels of a rope without mass."""
    return [straight(), straight_tangent(), free_length(), tension(), tension_tangent(), energy(),
            slide(), slide_tangent()]


def _program(kernel: str, doc: str) -> Program:
    return Program(f"{NAME}_{kernel}", doc, "common tangent of two circles")


def _straight(p: Program) -> tuple[np.ndarray, sp.Expr, np.ndarray, np.ndarray, np.ndarray]:
    """Stages: d, l, u, and the derivatives of l and of the angle of u by d.

    The angle is that of d, (-d_y, d_x) . dd/|d|^2, less the one from u to d, whose sine is the rise over |d|.
    """
    d = p.input("d", DIM, "m", "from the first centre to the second one")
    rise = p.input("rise", (), "m", "second radius less the first, with senses as signs")
    p.stage("straight part")
    square = p.define("square", d.dot(d))
    length = p.define("length", sp.sqrt(square - rise * rise))
    inverse = p.define("inv_square", 1 / square)
    u = inverse * (length * d + rise * np.array([d[1], -d[0]]))
    p.stage("derivatives")
    size = p.define("size", sp.sqrt(square))
    sine = p.define("sine", rise * p.define("inv_size", 1 / size))
    slope = p.define("inv_cosine", size * p.define("inv_length", 1 / length))
    l_d = p.vector("grow", jacobian(p, np.array([length]), d)[0])
    turn = inverse * np.array([-d[1], d[0]]) - slope * jacobian(p, np.array([sine]), d)[0]
    return d, length, u, l_d, p.vector("turn", turn)


def straight() -> Program:
    """Return the kernel of a straight part."""
    p = _program("straight", "straight part of a rope without mass")
    _, length, u, l_d, b_d = _straight(p)
    p.output("l", [length], "m", "its length")
    p.output("u", u, "1", "its direction, a unit vector")
    p.output("l_d", l_d, "1", "derivatives of l by d")
    p.output("b_d", b_d, "1/m", "derivatives of the angle of u by d")
    return p


def straight_tangent() -> Program:
    """Return the kernel of the second derivatives of a straight part."""
    p = _program("straight_tangent", "second derivatives of a straight part")
    w = p.input("w", DIM, "N, N m", "forces on the length and on the angle")
    d, _, _, l_d, b_d = _straight(p)
    p.stage("forces")
    force = p.vector("force", w[0] * l_d + w[1] * b_d)
    p.stage("second derivatives")
    p.output("K", jacobian(p, force, d), "N/m", "derivatives of w . (l_d, b_d) by d")
    return p


class _Rope:
    """Inputs and stages of a rope: L, the way w of its ends onto wheels since the last step, and its strain."""

    def __init__(self, p: Program):
        self.p = p
        self.lengths = p.input("lengths", 2, "m", "drawn length, and way onto wheels since the last step")
        past = p.input("past", 2, "m", "stress-free and drawn length after the last step")
        p.stage("stress-free length")
        left = p.define("left", past[0] * (1 - self.lengths[1] / (2 * past[1])))
        inverse = p.define("inv_length", 1 / self.lengths[0])
        self.free = p.define("free", left / (1 + self.lengths[1] * inverse / 2))
        self.slack = left - self.lengths[1] / 2  # with L0 in the place of L

    def tension(self) -> tuple[sp.Expr, np.ndarray]:
        """Stage: the tension, and the rates of the lengths: dU/dL + d(P/2)/dL' at a given stress-free length."""
        p = self.p
        EA = p.input("EA", (), "N", "axial stiffness, 0 of a slack rope")
        tau = p.input("tau", (), "s", "retardation time of the Kelvin-Voigt law")
        rates = p.input("rates", 2, "m/s", "rates of both")
        L, free = self.lengths[0], sp.Symbol("L0")
        p.stage("tension")
        elastic = sp.diff(EA * (L - free) ** 2 / (2 * free), L)
        damping = sp.diff(tau * EA * sum(rates) ** 2 / free / 2, rates[0])
        return p.define("tension_all", sp.factor(elastic + damping).subs(free, self.free)), rates


def free_length() -> Program:
    """Return the kernel of the stress-free length."""
    p = _program("free_length", "stress-free length of a rope whose ends run onto wheels")
    rope = _Rope(p)
    p.output("L0", [rope.free], "m", "stress-free length")
    p.output("slack", [rope.slack], "m", "that of a rope which is slack: without stretch it runs onto wheels")
    return p


def tension() -> Program:
    """Return the kernel of the tension."""
    p = _program("tension", "tension of a rope without mass")
    T, _ = _Rope(p).tension()
    p.output("T", [T], "N", "tension")
    return p


def tension_tangent() -> Program:
    """Return the kernel of the tension and its derivatives."""
    p = _program("tension_tangent", "tension of a rope without mass, and its derivatives")
    rope = _Rope(p)
    T, rates = rope.tension()
    p.stage("derivatives")
    p.output("T", [T], "N", "tension")
    p.output("K", jacobian(p, np.array([T]), rope.lengths)[0], "N/m", "derivatives by the lengths")
    p.output("D", jacobian(p, np.array([T]), rates)[0], "N s/m", "derivatives by their rates")
    return p


def energy() -> Program:
    """Return the kernel of the elastic energy and of that of a length, and of the power of damping."""
    p = _program("energy", "elastic energy of a rope without mass, and dissipated power")
    EA, tau = p.input("EA", (), "N", "axial stiffness"), p.input("tau", (), "s", "retardation time")
    L, free = p.input("L", (), "m", "drawn length"), p.input("L0", (), "m", "stress-free length")
    growth = p.input("growth", (), "m/s", "rate of the drawn length and of the way onto wheels")
    p.stage("strain")
    inverse = p.define("inv_free", 1 / free)
    strain = p.define("strain", (L - free) * inverse)
    W = p.define("W_all", EA * strain**2 / 2)
    p.output("U", [free * W], "J", "elastic energy")
    p.output("W", [W], "N", "that of a stress-free length")
    p.output("P", [tau * EA * inverse * growth**2], "W", "dissipated power")
    return p


class _Chain:
    """Inputs and stages of a rope in a chain: its parts of the sums over the chain.

    The strain is the ratio times that of the first rope, x. With it the trapezoidal rule gives the way onto wheels.
    Ways by slip cancel in the sum over the chain, in which the other ways exceed this one by zero. The rate of that
    gives x': the growth is x' times the sum of `by_rate`, and what changes of the ratio take.
    """

    def __init__(self, p: Program):
        self.lengths = p.input("lengths", 2, "m", "drawn length, and way onto wheels without slip since the last step")
        past = p.input("past", 2, "m", "stress-free and drawn length after the last step")
        self.ratio = p.input("ratio", (), "1", "of its tension to that of the first rope")
        self.x = p.input("x", (), "1", "strain of the first rope")
        L, w = self.lengths
        p.stage("stretch")
        stretch = p.define("stretch", 1 + self.ratio * self.x)
        inverse = p.define("inv_stretch", 1 / stretch)
        p.stage("parts of the sums")
        before = p.define("free_before", past[0] / past[1])
        way = 2 * (past[0] - L * inverse) * p.define("inv_free", 1 / (before + inverse))
        self.sums = np.array([w - p.define("way", way), p.define("by_rate", L * self.ratio * inverse)])


def slide() -> Program:
    """Return the kernel of the parts of a rope in the sums over a chain."""
    p = _program("slide", "rope without mass that slips on wheels")
    chain = _Chain(p)
    p.output("sums", chain.sums, "m, m", "excess of the way without slip; growth by the rate of x")
    p.stage("derivatives")
    p.output("sums_x", jacobian(p, chain.sums, np.array([chain.x]))[:, 0], "m, m", "derivatives by x")
    return p


def slide_tangent() -> Program:
    """Return the kernel of the derivatives of weighted sums over a chain."""
    p = _program("slide_tangent", "derivatives of the sums of ropes without mass that slip on wheels")
    weights = p.input("weights", 2, "N/m, N/m", "of the sums in the tension of a rope of the chain")
    chain = _Chain(p)
    p.stage("derivatives")
    tension = np.array([weights.dot(chain.sums)])
    p.output("K", jacobian(p, tension, chain.lengths)[0], "N/m", "derivatives by the lengths")
    p.output("by_ratio", chain.ratio * jacobian(p, tension, np.array([chain.ratio]))[0], "N",
             "derivative by the logarithm of the ratio")
    return p
