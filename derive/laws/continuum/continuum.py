"""St. Venant-Kirchhoff continuum, fully integrated over the volume (eq 5-8): a quadratic form in Gram products.

The Green strain E = (F'F - I)/2 is linear in G, hence U = 1/2 (G - G0)' A (G - G0) with A constant, integrated
exactly, and sparse, because Legendre polynomials are orthogonal (beam24: 114 entries of 784; in nodal slopes 228).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp

from ...algebra import section_integrals as integrals
from ...algebra.gram import Gram
from ...algebra.gram_tangent import blocks
from ...codegen.program import Program
from ...spec import Element, LawTraits
from .section import Resultants

NAME = "continuum"
DOC = "St. Venant-Kirchhoff continuum, orthotropic, fully integrated"
SOURCE = "eq 5-8"
TRAITS = LawTraits("continuum")
ROWS = {3: ("D11", "D22", "D33", "D12", "D13", "D23", "G12", "G13", "G23"), 2: ("D11", "D22", "D12", "G12")}


class Form:
    """The constant form A of an element."""

    def __init__(self, gram: Gram):
        self.gram = gram

    @cached_property
    def strain(self) -> dict[tuple[int, int], list[Any]]:
        """Return the Green strain (eq 6) over Gram pairs: E_ij = 1/2 sum_p strain[ij][p] (G - G0)_p, in the ring."""
        g, d = self.gram.gradient, range(self.gram.element.dim)
        return {(i, j): [g[a][i] * g[b][j] + (g[b][i] * g[a][j] if a != b else 0) for a, b in self.gram.pairs]
                for i in d for j in d if i <= j}

    @cached_property
    def elasticity(self) -> dict[tuple[Any, ...], int]:
        """Return the row of the section stiffness S of the law D E, by (ij, kl); orthotropic, axes x, y, z."""
        normal = [(i, i) for i in range(self.gram.element.dim)]
        shear = [ij for ij in self.strain if ij[0] != ij[1]]
        off = [(a, b) for k, a in enumerate(normal) for b in normal[k + 1:]]
        order = [(a, a) for a in normal] + off + [(s, s) for s in shear]
        law = {}
        for k, (a, b) in enumerate(order):
            law[a, b] = law[b, a] = k
        return law

    @cached_property
    def form(self) -> dict[tuple[int, int], dict[tuple[Any, ...], Any]]:
        """Return A over pairs (p, q): {(elastic constant, section moment, power of l): rational}, zeros left out.

        Shear enters as gamma = 2 E, so W = 1/2 sum D E_ii E_jj + 1/2 sum G gamma^2.
        """
        products: dict[Any, Any] = {}
        form = {}
        for p in range(len(self.gram.pairs)):
            for q in range(p, len(self.gram.pairs)):
                entry: dict[tuple[Any, ...], Any] = {}
                for (ij, kl), k in self.elasticity.items():
                    if not (self.strain[ij][p] and self.strain[kl][q]):
                        continue
                    integrand = self.strain[ij][p] * self.strain[kl][q]
                    if integrand not in products:
                        products[integrand] = integrals.over_element(integrand)
                    weight = sp.QQ(1, 4) if ij[0] == ij[1] else sp.QQ(1)
                    for (m, power), value in products[integrand].items():
                        entry[k, m, power] = entry.get((k, m, power), 0) + weight * value
                entry = {k: v for k, v in sorted(entry.items()) if v}
                if entry:
                    form[p, q] = form[q, p] = entry
        return form

    @cached_property
    def constants(self) -> list[tuple[Any, ...]]:
        """Return the different entries of A, in order of first use: the argument A of the kernels."""
        return list(dict.fromkeys(tuple(e.items()) for e in self.form.values()))

    @cached_property
    def index(self) -> dict[tuple[int, int], int]:
        """Return the index into `constants` of each non-zero entry of A."""
        place = {c: k for k, c in enumerate(self.constants)}
        return {pq: place[tuple(e.items())] for pq, e in self.form.items()}


class Continuum:
    """The law over an element's Gram products."""

    name, doc, source, set_up_kernel = NAME, DOC, SOURCE, "stiffness"

    form: Form

    def __init__(self, gram: Gram):
        self.gram, self.form = gram, Form(gram)

    def constants(self, program: Program) -> np.ndarray:
        """Declare the input A, the different non-zero entries of the form in N m, and return it."""
        return program.input("A", len(self.form.constants), "N m",
                             f"elastic constants from {self.gram.element.name}_{NAME}_stiffness")

    def section_stiffness(self, program: Program) -> np.ndarray:
        """Declare the input S, elastic constants integrated over the section times even powers of y and z, and return
        it.
        """
        rows = ROWS[self.gram.element.dim]
        return program.input("S", (len(rows), len(integrals.SECTION)), "N, N m^2, N m^2, N m^4, N m^4, N m^4",
                             f"section stiffness: integrals over A of {', '.join(rows)} (rows; orthotropic, axes x, y, "
                             "z) times 1, y^2, z^2, y^4, y^2 z^2, z^4 (columns)")

    def set_up(self, program: Program) -> None:
        """Declare the inputs l and S, and the output A. The section is any doubly symmetric one, the law any
        orthotropic one, the same over the section or not.
        """
        length = program.input("l", (), "m", "length of the element")
        S = self.section_stiffness(program)
        A = [sum(sp.Rational(int(c.numerator), int(c.denominator)) * S[k, m] * length**power
                 for (k, m, power), c in entry) for entry in self.form.constants]
        program.stage("integrals of strain products")
        program.output("A", [program.define(f"A_{i}", a) for i, a in enumerate(A)], "N m",
                       "different non-zero entries of A")

    def section_forces(self, program: Program, S: np.ndarray, c: np.ndarray, X: sp.Expr, w: sp.Expr,
                       c0: np.ndarray | None = None) -> tuple[Any, ...]:
        """Return force and moment in space, and strain, at X."""
        section = Resultants(self.form, program, S, c, X, w)
        return section.force(), section.moment(), section.strain()

    def energy(self, program: Program, A: np.ndarray, c: np.ndarray, w: sp.Expr) -> sp.Expr:
        """Return the elastic energy U = 1/2 (G - G0)' A (G - G0) (eq 7), J."""
        G = self._strain(program, A, c)
        return sum(a * b for a, b in zip(self._stress(program, A, G), G, strict=True)) / 2

    def forces(self, program: Program, A: np.ndarray, c: np.ndarray, w: sp.Expr) -> np.ndarray:
        """Return the forces dU/dc on the strain vectors c (eq 8): (vectors, dim), N m."""
        u = self._stress(program, A, self._strain(program, A, c))
        program.stage("forces on strain vectors")
        return self.gram.vector_forces(program, c, u)

    def discrete_forces(self, program: Program, A: np.ndarray, now: np.ndarray, then: np.ndarray,
                        w: sp.Expr) -> np.ndarray:
        """Return forces f on strain vectors with f . (then - now) = the difference of U: the stress of the mean strain
        on the mean vectors (Simo & Tarnow, ZAMP 43 (1992) 757-792).
        """
        G = [self._strain(program, A, c) for c in (now, then)]
        program.stage("mean strain and vectors")
        mean = [program.define(f"mean_{self.gram.pair(p)}", (a + b) / 2) for p, (a, b) in
                enumerate(zip(*G, strict=True))]
        c = np.array([program.vector(f"mean_{name}", (a + b) / 2) for name, a, b in
                      zip(self.gram.names, now, then, strict=True)])
        u = self._stress(program, A, mean)
        program.stage("forces on strain vectors")
        return self.gram.vector_forces(program, c, u)

    def stress_of_turning(self, program: Program, A: np.ndarray, change: np.ndarray, w: sp.Expr) -> np.ndarray:
        """Return blocks (n, n, 1, 1) over strain vectors that the mean stress of a step has more than the stress of the
        mean vectors: of A times the Gram products of half the change.
        """
        program.stage("Gram products of half the change")
        G = [program.define(f"G_{self.gram.pair(p)}", change[a].dot(change[b]) / 4)
             for p, (a, b) in enumerate(self.gram.pairs)]
        u = self._stress(program, A, G)
        blocks = np.zeros((len(self.gram.names), len(self.gram.names), 1, 1), dtype=object)
        for (a, b), value in zip(self.gram.pairs, u, strict=True):
            blocks[a, b] = blocks[b, a] = 2 * value if a == b else value
        return blocks

    def tangent(self, program: Program, A: np.ndarray, c: np.ndarray, w: sp.Expr) -> np.ndarray:
        """Return d2U/dc2 over strain vectors."""
        return blocks(self.gram, program, c, c, self._moduli(A), self._stress(program, A, self._strain(program, A, c)))

    def _strain(self, program: Program, A: np.ndarray, c: np.ndarray) -> list[sp.Expr]:
        """Return Gram products, less those of the stress-free shape."""
        program.stage("Gram products G - G0")
        return self.gram.gram(program, c)

    def _stress(self, program: Program, A: np.ndarray, G: Sequence[sp.Expr]) -> list[sp.Expr]:
        program.stage("u = A (G - G0)")
        return self._times(program, self._moduli(A), G)

    def _viscous_moduli(self, A: np.ndarray) -> dict[tuple[int, int], Any]:
        return self._moduli(A)

    def _moduli(self, A: np.ndarray) -> dict[tuple[int, int], Any]:
        return {pq: A[k] for pq, k in self.form.index.items()}

    # --- Kelvin-Voigt: stress follows G - G0 + tau dG/dt; what follows is the tau part ----------------------

    def _viscous(self, program: Program, A: np.ndarray, tau: sp.Expr, c: np.ndarray, dc: np.ndarray) -> tuple[Any, ...]:
        program.stage("rates of the Gram products")
        dG = self.gram.gram_rate(program, c, dc)
        program.stage("u = tau A dG/dt")
        return self._times(program, self._viscous_moduli(A), dG, tau), dG

    def damping_forces(self, program: Program, A: np.ndarray, tau: sp.Expr, c: np.ndarray, dc: np.ndarray,
                       w: sp.Expr) -> np.ndarray:
        """Return the damping forces on the strain vectors, (vectors, dim), N m."""
        u, _ = self._viscous(program, A, tau, c, dc)
        program.stage("forces on strain vectors")
        return self.gram.vector_forces(program, c, u)

    @staticmethod
    def rates(element: Element) -> dict[str, int]:
        """Return the number of strain rates that the damping of an element has, and whether a spin about the tangent is
        one.
        """
        return {"rates": element.n_vectors * (element.n_vectors - 1) // 2, "spins": 0}

    def algorithmic_forces(self, program: Program, A: np.ndarray, weight: sp.Expr, relaxed_strain: np.ndarray,
                           c: np.ndarray, dc: np.ndarray, w: sp.Expr) -> tuple[np.ndarray, Sequence[sp.Expr]]:
        """Return the forces on strain vectors of the stiffnesses times weight dE - relaxed_strain, and dE, the rates
        that dc makes.
        """
        program.stage("change of the Gram products")
        dG = self.gram.gram_rate(program, c, dc)
        program.stage("u = A (weight dG - relaxed_strain)")
        excess = [program.define(f"excess_{self.gram.pair(p)}", weight * d - relaxed_strain[p])
                  for p, d in enumerate(dG)]
        u = self._times(program, self._viscous_moduli(A), excess)
        program.stage("forces on strain vectors")
        return self.gram.vector_forces(program, c, u), dG

    def damping_blocks(self, program: Program, A: np.ndarray, tau: sp.Expr, c: np.ndarray, dc: np.ndarray,
                       rate: sp.Expr, w: sp.Expr) -> np.ndarray:
        """Return df/dc + rate df/d(dc) over strain vectors."""
        u, _ = self._viscous(program, A, tau, c, dc)
        program.stage("b = tau (dc/dt + rate c)")
        b = np.array([program.vector(f"b_{name}", tau * (dc[m] + rate * c[m]))
                      for m, name in enumerate(self.gram.names)])
        return blocks(self.gram, program, c, b, self._viscous_moduli(A), u)

    def dissipation(self, program: Program, A: np.ndarray, tau: sp.Expr, c: np.ndarray, dc: np.ndarray,
                    w: sp.Expr) -> sp.Expr:
        """Return the dissipated power, W."""
        u, dG = self._viscous(program, A, tau, c, dc)
        return sum(a * b for a, b in zip(u, dG, strict=True))

    def _times(self, program: Program, moduli: dict[tuple[int, int], Any], strain: Sequence[sp.Expr],
               scale: sp.Expr = sp.S.One) -> list[sp.Expr]:
        u = []
        for p in range(len(self.gram.pairs)):
            alike: dict[sp.Expr, sp.Expr] = {}
            for q in range(len(self.gram.pairs)):
                if (p, q) in moduli:
                    alike[moduli[p, q]] = alike.get(moduli[p, q], sp.S.Zero) + strain[q]
            u.append(program.define(f"u_{self.gram.pair(p)}", scale * sum(k * s for k, s in alike.items())))
        return u
