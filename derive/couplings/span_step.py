"""A span of a rope over a step that conserves energy: its momentum (material_step.py), and a discrete gradient of its
elastic energy U_m + U_b of stretching and bending.

With the strain vectors c of e and l, U_m = l u_m(c) and U_b = u_b(c)/l. With means ~ and changes d,

    dU = l~ du_m + (1/l)~ du_b + u_m~ dl + u_b~ d(1/l).

The law's discrete gradient is B c~ with scalars B over the strain vectors. These are c = g/l with g linear in the nodal
vectors of unit length, positions and l r_x; so the first two terms are

    d(g.B g/l^2)/2 = (1/l^2)~ g~.B dg + (g.B g)~ d(1/l^2)/2.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import sympy as sp

from ..algebra.discrete_gradient import STATES
from ..algebra.gram import Gram
from ..codegen.program import Program
from ..laws import law_class
from ..spec import Element, x
from .material_step import SOURCE, Step, at_point, gauss, on_slope
from .span_inertia import Flow, FlowingElement

POINTS = 4
"""Gauss points of the momentum of an element: exact for the square of a cubic, and for its product with the flow."""


class ElasticElement(FlowingElement):
    """An element whose ends flow along the rope, with a law."""

    def __init__(self, element: Element, law: str):
        super().__init__(element)
        self.gram = Gram(element)
        self.law = law_class(law)(self.gram)


def kernels(span: ElasticElement) -> list[Program]:
    """Return the kernels of a span over a step."""
    return [momentum(span), momentum_energy(span), momentum_step(span), elastic_step(span)]


def _shapes(span: ElasticElement, at: sp.Expr) -> tuple[np.ndarray, np.ndarray]:
    """Return the shape functions of the element of unit length and their derivatives at a point."""
    values = [[sp.sympify(f.subs(x, at)) for f in functions]
              for functions in (span.unit_shapes, [sp.diff(n, x) for n in span.unit_shapes])]
    return np.array(values[0], dtype=object), np.array(values[1], dtype=object)


def _along(span: ElasticElement, N_xi: np.ndarray, vectors: Sequence[np.ndarray]) -> np.ndarray:
    """Return the derivative by xi of nodal vectors of unit length, through differences of positions."""
    first = span.element.is_position.index(True)
    return np.asarray(sum(n * (v - vectors[first] if position else v) for k, (n, v, position) in enumerate(
        zip(N_xi, vectors, span.element.is_position, strict=True)) if k != first))


def momentum(span: ElasticElement) -> Program:
    """Return the kernel of the momentum at the points, over the mass of a length: l u."""
    p = span.program("momentum", "momentum of the material at the points of a step, over the mass of a length")
    flow = Flow(p, span)
    flow.velocities()
    p.stage("velocities of the material")
    scaled = [p.vector(f"scaled{k + 1}", u * flow.l ** (1 + power))
              for k, (u, power) in enumerate(zip(flow.u, span.powers, strict=True))]
    P = [sum(n * u for n, u in zip(_shapes(span, xi)[0], scaled, strict=True)) for xi, _ in gauss(POINTS)]
    p.output("P", np.array(P), "m^2/s", "l u at the points")
    return p


def momentum_energy(span: ElasticElement) -> Program:
    """Return the kernel of the kinetic energy of momenta at the points."""
    p = span.program("momentum_energy", "kinetic energy of the momentum at the points of a step", SOURCE)
    rho, length = p.input("rho", (), "kg/m", "mass of a length"), p.input("l", (), "m", "length s2 - s1 of the element")
    P = p.input("P", (POINTS, span.element.dim), "m^2/s", "momentum l u at the points")
    p.stage("kinetic energy")
    square = sum(weight * at.dot(at) for (_, weight), at in zip(gauss(POINTS), P, strict=True))
    p.output("T", [rho * square / (2 * length)], "J", "kinetic energy")
    return p


def momentum_step(span: ElasticElement) -> Program:
    """Return the kernel of the inertial forces over a step, and the momentum at its end."""
    p = span.program("momentum_step", "inertial forces over a step that conserves energy", SOURCE)
    step = Step.of(p)
    e = span.coordinates(p, doc="nodal vectors at the start of the step")
    change = span.coordinates(p, "e_change", doc="changes of the nodal vectors over the step")
    P = p.input("P", (POINTS, span.element.dim), "m^2/s", "momentum l u at the points at the start of the step")
    p.stage("nodal vectors of unit length")
    first = span.element.is_position.index(True)
    middle, means, changes = [], [], []  # positions from the first one: far from the origin they keep their digits
    for k, power in enumerate(span.powers):
        ends = (e[k], e[k] + change[k]) if power else (e[k] - e[first], e[k] - e[first] + change[k] - change[first])
        middle.append(p.vector(f"middle{k + 1}", ends[0] + (change[k] if power else change[k] - change[first]) / 2))
        means.append(p.vector(f"mean{k + 1}", (step.l[0] * ends[0] + step.l[1] * ends[1]) / 2) if power else middle[k])
        changes.append(p.vector(f"change{k + 1}", step.mean * change[k] + (step.l[1] - step.l[0]) * middle[k]) if power
                       else change[k])
    p.stage("forces at the points")
    f, on_s, after = np.zeros(e.shape, dtype=object), np.zeros(2, dtype=object), []
    for g, (xi, weight) in enumerate(gauss(POINTS)):
        N, N_xi = _shapes(span, xi)
        forces = at_point(p, f"_{g}", step, xi, N.dot(changes), _along(span, N_xi, means),
                          _along(span, N_xi, changes), P[g])
        on_place = p.vector(f"on_place_{g}", weight * forces.on_place)
        on_slope_g = p.vector(f"on_slope_{g}", weight * forces.on_slope)
        f = f + np.outer(N, on_place) + np.outer(N_xi, on_slope_g)
        on_s = on_s + weight * forces.on_s
        after.append(forces.P)
    f, by_length = _on_nodes(p, span, f, middle, change, step.l, step.mean)
    p.output("f", f, "N, N m", "forces on the nodal vectors")
    p.output("f_s", on_s + by_length * np.array([-1, 1]), "N", "forces on s1, s2")
    p.output("P_next", np.array(after), "m^2/s", "momentum l u at the points at the end of the step")
    return p


def _on_nodes(p: Program, span: ElasticElement, f: np.ndarray, middle: Sequence[np.ndarray], change: np.ndarray,
              l: Sequence[Any], mean: Any) -> tuple[np.ndarray, Any]:
    """Stage: the forces on the nodal vectors, with these means and changes, and on l of forces on those of unit length.
    """
    p.stage("forces on the nodal vectors")
    found, on_length = [], sp.S.Zero
    for k, power in enumerate(span.powers):
        row = p.vector(f"unit{k + 1}", f[k])
        if power:
            row, part = on_slope(p, f"{k + 1}", row, middle[k], change[k], l, mean)
            on_length += part
        found.append(row)
    return np.array(found), on_length


def elastic_step(span: ElasticElement) -> Program:
    """Return the kernel of a discrete gradient of the elastic energy by e and l."""
    p = span.program("elastic_step", "discrete gradient of the elastic energy over a step", span.law.source)
    now = p.input("l", (), "m", "length of the element at the start of the step")
    following = p.input("l_next", (), "m", "length at the end of the step")
    e = [span.coordinates(p, doc="nodal vectors at the start of the step"),
         span.coordinates(p, "e_next", doc="nodal vectors at the end of the step")]
    A = span.law.constants(p)
    stretching = p.input("U_m", 2, "J", "energy of stretching at both ends of the step")
    bending = p.input("U_b", 2, "J", "energy of bending at both ends of the step")
    p.stage("strain vectors at both ends of the step")
    ends = [now, following]
    w = [p.define("w", 1 / now), p.define("w_next", 1 / following)]
    c = [span.gram.of_chords(p, span.gram.chords(p, vectors, inverse, tag), f"{state}_")
         for vectors, inverse, tag, state in zip(e, w, ("", "_next"), STATES, strict=True)]
    mean, w_mean = p.define("l_mean", (now + following) / 2), p.define("w_mean", (w[0] + w[1]) / 2)
    step = A.copy()
    step[1] = p.define("EI_step", A[1] * w_mean * mean)
    apply = span.law.discrete_product(p, step, *c, p.define("w_step", 1 / mean))
    unit = [[length * vector for vector in vectors] for length, vectors in zip(ends, c, strict=True)]
    mean_square = p.define("w2_mean", (w[0] ** 2 + w[1] ** 2) / 2)
    on_unit = apply("mean", np.array([p.vector(f"unit_{name}", mean_square * (a + b) / 2)
                                      for name, a, b in zip(span.gram.names, *unit, strict=True)]))
    products = [sum(a.dot(b) for a, b in zip(apply(state, np.array(vectors)), vectors, strict=True)) * length**2
                for state, vectors, length in zip(STATES, c, ends, strict=True)]
    f = span.gram.nodal_forces(p, on_unit, sp.S.One)
    middle = [p.vector(f"middle{k + 1}", (a + b) / 2) for k, (a, b) in enumerate(zip(*e, strict=True))]
    change = np.array([p.vector(f"change{k + 1}", b - a) for k, (a, b) in enumerate(zip(*e, strict=True))])
    f, on_length = _on_nodes(p, span, f, middle, change, ends, mean)
    u_m = (stretching[0] * w[0] + stretching[1] * w[1]) / 2
    u_b = (bending[0] * now + bending[1] * following) / 2
    both = w[0] * w[1]
    p.output("f", f, "N, N m", "discrete derivatives by e")
    p.output("f_l", [u_m - u_b * both - w_mean * both * (products[0] + products[1]) / 2 + on_length], "N",
             "discrete derivative by l")
    return p
