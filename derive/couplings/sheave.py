"""A rope on a sheave in the plane: the tangent point of a span, and a zone of the wrap.

At a tangent point the end r of a span lies on a circle of radius R about c, and its slope is along the groove: with
x = r - c, |x| = R and r_S . x = 0. Its angle phi is that of x, counted over turns: dphi = x x dx/|x|^2.

Between the tangent points lies the wrap, in zones (sheave_zone.py), whose angles are linear in those of the two tangent
points. Friction acts between these (sheave_friction.py). A short wrap has a condition in its place (short_wrap.py).
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..codegen.family import CouplingFamily
from ..codegen.program import DirectionalDerivative, Program, jacobian
from . import drum, sheave_friction, sheave_step, sheave_zone, short_wrap
from .sheave_zone import DIM, program


def families() -> list[CouplingFamily]:
    """Return the family of sheaves in the plane."""
    return CouplingFamily.each("sheave", "rope on a sheave", {DIM: "planar_sheave"}, build)


def build(dim: int) -> list[Program]:
    """Return the kernels of a sheave."""
    return [tangent_point(), tangent_point_motion(), angle(), *sheave_zone.kernels(), *sheave_step.kernels(),
            *sheave_friction.kernels(), *short_wrap.kernels(), *drum.kernels()]


def _conditions(p: Program, x: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """Stage: |x| and r_S . x."""
    p.stage("conditions")
    size = p.define("size", sp.sqrt(x.dot(x)))
    p.define("inv_size", 1 / size)
    return np.array([size, p.define("lean", slope.dot(x))])


def tangent_point() -> Program:
    """Return the kernel of the conditions and their derivatives."""
    p = program("tangent_point", "conditions of a tangent point, and their derivatives")
    x = p.input("x", DIM, "m", "end of the span less the centre of the sheave")
    slope = p.input("slope", DIM, "1", "slope r_S there")
    R, f = p.input("R", (), "m", "radius to the axis of the rope"), p.input("f", 2, "N", "multipliers")
    phi = _conditions(p, x, slope)
    p.stage("derivatives")
    coordinates = [*x, *slope]
    J = jacobian(p, phi, coordinates)
    J = np.array([p.vector(f"J{k}", row[:2]).tolist() + p.vector(f"J{k}s", row[2:]).tolist()
                  for k, row in enumerate(J)], dtype=object)
    p.output("phi", phi - np.array([R, 0]), "m", "|x| - R, r_S . x")
    p.output("J", J, "1, m", "derivatives by x and the slope")
    p.output("K", jacobian(p, J.T.dot(f), coordinates), "N/m, N", "derivatives of J' f by x and the slope")
    return p


def tangent_point_motion() -> Program:
    """Return the kernel of the second rates of the conditions at zero accelerations."""
    p = program("tangent_point_motion", "second rates of the conditions at zero accelerations")
    x, slope = p.input("x", DIM, "m", "end of the span less the centre of the sheave"), sp.symbols("slope_x slope_y")
    x_rate = p.input("x_rate", DIM, "m/s", "rate of x")
    slope_rate = p.input("slope_rate", DIM, "1/s", "rate of the slope")
    dt = DirectionalDerivative(p, "dt", dict(zip([*x, *slope], [*x_rate, *slope_rate], strict=True)))
    p.stage("rates")
    rate = [p.define(f"rate_{k + 1}", dt(value)) for k, value in enumerate(_conditions(p, x, np.array(slope)))]
    p.output("Q_d", dt.array(np.array(rate)), "m/s^2", "second rates at zero accelerations of x and the slope")
    return p


def angle() -> Program:
    """Return the kernel of the rates of the angle of x, and of their derivatives."""
    p = program("angle", "rates of the angle of a tangent point, and their derivatives")
    x = p.input("x", DIM, "m", "end of the span less the centre of the sheave")
    x_rate = p.input("x_rate", DIM, "m/s", "rate of x")
    x_acc = p.input("x_acc", DIM, "m/s^2", "second rate of x")
    p.stage("rates")
    inverse = p.define("inv_square", 1 / p.define("square", x.dot(x)))
    rate = p.define("turn", (x[0] * x_rate[1] - x[1] * x_rate[0]) * inverse)
    on = dict(zip([*x, *x_rate], [*x_rate, *x_acc], strict=True))
    second = p.define("second", DirectionalDerivative(p, "dt", on)(rate))
    by_x = p.vector("by_x", jacobian(p, np.array([rate]), x_rate)[0])
    p.stage("derivatives")
    p.output("rate", [rate], "rad/s", "rate of the angle")
    p.output("acc", [second], "rad/s^2", "second rate of the angle")
    p.output("phi_x", by_x, "1/m", "derivatives of the angle by x, those of a rate by that of x")
    p.output("phi_xx", jacobian(p, by_x, x), "1/m^2", "second derivatives of the angle by x")
    p.output("rate_x", jacobian(p, np.array([rate]), x)[0], "1/(m s)", "derivatives of the rate by x")
    p.output("acc_x", jacobian(p, np.array([second]), x)[0], "1/(m s^2)", "derivatives of the second rate by x")
    p.output("acc_v", jacobian(p, np.array([second]), x_rate)[0], "1/(m s)", "derivatives of it by the rate of x")
    return p
