"""Added mass of a cable or a body, from the kinetic energy of the fluid.

Of a length of a cable it is T = (m_n |w_n|^2 + m_t w_t^2)/2, with the velocity w past the fluid, w_n across the axis
and w_t along it, and the added masses m_n and m_t of a length of the undeformed cable. M = m_n 1 - (m_n - m_t) i i'
turns with the tangent i, so Lagrange's equations give more than M times an acceleration: the change of the impulse
p = M w, and g, the derivative of T by the slope r_x (Lighthill, Proc. R. Soc. B 179 (1971) 125-138, has it from
momentum).
Of a body T = w . A C A' w/2 at a point, with C in the body's axes A: force and moment are those of Kirchhoff and Lamb
(Hydrodynamics, 6th ed., art. 124), the change of p = A C A' w and the moment w x p.

w = v - U, and w' = a - dU/dt - (grad U) v: with U of the fluid these are Lagrange's equations of the same T, which for
flow without curl are those of G. I. Taylor (Proc. R. Soc. A 120 (1928) 260-283).

Of a partly wet section or body T is that of the wet part c: c T (wetness.py). Lagrange's equations then contain the
rate of c, also that by waves at a fixed place, in that of the impulse, and the derivative of T by the place. At a
vertical entry in still water the slamming force is half of that of von Karman (NACA TN 321, 1929), c' m v^2/R, who has
the first alone. In his model the other half is lost to the jet, which has no part in T: here energy is conserved, and a
body that leaves the water regains it.

Morison's equation has the force c (M (a - DU/Dt) - m_d DU/Dt) alone, on the left side: across a cable
C rho V a_n - (1 + C) rho V (DU/Dt)_n. It has neither a force on the slope nor a moment (`_morison`).

Along a span of a rope w is that of the material, and a point of quadrature moves past it with the velocity y of a place
at a constant share of the length l. The kernels give the derivatives p, g and b of c T by v, the slope and the place,
and the rate (l p)'/l at that point; span_kinetic.py has the generalised forces.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp

from ..algebra.tangent_frame import cross, moment_of
from ..codegen.program import DirectionalDerivative, Program, jacobian

PAST = "velocity of the point past the fluid"
LENGTH = "Lighthill 1971; Lagrange's equations of T"
POINT = "Lamb, Hydrodynamics, art. 124; Taylor 1928"
FORMS = {"inertia": ("", ""), "morison": (" by Morison's equation", "Morison et al. 1950; Hall & Goupee 2015")}
"""By the kernels' name: end of their description, and a source that is not that of the other form."""


def build(name: str, dim: int) -> list[Program]:
    """Return the kernels in space or in the plane, of the family `name`."""
    return [impulse_of_cable(name, dim), of_cable(name, dim), of_cable_tangent(name, dim), of_cable_step(name, dim),
            of_span(name, dim), of_span_tangent(name, dim),
            impulse_of_point(name, dim), of_point(name, dim), of_point_tangent(name, dim), of_point_step(name, dim),
            *(build(name, dim, "morison") for build in (of_cable, of_cable_tangent, of_point, of_point_tangent))]


def _input_masses(p: Program) -> tuple[sp.Symbol, sp.Expr]:
    """Return m_n and m_n - m_t, kg/m."""
    normal, tangential = p.input("m", 2, "kg/m", "added masses of a length of the undeformed cable, across and along")
    p.stage("difference of the added masses")
    return normal, p.define("less", normal - tangential)


def impulse_of_cable(name: str, dim: int) -> Program:
    """Return the kernel of the impulse of the fluid a length of cable, and of its mass."""
    p = Program(f"{name}_impulse_of_cable", "impulse of the fluid along a cable, and its mass", LENGTH)
    t, w = p.input("t", dim, "1", "slope r_x of the axis"), p.input("w", dim, "m/s", PAST)
    normal, less = _input_masses(p)
    p.stage("added mass")
    scale = p.define("scale", less / t.dot(t))
    p.output("p", normal * w - p.define("along", scale * t.dot(w)) * t, "kg/s", "impulse M w of a length")
    p.output("M", normal * np.eye(dim, dtype=int) - scale * np.outer(t, t), "kg/m", "added mass of a length")
    return p


