"""Wheels of ropes in space on bodies that rotate: the wrap in the plane of a groove that tilts, and a ring.

All vectors have components in the axes of the groove (1, 2, and 3 along the axis), which turn with the angular velocity
omega of the body. phi' are the rates of the angles in space: with the rate of x = r - c seen from the centre, not from
the body. Then the kinetic energy T of the wrap depends on omega_3 through phi' alone. A material point of the wrap has
beside its velocity in the plane of the groove (sheave_zone.py) that along the axis,

    v_3 + omega_1 y - omega_2 x,    (x, y) = R (cos phi, sin phi).

Lagrange's equations in turning axes (Boltzmann and Hamel), with P = dT/dv and L = dT/domega, L_3 = dT/dphi' for both
angles together:

    force on c:     P' + omega x P
    moment about c: L' + omega x L + v x P

and those of the angles and of s as in fixed axes, where the rate of phi is phi' - omega_3. T, V and all angles may turn
together about the axis, so that the moment about it is that of the forces on the tangent points: what is computed are
the moments about 1 and 2.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ..algebra.tangent_frame import cross
from ..codegen.program import DirectionalDerivative, Program, jacobian
from .sheave_zone import ANGLES, Zone, at_ends, between_ends

SOURCE = "Lagrange's equations in turning axes (Boltzmann and Hamel)"
DIM, TILTS = 3, 2
OF_WRAP = ((0, 1), (7, 8))
"""Places of means and differences of both ends among middle, angle, c, tilts, flow, l."""
TURNS = np.eye(DIM, dtype=int)


def kernels() -> list[Program]:
    """Return the kernels of turning wheels."""
    return [turned_acc(), wrap_energy(), wrap_inertia(), wrap_mass(), wrap_weight(), laid_weight(), ring()]


def _program(kernel: str, doc: str) -> Program:
    return Program(f"tangent_point_{kernel}", doc, SOURCE)


def _omega(p: Program) -> np.ndarray:
    return p.input("omega", DIM, "rad/s", "angular velocity of the groove")


def _rate(p: Program, on: dict[sp.Symbol, sp.Expr]) -> DirectionalDerivative:
    return DirectionalDerivative(p, "dt", on)


def turned_acc() -> Program:
    """Return the kernel of the second rate of a place in the plane of the groove, as an observer sees it who turns with
    the groove but for its rotation about the axis.
    """
    p = _program("turned_acc", "second rate of a tangent point in the plane of a groove that tilts")
    omega = _omega(p)
    u = p.input("x_rate", DIM, "m/s", "rate of r - c in space, in the axes of the groove")
    acc = p.input("x_acc", DIM, "m/s^2", "second rate of r - c in space, likewise")
    p.stage("second rate")
    dt = _rate(p, dict(zip(u, acc - cross(omega, u), strict=True)))
    about = cross(np.array([0, 0, omega[2]]), u)
    p.output("acc", [sp.expand(dt(u[k]) + about[k]) for k in range(TILTS)], "m/s^2", "second rate")
    return p


class _Wrap(Zone):
    """A zone whose centre moves in space, and whose groove tilts; rates: those of its motion, with omega."""

    dim = DIM

    def __init__(self, p: Program, order: int = 1, at_rest: bool = False):
        self.rho = p.input("rho", (), "kg/m", "mass of a length")
        self.omega = np.array(sp.symbols("omega:3"), dtype=object) if at_rest else _omega(p)
        self.alpha: Any = p.input("omega_acc", TILTS, "rad/s^2", "its rates about 1 and 2") if order > 1 else None
        super().__init__(p, order, centre_moves=True, at_rest=at_rest)
        self.velocity = self.c_rate
        middle, angle, *centre, flow, length = self.motion[0]
        self.rates = [middle, angle, *centre, *self.omega[:TILTS], flow, length]

    def squares(self) -> None:
        """Stage: the means of (cos 2 phi, sin 2 phi) over the zone, with their derivatives of first order."""
        p = self.program
        p.stage("means of squares over the zone")
        cosine, sine = p.vector("twice", [sp.cos(2 * self.middle), sp.sin(2 * self.middle)])
        inverse = sp.Symbol("inv_angle")
        mean = p.define("S", sp.sin(self.angle) * inverse)
        by_angle = p.define("S1", (sp.cos(self.angle) - mean) * inverse)
        self.means.append({(0, 0): p.vector("square", [mean * cosine, mean * sine]),
                           (1, 0): p.vector("square10", [-2 * mean * sine, 2 * mean * cosine]),
                           (0, 1): p.vector("square01", [by_angle * cosine, by_angle * sine])})

    def kinetic_energy(self, order: int) -> sp.Expr:
        """Stage: T."""
        p, v = self.program, self.velocity
        self.material_rates()
        self.place(order)
        self.squares()
        p.stage("kinetic energy")
        m, (C, S), (one, two, _) = self.m, self.means[1][0, 0], self.omega
        square = p.define("R2", self.R**2)
        k = p.vector("k", self.turn * m[1, 0] + self.spread * m[0, 1])
        inside = v[:2].dot(v[:2]) / 2 + v[:2].dot(k) + square * (self.turn**2 + self.spread**2 / 12) / 2
        tilting = square * (one**2 * (1 - C) / 2 + two**2 * (1 + C) / 2 - one * two * S) / 2
        across = v[2] ** 2 / 2 + v[2] * (one * m[0, 0][1] - two * m[0, 0][0]) + tilting
        self.tau = p.define("tau", inside + across)
        return p.define("T", self.rho * self.l * self.tau)


def wrap_energy() -> Program:
    """Return the kernel of the kinetic energy of a zone."""
    p = _program("wrap_energy", "kinetic energy of a zone in a groove that tilts")
    zone = _Wrap(p)
    p.output("E", [zone.kinetic_energy(1)], "J", "kinetic energy")
    return p


def wrap_inertia() -> Program:
    """Return the kernel of the inertial forces of a zone."""
    p = _program("wrap_inertia", "inertial forces of a zone in a groove that tilts")
    zone = _Wrap(p, 2)
    T = zone.kinetic_energy(2)
    (*_, l_rate), (middle_acc, angle_acc, *acc, flow_acc, l_acc) = zone.motion
    p.stage("momenta")
    momenta = [p.define(f"p{k + 1}", value) for k, value in enumerate(jacobian(p, np.array([T]), zone.rates)[0])]
    P, L = np.array(momenta[2:5]), np.array([*momenta[5:7], momenta[0]])
    v, omega = zone.velocity, zone.omega
    p.stage("rates of the momenta")
    middle_rate, angle_rate = p.define("middle_turn", zone.rates[0] - omega[2]), zone.rates[1]
    on: dict[sp.Symbol, sp.Expr] = {zone.middle: middle_rate, zone.angle: angle_rate, zone.l: l_rate}
    on |= dict(zip(zone.rates, [middle_acc, angle_acc, *(np.array(acc) - cross(omega, v)), *zone.alpha, flow_acc,
                                l_acc], strict=True))
    for means in zone.means:
        for (i, j), vector in means.items():
            if (i + 1, j) in means and (i, j + 1) in means:
                on |= dict(zip(vector, middle_rate * means[i + 1, j] + angle_rate * means[i, j + 1], strict=True))
    dt = _rate(p, on)
    rates = [p.define(f"p{k + 1}_t", dt(value)) for k, value in enumerate(momenta)]
    p.stage("forces")
    T_middle, T_angle, T_l = zone.jacobian(np.array([T]), [zone.middle, zone.angle, zone.l])[0]
    on_c = np.array(rates[2:5]) + cross(omega, P)
    moment = np.array([*rates[5:7], 0]) + cross(omega, L) + cross(v, P)
    on_all = [rates[0] - T_middle, rates[1] - T_angle, *on_c, *moment[:TILTS], rates[7], rates[8] - T_l]
    force = np.array([p.define(f"F{k + 1}", value) for k, value in enumerate(on_all)])
    p.output("f", at_ends(p, "F", force, *OF_WRAP), "N, N m", "forces on phi_a, phi_b, c, about 1 and 2, on s_a, s_b")
    return p


def wrap_mass() -> Program:
    """Return the kernel of the mass matrix of a zone: second derivatives of T by the rates."""
    p = _program("wrap_mass", "mass matrix of a zone in a groove that tilts")
    zone = _Wrap(p, at_rest=True)
    T = zone.kinetic_energy(1)
    p.stage("momenta and their derivatives")
    momenta = jacobian(p, np.array([T]), zone.rates)[0]
    M = between_ends(p, "M", jacobian(p, momenta, zone.rates), OF_WRAP, OF_WRAP)
    p.output("M", M, "kg", "derivatives of momenta by rates of phi_a, phi_b, c, omega_1, omega_2, s_a, s_b")
    return p


def _by_turns(p: Program, g: np.ndarray, on: dict[sp.Symbol, sp.Expr]) -> list[DirectionalDerivative]:
    """Return the derivatives by rotations of the groove about 1 and 2, in which gravity turns back."""
    return [DirectionalDerivative(p, f"turn{k + 1}", on | dict(zip(g, cross(g, TURNS[k]), strict=True)))
            for k in range(TILTS)]


def wrap_weight() -> Program:
    """Return the kernel of the moments of the weight of a zone about the centre, as its groove tilts."""
    p = _program("wrap_weight", "moments of the weight of a zone about the centre of a groove that tilts")
    rho, g = p.input("rho", (), "kg/m", "mass of a length"), p.input("gravity", DIM, "m/s^2", "in the groove's axes")
    zone = Zone(p)
    zone.place(1)
    p.stage("energy of gravity about the centre")
    V = p.define("V", -rho * zone.l * g[:TILTS].dot(zone.m[0, 0]))
    p.stage("moments, and their derivatives")
    means = dict.fromkeys((s for vector in zone.m.values() for s in vector), sp.S.Zero)
    turns = _by_turns(p, g, means)
    M = np.array([p.define(f"M{k + 1}", turn(V)) for k, turn in enumerate(turns)])
    p.output("moment", M, "N m", "about 1 and 2: derivatives of V")
    by = zone.jacobian(M, [zone.middle, zone.angle, zone.l])
    p.output("M_q", at_ends(p, "M_q", by.T, *ANGLES).T, "N m, N", "derivatives of the moment by phi_a, phi_b and l")
    p.output("M_turn", np.stack([turn.array(M) for turn in turns], axis=1), "N m",
             "derivatives of the moment by rotations about 1 and 2")
    return p


def laid_weight() -> Program:
    """Return the kernel of the height at which a rope is laid on a drum whose groove tilts.

    See drum.py: the energy is that of the angle of x alone, whose size is R/cos f in space.
    """
    p = _program("laid_weight", "energy of gravity of the tangent point, as the rope is laid on there, and its forces")
    weight = p.input("laid", (), "kg m", "rho sigma R^2 over the stretch of the wound rope")
    g = p.input("gravity", DIM, "m/s^2", "in the groove's axes")
    x = p.input("x", DIM, "m", "end of the span less the centre, likewise")
    p.stage("energy of gravity")
    size = p.define("size", sp.sqrt(x[:TILTS].dot(x[:TILTS])))
    inverse = p.define("inv_size", 1 / size)
    n = p.vector("n", x[:TILTS] * inverse)
    height = p.define("height", weight * (g[1] * n[0] - g[0] * n[1]))
    p.stage("forces, and their derivatives")
    turns = _by_turns(p, g, dict.fromkeys(x, sp.S.Zero))
    by_x = [p.define(f"F{k + 1}", value) for k, value in enumerate(jacobian(p, np.array([height]), x[:TILTS])[0])]
    F = np.array([*by_x, *(p.define(f"M{k + 1}", turn(height)) for k, turn in enumerate(turns))])
    p.output("V", [height], "J", "energy of gravity")
    p.output("F", F, "N, N m", "derivatives of V by x_1, x_2, and by rotations about 1 and 2")
    K = np.concatenate([jacobian(p, F, x[:TILTS]), np.stack([turn.array(F) for turn in turns], axis=1)], axis=1)
    p.output("K", K, "N/m, N", "derivatives of F by these")
    return p


def ring() -> Program:
    """Return the kernel of the moments about 1 and 2 of a ring, or of a wheel, whose axis tilts."""
    p = _program("ring", "moments about diameters of a ring that spins about its axis, which tilts")
    inertia = p.input("inertia", TILTS, "kg m^2", "about a diameter and about the axis")
    growth = p.input("growth", (), "kg m^2/s", "rate of that about a diameter")
    omega, alpha = _omega(p), p.input("omega_acc", TILTS, "rad/s^2", "its rates about 1 and 2")
    spin = p.input("spin", (), "rad/s", "angular velocity of the ring about its axis")
    p.stage("kinetic energy")
    T = p.define("T", (inertia[0] * omega[:TILTS].dot(omega[:TILTS]) + inertia[1] * spin**2) / 2)
    p.stage("angular momentum and its rate")
    L = np.array([p.define(f"L{k + 1}", value) for k, value in
                  enumerate(jacobian(p, np.array([T]), [*omega[:TILTS], spin])[0])])
    dt = _rate(p, dict(zip(omega, [*alpha, 0], strict=True)) | {inertia[0]: growth})
    moment = np.array([*dt.array(L[:TILTS]), 0]) + cross(omega, L)
    p.output("E", [p.define("of_tilt", inertia[0] * omega[:TILTS].dot(omega[:TILTS]) / 2)], "J",
             "kinetic energy of the rotation about diameters")
    p.output("moment", moment[:TILTS], "N m", "about 1 and 2")
    return p
