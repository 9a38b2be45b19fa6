"""The force of a fluid that flows past a cable or a body: drag by the square of the relative velocity.

On a cable it is the drag term of Morison's equation (Morison, Johnson, O'Brien, Schaaf, J. Pet. Technol. 2 (1950)
149-154), resolved along and across the axis, as in Hall & Goupee, Ocean Eng. 104 (2015) 590-603, section 2.1: across
1/2 rho d C_n |w_n| w_n, along 1/2 rho pi d C_t |w_t| w_t a length of the cable as it is stretched. It is given a length
of the undeformed cable, so times the length of r_x. On a body it is 1/2 rho A C |w| w.

Lift is across the flow and the axis, on a cable 1/2 rho d C_L |w_n| i x w_n, on a body with the span s and the part w_p
of w across it 1/2 rho A |w_p| (C_D w_p + C_L s x w_p), with coefficients by the angle of attack, that of w_p from the
chord about the span.

The sizes of velocities have a tiny `least` under the root, so that their derivatives exist at zero, where they vanish.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..algebra.tangent_frame import cross
from ..codegen.family import CouplingFamily
from ..codegen.program import Program, jacobian
from . import added_mass, section_flow, waves, wetness

DRAGS = {3: "drag", 2: "planar_drag"}
RELATIVE = "velocity of the fluid less that of the point"
FORCE = "force a length of the undeformed cable"
SOURCE = "Morison et al. 1950; Hall & Goupee 2015"


def families() -> list[CouplingFamily]:
    """Return the families in space and in the plane."""
    return CouplingFamily.each("drag", "drag of a fluid", DRAGS, build, {2: ("lift_along_cable", "on_section")})


def build(dim: int) -> list[Program]:
    """Return the kernels in space or in the plane."""
    lift = [lift_along_cable(), section_flow.on_section(DRAGS[dim], RELATIVE)] if dim == 3 else []
    return [along_cable(dim), force_along_cable(dim), *lift, on_point(dim), on_foil(dim),
            *added_mass.build(DRAGS[dim], dim), *wetness.build(DRAGS[dim], dim),
            *waves.build(DRAGS[dim], dim)]


def _size(p: Program, name: str, square: sp.Expr, least: sp.Expr) -> sp.Expr:
    """Define the root of a square, not below `least`, and its reciprocal, which derivatives reuse."""
    size = p.define(name, sp.sqrt(square + least * least))
    p.define(f"inv_{name}", 1 / size)
    return size


def along_cable(dim: int) -> Program:
    """Return the kernel of the force a length of the undeformed cable, with its derivatives."""
    p = Program(f"{DRAGS[dim]}_along_cable", "drag a length of a cable, and its derivatives", SOURCE)
    return _with_derivatives(p, *_force_along_cable(p, dim))


def force_along_cable(dim: int) -> Program:
    """Return the kernel of the same force alone."""
    p = Program(f"{DRAGS[dim]}_force_along_cable", "drag a length of a cable", SOURCE)
    p.output("f", _force_along_cable(p, dim)[-1], "N/m", FORCE)
    return p


def _with_derivatives(p: Program, t: np.ndarray, w: np.ndarray, f: np.ndarray) -> Program:
    """Add the outputs of a force a length of a cable: the force and its derivatives."""
    p.stage("derivatives")
    by_t, by_w = jacobian(p, f, t), jacobian(p, f, w)
    p.output("f", f, "N/m", FORCE)
    p.output("f_t", by_t, "N/m", "derivatives of f by t")
    p.output("f_w", by_w, "N s/m^2", "derivatives of f by w")
    return p


def _along_axis(p: Program, t: np.ndarray) -> tuple[sp.Expr, np.ndarray]:
    """Define the length of the slope, and the unit vector along the axis by its reciprocal."""
    length = p.define("len_t", sp.sqrt(t.dot(t)))
    return length, p.vector("i", t * p.define("inv_len_t", 1 / length))


def _force_along_cable(p: Program, dim: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stage: the force a length of the undeformed cable. Return the slope, the relative velocity and the force."""
    t = p.input("t", dim, "1", "slope r_x of the axis")
    w = p.input("w", dim, "m/s", RELATIVE)
    normal, tangential, least = p.input("c", 3, "N s^2/m^3, N s^2/m^3, m/s",
                                        "rho d C_n/2, rho pi d C_t/2, and the least size of velocities")
    p.stage("tangent")
    length, i = _along_axis(p, t)
    p.stage("velocities along and across")
    w_t = p.define("w_t", i.dot(w))
    n = p.vector("w_n", w - w_t * i)
    size_n = _size(p, "size_n", n.dot(n), least)
    size_t = _size(p, "size_t", w_t * w_t, least)
    p.stage("force")
    across = p.define("across", length * normal * size_n)
    along = p.define("along", length * tangential * size_t * w_t)
    return t, w, p.vector("F", across * n + along * i)