@dataclass(frozen=True)
class Flow:
    """The motion of a point and of the fluid there; vectors that are definitions are independent in derivatives.

    y: velocity of the point of quadrature, on a cable v.
    """

    v: np.ndarray
    y: np.ndarray
    a: np.ndarray
    w: np.ndarray
    w_rate: np.ndarray
    material: np.ndarray
    U: np.ndarray
    G: np.ndarray
    part: sp.Expr
    part_by_place: np.ndarray
    part_by_time: sp.Expr
    curvature: sp.Expr
    up: np.ndarray


def _input_flow(p: Program, dim: int, drifts: bool = False) -> Flow:
    """Declare velocity and acceleration of a point, the flow, and the wet part; open a stage of the relative motion.

    drifts: whether the point of quadrature moves past the particle.
    """
    v = p.input("v", dim, "m/s", "velocity of the point")
    y = p.input("y", dim, "m/s", "velocity of the point of quadrature") if drifts else v
    a = p.input("a", dim, "m/s^2", "rate of v at the point of quadrature" if drifts else "acceleration of the point")
    U = p.input("U", dim, "m/s", "velocity of the fluid")
    U_rate = p.input("U_rate", dim, "m/s^2", "rate of U at a fixed place")
    G = p.input("G", (dim, dim), "1/s", "gradient of U: derivatives of a component in a row")
    wet = p.input("wet", 4, "1, 1/m, 1/m^2, 1/s",
                  "wet part c, its derivatives by the height above the surface, and its rate at a fixed place")
    up = p.input("up", dim, "1", "derivatives of that height by the place")
    p.stage("motion past the fluid")
    w = p.vector("w", v - U)
    w_rate = p.vector("w_rate", a - U_rate - G.dot(y))
    material = p.vector("material", U_rate + G.dot(U))
    return Flow(v, y, a, w, w_rate, material, U, G, wet[0], p.vector("c_place", wet[1] * up), wet[3], wet[2], up)


def _partial(p: Program, name: str, values: np.ndarray, flow: Flow, motion: np.ndarray | None = None
             ) -> tuple[np.ndarray, ...]:
    """Return the derivatives of values (n,) by w, by w', by the place, and by `motion`, v or y, where w is constant.

    The gradient of U, the rates of U and of c at a fixed place, and the slope of the surface count as constants.
    """
    relative = [*flow.w, *flow.w_rate, *flow.material]
    by_w, by_w_rate, by_material = (
        np.array([p.vector(f"{name}{k + 1}_{key}", row) for k, row in enumerate(jacobian(p, values, vector))])
        for key, vector in (("w", flow.w), ("w_rate", flow.w_rate), ("material", flow.material)))
    by_itself = np.zeros(0) if motion is None else jacobian(p, values, motion, constant=relative)
    by_part = jacobian(p, values, [flow.part])[:, 0]
    by_slope = jacobian(p, values, flow.part_by_place).dot(flow.up) * flow.curvature
    by_place = (by_material.dot(flow.G) - by_w).dot(flow.G)
    by_place = by_place + np.outer(by_part, flow.part_by_place) + np.outer(by_slope, flow.up)
    return by_w, by_w_rate, by_place, by_itself


def _by_motion(p: Program, name: str, values: np.ndarray, flow: Flow) -> tuple[np.ndarray, np.ndarray]:
    """Return the derivatives of values (n,) by the place and by the velocity of the point -> (n, dim) each."""
    by_w, by_w_rate, by_place, by_v = _partial(p, name, values, flow, flow.v)
    return by_place, by_w - by_w_rate.dot(flow.G) + by_v


Added = Callable[[np.ndarray], np.ndarray]
"""Returns M times a vector."""


def _forces(p: Program, form: str, flow: Flow, impulse: np.ndarray, impulse_rate: np.ndarray, added: Added
            ) -> tuple[np.ndarray, sp.Expr]:
    """Return the force on a particle, on the left side of the equations of motion, and the external power.

    Lagrange's equations of c T for the wet part c: the rate of c p, G' c p, less T times the derivative of c by the
    place; and less the force of the undisturbed fluid on the mass that it displaces.
    """
    if form == "morison":
        return _morison(p, flow, impulse, impulse_rate, added)
    of = _parts(p, flow, impulse, impulse_rate)
    force = of.rate + of.strained - of.carried - of.energy * flow.part_by_place
    return p.vector("F", force), of.power(flow)


