"""A rope on a drum in the plane: it sticks to the drum where it runs on, and is wound on it.

At the tangent point (sheave.py) the rope runs on as the drum, turned by psi, takes it up: with the wound length u
(stress-free) and the stretch lambda of what passes,

    sigma R (phi' - psi') = lambda u',

sigma the sense in which the point passes over the rim as the rope is wound. Winding, lambda is that of the span's
slope; paying out, that of the wound rope, which keeps its stretch. The wound rope turns with the drum, and its mean
place is the centre. Its kinetic energy and its height give forces on psi, on the centre and on u. The rope is laid
on at the height of the tangent point, from where the drum takes it to the mean place. Its elastic energy grows by
W(lambda) du. Of what is paid out with another stretch lambda_w than that of the span, lambda_s, the difference
W(lambda_w) - W(lambda_s) - W'(lambda_s) (lambda_w - lambda_s) a length is dissipated, so that the span pulls on the rim
with its own tension.

Over a step that conserves energy the wound rope has the velocities v of the centre and w = R omega of the rim, whose
means over the step are the displacements over it, dc/h and R dpsi/h. With changes d and the lengths u_0, u_1 the forces

    rho d(u w) R/h + K   on psi,   rho d(u v)/h   on c,   -rho (v_0.v_1 + w_0 w_1)/2 - K dpsi/du   on u

do the work d(rho u (|v|^2 + w^2)/2), for d(u v).(v_0 + v_1)/2 = d(u |v|^2/2) + du v_0.v_1/2. The couple K = rho du
(v_0 x v_1)/4 makes their moments the change of the angular momentum: dc x (u_0 v_0 + u_1 v_1)/2 is h du (v_0 x v_1)/4.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..codegen.program import DirectionalDerivative, Program, jacobian

SOURCE = "Lagrange's equations of a rope that is wound on a drum"
DIM = 2


def kernels() -> list[Program]:
    """Return the kernels of a drum."""
    return [winding(), winding_motion(), store(), store_mass(), store_tangent(), store_energy(), laying(),
            creep(), store_step()]


def _program(kernel: str, doc: str) -> Program:
    return Program(f"planar_sheave_{kernel}", doc, SOURCE)


def _passing(p: Program) -> tuple[sp.Symbol, np.ndarray, np.ndarray, sp.Expr]:
    """Stage: sigma R; the place of the tangent point, the span's slope, and the stretch of what passes."""
    sense, R = p.input("sense", (), "1", "1 where the point passes to greater angles as it winds, else -1"), _radius(p)
    x = p.input("x", DIM, "m", "end of the span less the centre of the drum")
    slope, _, passing = _stretches(p)
    return p.define("arm", sense * R), x, slope, passing


def _stretches(p: Program) -> tuple[np.ndarray, sp.Expr, sp.Expr]:
    """Stage: the span's slope, its stretch, and that of what passes."""
    slope = p.input("slope", DIM, "1", "slope r_S of the span at the tangent point")
    winds = p.input("winds", (), "1", "1 where the span's stretch passes, 0 where that of the wound rope does")
    wound = p.input("wound", (), "1", "stretch of the wound rope")
    p.stage("stretches")
    span = p.define("span_stretch", sp.sqrt(slope.dot(slope)))
    p.define("inv_span_stretch", 1 / span)
    return slope, span, p.define("passing", winds * span + (1 - winds) * wound)


def _radius(p: Program) -> sp.Symbol:
    return p.input("R", (), "m", "radius to the axis of the rope")


def winding() -> Program:
    """Return the kernel of the condition of winding, over rates, and of its force."""
    p = _program("winding", "rates of the condition of winding, and its force")
    arm, x, slope, passing = _passing(p)
    tension = p.input("tension", (), "N", "multiplier: tension of what passes")
    p.stage("condition")
    inverse = p.define("inv_square", 1 / p.define("square", x.dot(x)))
    by_x = p.vector("by_x", [-arm * x[1] * inverse, arm * x[0] * inverse])
    p.stage("derivatives")
    p.output("J", [*by_x, -arm, -passing], "1, m, 1", "of the rates of x, of the drum's rotation, of the wound length")
    force = np.array([tension * by_x[0], tension * by_x[1], -tension * passing])
    p.output("K", jacobian(p, force, [*x, *slope]), "N/m, N",
             "derivatives of J' tension, on x and the length, by x and slope")
    return p


