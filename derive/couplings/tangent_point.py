"""The tangent point of a rope on a sheave in space, which a span leaves at a fleet angle.

The wrap lies in the plane of the groove, so that the kernels of sheave.py hold in that plane. Alone the conditions of
the tangent point are others. With the axis a (unit), x = r - c from the centre to the end of the span, and the unit
vector e along the span,

    a . x = 0,   e . x = 0,   |x| cos f = R,   cos f = sqrt(1 - (a . e)^2).

The last one is Clairaut's: the arm of the tension about the axis is R. A taut rope without weight is a geodesic, on
which the energy R phi + l of wrap and span is stationary: then the multipliers of the last two vanish.

e is that of the chord d to the point of the span at a fixed stress-free distance b, less its sag under gravity at rest,
d/|d| + rho b g/(2 T), with the tension T of the chord. At low tension the sag has a limit.
The slope at the end cannot take the place of the chord: it follows the shape of the span by its stiffness alone, so
that rest would be a saddle of the energy. It stays free.

Small wraps have the slope t in the place of e in the second condition, t . x = 0 (by_chord: 0), so that both spans join
where the wrap vanishes. With the chord in the last condition rest is a minimum of the energy up to a fleet angle that
falls with the length of elements (tangent_point.md).

A sheave that moves along its axis takes the mass of the wrap along, which the kernels in the plane do not have. On a
body that rotates the axis turns with it (turning_wheel.py): the conditions depend on it, and a moment acts on the body.
"""

from __future__ import annotations

import numpy as np
import sympy as sp

from ..codegen.family import CouplingFamily
from ..codegen.program import DirectionalDerivative, Program, jacobian
from ..elements import ELEMENTS
from ..spec import x as along
from . import turning_step, turning_wheel
from .span_inertia import FlowingElement

DIM, NAME = 3, "tangent_point"
SOURCE = "Clairaut's relation of geodesics"


def families() -> list[CouplingFamily]:
    """Return the family of tangent points in space."""
    return CouplingFamily.each("tangent_point", "tangent point of a rope on a sheave", {DIM: NAME}, build)


def build(dim: int) -> list[Program]:
    """Return the kernels of a tangent point."""
    return [conditions(), motion(), chord(), across(), conditions(turns=True), motion(turns=True),
            *turning_wheel.kernels(), *turning_step.kernels()]


def _program(kernel: str, doc: str) -> Program:
    return Program(f"{NAME}_{kernel}", doc, SOURCE)


class _Foot:
    """Inputs and stages of the conditions; coordinates: x, the slope, the chord, and b; with an axis that turns the
    axis, too.
    """

    def __init__(self, p: Program, turns: bool):
        self.x = p.input("x", DIM, "m", "end of the span less the centre of the sheave")
        self.slope = p.input("slope", DIM, "1", "slope r_S of the span there")
        self.chord = p.input("chord", DIM, "m", "from there to a point of the span")
        self.b = p.input("b", (), "m", "stress-free length of the chord")
        self.axis = p.input("axis", DIM, "1", "axis of the sheave, a unit vector")
        self.weight = p.input("weight", DIM, "N/m", "half the weight of a length")
        self.EA = p.input("EA", (), "N", "axial stiffness")
        self.by_chord = p.input("by_chord", (), "1", "1: x lies across the chord, 0: across the slope")
        self.limit = p.input("limit", (), "N/m", "tension over b below which the sag has its limit")
        self.coordinates = [*self.x, *self.slope, *self.chord, self.b, *(self.axis if turns else ())]

    def conditions(self, p: Program) -> np.ndarray:
        """Stages: u, which is e but for its length; a . x, u . x or t . x, |x| cos f."""
        p.stage("direction of the span")
        length = p.define("length", sp.sqrt(self.chord.dot(self.chord)))
        inverse = p.define("inv_length", 1 / length)
        T, least = p.define("T", self.EA * (length / self.b - 1)), p.define("least", self.limit * self.b)
        pull = p.define("pull", sp.sqrt(T * T + least * least))
        bend = p.define("bend", self.b * p.define("inv_pull", 1 / pull))
        u = np.array(p.vector("along", self.chord * inverse + self.weight * bend))
        inverse = p.define("inv_along", 1 / p.define("len_along", sp.sqrt(u.dot(u))))
        rise = p.define("rise", self.axis.dot(u) * inverse)
        fleet = p.define("cos_fleet", sp.sqrt(1 - rise * rise))
        p.define("inv_fleet", 1 / fleet)
        p.stage("conditions")
        size = p.define("size", sp.sqrt(self.x.dot(self.x)))
        p.define("inv_size", 1 / size)
        across = np.array(p.vector("across", self.by_chord * u + (1 - self.by_chord) * self.slope))
        return np.array([p.define("aside", self.axis.dot(self.x)), p.define("lean", across.dot(self.x)),
                         p.define("arm", size * fleet)])