def lift_along_cable() -> Program:
    """Return the kernel of the lift a length of the undeformed cable, in space, with its derivatives."""
    p = Program(f"{DRAGS[3]}_lift_along_cable", "lift a length of a cable, and its derivatives", SOURCE)
    t = p.input("t", 3, "1", "slope r_x of the axis")
    w = p.input("w", 3, "m/s", RELATIVE)
    lift, least = p.input("c_lift", 2, "N s^2/m^3, m/s", "rho d C_L/2, and the least size of w across")
    p.stage("flow across")
    _, i = _along_axis(p, t)
    n = p.vector("w_n", w - i.dot(w) * i)
    size = _size(p, "size_n", n.dot(n), least)
    p.stage("force")
    f = p.vector("F", p.define("lift", lift * size) * np.array(cross(t, w)))
    return _with_derivatives(p, t, w, f)


def on_foil(dim: int) -> Program:
    """Return the kernel of drag and lift on a body with a span, with its derivative by w.

    The angle of attack turns with w by (s x w)/|w_p|^2, and the coefficients with it. With the body turns all of it: by
    a turn theta of the body alone the force changes by theta x f - f_w (theta x w).
    """
    p = Program(f"{DRAGS[dim]}_on_foil", "drag and lift on a body with a span, and their derivatives", SOURCE)
    w = p.input("w", dim, "m/s", RELATIVE)
    s = p.input("s", 3 if dim == 3 else 1, "1", "unit vector along the span; in the plane its sense along z")
    scale, least = p.input("c_foil", 2, "N s^2/m^2, m/s", "rho A/2, and the least size of w across")
    values = p.input("coefficients", 4, "1, 1/rad", "C_D and its derivative by the angle of attack, C_L and its")
    p.stage("flow across the span")
    across = w - s.dot(w) * s if dim == 3 else w
    n = p.vector("w_p", across)
    turned = p.vector("lifted", cross(s, n))
    size = _size(p, "size", n.dot(n), least)
    p.stage("force")
    f = p.vector("F", p.define("c_size", scale * size) * (values[0] * n + values[2] * turned))
    p.stage("derivatives")
    per_turn = p.define("c_turn", scale * sp.Symbol("inv_size"))
    by_angle = p.vector("F_angle", per_turn * (values[1] * n + values[3] * turned))
    by_w = jacobian(p, f, w) + np.outer(by_angle, turned)
    p.output("f", f, "N", "force")
    p.output("f_w", by_w, "N s/m", "derivatives of f by w")
    return p


def on_point(dim: int) -> Program:
    """Return the kernel of the force on a point, with its derivatives."""
    p = Program(f"{DRAGS[dim]}_on_point", "drag on a point, and its derivatives", SOURCE)
    w = p.input("w", dim, "m/s", RELATIVE)
    coefficient, least = p.input("c_point", 2, "N s^2/m^2, m/s", "rho A C/2, and the least size of w")
    p.stage("force")
    size = _size(p, "size", w.dot(w), least)
    f = p.vector("F", p.define("c_size", coefficient * size) * w)
    p.stage("derivatives")
    by_w = jacobian(p, f, w)
    p.output("f", f, "N", "force")
    p.output("f_w", by_w, "N s/m", "derivatives of f by w")
    return p

