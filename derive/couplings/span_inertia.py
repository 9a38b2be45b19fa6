"""Inertia of a span of a rope: an element whose ends flow along the rope, see span.py.

r(S) = N(S - s1; l) e. With xi = (S - s1)/l a material point moves along the element at
xi' = -(s1' (1 - xi) + s2' xi)/l, so its velocity

    r' = N e' + N_l l' e - N_xi (s1' (1 - xi) + s2' xi)/l e

has the degree of N in xi: it is N of nodal vectors u again. These are what material points at the nodes have: with e_S,
the nodal vectors of dr/dS, and the rate s' of a node,

    u = e' - s' e_S,   and of the acceleration   a = u' - s' u_S.

So T = u . m(l) u/2 with the mass matrix m of the element. Lagrange's equations of (e, s1, s2) are d'Alembert's
principle with the momentum that flows in and out at the nodes: with F = m a, v = e' at the position of a node, and the
sign -1 at the first node and 1 at the last,

    f = F + sign rho s' u at the position of each node,
    f_s = -e_S . F over the vectors of the node - sign rho (v.v - s'^2 r_S.r_S)/2.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp

from ..codegen.program import DirectionalDerivative, Program, jacobian
from ..spec import Element, l, x

SOURCE = "Lagrange's equations with moving nodes; Vetyukov, Int. J. Solids Struct. 150 (2018) 147-157"


class Flow:
    """Inputs and stages of the motion of material points: nodal vectors of slope, velocity and acceleration."""

    def __init__(self, program: Program, span: FlowingElement, moves: bool = True, accelerates: bool = False):
        p = program
        self.program, self.span = program, span
        self.l = p.input("l", (), "m", "length s2 - s1 of the element")
        self.e = span.coordinates(p)
        if not moves:
            return
        self.v = span.coordinates(p, "v", "m/s, 1/s", "rates of the nodal vectors")
        self.s_rate = p.input("s_rate", 2, "m/s", "rates of the material coordinates s1, s2")
        if accelerates:
            self.a = span.coordinates(p, "a", "m/s^2, 1/s^2", "accelerations of the nodal vectors")
            self.s_acc = p.input("s_acc", 2, "m/s^2", "second rates of s1, s2")

    def along(self) -> None:
        """Stage: w = 1/l and e_S."""
        p = self.program
        p.stage("slopes and curvatures at the nodes")
        self.w = p.define("w", 1 / self.l)
        self.e_S, self.e_Sl = self.span.along(p, "e", self.e, self.w)

    def velocities(self) -> None:
        """Stage: w, e_S, and u."""
        p, span = self.program, self.span
        self.along()
        self.l_rate = p.define("l_rate", self.s_rate[1] - self.s_rate[0])
        p.stage("velocities of material points at the nodes")
        self.u = np.array([p.vector(f"u{k + 1}", self.v[k] - self.s_rate[i] * self.e_S[k])
                           for k, i in enumerate(span.node_of)])

    def accelerations(self) -> None:
        """Stage: a = u' - s' u_S; u' + s' u_S takes e' and u alike."""
        p, span, nodes = self.program, self.span, self.span.node_of
        p.stage("accelerations of material points at the nodes")
        both = np.array([p.vector(f"both{k + 1}", self.v[k] + self.u[k]) for k in range(len(self.v))])
        both_S, _ = span.along(p, "both", both, self.w)
        self.acc = np.array([p.vector(f"acc{k + 1}", self.a[k] - self.s_acc[i] * self.e_S[k] - self.s_rate[i] * (
            both_S[k] + self.l_rate * self.e_Sl[k])) for k, i in enumerate(nodes)])

    def mass(self, rho: sp.Expr) -> np.ndarray:
        """Return m over the nodal vectors, (n, n)."""
        p, span = self.program, self.span
        p.stage("mass matrix")
        scale = [p.define("mass", rho * self.l)]
        for power in range(2 * max(span.powers)):
            scale.append(p.define(f"mass_{power + 1}", scale[-1] * self.l))
        n, powers = range(len(span.powers)), span.powers
        entry = {(j, k): p.define(f"m{j + 1}{k + 1}", span.gram_of_shapes[j, k] * scale[powers[j] + powers[k]])
                 for j in n for k in n if j <= k}
        return np.array([[entry[min(j, k), max(j, k)] for k in n] for j in n], dtype=object)