def conditions(turns: bool = False) -> Program:
    """Return the kernel of the conditions and their derivatives; turns: by the axis, too."""
    p = _program("turned_conditions" if turns else "conditions", "conditions of a tangent point, and their derivatives"
                 + " by the axis, too" * turns)
    foot = _Foot(p, turns)
    R, f = p.input("R", (), "m", "radius to the axis of the rope"), p.input("f", 3, "N", "multipliers")
    phi = foot.conditions(p)
    p.stage("derivatives")
    J = jacobian(p, phi, foot.coordinates)
    J = np.array([[*p.vector(f"J{k}_x", row[:DIM]), *p.vector(f"J{k}_slope", row[DIM:2 * DIM]),
                   *p.vector(f"J{k}_chord", row[2 * DIM:3 * DIM]), p.define(f"J{k}_b", row[3 * DIM]),
                   *p.vector(f"J{k}_axis", row[3 * DIM + 1:])] for k, row in enumerate(J)], dtype=object)
    by = "x, the slope, the chord and b" if not turns else "x, the slope, the chord, b and the axis"
    p.output("phi", phi - np.array([0, 0, R]), "m", "a . x, u . x or t . x, |x| cos f - R")
    p.output("J", J, "1", f"derivatives by {by}")
    K = np.tril(jacobian(p, J.T.dot(f), foot.coordinates))
    p.output("K", K + np.tril(K, -1).T, "N/m", f"derivatives of J' f by {by}")
    return p


def motion(turns: bool = False) -> Program:
    """Return the kernel of the second rates of the conditions at zero accelerations; turns: the axis has a rate."""
    p = _program("turned_motion" if turns else "motion", "second rates of the conditions at zero accelerations")
    foot = _Foot(p, turns)
    rates = [*p.input("x_rate", DIM, "m/s", "rate of x"), *p.input("slope_rate", DIM, "1/s", "rate of the slope"),
             *p.input("chord_rate", DIM, "m/s", "rate of the chord"), p.input("b_rate", (), "m/s", "rate of b")]
    if turns:
        rates += [*p.input("axis_rate", DIM, "1/s", "rate of the axis")]
    dt = DirectionalDerivative(p, "dt", dict(zip(foot.coordinates, rates, strict=True)))
    phi = foot.conditions(p)
    p.stage("rates")
    rate = [p.define(f"rate_{k + 1}", dt(value)) for k, value in enumerate(phi)]
    p.output("Q_d", dt.array(np.array(rate)), "m/s^2", "second rates at zero accelerations of x, the slope, the chord"
             + (" and b" if not turns else ", b and the axis"))
    return p