def winding_motion() -> Program:
    """Return the kernel of the rate of the condition of winding at zero accelerations."""
    p = _program("winding_motion", "rate of the condition of winding at zero accelerations")
    arm, x, slope, passing = _passing(p)
    x_rate = p.input("x_rate", DIM, "m/s", "rate of x")
    slope_rate = p.input("slope_rate", DIM, "1/s", "rate of the slope")
    u_rate = p.input("u_rate", (), "m/s", "rate of the wound length")
    p.stage("rates")
    inverse = p.define("inv_square", 1 / p.define("square", x.dot(x)))
    w = p.define("w", arm * (x[0] * x_rate[1] - x[1] * x_rate[0]) * inverse - passing * u_rate)
    dt = DirectionalDerivative(p, "dt", dict(zip([*x, *slope], [*x_rate, *slope_rate], strict=True)))
    p.output("Q_d", [dt(w)], "m/s^2", "rate of the condition at zero accelerations")
    return p


class Store:
    """Inputs of the wound rope, its energies and its elastic energy a length, W of a stretch."""

    def __init__(self, p: Program, order: int):
        if order > 0:
            self.A = p.input("A", 2, "N, N m^2", "axial and bending stiffness EA, EI")
        self.rho, self.R = p.input("rho", (), "kg/m", "mass of a length"), _radius(p)
        self.g = p.input("g", DIM, "m/s^2", "gravity")
        self.u = p.input("u", (), "m", "wound length, stress-free")
        self.c = p.input("c", DIM, "m", "centre of the drum")
        self.spin = p.input("spin", (), "rad/s", "angular velocity of the drum")
        self.c_rate = p.input("c_rate", DIM, "m/s", "velocity of the centre")
        if order > 0:
            self.u_rate = p.input("u_rate", (), "m/s", "rate of the wound length")
            self.spin_acc = p.input("spin_acc", (), "rad/s^2", "angular acceleration of the drum")
            self.c_acc = p.input("c_acc", DIM, "m/s^2", "acceleration of the centre")
            self.slope, self.span, self.passing = _stretches(p)
        p.stage("energies")
        self.T = _kinetic(self.rho, self.R, self.u, self.spin, self.c_rate)
        self.V = -self.rho * self.u * self.g.dot(self.c)

    def stored(self, stretch: sp.Expr) -> sp.Expr:
        """Return the elastic energy a stress-free length, J/m."""
        return _elastic(self.A, self.R, stretch)


def _kinetic(rho: sp.Symbol, R: sp.Symbol, u: sp.Symbol, spin: sp.Symbol, c_rate: np.ndarray) -> sp.Expr:
    """Return the kinetic energy, J."""
    moving: sp.Expr = rho * u * (c_rate.dot(c_rate) + R**2 * spin**2) / 2
    return moving


def _elastic(A: np.ndarray, R: sp.Symbol, stretch: sp.Expr) -> sp.Expr:
    """Return the energy of tension and of bending to the radius, a length, J/m."""
    bent: sp.Expr = (A[0] * (stretch - 1) ** 2 + A[1] * (stretch / R) ** 2) / 2
    return bent


def _forces(p: Program) -> tuple[Store, np.ndarray]:
    """Stage: d/dt dT/dv - dT/dq + dV/dq on the rotation, the centre and the length; and the elastic force on this."""
    of = Store(p, 1)
    p.stage("elastic force on the length")
    elastic = p.define("elastic", of.stored(of.span) + sp.diff(of.stored(of.span), of.span) * (of.passing - of.span))
    p.stage("forces")
    dt = DirectionalDerivative(p, "dt", {of.u: of.u_rate, of.spin: of.spin_acc,
                                         **dict(zip([*of.c, *of.c_rate], [*of.c_rate, *of.c_acc], strict=True))})
    moment = dt(sp.diff(of.T, of.spin))
    on_c = [dt(sp.diff(of.T, rate)) + sp.diff(of.V, place) for rate, place in zip(of.c_rate, of.c, strict=True)]
    on_u = sp.diff(of.V - of.T, of.u) + elastic
    return of, np.array([p.define(f"F{k + 1}", value) for k, value in enumerate([moment, *on_c, on_u])])


def store() -> Program:
    """Return the kernel of the forces of the wound rope."""
    p = _program("store", "forces of the wound rope")
    p.output("F", _forces(p)[1], "N m, N, N", "on the drum's rotation, on the centre, on the wound length")
    return p


def store_mass() -> Program:
    """Return the kernel of the mass matrix of the wound rope. No force on the length has accelerations."""
    p = _program("store_mass", "mass matrix of the wound rope")
    rho, R, u = p.input("rho", (), "kg/m", "mass of a length"), _radius(p), p.input("u", (), "m", "wound length")
    rates = np.array(sp.symbols(f"spin c_rate:{DIM}"))
    M = sp.hessian(_kinetic(rho, R, u, rates[0], rates[1:]), rates)
    p.output("M", np.array(M), "kg", "derivatives of momenta by rates of the rotation and the centre")
    return p


