"""A straight part of a rope without mass in space, between the grooves of two sheaves whose axes have any direction.

A groove is a circle of radius R about a centre c, in the plane of the first two columns x, y of its frame A, whose
third one is the axis a. R has the sense of travel as sign. A rope that has returned beside that plane lies at the place
w along the axis. The part leaves it at r = c + s, s = rho n + w a, n = x sin b - y cos b, where the groove has the
tangent t = x cos b + y sin b. Of two grooves, with d = c_2 - c_1, the length

    F = l + R_1 b_1 - R_2 b_2,  l = |d + s_2 - s_1|,

is stationary by the four unknowns z = (b_1, rho_1, b_2, rho_2): with u along the part, u . n = 0 and rho u . t = R,
Clairaut's relation of geodesics, so that |rho| = |R|/cos f at the fleet angle f. The derivatives of F by what the part
depends on, p = (d, rotations of A_1 and of A_2 about the axes of the ground), are thus those at constant z: u, -s_1 x u
and s_2 x u. Those of z follow from F_zz z_p = -F_zp. An anchor has s = 0 and no unknowns.

In a plane across the axes rho is R, and F_z = 0 is the common tangent of two circles (taut_rope.py). A straight part
that passes a groove lies across the radius at its point next to the axis, as at a foot. Where that point is |R|/cos f
from the axis, the part is a wrap of no angle, with the same length, direction and force: there it touches.

A wheel has the moment of inertia I about its axis a, and that about other axes is one of its carrier. It turns by psi
on that, whose angular velocity is w: T = I (psi' + a . w)²/2. The force on psi is the rate of dT/dpsi', and the moment
on the carrier that of the angular momentum dT/dw, as a vector of the ground.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..algebra.tangent_frame import cross
from ..codegen.family import CouplingFamily
from ..codegen.program import DirectionalDerivative, Program

DIM, NAME = 3, "taut_part"
ENDS, UNKNOWNS, PLACES = 2, 4, 9
X, Y, AXIS = 0, 1, 2


def families() -> list[CouplingFamily]:
    """Return the family of straight parts in space."""
    return CouplingFamily.each("taut_part", "straight part of a rope without mass", {DIM: NAME}, build)


def build(dim: int) -> list[Program]:
    """Return the kernels of a straight part."""
    return [feet(), moves(), tangent(), spin(), spin_tangent()]


class _Part:
    """Inputs and stages of a part; `by_z` and `by_p` are derivatives by the unknowns and by the places."""

    def __init__(self, kernel: str, doc: str):
        self.p = p = Program(f"{NAME}_{kernel}", doc, "Clairaut's relation of geodesics")
        self.d = p.input("d", DIM, "m", "from the first centre to the second one")
        self.angle = p.input("angle", ENDS, "rad", "of both tangents in their grooves")
        self.reach = p.input("reach", ENDS, "m", "distance of both feet from the centres, with senses as signs")
        aside = p.input("aside", ENDS, "m", "places of both wraps along the axes")
        self.frames = (p.input("one", (DIM, DIM), "1", "frame of the first groove, by columns"),
                       p.input("other", (DIM, DIM), "1", "frame of the second groove, by columns"))
        p.stage("feet")
        self.cosine = [p.define(f"cosine_{k + 1}", sp.cos(b)) for k, b in enumerate(self.angle)]
        self.sine = [p.define(f"sine_{k + 1}", sp.sin(b)) for k, b in enumerate(self.angle)]
        self.feet = [np.array(p.vector(f"foot_{k + 1}", self.reach[k] * (
            self.sine[k] * A[:, X] - self.cosine[k] * A[:, Y]) + aside[k] * A[:, AXIS])) for k, A in enumerate(
                self.frames)]
        p.stage("part")
        between = p.vector("between", self.d + self.feet[1] - self.feet[0])
        self.length = p.define("length", sp.sqrt(between.dot(between)))
        self.u = p.vector("along", between * p.define("inv_length", 1 / self.length))
        self.by_z = [self._by(f"d_{name}_{k + 1}", on) for k in range(ENDS) for name, on in (
            ("angle", {self.angle[k]: 1, self.cosine[k]: -self.sine[k], self.sine[k]: self.cosine[k]}),
            ("reach", {self.reach[k]: 1}))]
        self.by_p = [self._by(f"d_d{i}", {self.d[i]: 1}) for i in range(DIM)]
        self.by_p += [self._by(f"d_turn_{k + 1}_{i}", self._turned(k, np.eye(DIM, dtype=int)[i]))
                      for k in range(ENDS) for i in range(DIM)]

    def _by(self, tag: str, on: dict[sp.Symbol, sp.Expr]) -> DirectionalDerivative:
        return DirectionalDerivative(self.p, tag, on)

    def _turned(self, k: int, about: np.ndarray) -> dict[sp.Symbol, sp.Expr]:
        """Return the rates of a frame that turns about an axis of the ground."""
        A = self.frames[k]
        return {A[i, j]: value for j in (X, Y, AXIS) for i, value in enumerate(np.cross(about, A[:, j]))}

    def slope(self, *radii: sp.Expr) -> np.ndarray:
        """Stage: the derivatives of F by the unknowns, or of l without radii."""
        self.p.stage("slope")
        found = [by(self.length) for by in self.by_z]
        for k, R in enumerate(radii):
            found[2 * k] += R * (1 - 2 * k)
        return np.array([self.p.define(f"slope_{k + 1}", value) for k, value in enumerate(found)])

    def _along_rates(self) -> DirectionalDerivative:
        """Return the derivative along rates of unknowns and places."""
        rate_z = self.p.input("z_rate", UNKNOWNS, "rad/s, m/s", "rates of the unknowns")
        rate_p = self.p.input("p_rate", PLACES, "m/s, rad/s", "rates of d, and angular velocities of both frames")
        on = dict(zip(self.d, rate_p, strict=False))
        for k in range(ENDS):
            turn, reach = rate_z[2 * k : 2 * k + 2]
            on |= self._turned(k, rate_p[DIM * (k + 1) : DIM * (k + 2)])
            on |= {self.angle[k]: turn, self.reach[k]: reach, self.cosine[k]: -self.sine[k] * turn,
                   self.sine[k]: self.cosine[k] * turn}
        return self._by("dt", on)

    def bend(self) -> np.ndarray:
        """Stage: the rates of the derivatives by the unknowns."""
        slope, rate = self.slope(), self._along_rates()
        self.p.stage("rates")
        return np.array([self.p.define(f"bend_{k + 1}", rate(value)) for k, value in enumerate(slope)])


def _table(by: list[DirectionalDerivative], values: np.ndarray) -> np.ndarray:
    """Return the derivatives (values, by)."""
    return np.array([[each(value) for each in by] for value in values], dtype=object)


def feet() -> Program:
    """Return the kernel of the conditions of both feet."""
    part = _Part("feet", "conditions of the feet of a straight part")
    p = part.p
    R = p.input("R", ENDS, "m", "radii with senses as signs")
    slope = part.slope(*R)
    p.output("l", [part.length], "m", "its length")
    p.output("u", part.u, "1", "its direction, a unit vector")
    p.output("s", np.array(part.feet), "m", "both feet from their centres")
    p.output("F_z", slope, "m, 1", "derivatives of F by both angles and distances, one foot after the other")
    p.output("F_zz", _table(part.by_z, slope), "m, 1, 1/m", "second derivatives by these")
    return p


def moves() -> Program:
    """Return the kernel of the derivatives by places and rotations."""
    part = _Part("moves", "derivatives of a straight part by its places")
    p = part.p
    slope = part.slope()
    p.stage("derivatives")
    p.output("F_p", [by(part.length) for by in part.by_p], "1, m", "derivatives of F by d and turns of both frames")
    p.output("F_zp", _table(part.by_p, slope), "m, 1", "derivatives of F_z by these")
    return p


def tangent() -> Program:
    """Return the kernel of the second derivatives by places, and of those along a motion."""
    part = _Part("tangent", "second derivatives of a straight part")
    p = part.p
    bend = part.bend()
    p.stage("second derivatives")
    by_place = np.array([by(part.length) for by in part.by_p])
    p.output("F_pp", _table(part.by_p, by_place), "1/m, 1, m", "derivatives of F_p by d and turns of both frames")
    p.output("Q_z", _table(part.by_z, bend), "m/s, 1/s, 1/(m s)", "derivatives of the rate of F_z by the unknowns")
    p.output("Q_p", _table(part.by_p, bend), "m/s, 1/s, 1/(m s)", "and by d and turns of both frames, at given rates")
    return p


class _Wheel:
    """Inputs and stages of a wheel that spins about an axis which turns with its carrier: force and moment."""

    def __init__(self, kernel: str, doc: str):
        self.p = p = Program(f"{NAME}_{kernel}", doc, "the rate of angular momentum")
        inertia = p.input("inertia", (), "kg m^2", "about the axis")
        self.axis = p.input("axis", DIM, "1", "unit vector along it")
        self.omega = p.input("omega", DIM, "rad/s", "angular velocity of the carrier")
        self.own = p.input("own", (), "rad/s", "rate of the rotation on the carrier")
        acc = p.input("acc", (), "rad/s^2", "rate of the angular velocity about the axis")
        p.stage("angular momentum")
        self.rate = p.define("rate", self.own + self.axis.dot(self.omega))
        energy = inertia * self.rate**2 / 2
        by_rate = p.define("momentum", sp.diff(energy, self.rate))
        whole = np.array([by_rate * a for a in self.axis])
        p.stage("its rate")
        dt = DirectionalDerivative(p, "dt", {self.rate: acc} | dict(zip(self.axis, cross(self.omega, self.axis),
                                                                        strict=True)))
        self.energy, self.force = energy, dt(by_rate)
        self.moment = np.array(p.vector("moment_all", dt.array(whole)))


def spin() -> Program:
    """Return the kernel of a wheel that spins."""
    wheel = _Wheel("spin", "wheel that spins about an axis which turns")
    p = wheel.p
    p.output("E", [wheel.energy], "J", "kinetic energy")
    p.output("force", [wheel.force], "N m", "on the rotation")
    p.output("moment", wheel.moment, "N m", "on the carrier")
    return p


def spin_tangent() -> Program:
    """Return the kernel of its derivatives."""
    wheel = _Wheel("spin_tangent", "derivatives of the moment of a wheel that spins")
    p, eye = wheel.p, np.eye(DIM, dtype=int)
    p.stage("derivatives")
    by = [DirectionalDerivative(p, f"d_turn_{i}", dict(zip(wheel.axis, cross(eye[i], wheel.axis), strict=True)))
          for i in range(DIM)]
    by += [DirectionalDerivative(p, f"d_rate_{i}", {symbol: 1}) for i, symbol in enumerate((*wheel.omega, wheel.own))]
    p.output("K", _table(by, wheel.moment), "N m, N m s", "by turns of the axis, the angular velocity and the own rate")
    return p
