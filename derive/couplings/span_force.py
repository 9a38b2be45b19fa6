"""Forces on the material of a span: loads, and forces of a fluid, by its length.

A force F of a stress-free length acts on the material points of an element. It does work on their displacements at
constant S. These have the shape functions N, as the velocities do (span_inertia.py): with e_S, the nodal vectors of the
slope r_S,

    dr = sum N_k de_k - g_1 ds1 - g_2 ds2,   g_i = sum over the vectors of node i of N_k e_Sk,   r_S = g_1 + g_2.

A point of quadrature has a constant share xi of the length and a part of it as its weight. F may depend on place, slope
and velocity of the material there.

A force with a stored energy u of a stress-free length, as that of contact with a surface, follows from the sum of the
energy over the points: -d(part l u)/d(e, l). The energy of material that leaves a span in contact is then work on s.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ..codegen.program import DirectionalDerivative, Program
from ..spec import x
from .span_inertia import Flow, FlowingElement

SOURCE = "virtual work of the material at constant S"


def build(span: FlowingElement) -> list[Program]:
    """Return the kernels of forces on a span."""
    return [line_force(span), line_force_tangent(span), stored_force(span), stored_force_tangent(span), share(span),
            point_tangent(span)]


class _Point:
    """Inputs and stages of a point of quadrature: N, g."""

    def __init__(self, span: FlowingElement, p: Program, moves: bool):
        flow = Flow(p, span, moves=moves)
        xi = p.input("xi", (), "1", "(S - s1)/l")
        self.span, self.program, self.flow = span, p, flow
        self._more_inputs()
        flow.along()
        p.stage("shape functions")
        self.N = np.array([p.define(f"N{k + 1}", flow.l**power * sp.horner(shape.subs(x, xi)))
                           for k, (shape, power) in enumerate(zip(span.unit_shapes, span.powers, strict=True))])
        p.stage("displacements by the ends of the element")
        self.g = np.array([p.vector(f"g{i + 1}", sum(self.N[k] * flow.e_S[k] for k in nodal))
                           for i, nodal in enumerate(span.vectors_of)])

    def _more_inputs(self) -> None:
        """Declare further inputs."""

    def derive_motion(self) -> None:
        """Stage: derivatives of slope, place and velocity by the nodal vectors and by l, at a constant share."""
        p, flow, span = self.program, self.flow, self.span
        p.stage("derivatives of place, slope and velocity of the material")
        S = span.slope_matrix(p, flow.w)
        self.g_e = np.array([[p.define(f"g{i + 1}_{k + 1}", sum(self.N[j] * S[j, k] for j in nodal))
                              for k in range(len(S))] for i, nodal in enumerate(span.vectors_of)])
        self.past = [p.define(f"past{k + 1}", flow.s_rate.dot(self.g_e[:, k])) for k in range(len(S))]
        of_slopes = dict(zip(flow.e_S.ravel(), flow.e_Sl.ravel(), strict=True))
        self.by_l = DirectionalDerivative(p, "dl", {flow.l: 1, **of_slopes})
        self.g_l = np.array([p.vector(f"g{i + 1}_l", self.by_l.array(g)) for i, g in enumerate(self.g)])
        self.r_l = p.vector("r_l", self.by_l.array(self.N).dot(flow.e))
        self.v_l = p.vector("v_l", self.by_l.array(self.N).dot(flow.v) - flow.s_rate.dot(self.g_l))


class _Line(_Point):
    """The same, with a force there, and l times the part."""

    def __init__(self, span: FlowingElement, p: Program, moves: bool):
        part = p.input("part", (), "1", "weight of the point of quadrature: part of the length")
        super().__init__(span, p, moves)
        self.weight = p.define("weight", part * self.flow.l)

    def _more_inputs(self) -> None:
        self.F = self.program.input("F", self.span.element.dim, "N/m", "force of a stress-free length")


def line_force(span: FlowingElement) -> Program:
    """Return the kernel of the generalised forces."""
    p = span.program("line_force", "generalised forces of a force on the material", SOURCE)
    at = _Line(span, p, moves=False)
    p.output("f", np.outer(at.weight * at.N, at.F), "N, N m", "forces on the nodal vectors")
    p.output("f_s", [-at.weight * g.dot(at.F) for g in at.g], "N", "forces on s1, s2")
    return p


def line_force_tangent(span: FlowingElement) -> Program:
    """Return the kernel of the derivatives of the generalised forces, at a constant share of the length."""
    p = span.program("line_force_tangent", "derivatives of the generalised forces of a force on the material", SOURCE)
    at = _Line(span, p, moves=True)
    dim = span.element.dim
    by_r, by_r_S, by_v = (p.input(f"F_{name}", (dim, dim), f"N/m by {unit}", f"derivatives of F by {doc}")
                          for name, unit, doc in (("r", "m", "the place"), ("t", "1", "the slope"),
                                                  ("v", "m/s", "the velocity of the material")))
    at.derive_motion()
    g_e, g_l, by_l = at.g_e, at.g_l, at.by_l
    p.stage("derivatives of the force")
    of_e = np.array([_named(p, f"F_e{k + 1}", at.N[k] * by_r + g_e[:, k].sum() * by_r_S - at.past[k] * by_v)
                     for k in range(len(at.N))])
    of_v = np.array([_named(p, f"F_v{k + 1}", n * by_v) for k, n in enumerate(at.N)])
    of_l = p.vector("F_l", by_r.dot(at.r_l) + by_r_S.dot(g_l.sum(axis=0)) + by_v.dot(at.v_l))
    of_s = np.array([p.vector(f"F_s{i + 1}", -by_v.dot(g)) for i, g in enumerate(at.g)])
    p.stage("derivatives of the generalised forces")
    scaled = np.array([p.define(f"scaled{k + 1}", at.weight * n) for k, n in enumerate(at.N)])
    lever = np.array([p.vector(f"lever{i + 1}", -at.weight * g) for i, g in enumerate(at.g)])
    over_e, over_v = (np.hstack(list(blocks)) for blocks in (of_e, of_v))
    turned = -np.array([np.outer(at.weight * row, at.F).ravel() for row in g_e])
    p.output("D", np.hstack([_on_all(scaled, lever, over_v), _on_all(scaled, lever, of_s.T)]), "SI",
             "derivatives of f and f_s by rates of e, s1, s2")
    K_l = _on_all(scaled, lever, of_l[:, None])[:, 0] + np.concatenate(
        [np.outer(by_l.array(scaled), at.F).ravel(), by_l.array(lever).dot(at.F)])
    K_e = _on_all(scaled, lever, over_e)
    K_e[-len(turned):] += turned
    p.output("K", np.hstack([K_e, K_l[:, None]]), "SI", "derivatives of f and f_s by e and l")
    return p


def _named(p: Program, name: str, matrix: np.ndarray) -> np.ndarray:
    """Return a matrix with its rows named."""
    return np.array([p.vector(f"{name}{i + 1}", row) for i, row in enumerate(matrix)])


def _on_all(scaled: np.ndarray, lever: np.ndarray, of: np.ndarray) -> Any:
    """Return the generalised forces on e and s1, s2 of forces, the columns of a matrix (dim, n)."""
    return np.vstack([*(n * of for n in scaled), lever.dot(of)])


class _Stored:
    """Inputs and stages of a point of quadrature with a stored energy: l times the part, N, and dr/dl."""

    def __init__(self, span: FlowingElement, p: Program, has_energy: bool):
        self.part = p.input("part", (), "1", "weight of the point of quadrature: part of the length")
        self.l, self.e = p.input("l", (), "m", "length s2 - s1 of the element"), span.coordinates(p)
        xi = p.input("xi", (), "1", "(S - s1)/l")
        self.u = p.input("u", (), "J/m", "stored energy of a stress-free length") if has_energy else None
        self.F = p.input("F", span.element.dim, "N/m", "minus its derivative by the place")
        p.stage("shape functions")
        self.N = np.array([p.define(f"N{k + 1}", self.l**power * sp.horner(shape.subs(x, xi)))
                           for k, (shape, power) in enumerate(zip(span.unit_shapes, span.powers, strict=True))])
        self.by_l = DirectionalDerivative(p, "dl", {self.l: 1})
        self.N_l = self.by_l.array(self.N)
        p.stage("derivative of the place by the length, and weight")
        self.r_l = p.vector("r_l", self.N_l.dot(self.e))
        self.weight = p.define("weight", self.part * self.l)


def stored_force(span: FlowingElement) -> Program:
    """Return the kernel of the generalised forces of a stored energy."""
    p = span.program("stored_force", "generalised forces of a stored energy of the material", SOURCE)
    at = _Stored(span, p, has_energy=True)
    p.output("f", np.outer(at.weight * at.N, at.F), "N, N m", "forces on the nodal vectors")
    p.output("f_l", [at.weight * at.F.dot(at.r_l) - at.part * at.u], "N", "force on l")
    return p


def stored_force_tangent(span: FlowingElement) -> Program:
    """Return the kernel of the derivatives of these forces."""
    p = span.program("stored_force_tangent", "derivatives of the generalised forces of a stored energy", SOURCE)
    at = _Stored(span, p, has_energy=False)
    dim = span.element.dim
    H = p.input("H", (dim, dim), "N/m^2", "derivatives of F by the place, symmetric")
    p.stage("derivatives")
    H_l = p.vector("H_l", H.dot(at.r_l))
    twice = p.define("twice", 2 * at.F.dot(at.r_l))
    r_ll = at.by_l.array(at.N_l).dot(at.e)
    scaled = np.array([p.define(f"scaled{k + 1}", at.weight * n) for k, n in enumerate(at.N)])
    products = {(j, k): p.define(f"N{j + 1}N{k + 1}", scaled[j] * at.N[k])
                for j in range(len(scaled)) for k in range(j, len(scaled))}
    squares = np.array([[products[min(j, k), max(j, k)] for k in range(len(scaled))] for j in range(len(scaled))])
    p.output("K", np.kron(squares, H), "N/m, N, N m", "derivatives of f by e")
    p.output("K_l", np.outer(at.by_l.array(scaled), at.F) + np.outer(scaled, H_l), "N/m, N",
             "derivatives of f by l")
    p.output("K_ll", [at.part * twice + at.weight * (H_l.dot(at.r_l) + at.F.dot(r_ll))], "N/m",
             "derivative of f_l by l")
    return p


def share(span: FlowingElement) -> Program:
    """Return the kernel of the share of a material point in the length, and its derivatives."""
    p = span.program("share", "share of a material point in the length of an element", SOURCE)
    at, ends = p.input("at", (), "m", "material coordinate"), p.input("ends", 2, "m", "s1, s2")
    p.stage("share")
    inverse = p.define("inv_l", 1 / p.define("l", ends[1] - ends[0]))
    xi = p.define("xi", (at - ends[0]) * inverse)
    p.output("share", [xi], "1", "(S - s1)/l")
    p.output("share_s", [DirectionalDerivative(p, f"d{i + 1}", {end: 1})(xi) for i, end in enumerate(ends)], "1/m",
             "derivatives by s1, s2")
    return p


def point_tangent(span: FlowingElement) -> Program:
    """Return the kernel of the derivatives of place and velocity of the material, at a constant share of the length."""
    p = span.program("point_tangent", "derivatives of place and velocity of the material at a constant share", SOURCE)
    at = _Point(span, p, moves=True)
    at.derive_motion()
    dim = span.element.dim
    unit = np.eye(dim, dtype=int)
    p.output("r_q", np.hstack([np.kron(at.N, unit), at.r_l[:, None]]), "1, m", "derivatives of the place by e and l")
    p.output("v_q", np.hstack([-np.kron(np.array(at.past), unit), at.v_l[:, None]]), "1/s",
             "derivatives of the velocity by e and l")
    p.output("v_v", np.hstack([np.kron(at.N, unit), -at.g.T]), "1, m", "derivatives of the velocity by rates")
    return p