def chord() -> Program:
    """Return the kernel of a point of an element of the span, and its derivatives by the length L of the span."""
    p = _program("chord", "point of an element of a span, and its derivatives by the length of the span")
    span = FlowingElement(ELEMENTS["cable12"])
    e = span.coordinates(p)
    length, at = p.input("l", (), "m", "length of the element"), p.input("s", (), "m", "distance from its first node")
    of_L = p.input("by_L", 2, "1", "derivatives of s and l by the length L of the span")
    p.stage("shape functions")
    w = p.define("w", 1 / length)
    xi = p.define("xi", at * w)
    first = span.element.is_position.index(True)
    N = np.array([p.define(f"N{k + 1}", length**power * sp.horner(shape.subs(along, xi))) if k != first else 0
                  for k, (shape, power) in enumerate(zip(span.unit_shapes, span.powers, strict=True))])
    dL = DirectionalDerivative(p, "dL", {at: of_L[0], length: of_L[1]})
    p.stage("derivatives by the length of the span")
    by_L = np.array([p.define(f"N{k + 1}_L", dL(value)) for k, value in enumerate(N)])
    twice = dL.array(by_L)
    beyond = [e[k] - e[first] if position else e[k] for k, position in enumerate(span.element.is_position)]
    d = np.array([p.vector(f"d{k + 1}", value) if k != first else 0 * value for k, value in enumerate(beyond)])
    for of, start in ((N, 1), (by_L, 0)):
        of[first] = start - sum(of[k] for k, position in enumerate(span.element.is_position) if position and k != first)
    p.output("N", N, "1, m", "derivatives of its place by the nodal vectors")
    p.output("N_L", by_L, "1/m, 1", "derivatives of N by L")
    others = [k for k in range(len(e)) if k != first]
    for name, shapes, unit, doc in (("r", N, "m", "place"), ("r_L", by_L, "1", "derivative of the place by L"),
                                    ("r_LL", twice, "1/m", "second derivative by L")):
        start = e[first] if name == "r" else 0 * e[first]
        p.output(name, start + sum(shapes[k] * d[k] for k in others), unit, doc)
    return p


def across() -> Program:
    """Return the kernel of the wrap's inertia and weight where its sheave moves along the axis: with the place w of the
    groove on the axis and the stress-free length l of the wrap, T = rho l w'^2/2 and V = -rho l g w.
    """
    p = _program("across", "inertia and weight of a wrap along the axis of its sheave")
    rho, length = p.input("rho", (), "kg/m", "mass of a length"), p.input("l", (), "m", "length s_b - s_a of the wrap")
    w, g = p.input("w", (), "m", "place on the axis"), p.input("g", (), "m/s^2", "gravity along the axis")
    w_rate = p.input("w_rate", (), "m/s", "rate of w")
    w_acc = p.input("w_acc", (), "m/s^2", "second rate of w")
    s_rate = p.input("s_rate", 2, "m/s", "rates of s_a and s_b")
    p.stage("energies")
    mass = p.define("mass", rho * length)
    T, V = p.define("kinetic", mass * w_rate**2 / 2), p.define("potential", -mass * g * w)
    p.stage("forces")
    momentum = p.define("momentum", jacobian(p, np.array([T]), [w_rate])[0, 0])
    of_motion = {w: w_rate, length: s_rate[1] - s_rate[0], w_rate: w_acc}
    T_w, T_l = jacobian(p, np.array([T - V]), [w, length])[0]
    force = np.array([p.define("on_w", DirectionalDerivative(p, "dt", of_motion)(momentum) - T_w),
                      p.define("on_a", T_l), p.define("on_b", -T_l)])
    p.output("T", [T], "J", "kinetic energy along the axis")
    p.output("V", [V], "J", "energy of gravity along the axis")
    p.output("f", force, "N", "forces on w, s_a, s_b")
    p.output("M", jacobian(p, force, [w_acc]), "kg", "derivatives of f by the second rate of w")
    p.output("D", jacobian(p, force, [w_rate, *s_rate]), "N s/m", "derivatives of f by rates of w, s_a, s_b")
    p.output("K", jacobian(p, force, [w, length]), "N/m", "derivatives of f by w and l")
    return p