SIGN = (-1, 1)
"""Of both ends: mass flows in at the first and out at the last where their s grow, and l = s2 - s1."""


class FlowingElement:
    """An element whose ends flow along the rope, with the kernels of its inertia."""

    def __init__(self, element: Element):
        self.element, self.name = element, f"span_{element.name}"

    @cached_property
    def powers(self) -> list[int]:
        """Return the powers of l in the shape functions: 0 of positions, 1 of slopes."""
        return [name.count("x") for name in self.element.names]

    @cached_property
    def node_of(self) -> list[int]:
        """Return the number of the node of each nodal vector."""
        return [node for node in range(len(self.element.nodes)) for _ in self.element.nodal_vectors]

    @cached_property
    def vectors_of(self) -> list[list[int]]:
        """Return the nodal vectors of each node, its position first and then its slope."""
        return [[k for k, node in enumerate(self.node_of) if node == i] for i in range(len(self.element.nodes))]

    @cached_property
    def unit_shapes(self) -> list[sp.Expr]:
        """Return the shape functions of the element of unit length."""
        return [sp.expand(n.subs(l, 1)) for n in self.element.shape_functions]

    @cached_property
    def slopes(self) -> np.ndarray:
        """Return D with D d the nodal vectors of dr/dx, r those of d, of the element of unit length."""
        columns = [sp.diff(n, x) for n in self.unit_shapes]
        return np.array(self.element.nodal_conditions(columns).subs(l, 1), dtype=object)

    @cached_property
    def gram_of_shapes(self) -> np.ndarray:
        """Return int N_j N_k of the element of unit length."""
        n = self.unit_shapes
        return np.array([[sp.integrate(sp.expand(a * b), (x, 0, 1)) for b in n] for a in n], dtype=object)

    def along(self, p: Program, name: str, d: np.ndarray, w: sp.Expr) -> tuple[np.ndarray, np.ndarray]:
        """Return the nodal vectors of dr/dS, r those of d, through chords over l: slopes, curvatures. With these their
        derivatives by l, d constant.
        """
        n, first = range(len(d)), self.element.is_position.index(True)
        scaled = [p.vector(f"{name}_chord{k + 1}", (d[k] - d[first]) * w) if position else d[k] * w ** (1 - power)
                  for k, (position, power) in enumerate(zip(self.element.is_position, self.powers, strict=True))]

        def series(j: int, factors: Sequence[int]) -> np.ndarray:
            total = sum((self.slopes[j, k] * factors[k] * scaled[k] for k in n if k != first), 0 * d[0])
            return np.asarray(w ** self.powers[j] * total)

        along = np.array([p.vector(f"{name}_S{j + 1}", series(j, [1] * len(d))) for j in n])
        by_l = np.array([p.vector(f"{name}_Sl{j + 1}", -w * (self.powers[j] * along[j] + series(
            j, [1 - power for power in self.powers]))) for j in n])
        return along, by_l

    def coordinates(self, p: Program, name: str = "e", unit: str = "m, 1", doc: str = "nodal vectors") -> np.ndarray:
        """Declare nodal vectors (n, dim) as an input."""
        return p.input(name, (self.element.n_vectors, self.element.dim), unit, doc)

    def program(self, kernel: str, doc: str, source: str = SOURCE) -> Program:
        """Return an empty kernel."""
        return Program(f"{self.name}_{kernel}", doc, source)

    def point(self) -> Program:
        """Return the kernel of a material point: place, slope, velocity."""
        p = self.program("point", "place, slope and velocity of a material point")
        flow = Flow(p, self)
        xi = p.input("xi", (), "1", "(S - s1)/l")
        flow.velocities()
        p.stage("shape functions")
        shapes = [p.define(f"N{k + 1}", flow.l**power * sp.horner(shape.subs(x, xi)))
                  for k, (shape, power) in enumerate(zip(self.unit_shapes, self.powers, strict=True))]
        p.output("r", sum(n * e for n, e in zip(shapes, flow.e, strict=True)), "m", "place")
        p.output("r_S", sum(n * e_S for n, e_S in zip(shapes, flow.e_S, strict=True)), "1", "slope dr/dS")
        p.output("velocity", sum(n * u for n, u in zip(shapes, flow.u, strict=True)), "m/s",
                 "velocity of the material point")
        return p

    def kinetic_energy(self) -> Program:
        """Return the kernel of the kinetic energy."""
        p = self.program("kinetic_energy", "kinetic energy")
        rho = p.input("rho", (), "kg/m", "mass of a length")
        flow = Flow(p, self)
        flow.velocities()
        m = flow.mass(rho)
        p.stage("momenta of the nodal vectors")
        R = np.array([p.vector(f"R{k + 1}", value) for k, value in enumerate(m.dot(flow.u))])
        p.output("T", [np.sum(R * flow.u) / 2], "J", "kinetic energy")
        return p

    def _inertia(self, p: Program) -> tuple[Flow, sp.Expr, np.ndarray, np.ndarray]:
        """Stage: accelerations and forces F = m a of the material; return the flow, rho, m, F."""
        rho = p.input("rho", (), "kg/m", "mass of a length")
        flow = Flow(p, self, accelerates=True)
        flow.velocities()
        flow.accelerations()
        m = flow.mass(rho)
        p.stage("inertia of the material")
        return flow, rho, m, np.array([p.vector(f"F{k + 1}", value) for k, value in enumerate(m.dot(flow.acc))])

    def _forces(self, p: Program, flow: Flow, rho: sp.Expr, F: np.ndarray) -> tuple[Any, np.ndarray, np.ndarray]:
        """Stage: forces on the nodal vectors and on s1 and s2; return the rates sign rho s' of mass, and both."""
        p.stage("momentum through the nodes, and forces on s1 and s2")
        f, on_s, streams = F.copy(), [], []
        for i, (sign, rate, nodal) in enumerate(zip(SIGN, flow.s_rate, self.vectors_of, strict=True)):
            at = nodal[0]
            streams.append(p.define(f"stream{i + 1}", sign * rho * rate))
            f[at] = p.vector(f"f{i + 1}", F[at] + streams[i] * flow.u[at])
            v, r_S = flow.v[at], flow.e_S[at]
            on_s.append(p.define(f"f_s{i + 1}", -sum(flow.e_S[k].dot(F[k]) for k in nodal)
                                 - sign * rho / 2 * v.dot(v) + streams[i] * rate / 2 * r_S.dot(r_S)))
        return streams, f, np.array(on_s)

    def inertia(self) -> Program:
        """Return the kernel of the inertial forces."""
        p = self.program("inertia", "inertial forces d/dt dT/dv - dT/dq")
        flow, rho, _, F = self._inertia(p)
        _, f, on_s = self._forces(p, flow, rho, F)
        p.output("f", f, "N, N m", "forces on the nodal vectors")
        p.output("f_s", on_s, "N", "forces on s1, s2")
        return p

    def mass_matrix(self) -> Program:
        """Return the kernel of the mass matrix: derivatives of the inertial forces by accelerations."""
        p = self.program("mass_matrix", "mass matrix")
        rho = p.input("rho", (), "kg/m", "mass of a length")
        flow = Flow(p, self, moves=False)
        flow.along()
        m = flow.mass(rho)
        p.stage("derivatives of the forces on s1 and s2")
        M_s = self._on_s_by_vectors(p, flow, "M", m)
        M_ss = [[-sum(flow.e_S[k].dot(row[k]) for k in nodal) for nodal in self.vectors_of] for row in M_s]
        p.output("M", self._over_all(m, M_s, np.vstack([M_s.reshape(len(M_s), -1).T, M_ss])), "SI",
                 "derivatives of f and f_s by accelerations of e, s1, s2")
        return p

    def inertia_tangent(self) -> Program:
        """Return the kernel of the derivatives of the inertial forces by rates and configuration.

        Accelerations and nodal vectors have scalars as derivatives, alike in all directions; those of the forces by
        s', s'' and l are vectors.
        """
        p = self.program("inertia_tangent", "derivatives of the inertial forces by rates and configuration")
        flow, rho, m, F = self._inertia(p)
        streams, f, on_s = self._forces(p, flow, rho, F)
        S, by_v, by_e = self._acceleration_by_vectors(p, flow)
        p.stage("derivatives by the nodal vectors")
        D, K = self._named(p, "D", m.dot(by_v)), self._named(p, "K", m.dot(by_e))
        D_s, K_s = (self._on_s_by_vectors(p, flow, name, matrix) for name, matrix in (("D", D), ("K", K)))
        for i, (sign, rate, nodal) in enumerate(zip(SIGN, flow.s_rate, self.vectors_of, strict=True)):
            at, slope = nodal[:2]
            D[at, at] += streams[i]
            K[at, slope] -= streams[i] * rate
            D_s[i, at] -= sign * rho * flow.v[at]
            K_s[i, slope] += streams[i] * rate * flow.e_S[at]
            K_s[i] -= sum(np.outer(S[k], F[k]) for k in nodal)
        p.stage("derivatives by s1, s2 and l")
        values = np.concatenate([f.ravel(), on_s])
        of_slopes = dict(zip(flow.e_S.ravel(), flow.e_Sl.ravel(), strict=True))
        by_l = DirectionalDerivative(p, "dl", {flow.l: 1, **of_slopes})
        for name, over_e, on_ends, others, doc in (
                ("D", D, D_s, jacobian(p, values, flow.s_rate), "rates of e, s1, s2"),
                ("K", K, K_s, by_l.array(values)[:, None], "e and l")):
            p.output(name, self._over_all(over_e, on_ends, others), "SI", f"derivatives of f and f_s by {doc}")
        return p

    def _over_all(self, over_e: np.ndarray, on_ends: np.ndarray, others: np.ndarray) -> np.ndarray:
        """Return a matrix of f and f_s: its scalars over the nodal vectors, its rows of both ends, other columns."""
        rows = np.vstack([np.kron(over_e, np.eye(self.element.dim, dtype=int)), on_ends.reshape(len(on_ends), -1)])
        return np.hstack([rows, others])

    def _acceleration_by_vectors(self, p: Program, flow: Flow) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Stage: S with e_S = S e, da/de' = -2 s' S and da/de = -s'' S - s' (l' dS/dl - S s' S), s' of the nodes."""
        p.stage("derivatives of the accelerations by the nodal vectors")
        S = self.slope_matrix(p, flow.w)
        S_l = -flow.w * (1 + np.subtract.outer(self.powers, self.powers)) * S
        rate, second = (np.array([[of_s[node]] for node in self.node_of]) for of_s in (flow.s_rate, flow.s_acc))
        past = self._named(p, "sS", rate * S)
        return S, self._named(p, "A_v", -2 * past), self._named(p, "A_e", -second * S - rate * (
            flow.l_rate * S_l - S.dot(past)))

    def slope_matrix(self, p: Program, w: sp.Expr) -> np.ndarray:
        """Return S with e_S = S e, scalars over the nodal vectors."""
        return self._named(p, "S", self.slopes * w ** (1 + np.subtract.outer(self.powers, self.powers)))

    def _named(self, p: Program, name: str, matrix: np.ndarray) -> np.ndarray:
        """Return a matrix over the nodal vectors with its entries named: a translation of all positions gives zero."""
        positions = [k for k, position in enumerate(self.element.is_position) if position]
        named = np.array([[0 if k == positions[0] else p.define(f"{name}{j + 1}{k + 1}", value)
                           for k, value in enumerate(row)] for j, row in enumerate(matrix)], dtype=object)
        named[:, positions[0]] = -named[:, positions[1:]].sum(axis=1)
        return named

    def _on_s_by_vectors(self, p: Program, flow: Flow, name: str, matrix: np.ndarray) -> np.ndarray:
        """Stage: the derivatives of -e_S . F by the nodal vectors that F has `matrix` by: (2, n, dim)."""
        return np.array([[p.vector(f"{name}{k + 1}s{i + 1}", -sum(flow.e_S[j] * matrix[j, k] for j in nodal))
                          for k in range(len(matrix))] for i, nodal in enumerate(self.vectors_of)])
