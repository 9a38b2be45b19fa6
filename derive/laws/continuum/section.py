"""Force and moment resultants of a continuum at a point of its axis: integrals over the section of P e_x and of its
moment about the axis, P = F S the first Piola-Kirchhoff stress.

Strain and F are polynomials in y and z there; what is left are section moments of the elastic constants, the table S.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ...algebra.gram_point import Expansion, expansion
from ...algebra.section_integrals import SECTION
from ...algebra.tangent_frame import cross, spatial
from ...codegen.program import Program


class Resultants:
    """Of a law D E with the section stiffness S, at X."""

    def __init__(self, form: Any, program: Program, S: np.ndarray, c: np.ndarray, X: sp.Expr, w: sp.Expr):
        self.form, self.program, self.S = form, program, S
        gram = form.gram
        self.dim = gram.element.dim
        program.stage("columns of F as polynomials in y and z")
        by = "xyz"[: self.dim]
        self.F = [self._named(f"F{by[i]}", expansion([g[i] for g in gram.gradient], c, X, w)) for i in range(self.dim)]
        self.arm = self._named("arm", {power: v for power, v in expansion(gram.psi, c, X, w).items() if any(power)})
        program.stage("Green strain as polynomials in y and z")
        self.E = {(i, j): self._strain(i, j) for i in range(self.dim) for j in range(i, self.dim)}
        self._moments: dict[tuple[Any, ...], sp.Expr] = {}

    def _named(self, name: str, parts: Expansion) -> Expansion:
        return {power: self.program.vector(name + _suffix(power), v) for power, v in sorted(parts.items())}

    def _strain(self, i: int, j: int) -> dict[tuple[int, int], sp.Expr]:
        """Return E_ii, and gamma_ij = 2 E_ij."""
        total: dict[tuple[int, int], sp.Expr] = {}
        for (a, b), u in self.F[i].items():
            for (c, d), v in self.F[j].items():
                total[a + c, b + d] = total.get((a + c, b + d), 0) + u.dot(v)
        if i == j:
            total[0, 0] = total[0, 0] - 1
        half = sp.Rational(1, 2) if i == j else 1
        return {power: self.program.define(f"E{'xyz'[i]}{'xyz'[j]}{_suffix(power)}", half * value)
                for power, value in sorted(total.items())}

    def stress(self, j: int, power: tuple[int, int]) -> sp.Expr:
        """Return the integral over A of S_xj times powers of y and z."""
        if (j, power) not in self._moments:
            total = sp.S.Zero
            for kl, strain in self.E.items():
                k = self.form.elasticity.get(((0, j), kl))
                if k is None:
                    continue
                for (a, b), value in strain.items():
                    moment = SECTION.get((a + power[0], b + power[1]))
                    if moment is not None:  # the odd ones are zero
                        total += self.S[k, moment] * value
            name = f"{'xyz'[j]}{_suffix(power)}"
            self._moments[j, power] = self.program.define(f"N{name}", total)
        return self._moments[j, power]

    def strain(self) -> list[sp.Expr]:
        """Return strains, axial, shear along y and z, twist, curvatures about y and z: what of the Green strain a
        section that stays plane would have.
        """
        def of(i: int, j: int, *power: int) -> sp.Expr:
            return self.E.get((i, j), {}).get((power[0], power[1]), sp.S.Zero)

        return [of(0, 0, 0, 0), of(0, 1, 0, 0), of(0, 2, 0, 0), (of(0, 2, 1, 0) - of(0, 1, 0, 1)) / 2,
                of(0, 0, 0, 1), -of(0, 0, 1, 0)]

    def force(self) -> np.ndarray:
        """Return the integral of P e_x."""
        self.program.stage("moments of the stress over the section")
        return spatial(sum((self.stress(j, power) * v for j, column in enumerate(self.F)
                            for power, v in column.items()), np.zeros(self.dim, dtype=object)))

    def moment(self) -> np.ndarray:
        """Return the integral of the arm times P e_x."""
        total = np.full(3, sp.S.Zero)
        for (a, b), arm in self.arm.items():
            for j, column in enumerate(self.F):
                for (c, d), v in column.items():
                    total = total + self.stress(j, (a + c, b + d)) * cross(spatial(arm), spatial(v))
        return total


def _suffix(power: tuple[int, int]) -> str:
    return "_" + ("y" * power[0] + "z" * power[1] or "0")
