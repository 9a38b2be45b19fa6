"""Forces of a kinetic energy that moves with the material of a span, as that of a fluid around it (added_mass.py).

The energy T of a stress-free length depends on place r, slope t and velocity v of the material. On the element it is
the sum over points of quadrature at constant shares xi of part l T. Lagrange's equations of (e, s1, s2) follow by the
chain rule: with T_r, T_t, T_v, and x the rate (l T_v)'/l at the point, less a force on the material, with the velocity
v = sum N_k e_k' - g_1 s1' - g_2 s2' and the slope t = sum h_k e_k (span_force.py), the sign -1 of s1 and 1 of s2,

    f_k = part l (N_k (x - T_r) + (N_k' - v_ek) T_v - h_k T_t),
    f_s = part l (-g . x - (g' + sign v_l) . T_v - sign (r_l . T_r + t_l . T_t + T/l)),

where ' is a rate at a constant share. A span has no energy T beyond its ends: where material leaves it, the last term
returns T.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ..codegen.program import DirectionalDerivative, Program
from .span_force import _Point
from .span_inertia import SIGN, FlowingElement

SOURCE = "Lagrange's equations with moving nodes"


def build(span: FlowingElement) -> list[Program]:
    """Return the kernels of the motion at a point, and of the forces."""
    return [motion(span), kinetic_force(span), kinetic_force_tangent(span)]


class _Moving(_Point):
    """Inputs and stages of a point of quadrature that moves past the material, and rates at a constant share."""

    def __init__(self, span: FlowingElement, p: Program, accelerates: bool):
        self.accelerates = accelerates
        super().__init__(span, p, moves=True)
        flow = self.flow
        self.derive_motion()
        p.stage("rates at a constant share")
        self.l_rate = p.define("l_rate", flow.s_rate[1] - flow.s_rate[0])
        along, _ = span.along(p, "v", flow.v, flow.w)
        rates = {flow.l: self.l_rate} | dict(zip(flow.e_S.ravel(), (along + self.l_rate * flow.e_Sl).ravel(),
                                                 strict=True))
        rate = DirectionalDerivative(p, "dt", rates)
        self.N_l = self.by_l.array(self.N)
        self.N_rate = self.l_rate * self.N_l
        self.g_rate = np.array([p.vector(f"g{i + 1}_rate", rate.array(g)) for i, g in enumerate(self.g)])
        self.h = np.array([p.define(f"h{k + 1}", value) for k, value in enumerate(self.g_e.sum(axis=0))])
        self.t_l = p.vector("t_l", self.g_l.sum(axis=0))
        self.W = p.define("W", self.part * flow.l) if self.part is not None else sp.S.Zero

    def _more_inputs(self) -> None:
        p, flow, span = self.program, self.flow, self.span
        self.part: Any = None
        if self.accelerates:
            flow.a = span.coordinates(p, "a", "m/s^2, 1/s^2", "accelerations of the nodal vectors")
            flow.s_acc = p.input("s_acc", 2, "m/s^2", "second rates of s1, s2")


class _Forced(_Moving):
    """The same with the weight of the point, and the energy's derivatives."""

    def _more_inputs(self) -> None:
        super()._more_inputs()
        p, dim = self.program, self.span.element.dim
        self.part = p.input("part", (), "1", "weight of the point of quadrature: part of the length")
        self.T_r, self.T_t, self.T_v = (p.input(f"T_{key}", dim, unit, f"derivative of T by the {doc}") for
                                        key, unit, doc in (("r", "N/m", "place"), ("t", "N", "slope"),
                                                           ("v", "kg/s", "velocity of the material")))
        self.rate = p.input("rate", dim, "N/m", "(l T_v)'/l at the point, less a force on the material")

    def derive_forces(self) -> None:
        """Stage: factors of T_v in the forces."""
        p = self.program
        p.stage("factors of the impulse")
        self.drift = np.array([p.define(f"drift{k + 1}", n + past)
                               for k, (n, past) in enumerate(zip(self.N_rate, self.past, strict=True))])
        self.turn = np.array([p.vector(f"turn{i + 1}", -g - sign * self.v_l)
                              for i, (g, sign) in enumerate(zip(self.g_rate, SIGN, strict=True))])