def store_tangent() -> Program:
    """Return the kernel of the derivatives of these forces by rates and places."""
    p = _program("store_tangent", "derivatives of the forces of the wound rope by rates and places")
    of, force = _forces(p)
    p.stage("derivatives")
    p.output("D", jacobian(p, force, [of.spin, *of.c_rate, of.u_rate]), "kg/s",
             "derivatives of F by rates of the rotation, the centre, the length")
    p.output("K", jacobian(p, force, [*of.c, of.u, *of.slope]), "N/m", "derivatives of F by the centre, length, slope")
    return p


def store_energy() -> Program:
    """Return the kernel of the energies of the wound rope but the elastic one."""
    p = _program("store_energy", "kinetic energy of the wound rope, and its energy of gravity")
    of = Store(p, 0)
    p.output("T", [of.T], "J", "kinetic energy")
    p.output("V", [of.V], "J", "energy of gravity")
    return p


def laying() -> Program:
    """Return the kernel of the height at which the rope is laid on, beside that of the centre.

    With lambda du = sigma R dphi where the drum is still, the energy -rho sigma R^2/lambda g . m of the angle phi of
    the tangent point, m' = n, grows by -rho g . x du, x = R n. m is x turned to the right by 90 degrees, over R. A
    constant stretch lambda leaves it a function of the place.
    """
    p = _program("laying", "energy of gravity of the tangent point, as the rope is laid on there, and its force")
    rho, g = p.input("rho", (), "kg/m", "mass of a length"), p.input("g", DIM, "m/s^2", "gravity")
    sense, R = p.input("sense", (), "1", "1 where the point passes to greater angles as it winds, else -1"), _radius(p)
    stretch = p.input("wound", (), "1", "stretch of the wound rope, constant")
    x = p.input("x", DIM, "m", "end of the span less the centre of the drum")
    p.stage("energy of gravity")
    weight = p.define("weight", rho * sense * R / stretch)
    height = p.define("height", weight * (g[1] * x[0] - g[0] * x[1]))
    p.output("V", [height], "J", "energy of gravity")
    p.output("F", jacobian(p, np.array([height]), x)[0], "N", "derivatives of V by x")
    return p


def creep() -> Program:
    """Return the kernel of the elastic energy of a wound length, and of what is dissipated as it passes."""
    p = _program("creep", "elastic energy of a wound length, and the part that is dissipated as it passes")
    A, R = p.input("A", 2, "N, N m^2", "axial and bending stiffness EA, EI"), _radius(p)
    wound = p.input("wound", (), "1", "stretch of the wound rope")
    span = p.input("span_stretch", (), "1", "stretch of the span")
    p.stage("energies")
    p.output("W", [_elastic(A, R, wound)], "J/m", "elastic energy a length")
    # W is quadratic: the remainder of its second order is the whole, exact where the stretches nearly agree
    loss = sp.diff(_elastic(A, R, span), span, 2) * (wound - span) ** 2 / 2
    p.output("loss", [loss], "J/m", "dissipated a length that passes")
    return p


def store_step() -> Program:
    """Return the kernel of the forces of the wound rope over a step that conserves energy, but the elastic one."""
    p = _program("store_step", "inertial forces and weight of the wound rope over a step that conserves energy")
    rho, h, R = p.input("rho", (), "kg/m", "mass of a length"), p.input("h", (), "s", "step"), _radius(p)
    g = p.input("g", DIM, "m/s^2", "gravity")
    u = p.input("u", (), "m", "wound length at the start of the step")
    u_change = p.input("u_change", (), "m", "its change")
    c = p.input("c", DIM, "m", "centre of the drum at the start of the step")
    c_change = p.input("c_change", DIM, "m", "its change")
    turn = p.input("turn_change", (), "rad", "rotation of the drum over the step")
    V = p.input("V", 1 + DIM, "m/s", "velocities of the rim by the rotation, and of the centre, at the start")
    p.stage("velocities at the end")
    u_next, u_mean = p.define("u_next", u + u_change), p.define("u_mean", u + u_change / 2)
    V_next = np.array(p.vector("V_next", np.array([R * turn, *c_change]) * 2 / h - V))
    p.stage("forces")
    couple = p.define("couple", rho * (V[1] * V_next[2] - V[2] * V_next[1]) / 4)
    gain = np.array(p.vector("gain", rho * (u_next * V_next - u * V) / h))
    on_u = -rho * (V.dot(V_next) / 2 + g.dot(c + c_change / 2)) - couple * turn
    p.output("F", [R * gain[0] + couple * u_change, *(gain[1:] - rho * u_mean * g), on_u], "N m, N, N",
             "on the drum's rotation, on the centre, on the wound length")
    p.output("V_next", V_next, "m/s", "these velocities at the end")
    return p