def _morison(p: Program, flow: Flow, impulse: np.ndarray, impulse_rate: np.ndarray, added: Added
             ) -> tuple[np.ndarray, sp.Expr]:
    """Return the same of Morison's equation: M times the acceleration past that of the fluid, a - DU/Dt.

    It follows from no energy. With T as a kinetic energy the external power is its rate less the power on the particle.
    """
    displaced = p.symbols["displaced"].item()
    p.stage("force on the particle")
    past = p.vector("past_rate", flow.a - flow.material)
    force = p.vector("F", flow.part * (added(past) - displaced * flow.material))
    part_rate = p.define("c_rate", flow.part_by_place.dot(flow.v) + flow.part_by_time)
    rate = flow.part * (flow.w_rate.dot(impulse) + flow.w.dot(impulse_rate)) + part_rate * flow.w.dot(impulse)
    return force, rate / 2 - force.dot(flow.v)


@dataclass(frozen=True)
class Parts:
    """Impulse of the wet part and its rate, G' times it, force on the displaced mass, and energy of what is all wet."""

    wet: np.ndarray
    rate: np.ndarray
    strained: np.ndarray
    carried: np.ndarray
    energy: sp.Expr

    def power(self, flow: Flow) -> sp.Expr:
        """Return the external power of the fluid."""
        return (self.carried.dot(flow.v) - self.rate.dot(flow.U) - self.strained.dot(flow.y)
                - self.energy * flow.part_by_time)


def _parts(p: Program, flow: Flow, impulse: np.ndarray, impulse_rate: np.ndarray, growth: sp.Expr = sp.S.Zero) -> Parts:
    """Stage: the parts of the force; growth: l'/l of the length that has the impulse."""
    displaced = p.symbols["displaced"].item()
    p.stage("force on the particle")
    wet = p.vector("P_wet", flow.part * impulse)
    part_rate = p.define("c_rate", flow.part_by_place.dot(flow.y) + flow.part_by_time)
    rate = p.vector("P_wet_rate", flow.part * impulse_rate + part_rate * impulse + growth * wet)
    strained = p.vector("strained", flow.G.T.dot(wet))
    carried = p.vector("carried", p.define("displaced_wet", flow.part * displaced) * flow.material)
    return Parts(wet, rate, strained, carried, p.define("T", flow.w.dot(impulse) / 2))


def _cable(p: Program, dim: int, drifts: bool = False) -> tuple[Any, ...]:
    """Return slope and rate, the flow, impulse and its rate of a length that is all wet, its M, and the force on the
    slope.
    """
    t, t_rate = p.input("t", dim, "1", "slope r_x of the axis"), p.input("t_rate", dim, "1/s", "its rate")
    m = p.input("m", 2, "kg/m", "added masses of a length of the undeformed cable, across and along")
    p.input("displaced", (), "kg/m", "mass of the fluid that a length displaces")
    flow = _input_flow(p, dim, drifts)
    w, w_rate, normal = flow.w, flow.w_rate, m[0]
    p.stage("tangent and its rate")
    less = p.define("less", m[0] - m[1])
    inverse = p.define("inv_len_t", 1 / p.define("len_t", sp.sqrt(t.dot(t))))
    i = p.vector("i", t * inverse)
    i_rate = p.vector("i_rate", inverse * (t_rate - i.dot(t_rate) * i))
    p.stage("impulse and its rate")
    along = p.define("w_t", i.dot(w))
    along_rate = p.define("w_t_rate", i_rate.dot(w) + i.dot(w_rate))
    impulse = p.vector("P", normal * w - less * along * i)

    def added(x: np.ndarray) -> np.ndarray:
        return np.asarray(normal * x - p.define("less_x_t", less * i.dot(x)) * i)

    impulse_rate = p.vector("P_rate", normal * w_rate - less * (along_rate * i + along * i_rate))
    p.stage("derivative of the kinetic energy by the slope")
    on_slope = p.vector("G_t", -p.define("pull", flow.part * less * inverse * along) * (w - along * i))
    return t, t_rate, flow, impulse, impulse_rate, added, on_slope


def _cable_forces(p: Program, dim: int, form: str) -> tuple[Any, ...]:
    """Return slope and rate, the flow, the forces on particle and slope, and the external power."""
    t, t_rate, flow, impulse, impulse_rate, added, on_slope = _cable(p, dim)
    force, power = _forces(p, form, flow, impulse, impulse_rate, added)
    return t, t_rate, flow, force, 0 * on_slope if form == "morison" else on_slope, power