def motion(span: FlowingElement) -> Program:
    """Return the kernel of the motion of the material at a constant share of the length."""
    p = span.program("motion", "motion of the material at a constant share of the length", SOURCE)
    at = _Moving(span, p, accelerates=True)
    flow = at.flow
    p.output("r", at.N.dot(flow.e), "m", "place")
    p.output("r_S", at.g.sum(axis=0), "1", "slope dr/dS")
    p.output("velocity", at.N.dot(flow.v) - flow.s_rate.dot(at.g), "m/s", "velocity of the material point")
    p.output("slope_rate", at.g_rate.sum(axis=0), "1/s", "rate of the slope")
    p.output("place_rate", at.N.dot(flow.v) + at.l_rate * at.r_l, "m/s", "rate of the place")
    p.output("velocity_rate", at.N.dot(flow.a) + at.N_rate.dot(flow.v) - flow.s_acc.dot(at.g)
             - flow.s_rate.dot(at.g_rate), "m/s^2", "rate of the velocity")
    p.output("growth", [at.l_rate * flow.w], "1/s", "l'/l")
    return p


def kinetic_force(span: FlowingElement) -> Program:
    """Return the kernel of the generalised forces."""
    p = span.program("kinetic_force", "generalised forces of a kinetic energy of the material", SOURCE)
    at = _Forced(span, p, accelerates=False)
    T = p.input("T", (), "J/m", "kinetic energy of a stress-free length")
    at.derive_forces()
    p.stage("generalised forces")
    on_place = p.vector("on_place", at.rate - at.T_r)
    on_length = p.define("on_length", at.W * (at.r_l.dot(at.T_r) + at.t_l.dot(at.T_t)) + at.part * T)
    p.output("f", at.W * (np.outer(at.N, on_place) + np.outer(at.drift, at.T_v) - np.outer(at.h, at.T_t)), "N, N m",
             "forces on the nodal vectors, on the left side of the equations of motion")
    p.output("f_s", [at.W * (turn.dot(at.T_v) - g.dot(at.rate)) - sign * on_length
                     for g, turn, sign in zip(at.g, at.turn, SIGN, strict=True)], "N", "forces on s1, s2")
    return p


def kinetic_force_tangent(span: FlowingElement) -> Program:
    """Return the kernel of the derivatives of the generalised forces, at a constant share of the length."""
    p = span.program("kinetic_force_tangent", "derivatives of the generalised forces of a kinetic energy", SOURCE)
    at = _Forced(span, p, accelerates=True)
    dim = span.element.dim
    H = p.input("second", (3 * dim, 3 * dim), "SI", "derivatives of T_r, T_t, T_v by place, slope, velocity")
    X = p.input("rate_by", (dim, 6 * dim), "SI", "derivatives of the rate by place, slope, velocity, and by the rates "
                                                 "of slope, place and velocity")
    at.derive_forces()
    changes = _Changes(at, H, X)
    p.stage("derivatives by rates")
    D = np.hstack([*map(changes.by_rate_of_vector, range(len(at.N))), *map(changes.by_rate_of_end, range(2))])
    p.stage("derivatives by the configuration")
    K = np.hstack([*map(changes.by_vector, range(len(at.N))), changes.by_length()])
    p.output("D", D, "SI", "derivatives of f and f_s by rates of e, s1, s2")
    p.output("K", K, "SI", "derivatives of f and f_s by e and l")
    return p


