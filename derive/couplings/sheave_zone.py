"""A zone of the wrap of a rope on a sheave in the plane, see sheave.py.

A zone lies between the angles phi_a and phi_b, and between the material coordinates s_a and s_b, l = s_b -
s_a: r = c + R (cos phi, sin phi), phi linear in S. With the sense sigma of travel its stretch is
sigma R (phi_b - phi_a)/l. The angles of zones are linear in those of the two tangent points.

All is derived over means and differences of both ends: the middle theta of the zone and its angle alpha, the mean s of
the material coordinates and the length l. With the direction n of the middle and C = 2 sin(alpha/2)/alpha the mean
place of the zone is c + m, m = R C n. The material turns with the mean rate W and the difference V of the rates at both
ends,

    W = theta' - alpha s'/l,   V = alpha' - alpha l'/l.

Its mean velocity is c' + k, k = W m_theta + V m_alpha; its kinetic energy rho l tau. Lagrange's equations follow from
this, U and the height of the mean place.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import sympy as sp

from ..codegen.program import DirectionalDerivative, Program, jacobian

SOURCE = "Lagrange's equations of a rope on a circle"
DIM = 2
Pairs = Sequence[tuple[int, int]]
"""Places of means and differences of both ends among coordinates or rates."""
ANGLES, OF_MOTION, OF_DAMPING = ((0, 1),), ((0, 1), (4, 5)), ((0, 1), (2, 3))


def kernels() -> list[Program]:
    """Return the kernels of a zone."""
    return [energy(), weight(), force(), tangent(), kinetic_energy(), inertia(), mass_matrix(), inertia_tangent(),
            dissipation(), damping_force(), damping_tangent()]


def program(kernel: str, doc: str) -> Program:
    """Return an empty kernel of a sheave."""
    return Program(f"planar_sheave_{kernel}", doc, SOURCE)


class Zone:
    """Inputs and stages of a zone; of rates up to an order, and of the centre, as asked for.

    coordinates   middle, angle, centre, l: energies depend on no others
    motion        first and second rates of the middle, the angle, the centre, the mean of s_a and s_b ("flow"), and l
    m             derivatives of m by the middle (first index) and the angle (second)

    at_rest: the rates are symbols by which the program differentiates, and no inputs.
    """

    dim = DIM
    """Components of the centre."""

    def __init__(self, program: Program, order: int = 0, has_place: bool = False, centre_moves: bool = False,
                 at_rest: bool = False):
        p = self.program = program
        rate = _symbols if at_rest else p.input
        self.R = p.input("R", (), "m", "radius to the axis of the rope")
        phi = p.input("phi", 2, "rad", "angles phi_a, phi_b of the ends of the zone, over turns")
        self.c: Any = p.input("c", self.dim, "m", "centre of the sheave") if has_place else []
        self.l = p.input("l", (), "m", "length s_b - s_a of the zone")
        given: list[tuple[Any, ...]] = []
        if order:
            given.append((rate("phi_rate", 2, "rad/s", "rates of the angles"),
                          rate("c_rate", self.dim, "m/s", "velocity of the centre") if centre_moves else [],
                          rate("s_rate", 2, "m/s", "rates of s_a and s_b")))
        if order > 1:
            given.append((p.input("phi_acc", 2, "rad/s^2", "second rates of the angles"),
                          p.input("c_acc", self.dim, "m/s^2", "acceleration of the centre"),
                          p.input("s_acc", 2, "m/s^2", "second rates of s_a and s_b")))
        p.stage("zone")
        self.middle, self.angle = self._mean_and_difference("middle", "angle", phi)
        self.w = p.define("w", 1 / self.l)
        self.coordinates = [self.middle, self.angle, *self.c, self.l]
        self.c_rate: Any = np.array(given[0][1]) if centre_moves else []
        self.motion = [[*self._mean_and_difference(f"middle_{kind}", f"angle_{kind}", angles), *centre,
                        *self._mean_and_difference(f"flow_{kind}", f"l_{kind}", ends)]
                       for kind, (angles, centre, ends) in zip(("rate", "acc"), given, strict=False)]

    def _mean_and_difference(self, mean: str, difference: str, ends: np.ndarray) -> list[sp.Expr]:
        p = self.program
        return [p.define(mean, (ends[0] + ends[1]) / 2), p.define(difference, ends[1] - ends[0])]

    def material_rates(self) -> None:
        """Stage: mean rate of the angles of material points, and the difference of those at both ends."""
        p = self.program
        middle_rate, angle_rate, *_, flow_rate, l_rate = self.motion[0]
        p.stage("rates of the angles of material points")
        self.per_length = p.define("per_length", self.angle * self.w)
        self.turn = p.define("turn", middle_rate - self.per_length * flow_rate)
        self.spread = p.define("spread", angle_rate - self.per_length * l_rate)

    def place(self, order: int) -> None:
        """Stage: m and its derivatives up to an order.

        Those of C follow from angle C, whose second derivative is -angle C/4; a second one of n is -n.
        """
        p = self.program
        p.stage("mean place of the zone")
        n_x, n_y = p.vector("n", [sp.cos(self.middle), sp.sin(self.middle)])
        half, inverse = p.define("half", self.angle / 2), p.define("inv_angle", 1 / self.angle)
        C = [p.define("C", 2 * self.R * sp.sin(half) * inverse)]
        for k in range(1, order + 1):
            before = (k - 2) * C[k - 3] / 4 if k > 2 else 0
            right = self.R * sp.cos(half) if k == 1 else -self.angle * C[k - 2] / 4
            C.append(p.define(f"C{k}", right * inverse - (k * C[k - 1] + before) * inverse))
        turned = [np.array(v) for v in ((n_x, n_y), (-n_y, n_x), (-n_x, -n_y), (n_y, -n_x))]
        self.m = {(i, j): p.vector(f"m{i}{j}", C[j] * turned[i]) for j in range(order + 1)
                  for i in range(order + 1 - j)}
        self.means = [self.m]

    def jacobian(self, values: np.ndarray, symbols: Sequence[sp.Symbol]) -> np.ndarray:
        """Return the derivatives of values (n,) by symbols (m,), (n, m)."""
        columns = []
        for one in symbols:
            on: dict[sp.Symbol, Any] = dict.fromkeys(symbols, 0)
            for means in self.means:
                for (i, j), vector in means.items():
                    rate = {self.middle: means.get((i + 1, j)), self.angle: means.get((i, j + 1))}.get(one, 0 * vector)
                    if rate is not None:
                        on |= dict(zip(vector, rate, strict=True))
            tag = f"d_{one.name}".replace("[", "").replace("]", "")
            columns.append(DirectionalDerivative(self.program, tag, on | {one: 1}).array(values))
        return np.stack(columns, axis=-1)


def _symbols(name: str, shape: int, *_: str) -> np.ndarray:
    return np.array([sp.Symbol(f"{name}[{k}]") for k in range(shape)], dtype=object)


def at_ends(p: Program, name: str, values: np.ndarray, *pairs: tuple[int, int]) -> np.ndarray:
    """Return derivatives by values at both ends from those by their means and differences: places of these in pairs,
    on the first axis.
    """
    found = values.copy()
    for mean, difference in pairs:
        half = [p.define(f"half_{name}{mean}", value / 2) for value in np.ravel(values[mean])]
        by_mean = np.array(half, dtype=object).reshape(np.shape(values[mean]))
        found[mean], found[difference] = by_mean - values[difference], by_mean + values[difference]
    return found


def between_ends(p: Program, name: str, matrix: np.ndarray, rows: Pairs, columns: Pairs) -> np.ndarray:
    """Return a matrix of derivatives by values at both ends, see `at_ends`."""
    first = at_ends(p, f"{name}_", matrix.T, *columns).T
    named = np.array([[p.define(f"{name}{i + 1}{k + 1}", value) for k, value in enumerate(row)]
                      for i, row in enumerate(first)])
    return at_ends(p, name, named, *rows)


def _stiffness(p: Program) -> np.ndarray:
    return p.input("A", 2, "N, N m^2", "axial and bending stiffness EA, EI")


def _elastic(p: Program, zone: Zone, A: np.ndarray) -> sp.Expr:
    """Stage: elastic energy, J; the stretch is sense R angle/l, the curvature a stress-free length sense angle/l."""
    p.stage("elastic energy")
    bend = p.define("bend", sp.Symbol("sense") * zone.angle * zone.w)
    strain = p.define("strain", zone.R * bend - 1)
    return p.define("stored", zone.l * (A[0] * strain**2 + A[1] * bend**2) / 2)


def _sense(p: Program) -> sp.Symbol:
    return p.input("sense", (), "1", "1 for travel towards greater angles, else -1")


def _height(p: Program, zone: Zone, rho: sp.Expr, g: np.ndarray, order: int = 0) -> sp.Expr:
    """Stage: energy of gravity, J; m with derivatives up to an order."""
    zone.place(order)
    p.stage("energy of gravity")
    return p.define("height", -rho * zone.l * g.dot(zone.c + zone.m[0, 0]))


def _gravity(p: Program) -> tuple[sp.Symbol, np.ndarray]:
    return p.input("rho", (), "kg/m", "mass of a length"), p.input("g", DIM, "m/s^2", "gravity")


def energy() -> Program:
    """Return the kernel of the elastic energy."""
    p = program("energy", "elastic energy of a zone")
    A, _ = _stiffness(p), _sense(p)
    p.output("U", [_elastic(p, Zone(p), A)], "J", "elastic energy")
    return p


def weight() -> Program:
    """Return the kernel of the energy of gravity."""
    p = program("weight", "energy of gravity of a zone")
    rho, g = _gravity(p)
    p.output("V", [_height(p, Zone(p, has_place=True), rho, g)], "J", "energy of gravity")
    return p


def _potential(p: Program, order: int) -> tuple[Zone, np.ndarray]:
    """Stage: derivatives of U + V by the middle, the angle, c, l."""
    A, _ = _stiffness(p), _sense(p)
    rho, g = _gravity(p)
    zone = Zone(p, has_place=True)
    total = _elastic(p, zone, A) + _height(p, zone, rho, g, order)
    p.stage("forces")
    force = zone.jacobian(np.array([total]), zone.coordinates)[0]
    return zone, np.array([p.define(f"F{k + 1}", value) for k, value in enumerate(force)])


def force() -> Program:
    """Return the kernel of the derivatives of both energies."""
    p = program("force", "derivatives of the elastic energy and of that of gravity")
    _, value = _potential(p, 1)
    p.output("f", at_ends(p, "F", value, *ANGLES), "N", "derivatives by phi_a, phi_b, c and l")
    return p


def tangent() -> Program:
    """Return the kernel of the second derivatives of both energies."""
    p = program("tangent", "second derivatives of the elastic energy and of that of gravity")
    zone, value = _potential(p, 2)
    p.stage("second derivatives")
    K = zone.jacobian(value, zone.coordinates)
    p.output("K", between_ends(p, "K", K, ANGLES, ANGLES), "N/m", "derivatives of f by phi_a, phi_b, c and l")
    return p


def _kinetic(p: Program, zone: Zone, order: int = 1) -> tuple[np.ndarray, sp.Expr]:
    """Stage: k, and the kinetic energy tau of a mass, J/kg."""
    zone.material_rates()
    zone.place(order)
    p.stage("kinetic energy of a mass")
    k = p.vector("k", zone.turn * zone.m[1, 0] + zone.spread * zone.m[0, 1])
    square = p.define("R2", zone.R**2) * (zone.turn**2 + zone.spread**2 / 12)
    return k, p.define("tau_k", (zone.c_rate.dot(zone.c_rate) + square) / 2 + zone.c_rate.dot(k))


def kinetic_energy() -> Program:
    """Return the kernel of the kinetic energy."""
    p = program("kinetic_energy", "kinetic energy of a zone")
    rho = p.input("rho", (), "kg/m", "mass of a length")
    zone = Zone(p, 1, centre_moves=True)
    p.output("T", [rho * zone.l * _kinetic(p, zone)[1]], "J", "kinetic energy")
    return p


def _inertia(p: Program, order: int) -> tuple[Zone, np.ndarray]:
    """Stage: d/dt dT/dv - dT/dq by the middle, the angle, c, the mean s of s_a and s_b, and l.

    tau depends on s' and l' through W and V alone; its derivatives by these are P and Q. Over rho, with the material
    acceleration of the mean place, k_t = W' m_theta + V' m_alpha + W k_theta + V k_alpha, and with
    y = alpha (s' m_theta + l' m_alpha) of what flows past the ends, whose indices are derivatives at constant alpha,

        f_theta = l (c''.m_theta + R^2 W') + l' P + c'.y_theta
        f_alpha = l (c''.m_alpha + R^2 V'/12) + l' Q + c'.y_alpha + s' P + l' Q
        f_c     = l (c'' + k_t) + l' (c' + k) + W y_theta + V y_alpha
        f_s     = -alpha/l f_theta - alpha c'.k_theta - V P
        f_l     = -alpha/l f_alpha - alpha c'.k_alpha - V Q - tau
    """
    rho = p.input("rho", (), "kg/m", "mass of a length")
    zone = Zone(p, 2, centre_moves=True)
    k, tau = _kinetic(p, zone, order)
    m, l, angle, c_rate, turn, spread, R2 = (zone.m, zone.l, zone.angle, zone.c_rate, zone.turn, zone.spread,
                                             sp.Symbol("R2"))
    (*_, flow_rate, l_rate), (middle_acc, angle_acc, *acc, flow_acc, l_acc) = zone.motion
    p.stage("momenta and accelerations of the material")
    P = p.define("P", c_rate.dot(m[1, 0]) + R2 * turn)
    Q = p.define("Q", c_rate.dot(m[0, 1]) + R2 * spread / 12)
    opening = p.define("opening", zone.w * spread)  # rate of alpha/l
    turn_t = p.define("turn_t", middle_acc - zone.per_length * flow_acc - opening * flow_rate)
    spread_t = p.define("spread_t", angle_acc - zone.per_length * l_acc - opening * l_rate)
    k_middle, k_angle = (p.vector(f"k_{name}", turn * m[1 + i, 1 - i] + spread * m[i, 2 - i])
                         for i, name in ((1, "middle"), (0, "angle")))
    k_t = p.vector("k_t", turn_t * m[1, 0] + spread_t * m[0, 1] + turn * k_middle + spread * k_angle)
    p.stage("what flows past the ends")
    past_flow, past_l = p.define("past_flow", angle * flow_rate), p.define("past_l", angle * l_rate)
    y_middle, y_angle = (p.vector(f"y_{name}", past_flow * m[1 + i, 1 - i] + past_l * m[i, 2 - i])
                         for i, name in ((1, "middle"), (0, "angle")))
    p.stage("forces over the mass of a length")
    c_acc = np.array(acc)
    f_middle = p.define("f_middle", l * (c_acc.dot(m[1, 0]) + R2 * turn_t) + l_rate * P + c_rate.dot(y_middle))
    f_angle = p.define("f_angle", l * (c_acc.dot(m[0, 1]) + R2 * spread_t / 12) + 2 * l_rate * Q + flow_rate * P
                       + c_rate.dot(y_angle))
    f_c = p.vector("f_c", l * (c_acc + k_t) + l_rate * (c_rate + k) + turn * y_middle + spread * y_angle)
    drawn = [p.define(f"drawn_{name}", c_rate.dot(value)) for name, value in (("middle", k_middle), ("angle", k_angle))]
    f_flow = p.define("f_flow", -zone.per_length * f_middle - angle * drawn[0] - spread * P)
    f_l = p.define("f_l", -zone.per_length * f_angle - angle * drawn[1] - spread * Q - tau)
    p.stage("forces")
    return zone, np.array([p.define(f"F{i + 1}", rho * value)
                           for i, value in enumerate([f_middle, f_angle, *f_c, f_flow, f_l])])


def inertia() -> Program:
    """Return the kernel of the inertial forces."""
    p = program("inertia", "inertial forces d/dt dT/dv - dT/dq of a zone")
    _, force = _inertia(p, 2)
    p.output("f", at_ends(p, "F", force, *OF_MOTION), "N", "forces on phi_a, phi_b, c, s_a, s_b")
    return p


def mass_matrix() -> Program:
    """Return the kernel of the mass matrix: second derivatives of the kinetic energy by the rates."""
    p = program("mass_matrix", "mass matrix of a zone")
    rho = p.input("rho", (), "kg/m", "mass of a length")
    zone = Zone(p, 1, centre_moves=True, at_rest=True)
    _, tau = _kinetic(p, zone)
    p.stage("momenta and their derivatives")
    (rates,) = zone.motion
    momenta = zone.jacobian(np.array([rho * zone.l * tau]), rates)[0]
    M = between_ends(p, "M", zone.jacobian(momenta, rates), OF_MOTION, OF_MOTION)
    p.output("M", M, "kg", "derivatives of momenta by rates of phi_a, phi_b, c, s_a, s_b")
    return p


def inertia_tangent() -> Program:
    """Return the kernel of the derivatives of the inertial forces by rates and places."""
    p = program("inertia_tangent", "derivatives of the inertial forces of a zone by rates and places")
    zone, force = _inertia(p, 3)
    rates, _ = zone.motion
    p.stage("derivatives")
    for name, symbols, pairs, unit, doc in (
            ("D", rates, OF_MOTION, "kg/s", "rates of phi_a, phi_b, c, s_a, s_b"),
            ("K", [zone.middle, zone.angle, zone.l], ANGLES, "SI", "phi_a, phi_b, l")):
        value = between_ends(p, name, zone.jacobian(force, symbols), OF_MOTION, pairs)
        p.output(name, value, unit, f"derivatives of f by {doc}")
    return p


def _stretching(p: Program) -> tuple[Zone, sp.Expr, sp.Expr]:
    """Stage: rate of the curvature, which is that of the strain over R; the viscosity for both."""
    A, tau = _stiffness(p), p.input("tau", (), "s", "retardation time of the Kelvin-Voigt law")
    zone = Zone(p, 1)
    zone.material_rates()
    p.stage("rate of the curvature")
    rate = p.define("bend_rate", zone.w * zone.spread)
    return zone, rate, p.define("viscosity", tau * zone.l * (A[0] * zone.R**2 + A[1]))


def dissipation() -> Program:
    """Return the kernel of the power of damping."""
    p = program("dissipation", "power dissipated by damping of a zone")
    _, rate, viscosity = _stretching(p)
    p.output("P", [viscosity * rate**2], "W", "dissipated power")
    return p


def _damping(p: Program) -> tuple[Zone, np.ndarray]:
    """Stage: forces on the angle and on l; there are none on the means."""
    zone, rate, viscosity = _stretching(p)
    p.stage("forces")
    moment = p.define("moment", viscosity * rate * zone.w)
    return zone, np.array([0, moment, 0, p.define("pull", -zone.per_length * moment)])


def damping_force() -> Program:
    """Return the kernel of the forces of damping."""
    p = program("damping_force", "forces of damping of a zone")
    p.output("f", at_ends(p, "F", _damping(p)[1], *OF_DAMPING), "N m, N", "forces on phi_a, phi_b, s_a, s_b")
    return p


def damping_tangent() -> Program:
    """Return the kernel of the derivatives of the forces of damping."""
    p = program("damping_tangent", "derivatives of the forces of damping of a zone")
    zone, force = _damping(p)
    p.stage("derivatives")
    for name, symbols, pairs, unit, doc in (
            ("D", zone.motion[0], OF_DAMPING, "N m s, N s", "rates of phi_a, phi_b, s_a, s_b"),
            ("K", zone.coordinates, ANGLES, "N m, N", "phi_a, phi_b, l")):
        value = between_ends(p, name, jacobian(p, force, symbols), OF_DAMPING, pairs)
        p.output(name, value, unit, f"derivatives of f by {doc}")
    return p