def of_cable(name: str, dim: int, form: str = "inertia") -> Program:
    """Return the kernel of the force of the fluid a length of cable, and of that on the slope; form: a key of FORMS."""
    p = Program(f"{name}_{form}_of_cable", "force of the inertia of the fluid on a length of cable" + FORMS[form][0],
                FORMS[form][1] or LENGTH)
    _, _, _, force, on_slope, power = _cable_forces(p, dim, form)
    p.output("f", force, "N/m", "force on the particle, on the left side of the equations of motion")
    p.output("g", on_slope, "N", "derivative of c T by t")
    p.output("power", [power], "W/m", "external power of the fluid, with T as a kinetic energy")
    return p


def of_cable_tangent(name: str, dim: int, form: str = "inertia") -> Program:
    """Return the kernel of the derivatives of the force of the fluid on a length of cable, and of that on the slope."""
    p = Program(f"{name}_{form}_of_cable_tangent",
                "derivatives of the force of the inertia of the fluid on a cable" + FORMS[form][0],
                f"derivatives of {FORMS[form][1] or LENGTH}")
    t, t_rate, flow, force, on_slope, _ = _cable_forces(p, dim, form)
    p.stage("derivatives")
    for output, values, by in (("f", force, {"t": t, "t_rate": t_rate}), ("g", on_slope, {"t": t})):
        for key, symbols in by.items():
            p.output(f"{output}_{key}", jacobian(p, values, symbols), "SI", f"derivatives of {output} by {key}")
        for key, by_motion in zip("rv", _by_motion(p, output, values, flow), strict=True):
            p.output(f"{output}_{key}", by_motion, "SI",
                     f"derivatives of {output} by the {'velocity' if key == 'v' else 'place'} of the point")
    return p


def _span(p: Program, dim: int) -> tuple[Any, ...]:
    """Return slope and rate, the flow, the derivatives of c T by place, slope and velocity, its value, the rate of the
    last derivative less the force on the displaced mass, and the external power.
    """
    growth = p.input("growth", (), "1/s", "l'/l of the length of the element")
    t, t_rate, flow, impulse, impulse_rate, _, on_slope = _cable(p, dim, drifts=True)
    of = _parts(p, flow, impulse, impulse_rate, growth)
    by_place = p.vector("b", of.energy * flow.part_by_place - of.strained)
    rate = p.vector("x", of.rate - of.carried)
    return t, t_rate, flow, (by_place, on_slope, of.wet), flow.part * of.energy, rate, of.power(flow)


def of_span(name: str, dim: int) -> Program:
    """Return the kernel of the kinetic energy of the fluid along a length of a rope, its derivatives, and the rate of
    the impulse.
    """
    p = Program(f"{name}_inertia_of_span", "kinetic energy of the fluid along a rope, and its derivatives", LENGTH)
    *_, (by_place, on_slope, impulse), energy, rate, power = _span(p, dim)
    p.output("T_r", by_place, "N/m", "derivative of c T by the place")
    p.output("T_t", on_slope, "N", "derivative of c T by the slope")
    p.output("T_v", impulse, "kg/s", "derivative of c T by the velocity, the impulse")
    p.output("rate", rate, "N/m", "(l T_v)'/l at the point of quadrature, less the force on the displaced mass")
    p.output("energy", [energy], "J/m", "c T")
    p.output("power", [power], "W/m", "external power of the fluid, with T as a kinetic energy")
    return p


def of_span_tangent(name: str, dim: int) -> Program:
    """Return the kernel of the derivatives of those derivatives, and of the rate."""
    p = Program(f"{name}_inertia_of_span_tangent",
                "second derivatives of the kinetic energy of the fluid along a rope, and derivatives of the rate of "
                "the impulse", f"derivatives of {LENGTH}")
    t, t_rate, flow, gradient, _, rate, _ = _span(p, dim)
    p.stage("derivatives")
    rows = []
    for key, values in zip("rtv", gradient, strict=True):
        by_w, _, by_place, _ = _partial(p, f"T_{key}", values, flow)
        rows.append(np.hstack([by_place, jacobian(p, values, t), by_w]))
    p.output("second", np.vstack(rows), "SI", "derivatives of T_r, T_t, T_v by place, slope, velocity")
    by_w, by_w_rate, by_place, by_y = _partial(p, "rate", rate, flow, flow.y)
    p.output("rate_by", np.hstack([by_place, jacobian(p, rate, t), by_w, jacobian(p, rate, t_rate),
                                   by_y - by_w_rate.dot(flow.G), by_w_rate]), "SI",
             "derivatives of the rate by place, slope, velocity, t_rate, y, a")
    return p


