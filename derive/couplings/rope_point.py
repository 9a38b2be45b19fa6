"""A material point of a rope in a span, to which joints and springs hold.

The material coordinate S of the point is constant. The nodes of its element have the shares a and b of the length
L = s2 - s1 of the span, so that in the element

    r = N(x; l) e,   x = S - s1 - a L,   l = (b - a) L.

The point moves with the nodal vectors e and with the coordinates s1, s2 of the span. At the nodes of elements r and its
first derivatives are continuous. The frame at a slide moves along the rope: its slope t = N_x e has S as a coordinate,
too.

Over a step that conserves energy, with means ~ and changes d, and differences D of the shape functions by s1, s2,

    r_next - r = N~ de + D e~ ds,   (r_next + r)/2 = N~ e~ + y/4,   y = D ds de.

A force f with the factors N~ on e has the arm N~ e~, and misses the couple y x f/4 of the mean place. In the plane this
acts on the slope t = D_x e with the divided difference D_x by the place: forces D_x k x t~/|t~|^2 on e, whose work is
subtracted from that on s1, s2. In space a straight rope cannot take its part along the rope: it is left out, and the
angular momentum has an error of order h^2 where the rope flows past the point.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ..algebra.discrete_axis import DiscreteShapes, middle_and_change
from ..algebra.tangent_frame import cross
from ..codegen.family import CouplingFamily
from ..codegen.program import DirectionalDerivative, Program
from ..elements import ELEMENTS
from ..spec import x as along
from .span_inertia import FlowingElement

NAMES = {2: "planar_rope_point", 3: "rope_point"}
ELEMENT = {2: "cable8p", 3: "cable12"}
SOURCE = "shape functions of an element whose ends flow along the rope"


def families() -> list[CouplingFamily]:
    """Return the families of points of ropes in the plane and in space."""
    return CouplingFamily.each("rope_point", "material point of a rope", NAMES, build)


def build(dim: int) -> list[Program]:
    """Return the kernels of a point."""
    return [point(dim), wrench(dim), discrete_point(dim), slope(dim), slope_stiffness(dim)]


class _Point:
    """Inputs and stages: shape functions, less those of the first node, over the span's coordinates e, s1, s2.

    of_slope: of r_x at a place that moves: S is the last coordinate.
    """

    def __init__(self, p: Program, dim: int, of_slope: bool = False):
        span = FlowingElement(ELEMENTS[ELEMENT[dim]])
        self.program, self.positions = p, span.element.is_position
        self.e = span.coordinates(p)
        self.v = span.coordinates(p, "v", "m/s, 1/s", "rates of the nodal vectors")
        self.s = p.input("s", 2, "m", "material coordinates s1, s2 of the ends of the span")
        self.s_rate = p.input("s_rate", 2, "m/s", "rates of s1, s2")
        share = p.input("share", 2, "1", "shares a, b of the nodes in the length of the span")
        S = p.input("S", (), "m", "material coordinate of the point")
        along_rope = {S: p.input("S_rate", (), "m/s", "rate of S")} if of_slope else {}
        self.first = self.positions.index(True)
        self.others = [k for k in range(len(self.positions)) if k != self.first]
        p.stage("shape functions")
        L = p.define("L", self.s[1] - self.s[0])
        l = p.define("l", (share[1] - share[0]) * L)
        xi = p.define("xi", (S - self.s[0] - share[0] * L) * p.define("w", 1 / l))
        shapes = [(sp.diff(shape, along), power - 1) if of_slope else (shape, power)
                  for shape, power in zip(span.unit_shapes, span.powers, strict=True)]
        self.N = np.array([0 if k == self.first else p.define(f"N{k + 1}", l**power * sp.horner(shape.subs(along, xi)))
                           for k, (shape, power) in enumerate(shapes)])
        self.ends = [DirectionalDerivative(p, f"d{i + 1}", {symbol: 1})
                     for i, symbol in enumerate([*self.s, *along_rope])]
        self.time = DirectionalDerivative(p, "dt", dict(zip(self.s, self.s_rate, strict=True)) | along_rope)
        p.stage("differences from the first node")
        self.d, self.d_rate = (np.array([p.vector(f"{name}{k + 1}", vectors[k] - vectors[self.first])
                                         if position and k != self.first else vectors[k]
                                         for k, position in enumerate(self.positions)])
                               for name, vectors in (("d", self.e), ("d_rate", self.v)))

    def named(self, name: str, values: np.ndarray) -> np.ndarray:
        """Return derivatives of the shape functions with names."""
        return np.array([self.program.define(f"{name}{k + 1}", value) for k, value in enumerate(values)])

    def sum(self, shapes: np.ndarray, vectors: np.ndarray) -> np.ndarray:
        """Return the sum over the differences from the first node."""
        total: np.ndarray = sum((shapes[k] * vectors[k] for k in self.others), 0 * vectors[0])
        return total

    def of_all(self, shapes: np.ndarray, whole: int) -> np.ndarray:
        """Return shape functions or their derivatives with that of the first node; whole: the sum of positions."""
        found = shapes.copy()
        found[self.first] = whole - sum(shapes[k] for k in self.others if self.positions[k])
        return found


def _program(dim: int, kernel: str, doc: str, of_slope: bool = False) -> tuple[Program, _Point]:
    p = Program(f"{NAMES[dim]}_{kernel}", doc, SOURCE)
    return p, _Point(p, dim, of_slope)


def _over_coordinates(dim: int, shapes: np.ndarray, by_ends: Any) -> np.ndarray:
    """Return (dim, n + 2): derivatives of a vector by e, from shape functions, and by s1, s2."""
    return np.hstack([np.kron(shapes, np.eye(dim, dtype=int)), np.array(by_ends).T])


def point(dim: int) -> Program:
    """Return the kernel of the motion of a point."""
    p, at = _program(dim, "point", "place, derivatives and motion of a material point")
    p.stage("derivatives by s1, s2 and along the motion")
    by_ends = [at.sum(at.named(f"N_{i + 1}_", end.array(at.N)), at.d) for i, end in enumerate(at.ends)]
    rate = at.named("N_t", at.time.array(at.N))
    second = at.named("N_tt", at.time.array(rate))
    p.output("p", at.e[at.first] + at.sum(at.N, at.d), "m", "place")
    p.output("P", _over_coordinates(dim, at.of_all(at.N, 1), by_ends), "1, m", "derivatives of the place by e, s1, s2")
    p.output("velocity", at.v[at.first] + at.sum(at.N, at.d_rate) + at.sum(rate, at.d), "m/s", "velocity")
    p.output("bias", 2 * at.sum(rate, at.d_rate) + at.sum(second, at.d), "m/s^2", "acceleration at zero second rates")
    return p


def wrench(dim: int) -> Program:
    """Return the kernel of the derivatives of a force's generalised force, and of the velocity."""
    p, at = _program(dim, "wrench", "derivatives of the generalised force of a force on the point, and of its velocity")
    f = p.input("f", dim, "N", "force on the point")
    p.stage("derivatives by s1, s2 and along the motion")
    first = [at.named(f"N_{i + 1}_", end.array(at.N)) for i, end in enumerate(at.ends)]
    second = {(i, j): at.named(f"N_{i + 1}{j + 1}_", at.ends[j].array(first[i])) for i in range(2)
              for j in range(i + 1)}
    rate = at.named("N_t", at.time.array(at.N))
    past = [at.named(f"N_{i + 1}t_", end.array(rate)) for i, end in enumerate(at.ends)]
    n = len(at.positions) * dim
    K = np.zeros((n + 2, n + 2), dtype=object)
    for i, by_end in enumerate(first):
        K[:n, n + i] = K[n + i, :n] = np.outer(at.of_all(by_end, 0), f).ravel()
        for j in range(2):
            K[n + i, n + j] = f.dot(at.sum(second[max(i, j), min(i, j)], at.d))
    by_ends = [at.sum(of_end, at.d_rate) + at.sum(of_rate, at.d) for of_end, of_rate in zip(first, past, strict=True)]
    p.output("K", K, "N, N/m", "derivatives of P' f by e, s1, s2")
    p.output("v_q", _over_coordinates(dim, at.of_all(rate, 0), by_ends), "1/s, m/s",
             "derivatives of the velocity by e, s1, s2")
    return p


