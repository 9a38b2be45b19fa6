"""A rope without mass in the plane: straight parts, tangent to circles, between two ends, with one tension.

A straight part leads from the circle of radius R_1 about c_1 to that of R_2 about c_2; radii have the senses of travel
as signs, and are 0 at an anchor. With d = c_2 - c_1, u along the part and n to the left of it,

    d = l u + (R_2 - R_1) n,

which gives its length l and the angle of u. The drawn length L of the rope is the sum of the l and of arcs, which are
linear in the angles; its stress-free length L0 depends on these where the rope is wound on a wheel at its end.
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
    return [straight(), straight_tangent(), energy(), tension(), tension_tangent(), dissipation()]


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
    """Inputs and stages of a rope: lengths L, L0 and their rates."""

    def __init__(self, p: Program, rates: bool = True):
        self.p = p
        self.EA = p.input("EA", (), "N", "axial stiffness, 0 of a slack rope")
        self.tau = p.input("tau", (), "s", "retardation time of the Kelvin-Voigt law") if rates else sp.S.Zero
        self.lengths = p.input("lengths", 2, "m", "drawn and stress-free length")
        self.rates = p.input("rates", 2, "m/s", "their rates") if rates else np.zeros(2, dtype=int)
        p.stage("stretch")
        inverse = p.define("inv_free", 1 / self.lengths[1])
        self.stretch = p.define("stretch", self.lengths[0] * inverse)
        self.strain = p.define("strain", (self.lengths[0] - self.lengths[1]) * inverse)
        if rates:
            self.growth = p.define("growth", (self.rates[0] - self.stretch * self.rates[1]) * inverse)

    def energy(self) -> sp.Expr:
        """Return the elastic energy."""
        return self.EA * self.lengths[1] * self.strain**2 / 2

    def power(self) -> sp.Expr:
        """Return the power of damping."""
        return self.tau * self.EA * self.lengths[1] * self.growth**2

    def forces(self) -> np.ndarray:
        """Stage: the forces on both lengths, of the energy less `kept` for each length that leaves, and of damping."""
        p = self.p
        kept = p.input("kept", (), "N", "energy of a length of what wheels hold")
        p.stage("forces")
        U = p.define("U", self.energy())
        P = p.define("half_P", self.power() / 2)
        elastic = jacobian(p, np.array([U]), self.lengths)[0]
        damping = jacobian(p, np.array([P]), self.rates)[0]
        return np.array([p.define(f"force_{k + 1}", elastic[k] + damping[k] - (kept if k else 0)) for k in range(2)])


def energy() -> Program:
    """Return the kernel of the elastic energy."""
    p = _program("energy", "elastic energy of a rope without mass")
    p.output("U", [_Rope(p, rates=False).energy()], "J", "elastic energy")
    return p


def tension() -> Program:
    """Return the kernel of the tension and of the force on the stress-free length."""
    p = _program("tension", "forces on the lengths of a rope without mass")
    p.output("f", _Rope(p).forces(), "N", "on the drawn and the stress-free length")
    return p


def tension_tangent() -> Program:
    """Return the kernel of the derivatives of these forces."""
    p = _program("tension_tangent", "forces on the lengths of a rope without mass, and their derivatives")
    rope = _Rope(p)
    f = rope.forces()
    p.stage("derivatives")
    p.output("f", f, "N", "on the drawn and the stress-free length")
    p.output("K", jacobian(p, f, rope.lengths), "N/m", "derivatives of f by the lengths")
    p.output("D", jacobian(p, f, rope.rates), "N s/m", "derivatives of f by the rates of the lengths")
    return p


def dissipation() -> Program:
    """Return the kernel of the power of damping."""
    p = _program("dissipation", "power that a rope without mass dissipates")
    p.output("P", [_Rope(p).power()], "W", "dissipated power")
    return p
