"""Linear waves on a fluid of a constant depth (Airy): elevation of the surface, and velocity of the fluid.

A wave of the amplitude a, with the vector k along its direction, has the elevation a cos theta, theta = k . r - omega t
+ phi, and the potential a omega/k C(Z) sin theta at the height Z above the still level, with C = cosh k(Z + d)/sinh k d
= (e^{kZ} + q e^{-kZ})/(1 - q), q = e^{-2kd}, zero for infinite depth. Its gradient is the velocity, and omega^2 = g k
tanh k d the dispersion relation (Dean & Dalrymple, Water Wave Mechanics, 1991, ch. 3).

Above the still level the theory has no fluid. The velocity there is that at another height Z(t, r), given with its
derivatives: by Wheeler's rule Z = (z - eta)/(1 + eta/d) (J. Pet. Technol. 22 (1970) 359-367), 0 at the surface.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..codegen.program import Program, jacobian

SOURCE = "Airy 1845; Dean & Dalrymple 1991"


def build(name: str, dim: int) -> list[Program]:
    """Return the kernels in space or in the plane, of the family `name`."""
    return [phase(name, dim), elevation(name, dim), stretching(name, dim), velocity(name, dim)]


def _wave(p: Program, dim: int) -> tuple[sp.Expr, ...]:
    """Return wave vector, numbers of the wave, and cosine and sine of its phase."""
    k = p.input("k", dim, "1/m", "vector of the wave, along its direction")
    wave = p.input("wave", 5, "m, rad/s, rad, 1/m, 1", "a, omega, phi, size of k, q")
    return k, wave, p.input("cosine", (), "1", "cos theta"), p.input("sine", (), "1", "sin theta")


def phase(name: str, dim: int) -> Program:
    """Return the kernel of the phase of a wave."""
    p = Program(f"{name}_wave_phase", "phase of a wave", SOURCE)
    place, time = p.input("place", dim, "m", "place"), p.input("time", (), "s", "time")
    k = p.input("k", dim, "1/m", "vector of the wave, along its direction")
    wave = p.input("wave", 5, "m, rad/s, rad, 1/m, 1", "a, omega, phi, size of k, q")
    p.stage("phase")
    p.output("theta", k.dot(place) - wave[1] * time + wave[2], "rad", "phase")
    return p


def elevation(name: str, dim: int) -> Program:
    """Return the kernel of the elevation of a wave by its phase."""
    p = Program(f"{name}_wave_elevation", "elevation of the surface by a wave", SOURCE)
    k, (a, omega, *_), cosine, sine = _wave(p, dim)
    p.stage("elevation")
    p.output("eta", a * cosine, "m", "elevation above the still level")
    p.output("eta_t", a * omega * sine, "m/s", "its rate at a fixed place")
    p.output("eta_r", -p.define("slope", a * sine) * k, "1", "its derivatives by the place")
    return p


def stretching(name: str, dim: int) -> Program:
    """Return the kernel of the height at which Wheeler's rule takes the velocity, with its derivatives."""
    p = Program(f"{name}_wave_stretching", "height of the velocity by Wheeler's rule", "Wheeler 1970")
    height = p.input("height", (), "m", "height above the still level")
    eta, eta_t = p.input("eta", (), "m", "elevation"), p.input("eta_t", (), "m/s", "its rate at a fixed place")
    eta_r = p.input("eta_r", dim, "1", "its derivatives by the place")
    up = p.input("up", dim, "1", "vertical")
    inv_depth = p.input("inv_depth", (), "1/m", "reciprocal of the depth, 0 for infinite depth")
    p.stage("height")
    Z = p.define("stretched", (height - eta) / (1 + eta * inv_depth))
    (by_height, by_eta), = jacobian(p, np.array([Z]), [height, eta])
    p.output("Z", [Z], "m", "height above the still level")
    p.output("Z_t", [by_eta * eta_t], "m/s", "its rate at a fixed place")
    p.output("Z_r", by_height * up + by_eta * eta_r, "1", "its derivatives by the place")
    return p


def velocity(name: str, dim: int) -> Program:
    """Return the kernel of the velocity of the fluid in a wave by its phase, with its derivatives."""
    p = Program(f"{name}_wave_velocity", "velocity of the fluid in a wave", SOURCE)
    k, (a, omega, _, size, q), cosine, sine = _wave(p, dim)
    grow = p.input("grow", (), "1", "e^{kZ} at the height Z above the still level at which the velocity is taken")
    up = p.input("up", dim, "1", "vertical")
    Z_t = p.input("Z_t", (), "m/s", "rate of Z at a fixed place")
    Z_r = p.input("Z_r", dim, "1", "its derivatives by the place")
    p.stage("decay with depth")
    scale, mirrored = p.define("scale", a * omega / (1 - q)), p.define("mirrored", q / grow)
    inverse = p.define("inv_k", 1 / size)
    ahead = p.vector("ahead", inverse * k)
    C, S = p.define("C", scale * (grow + mirrored)), p.define("S", scale * (grow - mirrored))
    p.stage("velocity, by phase and height")
    U = p.vector("V", C * cosine * ahead + S * sine * up)
    by_phase = p.vector("V_theta", S * cosine * up - C * sine * ahead)
    by_height = p.vector("V_Z", size * (S * cosine * ahead + C * sine * up))
    p.output("potential", C * inverse * sine, "m^2/s", "potential")
    p.output("U", U, "m/s", "velocity")
    p.output("U_t", by_height * Z_t - omega * by_phase, "m/s^2", "its rate at a fixed place")
    p.output("G", [[by_phase[i] * k[j] + by_height[i] * Z_r[j] for j in range(dim)] for i in range(dim)], "1/s",
             "its gradient: derivatives of a component in a row")
    return p
