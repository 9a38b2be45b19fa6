"""Gram products of strain vectors, the arguments of every elastic energy that rigid motion does not change (eq 5-8).

r is linear in the nodal vectors, so r = sum_m c_m psi_m in any other basis psi of the same span. With psi_0 = 1
and the others built on Legendre polynomials along the axis, the gradient F needs the *strain vectors* c_m,
m > 0, only: combinations of slopes and of differences of positions. The energy is a function of their Gram products
G_mn = c_m . c_n; a law (laws/) gives u = dU/dG and A = d2U/dG2, and then

    f_m = sum_n u_mn dG_mn/dc_m,   K = B' A B + u (x) I,   B = dG/dc.

G0 belongs to the straight reference of length l, whose strain vectors are unit axes; programs stage G - G0.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp
from sympy.polys.rings import PolyElement

from ..codegen.program import Program
from ..spec import Element, l, x, y, z
from . import section_integrals as integrals

DIRECTIONS = "xyz"


class Gram:
    """Strain vectors and Gram pairs of an element, and the stages that lead from and to its nodal vectors."""

    def __init__(self, element: Element):
        self.element = element
        ring_basis, names = [], []
        for monomial in element.basis:
            a, b, c = sp.Poly(monomial, x, y, z).monoms()[0]
            section = integrals.Y**b * integrals.Z**c
            if b == c == 0 and a > 0:  # the axis: psi' = P_{a-1}, so that r_x is a Legendre series
                psi = _antiderivative(integrals.legendre(a - 1))
                names.append(f"t{a - 1}")
            else:
                psi = section * integrals.legendre(a)
                names.append("y" * b + "z" * c + str(a))
            ring_basis.append(psi)
        self.psi = ring_basis[1:]
        self.names = names[1:]
        self.all_psi = ring_basis

    @cached_property
    def pairs(self) -> list[tuple[int, int]]:
        """Return the pairs m <= n of strain vectors."""
        n = len(self.psi)
        return [(a, b) for a in range(n) for b in range(a, n)]

    @cached_property
    def transform(self) -> sp.Matrix:
        """Return T with c = T d over nodal vectors d (rows: strain vectors), exact in l."""
        functions = [_to_sympy(p) for p in self.all_psi]
        return self.element.nodal_conditions(functions).inv().applyfunc(sp.cancel)[1:, :]

    @cached_property
    def gradient(self) -> list[list[Any]]:
        """Return gradient with F = sum_m c_m (x) gradient[m]: derivatives of psi_m by x, y, z in the ring of
        polynomials.
        """
        by: list[Callable[[PolyElement], PolyElement]] = [integrals.d_dx, lambda p: p.diff(integrals.Y),
                                                          lambda p: p.diff(integrals.Z)]
        return [[by[i](p) for i in range(self.element.dim)] for p in self.psi]

    @cached_property
    def reference(self) -> list[int]:
        """Return G0 over the pairs: the straight reference r = (x, y, z) has c = unit axes, the rest zero."""
        axis = {name: i for i, name in enumerate(("t0", "y0", "z0")[: self.element.dim])}
        return [int(a == b and self.names[a] in axis) for a, b in self.pairs]

    def differences(self, program: Program, e: np.ndarray, w: sp.Expr, tag: str = "") -> np.ndarray:
        """Return the strain vectors (m, dim) of nodal vectors e (n, dim), through chords (r_k - r_1) w, w = 1/l."""
        return self.of_chords(program, self.chords(program, e, w, tag), tag)

    def chords(self, program: Program, e: np.ndarray, w: sp.Expr, tag: str = "") -> np.ndarray:
        """Return nodal vectors (n, dim) with chords (r_k - r_1) w in place of positions."""
        return np.array([program.vector(f"chord{tag}{k}" if v else "", (e[k] - e[0]) * w) if v else e[k]
                         for k, v in enumerate(self.element.is_position)])

    def of_chords(self, program: Program, d: np.ndarray, tag: str = "") -> np.ndarray:
        """Return the strain vectors (m, dim) of nodal vectors d with chords in place of positions."""
        return np.array([
            program.vector(f"{tag}{name}", sum(self.scaled[m][k] * d[k] for k in range(1, len(d))
                                               if self.scaled[m][k] != 0))
            for m, name in enumerate(self.names)])

    def gram(self, program: Program, c: np.ndarray) -> list[sp.Expr]:
        """Return G - G0 over the pairs."""
        return [program.define(f"G_{self.pair(p)}", c[a].dot(c[b]) - self.reference[p])
                for p, (a, b) in enumerate(self.pairs)]

    def gram_rate(self, program: Program, c: np.ndarray, rate: np.ndarray) -> list[sp.Expr]:
        """Return dG/dt over the pairs."""
        return [program.define(f"dG_{self.pair(p)}", c[a].dot(rate[b]) + rate[a].dot(c[b]))
                for p, (a, b) in enumerate(self.pairs)]

    def by_vector(self, c: np.ndarray, p: int, m: int) -> np.ndarray | None:
        """Return dG_p/dc_m, a vector, or None where it is zero."""
        a, b = self.pairs[p]
        if a == b == m:
            return np.asarray(2 * c[m])
        return c[b] if a == m else c[a] if b == m else None

    def vector_forces(self, program: Program, c: np.ndarray, u: Sequence[sp.Expr]) -> np.ndarray:
        """Return f_m = sum_p u_p dG_p/dc_m."""
        terms = [[u[p] * g for p in range(len(self.pairs)) if (g := self.by_vector(c, p, m)) is not None]
                 for m in range(len(self.names))]
        return np.array([program.vector(f"f_{name}", sum(t)) for name, t in zip(self.names, terms, strict=True)])

    def nodal_forces(self, program: Program, f: np.ndarray, w: sp.Expr) -> np.ndarray:
        """Return the forces on nodal vectors (n, dim) from forces f on strain vectors, f_d = T' f_c, in N and N m."""
        nodal: list[Any] = []
        for k, position in enumerate(self.element.is_position):
            column = sum(self.scaled[m][k] * f[m] for m in range(len(f)) if self.scaled[m][k] != 0)
            nodal.append(program.vector(f"f_{self.element.names[k]}", column * w if position else column))
        nodal[0] = -sum(nodal[k] for k, position in enumerate(self.element.is_position) if position and k)
        return np.array(nodal)

    @cached_property
    def scaled(self) -> list[list[sp.Expr]]:
        """Return T with positions measured in lengths l: plain rationals."""
        scale = [l if p else 1 for p in self.element.is_position]
        return [[sp.cancel(self.transform[m, k] * scale[k]) for k in range(self.element.n_vectors)]
                for m in range(len(self.names))]

    def pair(self, p: int) -> str:
        """Return the name of a Gram pair."""
        a, b = self.pairs[p]
        return self.names[a] + self.names[b]


def _antiderivative(p: PolyElement) -> PolyElement:
    """Return the integral from the element's start of a polynomial in X, times dx/dX = l/2."""
    integral = sum((integrals.RING(c / (k[0] + 1)) * integrals.X ** (k[0] + 1) for k, c in p.terms()),
                   integrals.RING(0))
    at_start = sum((c * (-1) ** k[0] for k, c in integral.terms()), integrals.RING(0))
    return (integral - at_start) * integrals.L / 2


def _to_sympy(p: PolyElement) -> sp.Expr:
    return p.as_expr(2 * x / l - 1, y, z, l, 1 / l)
