"""Cable with an assumed axial strain: the lowest Legendre modes of the strain of an element.

The strain along a centreline of degree d has degree 2(d - 1) in X, but the lengths of the slopes can make it constant
only up to degree d - 1. No motion of the nodes relieves the rest: the element is too stiff where its slope turns
(membrane locking), and its tension oscillates. Here

    strain(X) = sum_m strain_m P_m(X),   strain_m = (2m + 1)/2 ∫ strain P_m dX,   m < d,

and the membrane energy is l/2 sum_m EA_m strain_m^2/(2m + 1). The modes of the Green strain are linear in Gram products
and integrated exactly.

A node has (d + 1)/2 coordinates along the cable. With (d + 1)/2 modes an element is free of locking, but a straight
cable then has a motion without energy, in which the slopes change their length and no node moves: it is unstable under
any compression. The modes above, the upper ones, have an axial stiffness of their own, the third constant. EA gives the
modes of degree d - 1 entirely; a small part of EA relieves them and keeps the slopes stable as long as the compressive
strain is below that part.

A Gauss quadrature with d points is the same but for the aliasing of higher modes. So the quintic with exact curvature,
whose quadrature has five points, has the full law's energy if its upper modes have EA.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import reduce
from operator import add
from typing import Any

import numpy as np
import sympy as sp

from ...algebra import section_integrals as integrals
from ...algebra.gram import Gram
from ...codegen.program import Program
from ...spec import LawTraits
from .blocks import named_blocks
from .cable import Cable, Term
from .points import Point, gathered


def traits(strain: str, curvature: str) -> LawTraits:
    """Return the traits of the law with these measures; it is damped like the full law with the same strain."""
    return LawTraits("cable", strain, curvature, membrane="assumed", damped_like=f"{strain}_exact")


class AssumedCable(Cable):
    """The law over an element's strain vectors; the damping is that of the law without assumed strain."""

    stiffness_units = "N, N m^2, N"
    stiffness_doc = "axial and bending stiffness EA, EI, and EA of the strain's upper modes"

    def __init__(self, gram: Gram, strain: str, curvature: str):
        super().__init__(gram, strain, curvature)
        self.name += "_assumed"
        self.doc += ", the strain by its lowest Legendre modes"

    @property
    def n_full(self) -> int:
        """Return the number of modes that have EA; those above have the stiffness of the upper modes."""
        return (self.degree + 1) // 2

    @property
    def axial_points(self) -> list[Point]:
        """Return the points for the axial strain: see `Cable`; else enough for exact modes of the Green strain, of
        degree 3(d - 1).
        """
        if self.curvature == "exact" or self.strain == "engineering":
            return super().axial_points
        return self.points((3 * self.degree - 1) // 2)

    def _terms(self, program: Program, A: np.ndarray, c: np.ndarray, w: sp.Expr) -> Iterator[Term]:
        """Yield the energy of bending point by point, with strain and stress of the membrane."""
        program.stage("strain at the quadrature points")
        EI = program.define("EI_l", 2 * A[1] * w)
        points, names = self.axial_points, "abc" if self.curvature == "exact" else "a"
        every = self._at_points(program, "", names, points, c)
        strains, bending = [], []
        weighted = [self._weighted(program, points, g, "EI", EI) for g in range(len(points)) if names == "abc"]
        for g, (invariants, *_) in enumerate(every):
            if names == "a":
                strains.append(self._axial_strain(program, f"_{g}", *invariants))
                bending.append(sp.S.Zero)
                continue
            strain, k2, _ = self.measures(program, f"_{g}", invariants, weighted[g])
            strains.append(strain)
            bending.append(k2)
        stresses = self._stresses(program, A, w, points, strains)
        for (invariants, vectors, series), k2, strain, stress in zip(every, bending, strains, stresses, strict=True):
            yield Term(names, k2, invariants, vectors, series, strain, stress, bending=k2)
        if names == "abc":
            return
        program.stage("curvature at the quadrature points")
        points = self.bending_points
        for g, (invariants, vectors, series) in enumerate(self._at_points(program, "b", "c", points, c)):
            twice = self._weighted(program, points, g, "EI", EI) * invariants[0]
            yield Term("c", twice, invariants, vectors, series, bending=twice)

    # --- the strain by its modes ------------------------------------------------------------------------------

    def _stiffnesses(self, program: Program, A: np.ndarray, w: sp.Expr) -> list[sp.Expr]:
        """Return EA_m l/2 of each mode m of the strain, N m."""
        full, upper = (program.define_once(name, value / (2 * w))
                       for name, value in (("EA_l", A[0]), ("EA_up_l", A[2])))
        return [full if m < self.n_full else upper for m in range(self.degree)]

    def _modes(self, program: Program, points: Sequence[Point], strains: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return strain_m from the strain at points, which come in pairs at X and -X."""
        program.stage("strain by its Legendre modes")
        total = [sp.S.Zero] * self.degree
        for here in range((len(points) + 1) // 2):
            there = len(points) - 1 - here
            point, parts = points[here], [strains[here]]
            if there != here:
                parts = [program.define(f"{kind}_eps_{here}", strains[here] + sign * strains[there])
                         for kind, sign in (("even", 1), ("odd", -1))]
            for m in range(0, self.degree, 3 - len(parts)):
                total[m] += sp.Rational(2 * m + 1, 2) * point.weight * point.value[m] * parts[m % 2]
        return [program.define(f"eps_m{m}", value) for m, value in enumerate(total)]

    def _stresses(self, program: Program, A: np.ndarray, w: sp.Expr, points: Sequence[Point],
                  strains: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return derivatives of twice the membrane energy by the strain at the points."""
        modes = self._modes(program, points, strains)
        program.stage("normal force at the quadrature points")
        N = [program.define(f"N_m{m}", EA * eps)
             for m, (EA, eps) in enumerate(zip(self._stiffnesses(program, A, w), modes, strict=True))]
        found: list[Any] = [None] * len(points)
        for here in range((len(points) + 1) // 2):
            there, point = len(points) - 1 - here, points[here]
            even, odd = (program.define(f"{kind}_N_{here}", sum(
                2 * point.weight * point.value[m] * N[m] for m in range(first, self.degree, 2)))
                for kind, first in (("even", 0), ("odd", 1)))
            found[here] = program.define(f"stress_{here}", even + odd if there != here else even, alias=True)
            if there != here:
                found[there] = program.define(f"stress_{there}", even - odd)
        return found

    def _product(self, m: int, i: int, k: int) -> sp.Rational:
        """Return (2m + 1)/2 ∫ P_m P_i P_k dX."""
        integrand = integrals.legendre(m) * integrals.legendre(i) * integrals.legendre(k)
        total = sum((c * 2 / (powers[0] + 1) for powers, c in integrand.terms() if powers[0] % 2 == 0), sp.QQ(0))
        return sp.Rational(2 * m + 1, 2) * sp.Rational(int(total.numerator), int(total.denominator))

    def _product_at_points(self, m: int, i: int, k: int) -> sp.Expr:
        """Return the same by the quadrature of the membrane, which may have too few points."""
        points = self.axial_points
        if m + i + k < 2 * len(points):
            return self._product(m, i, k)
        if (m + i + k) % 2:
            return sp.S.Zero
        values = [float(point.weight * point.value[m] * point.value[i] * point.value[k]) for point in points]
        # not sum(), which compensates since Python 3.12: generated text must have the same digits everywhere
        return sp.Float((2 * m + 1) / 2 * reduce(add, values))

    # --- second derivatives -----------------------------------------------------------------------------------

    def _tangent(self, program: Program, A: np.ndarray, c: np.ndarray, w: sp.Expr, terms: list[Term]) -> np.ndarray:
        """Return d2U/dc2 over strain vectors: at the points with the stress constant, and what the stress changes."""
        total = np.array(0)
        for names in dict.fromkeys(term.names for term in terms):
            total = total + self._second(program, [term for term in terms if term.names == names])
        axial = [term for term in terms if term.strain != 0]
        by_vectors = self._mode_gradients(program, c, axial)
        program.stage("stress changed by the strain's modes")
        stiffness = self._stiffnesses(program, A, w)
        for m, gradient in enumerate(by_vectors):
            factor = program.define(f"EA_m{m}", sp.Rational(2, 2 * m + 1) * stiffness[m])
            stressed = [program.vector(f"dN_m{m}_{self.gram.names[i]}", [factor * v for v in vector])
                        for i, vector in enumerate(gradient)]
            for i, vector in enumerate(gradient):
                for k in range(i, len(gradient)):
                    total[i, k] = total[i, k] + np.outer(vector, stressed[k])
        program.stage("blocks over strain vectors")
        return named_blocks(program, self.gram.names, total, symmetric=True)

    def _mode_gradients(self, program: Program, c: np.ndarray, terms: list[Term]) -> np.ndarray:
        """Return derivatives of strain_m by the strain vectors, (m, n, dim)."""
        program.stage("derivatives of the strain's modes")
        d = range(self.degree)
        along = [c[m] for m in self.axis_indices]
        if self.strain == "green":
            values = [[sum((self._product_at_points(m, i, k) * along[k] for k in d), np.zeros(len(c[0]), dtype=object))
                       for i in d] for m in d]
        else:
            tangents = [program.vector(f"t_{g}", sp.Symbol(f"inv_len_{g}") * term.vectors[0])
                        for g, term in enumerate(terms)]
            series = [[sp.Rational(2 * m + 1, 2) * point.weight * point.value[m] * point.value[i] for m in d for i in d]
                      for point in self.axial_points]
            values = list(gathered(program, "t", series, tangents).reshape(len(d), len(d), -1))
        return np.array([[program.vector(f"eps_m{m}_{self.gram.names[i]}", value) for i, value in enumerate(row)]
                         for m, row in enumerate(values)])

    def stress_of_turning(self, program: Program, A: np.ndarray, change: np.ndarray, w: sp.Expr) -> np.ndarray:
        """See `Cable`: |dr'|^2/8 by its modes."""
        program.stage("strain of the change by its Legendre modes")
        d = range(self.degree)
        along = [change[m] for m in self.axis_indices]
        products = {(i, k): program.define(f"dG_{self.gram.names[i]}{self.gram.names[k]}", along[i].dot(along[k]))
                    for i in d for k in d if i <= k}
        blocks = np.zeros((len(self.gram.names), len(self.gram.names), 1, 1), dtype=object)
        for m, stiffness in enumerate(self._stiffnesses(program, A, w)):
            strain = sum(self._product(m, i, k) * (1 if i == k else 2) * product / 8
                         for (i, k), product in products.items())
            N = program.define(f"N_m{m}", sp.Rational(2, 2 * m + 1) * stiffness * strain)
            for i in d:
                for k in d:
                    blocks[i, k] += self._product(m, i, k) * N
        return blocks

    # --- sections ---------------------------------------------------------------------------------------------

    def membrane(self, program: Program, S: np.ndarray, c: np.ndarray, X: sp.Expr, strain: sp.Expr) -> tuple[Any, ...]:
        """Return energy per length whose derivative is the membrane's force, what is constant in it, and the strain:
        the modes' normal force and strain at X.
        """
        points = self.axial_points
        strains = [self._axial_strain(program, f"_{g}", *invariants)
                   for g, (invariants, *_) in enumerate(self._at_points(program, "", "a", points, c))]
        modes = self._modes(program, points, strains)
        program.stage("strain and normal force at the section")
        values = [eps * sp.legendre(m, X) for m, eps in enumerate(modes)]
        N = program.define("N", sum((S[0] if m < self.n_full else S[2]) * value for m, value in enumerate(values)))
        return N * strain, [N], program.define("eps_section", sum(values))
