"""A point of the wrap of a rope on a sheave over a step that conserves energy, see material_step.py.

The place is c + R n(phi), and the slope r_xi is R alpha n_phi in a zone of the angle alpha; its mean is taken as
R alpha~ n_phi~. Over a step a turn has the measure 2 tan(dphi/2), so that with the mean angle phi~

    dn = 2 sin(dphi/2) n_phi(phi~) = 2 tan(dphi/2) cos(dphi/2) n_phi(phi~),   n~ = cos(dphi/2) n(phi~):

a force f on n is the moment cos(dphi/2) n_phi(phi~).f, the moment about the centre of f at n~.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..codegen.program import Program
from .material_step import SOURCE, Step, at_point

DIM = 2


def kernels() -> list[Program]:
    """Return the kernels of a point over a step."""
    return [momentum(), momentum_energy(), momentum_step()]


def radial_and_along(angle: sp.Expr) -> tuple[np.ndarray, np.ndarray]:
    """Return n and n_phi at an angle."""
    return np.array([sp.cos(angle), sp.sin(angle)]), np.array([-sp.sin(angle), sp.cos(angle)])


def momentum() -> Program:
    """Return the kernel of the momentum at a point, over the mass of a length."""
    p = Program("planar_sheave_momentum", "momentum of the material at a point of a zone, over the mass of a length",
                "material velocity of a rope on a circle")
    R, length = p.input("R", (), "m", "radius to the axis of the rope"), p.input("l", (), "m", "length s_b - s_a")
    xi = p.input("xi", (), "1", "part of the zone")
    phi, angle = p.input("angle_at", (), "rad", "angle of the point"), p.input("alpha", (), "rad", "angle of the zone")
    c_rate = p.input("c_rate", DIM, "m/s", "velocity of the centre")
    turn = p.input("turn", (), "rad/s", "rate of the angle of the point")
    s_rate = p.input("s_rate", 2, "m/s", "rates of s_a and s_b")
    p.stage("momentum")
    along = p.define("along", R * (length * turn - angle * ((1 - xi) * s_rate[0] + xi * s_rate[1])))
    p.output("P", length * c_rate + along * p.vector("across", radial_and_along(phi)[1]), "m^2/s", "l u")
    return p


def momentum_energy() -> Program:
    """Return the kernel of the kinetic energy of the momentum at a point."""
    p = Program("planar_sheave_momentum_energy", "kinetic energy of the momentum at a point of a zone", SOURCE)
    rho, length = p.input("rho", (), "kg/m", "mass of a length"), p.input("l", (), "m", "length s_b - s_a")
    P = p.input("P", DIM, "m^2/s", "momentum l u")
    p.stage("kinetic energy")
    p.output("T", [rho * P.dot(P) / (2 * length)], "J", "kinetic energy")
    return p


def momentum_step() -> Program:
    """Return the kernel of the inertial forces of a point over a step, and its momentum at the end."""
    p = Program("planar_sheave_momentum_step", "inertial forces of a point of a zone over a step that conserves energy",
                SOURCE)
    step = Step.of(p)
    R, xi = p.input("R", (), "m", "radius to the axis of the rope"), p.input("xi", (), "1", "part of the zone")
    phi = p.input("angle_at", (), "rad", "angle of the point at the start of the step")
    phi_change = p.input("angle_change", (), "rad", "its change")
    alpha = p.input("alpha", (), "rad", "angle of the zone at the start of the step")
    alpha_change = p.input("alpha_change", (), "rad", "its change")
    c_change = p.input("c_change", DIM, "m", "change of the centre")
    P = p.input("P", DIM, "m^2/s", "momentum l u at the start of the step")
    p.stage("directions")
    half = p.define("half", phi_change / 2)
    cos, sin = p.define("cos_half", sp.cos(half)), p.define("sin_half", sp.sin(half))
    n, across = (p.vector(name, v) for name, v in zip(("n", "across"), radial_and_along(p.define("middle", phi + half)),
                                                      strict=True))
    mean = p.define("mean_size", R * (alpha + alpha_change / 2))
    p.stage("forces")
    forces = at_point(p, "", step, xi, c_change + 2 * R * sin * across, mean * cos * across,
                      R * alpha_change * cos * across - 2 * mean * sin * n, P)
    on_place, on_slope = p.vector("on_place", forces.on_place), p.vector("on_slope", forces.on_slope)
    p.output("on_c", on_place, "N", "force on the centre")
    p.output("on_turn", [cos * (R * across.dot(on_place) - mean * n.dot(on_slope))], "N m",
             "moment about the centre")
    p.output("on_alpha", [R * cos * across.dot(on_slope)], "N m", "moment on the angle of the zone")
    p.output("on_s", forces.on_s, "N", "forces on s_a and s_b")
    p.output("P_next", forces.P, "m^2/s", "momentum l u at the end of the step")
    return p