def slope(dim: int) -> Program:
    """Return the kernel of the motion of the slope at a slide."""
    p, at = _program(dim, "slope", "slope at a place that moves along the rope, its derivatives and motion", True)
    p.stage("derivatives by s1, s2, S and along the motion")
    by_ends = [at.sum(at.named(f"N_{i + 1}_", end.array(at.N)), at.d) for i, end in enumerate(at.ends)]
    rate = at.named("N_t", at.time.array(at.N))
    second = at.named("N_tt", at.time.array(rate))
    p.output("t", at.sum(at.N, at.d), "1", "slope r_x")
    p.output("T", _over_coordinates(dim, at.of_all(at.N, 0), by_ends), "1/m, 1", "derivatives of t by e, s1, s2, S")
    p.output("rate", at.sum(at.N, at.d_rate) + at.sum(rate, at.d), "1/s", "rate of t")
    p.output("bias", 2 * at.sum(rate, at.d_rate) + at.sum(second, at.d), "1/s^2",
             "its second rate at zero second rates")
    return p


def slope_stiffness(dim: int) -> Program:
    """Return the kernel of the second derivatives of g . t for a constant vector g."""
    p, at = _program(dim, "slope_stiffness", "second derivatives of the slope at a place that moves along the rope",
                     True)
    g = p.input("g", dim, "N m", "a vector")
    p.stage("derivatives by s1, s2, S")
    first = [at.named(f"N_{i + 1}_", end.array(at.N)) for i, end in enumerate(at.ends)]
    n, more = len(at.positions) * dim, len(at.ends)
    K = np.zeros((n + more, n + more), dtype=object)
    for i, by_end in enumerate(first):
        K[:n, n + i] = K[n + i, :n] = np.outer(at.of_all(by_end, 0), g).ravel()
        for j in range(i + 1):
            both = at.named(f"N_{i + 1}{j + 1}_", at.ends[j].array(by_end))
            K[n + i, n + j] = K[n + j, n + i] = g.dot(at.sum(both, at.d))
    p.output("K", K, "N, N/m, N m", "derivatives of T' g by e, s1, s2, S")
    return p


