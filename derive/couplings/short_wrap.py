"""A wrap so short that its stretch is that of the spans beside it.

The stretch sigma R (phi_b - phi_a)/l of a wrap has no limit as the rope leaves the sheave. Below a small angle it is
therefore the mean lambda of the lengths of both slopes beside the wrap, by the condition

    h = sigma R (phi_b - phi_a) - lambda l = 0,

and the elastic energy is that of the length l at this stretch. Inertia and weight are those of zones (sheave_zone.py),
which are equal parts of the wrap. Friction acts at one point in its middle (sheave_friction.py).
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..codegen.program import DirectionalDerivative, Program, jacobian
from .sheave_zone import DIM, program


def kernels() -> list[Program]:
    """Return the kernels of a short wrap."""
    return [short_wrap(), short_wrap_motion()]


def _stretch(p: Program, *slopes: np.ndarray) -> sp.Expr:
    """Stage: mean length of the slopes of both spans at the wrap."""
    p.stage("stretch")
    sizes = [p.define(f"size_{k + 1}", sp.sqrt(slope.dot(slope))) for k, slope in enumerate(slopes)]
    for k, size in enumerate(sizes):
        p.define(f"inv_size_{k + 1}", 1 / size)
    return p.define("stretch", (sizes[0] + sizes[1]) / 2)


def short_wrap() -> Program:
    """Return the kernel of the condition, the elastic energy, and their derivatives."""
    p = program("short_wrap", "condition and elastic energy of a short wrap, and their derivatives")
    A = p.input("A", 2, "N, N m^2", "axial and bending stiffness EA, EI")
    sense = p.input("sense", (), "1", "1 for travel towards greater angles, else -1")
    R = p.input("R", (), "m", "radius to the axis of the rope")
    phi = p.input("phi", 2, "rad", "angles phi_a, phi_b of both tangent points, over turns")
    slope = p.input("slope", DIM, "1", "slope r_S of the span before it")
    other = p.input("span_slope", DIM, "1", "slope r_S of the span behind it")
    l = p.input("l", (), "m", "length s_b - s_a of the wrap")
    f = p.input("tension", (), "N", "multiplier")
    stretch = _stretch(p, slope, other)
    p.stage("condition and energy")
    length = p.define("length_energy", (A[0] * (stretch - 1) ** 2 + A[1] * (stretch / R) ** 2) / 2)
    stored = p.define("stored", l * length)
    condition = p.define("condition", sense * R * (phi[1] - phi[0]) - stretch * l)
    coordinates = [*phi, *slope, *other, l]
    p.stage("derivatives")
    J, force = (np.array([p.define(f"{name}{k + 1}", value) for k, value in
                          enumerate(jacobian(p, np.array([whole]), coordinates)[0])])
                for name, whole in (("J", condition), ("F", stored)))
    p.output("h", [condition], "m", "sense R (phi_b - phi_a) - stretch l")
    p.output("U", [stored], "J", "elastic energy")
    p.output("J", J, "m, m, 1", "derivatives of h by phi_a, phi_b, both slopes, l")
    p.output("F", force, "N m, N", "derivatives of U")
    p.output("K", jacobian(p, force + f * J, coordinates), "N m, N", "derivatives of F + J' tension")
    return p


def short_wrap_motion() -> Program:
    """Return the kernel of the second rate of the condition at zero accelerations."""
    p = program("short_wrap_motion", "second rate of the condition of a short wrap at zero accelerations")
    slope = p.input("slope", DIM, "1", "slope r_S of the span before it")
    other = p.input("span_slope", DIM, "1", "slope r_S of the span behind it")
    l = p.input("l", (), "m", "length s_b - s_a of the wrap")
    slope_rate = p.input("slope_rate", DIM, "1/s", "rate of the slope before")
    other_rate = p.input("span_slope_rate", DIM, "1/s", "rate of the slope behind")
    l_rate = p.input("l_rate", (), "m/s", "rate of the length")
    dt = DirectionalDerivative(p, "dt", dict(zip([*slope, *other, l], [*slope_rate, *other_rate, l_rate], strict=True)))
    stretch = _stretch(p, slope, other)
    p.stage("rates")
    rate = p.define("rate", dt(stretch * l))
    p.output("Q_d", [-dt(rate)], "m/s^2", "second rate of h at zero accelerations of the angles, slopes and the length")
    return p
