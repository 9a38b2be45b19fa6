"""A span of a rope: an element whose ends flow along the rope.

r(S) = N(S - s1; l) e with l = s2 - s1, where the material coordinates s1, s2 (stress-free arc-length, m) of the ends
are unknowns beside the nodal vectors e. Lagrange's equations of all three follow from the kinetic energy
(span_inertia.py), the energy of gravity, and the law's energy with the length l. Of an energy that depends on s1 and s2
through l, the force on s1 is minus the derivative by l, that on s2 the derivative by l.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import sympy as sp

from ..algebra.gram_tangent import from_others, nodal_tangent
from ..codegen.family import ElementFamily
from ..codegen.program import Program
from ..elements import ELEMENTS
from ..laws import law_traits
from ..laws.cable.blocks import named_block
from ..spec import Element, x
from . import span_force, span_kinetic, span_step
from .span_inertia import Flow

SPANS = {"cable8p": "engineering_exact_assumed", "cable12": "engineering_exact_assumed"}
"""Elements that spans have, and their law."""


def families() -> list[ElementFamily]:
    """Return the families of spans."""
    return [ElementFamily(f"span_{name}", f"span of a rope of {name} elements", partial(build, ELEMENTS[name], law),
                          ("couplings.span", f"elements.{name}"), role="span",
                          facts={"dim": ELEMENTS[name].dim, "coordinates": ELEMENTS[name].n_coordinates,
                                 "points": span_step.POINTS},
                          element=ELEMENTS[name], law=law, traits=law_traits(law))
            for name, law in SPANS.items()]


def build(element: Element, law: str) -> list[Program]:
    """Return the kernels of the spans of an element with a law."""
    span = Span(element, law)
    return [span.point(), span.kinetic_energy(), span.inertia(), span.mass_matrix(), span.inertia_tangent(),
            span.weight(), span.energy(), span.elastic_force(), span.elastic_tangent(), span.dissipation(),
            span.damping_force(), span.damping_tangent(), *span_step.kernels(span), *span_force.build(span),
            *span_kinetic.build(span)]


class Span(span_step.ElasticElement):
    """The kernels of the spans of an element with a law."""

    def weight(self) -> Program:
        """Return the kernel of the energy of gravity and its derivatives."""
        p = self.program("weight", "energy of gravity, and its derivatives")
        rho = p.input("rho", (), "kg/m", "mass of a length")
        length, e = p.input("l", (), "m", "length s2 - s1 of the element"), self.coordinates(p)
        g = p.input("g", self.element.dim, "m/s^2", "gravity")
        p.stage("weights of the nodal vectors")
        mean = [sp.integrate(n, (x, 0, 1)) for n in self.unit_shapes]
        weight = [p.define(f"weight{k + 1}", -rho * part * length ** (1 + power))
                  for k, (part, power) in enumerate(zip(mean, self.powers, strict=True))]
        by_l = [p.define(f"weight{k + 1}_l", sp.diff(p.definition[value], length)) for k, value in enumerate(weight)]
        fall = [p.define(f"fall{k + 1}", g.dot(row)) for k, row in enumerate(e)]
        p.output("V", [sum(w * f for w, f in zip(weight, fall, strict=True))], "J", "energy of gravity")
        p.output("f", np.outer(weight, g), "N, N m", "derivatives by e")
        p.output("f_l", [sum(w * f for w, f in zip(by_l, fall, strict=True))], "N", "derivative by l")
        p.output("K_l", np.outer(by_l, g), "N/m, N", "derivatives of f by l")
        p.output("K_ll", [sum(sp.diff(p.definition[w], length) * f if w.is_Symbol else 0
                              for w, f in zip(by_l, fall, strict=True))], "N/m", "second derivative by l")
        return p

    # --- elasticity -------------------------------------------------------------------------------------------

    def _strain(self, p: Program) -> tuple[Any, ...]:
        """Stage: w = 1/l and strain vectors; return the law's constants, the strain vectors, w, and chords over l."""
        length, e = p.input("l", (), "m", "length s2 - s1 of the element"), self.coordinates(p)
        A = self.law.constants(p)
        p.stage("strain vectors")
        w = p.define("w", 1 / length)
        d = self.gram.chords(p, e, w)
        return A, self.gram.of_chords(p, d), w, np.where(self._positions, d, 0)

    def energy(self) -> Program:
        """Return the kernel of the elastic energy."""
        p = self.program("energy", "elastic energy", self.law.source)
        A, c, w, _ = self._strain(p)
        p.output("U", [self.law.energy(p, A, c, w)], "J", "elastic energy")
        return p

    def elastic_force(self) -> Program:
        """Return the kernel of the derivatives of the elastic energy by e and l: l dU/dl = U_m - U_b - l x.f, x the
        chords over l.
        """
        p = self.program("elastic_force", "derivatives of the elastic energy", self.law.source)
        A, c, w, chords = self._strain(p)
        on_strain, U_m, U_b = self.law.forces_and_energies(p, A, c, w)
        p.stage("forces on nodal vectors")
        f = self.gram.nodal_forces(p, on_strain, w)
        p.output("f", f, "N, N m", "derivatives by e")
        p.output("f_l", [w * (U_m - U_b) - np.sum(chords * f)], "N", "derivative by l")
        return p

    def elastic_tangent(self) -> Program:
        """Return the kernel of the second derivatives of the elastic energy.

        With the chords x over l, and the forces f_m and f_b of stretching and bending,

            df/dl = (f_m - f_b - f at positions)/l - K x,   d2U/dl2 = 2 U_b/l^2 + 4 x.f_b/l + x.K x.
        """
        p = self.program("elastic_tangent", "second derivatives of the elastic energy", self.law.source)
        A, c, w, chords = self._strain(p)
        blocks, *on_strain, U_b = self.law.tangent_and_parts(p, A, c, w)
        K = nodal_tangent(self.gram, p, blocks, w, symmetric=True)
        p.stage("forces on nodal vectors")
        f_m, f_b = (self.gram.nodal_forces(p, f, w) for f in on_strain)
        p.stage("derivatives by the length")
        by_chords = np.array([p.vector(f"K_x{k + 1}", row)
                              for k, row in enumerate(K.dot(chords.ravel()).reshape(chords.shape))])
        on_positions = np.where(self._positions, f_m + f_b, 0)
        p.output("K", K, "N/m, N, N m", "by e twice")
        p.output("K_l", w * (f_m - f_b - on_positions) - by_chords, "N/m, N", "by e and l")
        p.output("K_ll", [2 * w**2 * U_b + 4 * w * np.sum(chords * f_b) + np.sum(chords * by_chords)], "N/m",
                 "by l twice")
        return p

    # --- damping ----------------------------------------------------------------------------------------------

    def _rates(self, p: Program) -> tuple[Any, ...]:
        """Stage: strain vectors and their rates at material points, with chords over l of places and of velocities."""
        flow = Flow(p, self)
        A, tau = self.law.constants(p), p.input("tau", (), "s", "retardation time of the Kelvin-Voigt law")
        flow.velocities()
        p.stage("strain vectors and their rates")
        d, rates = self.gram.chords(p, flow.e, flow.w), self.gram.chords(p, flow.u, flow.w, "d")
        constants = A, tau, self.gram.of_chords(p, d), self.gram.of_chords(p, rates, "d"), flow.w
        return flow, constants, [np.where(self._positions, vectors, 0) for vectors in (d, rates)]

    @property
    def _positions(self) -> np.ndarray:
        return np.array(self.element.is_position)[:, None]

    def dissipation(self) -> Program:
        """Return the kernel of the power of damping."""
        p = self.program("dissipation", "power dissipated by damping", self.law.source)
        _, constants, _ = self._rates(p)
        p.output("P", [sp.sympify(self.law.dissipation(p, *constants))], "W", "dissipated power")
        return p

    def _on_s(self, flow: Flow, f: np.ndarray) -> np.ndarray:
        """Return the power -e_S . f on each s' of forces on the velocities u of material points: (2, ...)."""
        return np.array([-sum(np.tensordot(flow.e_S[k], f[k], 1) for k in nodal) for nodal in self.vectors_of])

    def damping_force(self) -> Program:
        """Return the kernel of the forces of damping."""
        p = self.program("damping_force", "forces of damping", self.law.source)
        flow, constants, _ = self._rates(p)
        on_strain = self.law.damping_forces(p, *constants)
        p.stage("forces on nodal vectors")
        f = self.gram.nodal_forces(p, on_strain, flow.w)
        p.output("f", f, "N, N m", "forces on the nodal vectors")
        p.output("f_s", self._on_s(flow, f), "N", "forces on s1, s2")
        return p

    def damping_tangent(self) -> Program:
        """Return the kernel of the derivatives of the forces of damping.

        Forces f on u = e' - s' e_S, and -e_S.f on s', with the derivatives K_e and K_u of f: those by e are
        K_e - K_u s' S, and by l, with the chords x over l of places and x_u of velocities, see `elastic_tangent`,

            (f_m - f_b - f at positions)/l - K_e x - K_u (x_u + s' de_S/dl).
        """
        p = self.program("damping_tangent", "derivatives of the forces of damping", self.law.source)
        flow, constants, (x, x_u) = self._rates(p)
        *on_strain, by_c, by_dc = self.law.damping_parts(p, *constants)
        n, dim = flow.e.shape
        p.stage("forces on nodal vectors")
        f_m, f_b = (self.gram.nodal_forces(p, f, flow.w) for f in on_strain)
        f = np.array([p.vector(f"force{k + 1}", value) for k, value in enumerate(f_m + f_b)])
        K_e, K_u = (nodal_tangent(self.gram, p, blocks, flow.w, symmetric=symmetric)
                    for blocks, symmetric in ((by_c, False), (by_dc, True)))
        p.stage("slopes of velocities")
        rate = np.array([[flow.s_rate[node]] for node in self.node_of])
        S = self.slope_matrix(p, flow.w)
        past = np.kron(rate * S, np.eye(dim, dtype=int))
        p.stage("derivatives of the forces on nodal vectors")
        by_e = self._named_blocks(p, "K", K_e - K_u.dot(past))
        p.stage("derivatives by the length and by the rates of s1, s2")
        by_l = np.array([p.vector(f"by_l{k + 1}", row) for k, row in enumerate(
            flow.w * (f_m - f_b - np.where(self._positions, f, 0))
            - (K_e.dot(x.ravel()) + K_u.dot((x_u + rate * flow.e_Sl).ravel())).reshape(n, dim))])
        by_s = np.array([p.vector(f"D{k + 1}s{i + 1}", row) for i, nodal in enumerate(self.vectors_of)
                         for k, row in enumerate(self._on_s(flow, K_u.reshape(n, dim, -1))[i].reshape(n, dim))])
        p.stage("derivatives of the forces on s1, s2")
        by_s = by_s.reshape(len(self.vectors_of), n, dim)
        D_s = self._on_s(flow, by_s.transpose(1, 2, 0))
        K_s = self._on_s(flow, by_e.reshape(n, dim, -1)).reshape(-1, n, dim)
        for i, nodal in enumerate(self.vectors_of):
            K_s[i] -= sum(np.outer(S[k], f[k]) for k in nodal)
        l_s = self._on_s(flow, by_l) - [sum(flow.e_Sl[k].dot(f[k]) for k in nodal) for nodal in self.vectors_of]
        rows = by_s.reshape(len(by_s), -1)
        p.output("D", np.block([[K_u, rows.T], [rows, D_s]]), "SI", "derivatives of f and f_s by rates of e, s1, s2")
        p.output("K", np.block([[by_e, by_l.reshape(-1, 1)], [K_s.reshape(len(K_s), -1), l_s[:, None]]]), "SI",
                 "derivatives of f and f_s by e and l")
        return p

    def _named_blocks(self, p: Program, name: str, K: np.ndarray) -> np.ndarray:
        """Return a matrix over nodal coordinates with its entries named: no net force, none by translations."""
        n, dim = self.element.n_vectors, self.element.dim
        blocks = K.reshape(n, dim, n, dim).transpose(0, 2, 1, 3).copy()
        for j, k in np.ndindex(n - 1, n - 1):
            blocks[j + 1, k + 1] = named_block(p, f"{name}{j + 2}{k + 2}", blocks[j + 1, k + 1])
        return from_others(self.element, p, blocks, symmetric=False)