def discrete_point(dim: int) -> Program:
    """Return the kernel of the Jacobian P of a point over a step: p_next - p = P (de, ds1, ds2)."""
    p = Program(f"{NAMES[dim]}_discrete_point", "Jacobian of a material point over a step that conserves energy",
                f"{SOURCE}; Gonzalez, J. Nonlinear Sci. 6 (1996) 449-467")
    element = ELEMENTS[ELEMENT[dim]]
    e = p.input("e", (element.n_vectors, dim), "m, 1", "nodal vectors at the start of the step")
    e_next = p.input("e_next", e.shape, "m, 1", "nodal vectors at the end of the step")
    s = p.input("s", 2, "m", "material coordinates s1, s2 of the ends of the span at the start of the step")
    s_next = p.input("s_next", 2, "m", "s at the end of the step")
    a, b = p.input("share", 2, "1", "shares a, b of the nodes in the length of the span")
    S = p.input("S", (), "m", "material coordinate of the point")
    p.stage("place and length at both ends of the step")
    spans = [p.define(f"L{tag}", at[1] - at[0]) for tag, at in (("", s), ("_next", s_next))]
    part = p.define("part", b - a)
    places = [p.define(f"x{tag}", S - at[0] - a * span)
              for tag, at, span in zip(("", "_next"), (s, s_next), spans, strict=True)]
    lengths = [p.define(f"l{tag}", part * span) for tag, span in zip(("", "_next"), spans, strict=True)]
    mean, slopes = DiscreteShapes(p, element, True, lengths, places).shapes()
    p.stage("means and changes, from the first node")
    middle, change = middle_and_change(p, element, e, e_next)
    along = {tag: p.vector(f"along{tag}", slope.dot(middle)) for tag, slope in slopes.items()}
    by_e = np.kron(mean, np.eye(dim, dtype=int))
    if dim == 2:
        by_ends = {tag: p.vector(f"swing{tag}", slope.dot(change) / 4) for tag, slope in slopes.items()}
        t, dt = along[""], by_ends[""]
        arm = p.vector("arm", cross(np.array([p.define("inv_tt", 1 / t.dot(t))]), t))
        turn = p.define("turn", 4 * arm.dot(dt))
        change_of = {"": places[1] - places[0], "_l": lengths[1] - lengths[0]}
        couple = p.vector("couple", cross(np.array([1]), sum(change_of[tag] * swing for tag, swing in by_ends.items())))
        by_e = by_e + np.hstack([np.outer(couple, D * arm) for D in slopes[""]])
        along = {tag: p.vector(f"worked{tag}", value - cross(np.array([turn]), by_ends[tag]))
                 for tag, value in along.items()}
    on_s = [-(1 - a) * along[""] - part * along["_l"], part * along["_l"] - a * along[""]]
    p.output("P", np.hstack([by_e, np.array(on_s).T]), "1, m",
             "by e, s1, s2; P' f is the force f on the point over a step")
    return p
