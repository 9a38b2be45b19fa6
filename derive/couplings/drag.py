"""The force of a fluid that flows past a cable or a body: drag by the square of the relative velocity.

On a cable it is the drag term of Morison's equation (Morison, Johnson, O'Brien, Schaaf, J. Pet. Technol. 2 (1950)
149-154), resolved along and across the axis, as in Hall & Goupee, Ocean Eng. 104 (2015) 590-603, section 2.1: across
1/2 rho d C_n |w_n| w_n, along 1/2 rho pi d C_t |w_t| w_t a length of the cable as it is stretched. It is given a length
of the undeformed cable, so times the length of r_x. On a body it is 1/2 rho A C |w| w.

The sizes of velocities have a tiny `least` under the root, so that their derivatives exist at zero, where they vanish.
"""

from __future__ import annotations

import sympy as sp

from ..codegen.program import Program, jacobian
from . import added_mass

DRAGS = {3: "drag", 2: "planar_drag"}
RELATIVE = "velocity of the fluid less that of the point"
SOURCE = "Morison et al. 1950; Hall & Goupee 2015"


def build(dim: int) -> list[Program]:
    """Return the kernels in space or in the plane."""
    return [along_cable(dim), on_point(dim), *added_mass.build(DRAGS[dim], dim)]


def _size(p: Program, name: str, square: sp.Expr, least: sp.Expr) -> sp.Expr:
    """Define the root of a square, not below `least`, and its reciprocal, which derivatives reuse."""
    size = p.define(name, sp.sqrt(square + least * least))
    p.define(f"inv_{name}", 1 / size)
    return size


def along_cable(dim: int) -> Program:
    """Return the kernel of the force a length of the undeformed cable, with its derivatives."""
    p = Program(f"{DRAGS[dim]}_along_cable", "drag a length of a cable, and its derivatives", SOURCE)
    t = p.input("t", dim, "1", "slope r_x of the axis")
    w = p.input("w", dim, "m/s", RELATIVE)
    normal, tangential, least = p.input("c", 3, "N s^2/m^3, N s^2/m^3, m/s",
                                        "rho d C_n/2, rho pi d C_t/2, and what sizes of velocities are not below")
    p.stage("tangent")
    length = _size(p, "len_t", t.dot(t), sp.S.Zero)
    i = p.vector("i", t / length)
    p.stage("velocities along and across")
    w_t = p.define("w_t", i.dot(w))
    n = p.vector("w_n", w - w_t * i)
    size_n = _size(p, "size_n", n.dot(n), least)
    size_t = _size(p, "size_t", w_t * w_t, least)
    p.stage("force")
    across = p.define("across", length * normal * size_n)
    along = p.define("along", length * tangential * size_t * w_t)
    f = p.vector("F", across * n + along * i)
    p.stage("derivatives")
    by_t, by_w = jacobian(p, f, t), jacobian(p, f, w)
    p.output("f", f, "N/m", "force a length of the undeformed cable")
    p.output("f_t", by_t, "N/m", "derivatives of f by t")
    p.output("f_w", by_w, "N s/m^2", "derivatives of f by w")
    return p


def on_point(dim: int) -> Program:
    """Return the kernel of the force on a point, with its derivatives."""
    p = Program(f"{DRAGS[dim]}_on_point", "drag on a point, and its derivatives", SOURCE)
    w = p.input("w", dim, "m/s", RELATIVE)
    coefficient, least = p.input("c_point", 2, "N s^2/m^2, m/s", "rho A C/2, and what the size of w is not below")
    p.stage("force")
    size = _size(p, "size", w.dot(w), least)
    f = p.vector("F", p.define("c_size", coefficient * size) * w)
    p.stage("derivatives")
    by_w = jacobian(p, f, w)
    p.output("f", f, "N", "force")
    p.output("f_w", by_w, "N s/m", "derivatives of f by w")
    return p