def of_cable_step(name: str, dim: int) -> Program:
    """Return the kernel of the impulse over a step, and a discrete derivative by the slope that conserves energy.

    With a and b, the half sum and half difference of w at the ends, T_next - T = dp . a - (D_next - D) for
    D = (a . M a - b . M b)/2, of which the output g is a discrete gradient: g . (t_next - t) = D_next - D.
    """
    p = Program(f"{name}_inertia_step", "impulse of the fluid along a cable over a step", f"{LENGTH}; Gonzalez 1996")
    t, t_next = p.input("t", dim, "1", "slope r_x of the axis"), p.input("t_next", dim, "1", "t at the end of the step")
    w, w_next = p.input("w", dim, "m/s", PAST), p.input("w_next", dim, "m/s", "w at the end of the step")
    normal, less = _input_masses(p)
    p.stage("both ends")
    size, size_next = p.define("size", t.dot(t)), p.define("size_next", t_next.dot(t_next))
    a, b = p.vector("a", (w + w_next) / 2), p.vector("b", (w_next - w) / 2)
    mean = p.vector("mean", (t + t_next) / 2)
    p.stage("impulse")
    along = p.define("along", t.dot(w) / size)
    along_next = p.define("along_next", t_next.dot(w_next) / size_next)
    p.output("dp", 2 * normal * b - less * (along_next * t_next - along * t), "kg/s", "change of the impulse M w")
    p.stage("discrete gradient")
    parts = [p.define(f"n{k}", (at.dot(a) ** 2 - at.dot(b) ** 2) / 2) for k, at in enumerate((t, t_next))]
    scale = p.define("scale", -less / (size * size_next))
    pull = p.vector("pull", mean.dot(a) * a - mean.dot(b) * b)
    p.output("g", scale * ((size + size_next) / 2 * pull - (parts[0] + parts[1]) * mean), "N",
             "discrete gradient of (a . M a - b . M b)/2 by t")
    return p


def _turned_mass(p: Program, name: str, A: np.ndarray, C: np.ndarray) -> np.ndarray:
    """Return A C A', its entries named."""
    half = np.array([p.vector(f"C{name}{k + 1}", row) for k, row in enumerate(C.dot(A.T))])
    return np.array([p.vector(f"{name}{k + 1}", row) for k, row in enumerate(A.dot(half))])


