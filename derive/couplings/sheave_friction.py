"""Friction of a rope on a sheave, at the ends of the zones of its wrap, the tangent points among them.

The rope slides on the sheave, turned by psi, at w = sigma R (phi' - psi') - lambda s' with the stretch lambda of the
side from which the material comes. The force f is sigma R f on phi, its opposite on psi, and -f times the mean stretch
of both sides on s, so that it is the jump of the tension. Of a point with the share theta of the wrap |f| is at most
tanh(mu theta/2) (P- + P+), with which the normal forces on an angle of both sides differ by exp(mu theta) (Euler's belt
equation). P = T - rho/lambda (v^2 + R g . n), n from the centre to the point: the inertia of the turn and the weight
are those of the stretched rope. Beside a tangent point the stretch of the span is that of its slope.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import sympy as sp

from ..codegen.program import Program, jacobian

DIM = 2
SOURCE = "Euler's belt equation"


def _program(kernel: str, doc: str) -> Program:
    return Program(f"planar_sheave_{kernel}", doc, SOURCE)


@dataclass(frozen=True)
class Beside:
    """What is before and behind a point of friction: a zone of the wrap, or a span, of which the slope is known."""

    name: str
    before: str
    behind: str


POINTS = (Beside("friction", "zone", "zone"), Beside("friction_on", "span", "zone"),
          Beside("friction_off", "zone", "span"))
"""A point between two zones; the point where the rope runs on; the point where it runs off."""


def _friction(p: Program, beside: Beside) -> tuple[list[sp.Symbol], list[sp.Symbol], np.ndarray, dict[str, sp.Expr]]:
    """Stage: the force of friction at a point; return configuration, rates, forces, and numbers."""
    A = p.input("A", 2, "N, N m^2", "axial and bending stiffness EA, EI")
    sense = p.input("sense", (), "1", "1 for travel towards greater angles, else -1")
    rho, R = p.input("rho", (), "kg/m", "mass of a length"), p.input("R", (), "m", "radius to the axis of the rope")
    g = p.input("g", DIM, "m/s^2", "gravity")
    mu = p.input("mu", (), "1", "coefficient of friction")
    v0 = p.input("v0", (), "m/s", "speed at which friction is 0.7 of its limit")
    zones = (beside.before, beside.behind).count("zone")
    phi = p.input(f"angles{zones + 1}", zones + 1, "rad", "angles of the ends of its zones, in the rope's order")
    length = p.input(f"lengths{zones}", zones, "m", "lengths of its zones")
    slope = [] if zones == 2 else [*p.input("span_slope", DIM, "1", "slope r_S of the span")]
    phi_rate = p.input("angle_rate", (), "rad/s", "rate of the angle of the point")
    psi_rate = p.input("spin", (), "rad/s", "angular velocity of the sheave")
    s_rate = p.input("flow", (), "m/s", "rate of the material coordinate of the point")
    p.stage("both sides")
    of_zone = [sense * R * (phi[k + 1] - phi[k]) / length[k] for k in range(zones)]
    stretch = [p.define(f"stretch_{name}", of_zone.pop(0) if kind == "zone" else sp.sqrt(slope[0]**2 + slope[1]**2))
               for name, kind in (("before", beside.before), ("behind", beside.behind))]
    tension = [p.define(f"T_{name}", A[0] * (value - 1))
               for name, value in zip(("before", "behind"), stretch, strict=True)]
    mean = p.define("mean_stretch", (stretch[0] + stretch[1]) / 2)
    p.stage("sliding")
    source = p.define("source", sp.Piecewise((stretch[0], s_rate < 0), (stretch[1], True)))
    groove = p.define("groove", sense * R * phi_rate)
    w = p.define("w", groove - sense * R * psi_rate - source * s_rate)
    speed = p.define("speed", groove - mean * s_rate)
    smooth = p.define("smooth", w * p.define("inv_w", 1 / p.define("len_w", sp.sqrt(w * w + v0 * v0))))
    p.stage("limit")
    here = phi[1] if beside.before == "zone" else phi[0]
    outwards = p.define("outwards", R * (g[0] * sp.cos(here) + g[1] * sp.sin(here)))
    mass = p.define("drawn_mass", 2 * rho * p.define("inv_mean_stretch", 1 / mean))
    both = p.define("P", tension[0] + tension[1] - mass * (speed**2 + outwards))
    decay = p.define("decay", sp.exp(-mu * sense * (phi[zones] - phi[0]) / 2))
    share = p.define("share", (1 - decay) * p.define("inv_share", 1 / p.define("one_more", 1 + decay)))
    p.stage("force")
    f = p.define("f", smooth * share * sp.Piecewise((0, both < 0), (both, True)))
    force = np.array([p.define("on_phi", sense * R * f), p.define("on_psi", -sense * R * f),
                      p.define("on_s", -f * mean)])
    numbers = {"w": w, "P": both, "force": f}
    return [*phi, *length, *slope], [phi_rate, psi_rate, s_rate], force, numbers


def kernels() -> list[Program]:
    """Return the kernels of friction."""
    return [make(beside) for beside in POINTS for make in (friction, friction_tangent)]


def friction(beside: Beside) -> Program:
    """Return the kernel of friction at a point."""
    p = _program(beside.name, f"friction at a point between a {beside.before} and a {beside.behind}")
    _, rates, force, numbers = _friction(p, beside)
    p.output("F", force, "N m, N", "forces on phi, on psi, on s")
    p.output("numbers", list(numbers.values()), "m/s, N, N", "speed of sliding w, P- + P+, jump f of the tension")
    p.output("power", [force.dot(np.array(rates))], "W", "dissipated power")
    return p


def friction_tangent(beside: Beside) -> Program:
    """Return the kernel of the derivatives of friction at a point."""
    p = _program(f"{beside.name}_tangent", f"derivatives of friction between a {beside.before} and a {beside.behind}")
    configuration, rates, force, _ = _friction(p, beside)
    p.stage("derivatives")
    p.output("K", jacobian(p, force, configuration), "SI", "derivatives of F by the angles, the lengths, the slope")
    p.output("D", jacobian(p, force, rates), "SI", "derivatives of F by rates of phi, psi, s")
    return p
