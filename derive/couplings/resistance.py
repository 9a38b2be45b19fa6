"""Forces along the cable on a slide that moves: friction, and the buffer in contact.

R is the generalised force of s: the length of r_x times a force on the rider along it. The normal force N is the part
across of the whole force f of the joint. Friction is Coulomb's: its direction is given
(``slip_direction`` 1 or -1), or the smooth function v/sqrt(v^2 + v0^2) of the speed (``slip_direction`` 0).
"""

from __future__ import annotations

import sympy as sp

from ..codegen.family import CouplingFamily
from ..codegen.program import DirectionalDerivative, Program

RESISTANCES = {3: "resistance", 2: "planar_resistance"}
FRICTION = ("coefficient", "viscous", "v0", "slip_direction", "least")
BUFFER = ("stiffness", "damping", "x", "side")


def families() -> list[CouplingFamily]:
    """Return the families in space and in the plane."""
    return CouplingFamily.each("resistance", "friction and buffers of slides", RESISTANCES, build)


def build(dim: int) -> list[Program]:
    """Return the kernels in space or in the plane."""
    return [force(dim)]


def force(dim: int) -> Program:
    """Return the kernel of R, the generalised force of s in N, and of its derivatives."""
    p = Program(f"{RESISTANCES[dim]}_force", "force along the cable on a slide, and its derivatives", "eq 30")
    t = p.input("t", dim, "1", "r_x at s")
    u = p.input("u", dim, "m/s", "velocity of the rider's point less that of the cable's particle")
    f = p.input("f", dim, "N", "force of the joint on the rider")
    mu, viscous, v0, slip_direction, least = p.input("friction", len(FRICTION), "1, N s/m, m/s, 1, N",
                                          "coefficient, viscous, v0, slip_direction, and the least N")
    stiffness, damping, x, side = p.input("buffer", len(BUFFER), "N/m, N s/m, m, 1",
                                          "stiffness, damping, compression, its end of the cable: 1, the start -1")
    p.stage("tangent and speed")
    length = p.define("len_t", sp.sqrt(t.dot(t)))
    inverse = p.define("inv_t", 1 / length)
    i = p.vector("i", inverse * t)
    v = p.define("v", i.dot(u))
    p.stage("normal force")
    n = p.vector("n", f - p.define("f_i", f.dot(i)) * i)
    N = p.define("N", sp.sqrt(n.dot(n) + least * least))
    p.stage("friction and buffer")
    smooth = p.define("smooth", v * p.define("inv_v", 1 / p.define("len_v", sp.sqrt(v * v + v0 * v0))))
    tau = p.define("tau", slip_direction + (1 - slip_direction * slip_direction) * smooth)
    R = p.define("R_all", -length * (mu * N * tau + viscous * v) - side * stiffness * x - damping * inverse * v)
    p.stage("derivatives")
    by = {name: [DirectionalDerivative(p, f"d{name}{k}", {symbol: 1}) for k, symbol in enumerate(symbols)]
          for name, symbols in (("t", t), ("u", u), ("f", f), ("x", [x]))}
    p.output("R", [R], "N", "generalised force of s")
    p.output("R_t", [d(R) for d in by["t"]], "N", "derivatives by t")
    p.output("R_u", [d(R) for d in by["u"]], "N s/m", "by u")
    p.output("R_f", [d(R) for d in by["f"]], "1", "by f")
    p.output("R_x", [d(R) for d in by["x"]], "N/m", "by x")
    return p