def mass_of_point(p: Program, dim: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the axes A of a body and its added mass A C A' in global axes."""
    A = p.input("A", (dim, dim), "1", "axes of the body by columns")
    C = p.input("C", (dim, dim), "kg", "added mass in body axes, symmetric")
    p.stage("added mass")
    return A, _turned_mass(p, "M", A, C)


def impulse_of_point(name: str, dim: int) -> Program:
    """Return the kernel of the impulse of the fluid at a point of a body, and of its mass."""
    p = Program(f"{name}_impulse_of_point", "impulse of the fluid at a body, and its mass", POINT)
    _, M = mass_of_point(p, dim)
    w = p.input("w", dim, "m/s", PAST)
    p.output("p", M.dot(w), "kg m/s", "impulse A C A' w")
    p.output("M", M, "kg", "added mass A C A' in global axes")
    return p


def _point(p: Program, dim: int, form: str) -> tuple[Any, ...]:
    """Return axes, angular velocity, flow, force, moment and external power of the fluid at a point of a body."""
    A, M = mass_of_point(p, dim)
    omega = p.input("omega", 3 if dim == 3 else 1, "rad/s", "angular velocity in global axes")
    p.input("displaced", (), "kg", "mass of the fluid that the body displaces")
    flow = _input_flow(p, dim)
    p.stage("impulse, its rate and moment")
    impulse = p.vector("P", M.dot(flow.w))
    rest = p.vector("rest", flow.w_rate - cross(omega, flow.w))
    impulse_rate = p.vector("P_rate", M.dot(rest) + cross(omega, impulse))
    moment = np.array([p.define(f"moment{k}", flow.part * value)
                       for k, value in enumerate(moment_of(flow.w, impulse))])
    moment = 0 * moment if form == "morison" else moment
    return A, omega, flow, moment, *_forces(p, form, flow, impulse, impulse_rate, M.dot)


def of_point(name: str, dim: int, form: str = "inertia") -> Program:
    """Return the kernel of the force and the moment of the fluid at a point of a body."""
    p = Program(f"{name}_{form}_of_point", "force and moment of the inertia of the fluid on a body" + FORMS[form][0],
                FORMS[form][1] or POINT)
    *_, moment, force, power = _point(p, dim, form)
    p.output("f", force, "N", "force at the point, on the left side of the equations of motion")
    p.output("moment", moment, "N m", "c w x p")
    p.output("power", [power], "W", "external power of the fluid, with T as a kinetic energy")
    return p


def of_point_tangent(name: str, dim: int, form: str = "inertia") -> Program:
    """Return the kernel of the derivatives of force and moment of the fluid at a point of a body."""
    p = Program(f"{name}_{form}_of_point_tangent",
                "derivatives of force and moment of the inertia of the fluid" + FORMS[form][0],
                f"derivatives of {FORMS[form][1] or POINT}")
    A, omega, flow, moment, force, _ = _point(p, dim, form)
    p.stage("derivatives")
    turns = [DirectionalDerivative(p, f"d_th{k + 1}", turned(A, axis))
             for k, axis in enumerate(np.eye(len(omega), dtype=int))]
    for output, values in {"f": force, "moment": moment}.items():
        by_turn = np.stack([each.array(values) for each in turns], axis=-1)
        p.output(f"{output}_by", np.concatenate([*_by_motion(p, output, values, flow), by_turn,
                                                 jacobian(p, values, omega)], axis=1), "SI",
                 f"derivatives of {output} by place, velocity, a turn about global axes, angular velocity")
    return p


def of_point_step(name: str, dim: int) -> Program:
    """Return the kernel of the impulse at a point of a body over a step, and the moment that conserves energy.

    A_next - A = theta~ (A + A_next)/2. With a and b, the half sum and half difference of w at the ends, and M = A C A',
    T_next - T = dp . a - (D_next - D) for D = (a . M a - b . M b)/2. D_next - D is -theta . m(a) + theta . m(b),
    with m(x) = x x M_mean x - y x N y/4, y = theta x x, and N that of the mean axes: of a sphere m is nil. The mean
    velocity of the point is its displacement over the step and theta x turning/4; `moment` does the work of both.
    """
    turns = 3 if dim == 3 else 1
    p = Program(f"{name}_inertia_of_point_step", "impulse of the fluid at a body over a step, and its moment",
                f"{POINT}; Simo & Wong 1991; Gonzalez 1996")
    A, A_next = (p.input(key, (dim, dim), "1", f"axes of the body by columns{at}")
                 for key, at in (("A", ""), ("A_next", " at the end of the step")))
    C = p.input("C", (dim, dim), "kg", "added mass in body axes, symmetric")
    w, w_next = p.input("w", dim, "m/s", PAST), p.input("w_next", dim, "m/s", "w at the end of the step")
    theta = p.input("theta", turns, "1", "Cayley vector of the turn in global axes")
    turning = p.input("turning", dim, "m/s", "change over the step of the velocity by which the point turns about the "
                                            "mass centre, in axes of the body, turned by the mean of A")
    p.stage("added mass at both ends, and that of the mean axes")
    M, M_next, N = (_turned_mass(p, key, axes, C)
                    for key, axes in (("M", A), ("L", A_next), ("N", (A + A_next) / 2)))
    p.stage("impulse")
    P, P_next = p.vector("P", M.dot(w)), p.vector("Q", M_next.dot(w_next))
    dp = p.vector("dp", P_next - P)
    p.stage("moment")
    moment = moment_of(turning, dp) / 4
    for sign, at in ((1, p.vector("a", (w + w_next) / 2)), (-1, p.vector("b", (w_next - w) / 2))):
        y = p.vector(f"y_{'ab'[sign < 0]}", cross(theta, at))
        moment = moment + sign * (moment_of(at, (M + M_next).dot(at)) / 2 - moment_of(y, N.dot(y)) / 4)
    p.output("dp", dp, "kg m/s", "change of the impulse A C A' w")
    p.output("p", (P + P_next) / 2, "kg m/s", "its mean")
    p.output("moment", moment, "N m", "that does the work of w x p over the step")
    p.output("more", cross(theta, turning) / 4, "m/s", "mean velocity at both ends, less displacement over step")
    return p


def turned(A: np.ndarray, axis: np.ndarray) -> dict[sp.Symbol, sp.Expr]:
    """Return the change of the entries of A by a turn about a global axis."""
    change = np.stack([cross(axis, column) for column in A.T], axis=1)
    return dict(zip(A.ravel(), change.ravel(), strict=True))