class _Changes:
    """Changes of the generalised forces by changes of coordinates and rates, columns of matrices."""

    def __init__(self, at: _Forced, H: np.ndarray, X: np.ndarray):
        self.at, self.dim = at, at.span.element.dim
        self.one = np.eye(self.dim, dtype=int)
        self.H, self.X = H, X
        self.by_l = at.by_l
        self.g_el, self.h_l = (self.by_l.array(values) for values in (at.g_e, at.h))

    def by_vector(self, k: int) -> np.ndarray:
        """Return the changes by a nodal vector."""
        at, flow, one = self.at, self.at.flow, self.one
        past_l = flow.s_rate.dot(self.g_el[:, k])
        velocity_rate = -flow.s_acc.dot(at.g_e[:, k]) - at.l_rate * past_l
        motion = [at.N[k], at.h[k], -at.past[k], at.l_rate * self.h_l[k], at.l_rate * at.N_l[k], velocity_rate]
        turn = [sign * past_l - at.l_rate * g_el for sign, g_el in zip(SIGN, self.g_el[:, k], strict=True)]
        return self._forces(f"e{k + 1}", [value * one for value in motion], turn=[value * one for value in turn],
                            g=[value * one for value in at.g_e[:, k]], r_l=at.N_l[k] * one, t_l=self.h_l[k] * one)

    def by_rate_of_vector(self, k: int) -> np.ndarray:
        """Return the changes by the rate of a nodal vector."""
        at, one = self.at, self.one
        motion = [0, 0, at.N[k], at.h[k], at.N[k], at.N_rate[k] - at.past[k]]
        turn = [-g_e - sign * at.N_l[k] for sign, g_e in zip(SIGN, at.g_e[:, k], strict=True)]
        return self._forces(f"v{k + 1}", [value * one for value in motion], turn=[value * one for value in turn])

    def by_rate_of_end(self, j: int) -> np.ndarray:
        """Return the changes by the rate of s1 or s2."""
        at, sign = self.at, SIGN[j]
        zero = 0 * at.r_l
        motion = [zero, zero, -at.g[j], sign * at.t_l, sign * at.r_l, sign * at.v_l - at.g_rate[j]]
        turn = [other * at.g_l[j] - sign * g_l for other, g_l in zip(SIGN, at.g_l, strict=True)]
        return self._forces(f"s{j + 1}", [value[:, None] for value in motion], sign * at.flow.w,
                            turn=[value[:, None] for value in turn], drift=sign * at.N_l + at.g_e[j])

    def by_length(self) -> np.ndarray:
        """Return the changes by l."""
        at, flow, by_l = self.at, self.at.flow, self.by_l.array
        velocity_rate = by_l(at.N_rate).dot(flow.v) + at.N_l.dot(flow.a) - flow.s_acc.dot(at.g_l) - flow.s_rate.dot(
            by_l(at.g_rate))
        motion = [at.r_l, at.t_l, at.v_l, by_l(at.g_rate.sum(axis=0)), at.N_l.dot(flow.v) + at.l_rate * by_l(at.r_l),
                  velocity_rate]
        g, turn = (list(by_l(values)[..., None]) for values in (at.g, at.turn))
        return self._forces("l", [value[:, None] for value in motion], -at.l_rate * flow.w**2, self.by_l(at.W),
                            by_l(at.N), by_l(at.drift), by_l(at.h), g, turn, by_l(at.r_l)[:, None],
                            by_l(at.t_l)[:, None])

    def _forces(self, name: str, motion: list[np.ndarray], growth: Any = 0, W: Any = 0, N: Any = None,
                drift: Any = None, h: Any = None, g: Any = None, turn: Any = None, r_l: Any = 0, t_l: Any = 0
                ) -> np.ndarray:
        """Return the changes of f and f_s, by those of place, slope and velocity, of their rates (slope first), and of
        the factors.
        """
        at, p = self.at, self.at.program
        none, still = np.zeros(len(at.N), dtype=int), [0 * motion[0]] * len(at.g)
        N, drift, h = (none if value is None else value for value in (N, drift, h))
        g, turn = (still if value is None else value for value in (g, turn))
        place, slope, velocity = motion[:3]
        energy = self.H.dot(np.vstack(motion[:3])).reshape(3, self.dim, -1)
        T_r, T_t, T_v = (self._named(f"{name}_T{key}", value) for key, value in zip("rtv", energy, strict=True))
        rate = self._named(f"{name}_x", self.X.dot(np.vstack(motion)) + np.multiply.outer(at.T_v, growth).reshape(
            self.dim, -1))
        on_place, still_place = rate - T_r, at.rate - at.T_r
        rows = []
        for k in range(len(at.N)):
            value = at.W * (at.N[k] * on_place + at.drift[k] * T_v - at.h[k] * T_t)
            factors = [W * old + at.W * new for old, new in ((at.N[k], N[k]), (at.drift[k], drift[k]), (at.h[k], h[k]))]
            steady = factors[0] * still_place + factors[1] * at.T_v - factors[2] * at.T_t
            rows.append(value + steady[:, None] if value.shape[1] == 1 else value)
        T = at.part * (at.T_r.dot(place) + at.T_t.dot(slope) + at.T_v.dot(velocity))
        on_length = T + at.W * (at.r_l.dot(T_r) + at.t_l.dot(T_t) + at.T_r.dot(r_l + 0 * place) + at.T_t.dot(
            t_l + 0 * place)) + W * (at.r_l.dot(at.T_r) + at.t_l.dot(at.T_t))
        on_length = np.array([p.define(f"{name}_length{j + 1}", value) for j, value in enumerate(on_length)])
        for i, sign in enumerate(SIGN):
            value = at.turn[i].dot(T_v) - at.g[i].dot(rate) + at.T_v.dot(turn[i]) - at.rate.dot(g[i])
            steady = W * (at.turn[i].dot(at.T_v) - at.g[i].dot(at.rate))
            rows.append((at.W * value + steady - sign * on_length)[None])
        return np.vstack(rows)

    def _named(self, name: str, matrix: np.ndarray) -> np.ndarray:
        return np.array([self.at.program.vector(f"{name}{j + 1}", column) for j, column in enumerate(matrix.T)]).T
