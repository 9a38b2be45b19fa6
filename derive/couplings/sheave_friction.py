"""Friction of a rope on a sheave, at the ends of the zones of its wrap, the tangent points among them.

The rope slides on the sheave, turned by psi, at w = sigma R (phi' - psi') - lambda s' with the stretch lambda of the
side from which the material comes. The force f is sigma R f on phi, its opposite on psi, and -f times the mean stretch
of both sides on s, so that it is the jump of the tension. Of a point with the share theta of the wrap |f| is at most
tanh(mu theta/2) (P- + P+), with which the normal forces on an angle of both sides differ by exp(mu theta) (Euler's belt
equation). P = T - rho/lambda (v^2 + R g . n), n from the centre to the point: the inertia of the turn and the weight
are those of the stretched rope. Beside a tangent point the stretch of the span is that of its slope. A short wrap
(short_wrap.py) has one point, in its middle between both spans, with all of its angle.

Regularised friction is the limit times w/sqrt(w^2 + v0^2). Coulomb friction that sticks is a multiplier f with w = 0;
where it slides, f is the limit in a direction. Since f acts on s by the mean stretch and w has that of one side, a
sticking point through which material passes takes f s' times half the jump of the stretch: creep.

At rest a rope that sticks has no w. There its sliding is sigma R (phi - psi) - X(s) since the state in which it began
to stick, with the place X along the groove that a material coordinate had: linear over each zone, with the stretch of
the spans beyond both tangent points. f is the same.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import sympy as sp

from ..codegen.program import DirectionalDerivative, Program, jacobian

DIM = 2
SOURCE = "Euler's belt equation"


def _program(kernel: str, doc: str) -> Program:
    return Program(f"planar_sheave_{kernel}", doc, SOURCE)


@dataclass(frozen=True)
class Beside:
    """What is before and behind a point of friction: a zone of the wrap, or a span, of which the slope is known."""

    suffix: str
    before: str
    behind: str

    @property
    def sides(self) -> tuple[str, str]:
        """Return what is before and behind it."""
        return self.before, self.behind

    @property
    def zones(self) -> int:
        """Return the number of zones beside it."""
        return self.sides.count("zone")

    @property
    def between(self) -> str:
        """Return where it lies, in words."""
        return f"between a {self.before} and a {self.behind}"


POINTS = (Beside("", "zone", "zone"), Beside("_on", "span", "zone"), Beside("_off", "zone", "span"),
          Beside("_short", "span", "span"))
"""A point between two zones; the point where the rope runs on; the point where it runs off; that of a short wrap."""
SLOPES = {0: ("slope", "span_slope"), 1: ("span_slope",), 2: ()}
"""Slopes of the spans beside a point, by the number of zones there."""


class _Point:
    """Inputs of a point of friction, and the stages of its sliding speed w, and of the limit."""

    v0: sp.Symbol

    def __init__(self, p: Program, beside: Beside, *, is_regularised: bool):
        self.p, self.beside = p, beside
        self.A = p.input("A", 2, "N, N m^2", "axial and bending stiffness EA, EI")
        self.sense = p.input("sense", (), "1", "1 for travel towards greater angles, else -1")
        self.rho = p.input("rho", (), "kg/m", "mass of a length")
        self.R = p.input("R", (), "m", "radius to the axis of the rope")
        self.g = p.input("g", DIM, "m/s^2", "gravity")
        self.mu = p.input("mu", (), "1", "coefficient of friction")
        if is_regularised:
            self.v0 = p.input("v0", (), "m/s", "speed at which friction is 0.7 of its limit")
        self.phi, self.length, self.slope = _places(p, beside)
        self.phi_rate, self.psi_rate, self.s_rate = self.rates = _rates(p)
        p.stage("both sides")
        self.stretch = [p.define(f"stretch_{name}", value) for name, value in zip(
            ("before", "behind"), _stretches(beside, self.sense * self.R, self.phi, self.length, self.slope),
            strict=True)]
        self.tension = [p.define(f"T_{name}", self.A[0] * (value - 1))
                        for name, value in zip(("before", "behind"), self.stretch, strict=True)]
        self.mean = p.define("mean_stretch", (self.stretch[0] + self.stretch[1]) / 2)
        p.stage("sliding")
        source = p.define("source", _source(self.stretch, self.s_rate))
        self.groove = p.define("groove", self.sense * self.R * self.phi_rate)
        self.w = p.define("w", self.groove - self.sense * self.R * self.psi_rate - source * self.s_rate)

    @property
    def configuration(self) -> list[sp.Symbol]:
        """Return the angles, lengths and slopes."""
        return [*self.phi, *self.length, *self.slope]

    def limit(self, factor: sp.Expr, speed: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """Stages: P- + P+, and the limit of |f| times a factor."""
        p = self.p
        p.stage("limit")
        phi, zones = self.phi, self.beside.zones
        here = phi[1] if self.beside.before == "zone" else phi[0] if zones else (phi[0] + phi[1]) / 2
        outwards = p.define("outwards", self.R * (self.g[0] * sp.cos(here) + self.g[1] * sp.sin(here)))
        mass = p.define("drawn_mass", 2 * self.rho * p.define("inv_mean_stretch", 1 / self.mean))
        both = p.define("P", self.tension[0] + self.tension[1] - mass * (speed**2 + outwards))
        angle = self.sense * (phi[-1] - phi[0])
        part = angle / 2 if zones else p.define("angle", sp.Piecewise((0, angle < 0), (angle, True)))
        decay = p.define("decay", sp.exp(-self.mu * part))
        share = p.define("share", (1 - decay) * p.define("inv_share", 1 / p.define("one_more", 1 + decay)))
        p.stage("force")
        return both, p.define("f", factor * share * sp.Piecewise((0, both < 0), (both, True)))

    def speed(self) -> sp.Expr:
        """Return the speed of the material past the centre, with the mean stretch."""
        return self.p.define("speed", self.groove - self.mean * self.s_rate)

    def forces(self, f: sp.Expr) -> np.ndarray:
        """Return the forces on phi, psi, s."""
        define = self.p.define
        arm = self.sense * self.R * f
        return np.array([define("on_phi", arm), define("on_psi", -arm), define("on_s", -f * self.mean)])

    def with_derivatives(self, force: np.ndarray) -> Program:
        """Return the kernel with the derivatives of forces as its outputs."""
        p = self.p
        p.stage("derivatives")
        p.output("K", jacobian(p, force, self.configuration), "SI", "derivatives of F by angles, lengths, slopes")
        p.output("D", jacobian(p, force, self.rates), "SI", "derivatives of F by rates of phi, psi, s")
        return p


def _places(p: Program, beside: Beside) -> tuple[np.ndarray, list[sp.Symbol], list[sp.Symbol]]:
    """Declare the angles, the lengths, and the slopes of spans."""
    zones, angles = beside.zones, max(beside.zones, 1) + 1
    phi = p.input(f"angles{angles}", angles, "rad", "angles of the ends of its zones, in the rope's order")
    length = [*p.input(f"lengths{zones}", zones, "m", "lengths of its zones")] if zones else []
    return phi, length, _slopes(p, beside)


def _slopes(p: Program, beside: Beside) -> list[sp.Symbol]:
    """Declare the slopes of spans."""
    return [part for name in SLOPES[beside.zones] for part in p.input(name, DIM, "1", "slope r_S of a span beside it")]


def _rates(p: Program) -> list[sp.Symbol]:
    """Declare the rates of phi, psi and s."""
    return [p.input("angle_rate", (), "rad/s", "rate of the angle of the point"),
            p.input("spin", (), "rad/s", "angular velocity of the sheave"),
            p.input("flow", (), "m/s", "rate of the material coordinate of the point")]


def _stretches(beside: Beside, arm: sp.Expr, phi: np.ndarray, length: list[sp.Symbol],
               slope: list[sp.Symbol]) -> list[sp.Expr]:
    """Return the stretch of both sides; arm: the radius, with the sense of travel as sign."""
    of_zone = [arm * (phi[k + 1] - phi[k]) / length[k] for k in range(beside.zones)]
    of_span = [sp.sqrt(slope[k]**2 + slope[k + 1]**2) for k in range(0, len(slope), DIM)]
    return [(of_zone if kind == "zone" else of_span).pop(0) for kind in beside.sides]


def _source(stretch: list[sp.Expr], s_rate: sp.Expr) -> sp.Expr:
    """Return the stretch of the side from which the material comes."""
    return sp.Piecewise((stretch[0], s_rate < 0), (stretch[1], True))


def kernels() -> list[Program]:
    """Return the kernels of friction."""
    return [make(beside) for of in ((friction, friction_tangent), (coulomb, coulomb_tangent, coulomb_motion))
            for beside in POINTS for make in of]


def _friction(p: Program, beside: Beside) -> tuple[_Point, np.ndarray, dict[str, sp.Expr]]:
    """Stage: the force of regularised friction at a point; return the point, the forces, and numbers."""
    point = _Point(p, beside, is_regularised=True)
    speed, w = point.speed(), point.w
    inverse = p.define("inv_w", 1 / p.define("len_w", sp.sqrt(w * w + point.v0 * point.v0)))
    both, f = point.limit(p.define("smooth", w * inverse), speed)
    return point, point.forces(f), {"w": w, "P": both, "force": f}


def friction(beside: Beside) -> Program:
    """Return the kernel of regularised friction at a point."""
    p = _program(f"friction{beside.suffix}", f"friction at a point {beside.between}")
    point, force, numbers = _friction(p, beside)
    p.output("F", force, "N m, N", "forces on phi, on psi, on s")
    p.output("numbers", list(numbers.values()), "m/s, N, N", "speed of sliding w, P- + P+, jump f of the tension")
    p.output("power", [force.dot(np.array(point.rates))], "W", "dissipated power")
    return p


def friction_tangent(beside: Beside) -> Program:
    """Return the kernel of the derivatives of regularised friction at a point."""
    p = _program(f"friction{beside.suffix}_tangent", f"derivatives of friction {beside.between}")
    point, force, _ = _friction(p, beside)
    return point.with_derivatives(force)


def coulomb(beside: Beside) -> Program:
    """Return the kernel of Coulomb friction at a point."""
    p = _program(f"coulomb{beside.suffix}", f"Coulomb friction at a point {beside.between}")
    point = _Point(p, beside, is_regularised=False)
    _, limit = point.limit(sp.Integer(1), point.speed())
    p.output("numbers", [point.w, limit], "m/s, N", "speed of sliding w, limit of |f|")
    row = jacobian(p, np.array([point.w]), point.rates)[0]
    p.output("row", row, "m, 1", "derivatives of w by rates of phi, psi, s")
    p.output("column", point.forces(sp.Integer(1)), "m, 1", "forces on phi, psi, s of a unit of f")
    return p


def coulomb_tangent(beside: Beside) -> Program:
    """Return the kernel of the derivatives of Coulomb friction at a point."""
    p = _program(f"coulomb{beside.suffix}_tangent", f"derivatives of Coulomb friction {beside.between}")
    point = _Point(p, beside, is_regularised=False)
    held = p.input("held", (), "N", "f of a point that sticks, else 0")
    direction = p.input("direction", (), "1", "of sliding, 1 or -1; 0 of a point that sticks")
    _, limit = point.limit(sp.Integer(1), point.speed())
    force = point.forces(p.define("f_all", held + direction * limit))
    return point.with_derivatives(force)


def coulomb_motion(beside: Beside) -> Program:
    """Return the kernel of the rate of w at zero accelerations."""
    p = _program(f"coulomb{beside.suffix}_motion", f"rate of w at zero accelerations {beside.between}")
    arm = p.input("sense", (), "1", "1 for travel towards greater angles, else -1") * p.input(
        "R", (), "m", "radius to the axis of the rope")
    zones = beside.zones
    phi, length, slope = _places(p, beside) if zones else (np.array([]), [], _slopes(p, beside))
    rates: list[sp.Symbol] = []
    if zones:
        rates += [*p.input(f"angles{zones + 1}_rate", zones + 1, "rad/s", "rates of these angles")]
        rates += [*p.input(f"lengths{zones}_rate", zones, "m/s", "rates of the lengths")]
    for name in SLOPES[zones]:
        rates += [*p.input(f"{name}_rate", DIM, "1/s", "rate of the slope")]
    s_rate = p.input("flow", (), "m/s", "rate of the material coordinate of the point")
    second = p.input("angle_acc", (), "rad/s^2", "second rate of the angle of the point")
    on = dict(zip([*phi, *length, *slope], rates, strict=True))
    p.stage("both sides")
    stretch = _stretches(beside, arm, phi, length, slope)
    dt = DirectionalDerivative(p, "dt", on)
    p.stage("rates")
    p.output("Q_d", [arm * second - dt(p.define("source", _source(stretch, s_rate))) * s_rate], "m/s^2",
             "rate of w at zero accelerations of the dofs")
    return p
