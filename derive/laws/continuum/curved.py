"""St. Venant-Kirchhoff continuum with a curved stress-free shape e0, eq 5: D = dr/dX with J0 = dr0/dx of e0.

E = J0^-T (F'F - F0'F0)/2 J0^-1 is linear in G - G0 at every point, so the energy is the same quadratic form with a
dense A and the G0 of e0. J0 is not a polynomial: A is a sum over points of the volume, each by the kernel
`stiffness_at`, once for an element. Axes of the elastic constants are the tangent frame of the stress-free axis.
Damping takes the form of the straight law, whose components are those of the tangent frame but for a part of the order
of section over radius.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from ...algebra.gram import DIRECTIONS, Gram
from ...algebra.gram_point import by_section
from ...codegen.program import Program
from ...spec import LawTraits
from .. import stress_free
from .continuum import ROWS, Continuum, Form
from .curved_point import Metric, at_point, columns, frame, voigt
from .curved_section import resultants

NAME = "continuum_curved"
TRAITS = LawTraits("continuum", straight="continuum", takes_shape=True, damped_like="continuum")


class DenseForm(Form):
    """All entries of a symmetric A, row by row from the diagonal, `start` other constants before them."""

    def __init__(self, gram: Gram, start: int):
        super().__init__(gram)
        n = len(gram.pairs)
        upper = [(p, q) for p in range(n) for q in range(p, n)]
        self.stop = start + len(upper)
        self.places = {place: k for k, (p, q) in enumerate(upper, start) for place in ((p, q), (q, p))}

    @property
    def index(self) -> dict[tuple[int, int], int]:
        """Return the index into A of its entries."""
        return self.places


class CurvedContinuum(Continuum):
    """The law with e0."""

    set_up_kernel = "stiffness_at"
    name, doc = NAME, "St. Venant-Kirchhoff continuum, orthotropic, its stress-free shape curved"

    form: DenseForm

    def __init__(self, gram: Gram):
        self.gram, self.straight = gram, Form(gram)
        self.form = DenseForm(gram, len(self.straight.constants))

    def constants(self, program: Program) -> np.ndarray:
        """Declare the input A: the straight law's constants, the form over Gram pairs in N m, and its G0; return it."""
        element = self.gram.element.name
        return program.input("A", self.form.stop + len(self.gram.pairs), "N m, 1",
                             f"A of {element}_continuum_stiffness; form over Gram pairs, summed over "
                             f"{element}_{NAME}_stiffness_at; its G0")

    def set_up(self, program: Program) -> None:
        """Declare the inputs l, e0, at, D and the outputs A, G0: the contribution of a point of the volume."""
        length = program.input("l", (), "m", "length of the element")
        e0 = stress_free.shape(program, self.gram.element)
        at = program.input("at", 3, "m", "local coordinates x, y, z of a point")
        D = program.input("D", len(ROWS[self.gram.element.dim]), "N m",
                          "elastic constants there times the volume that it stands for: "
                          + ", ".join(ROWS[self.gram.element.dim]))
        program.stage("stress-free shape")
        w = program.define("w", 1 / length)
        X = program.define("X", 2 * w * at[0] - 1)
        c0 = self.gram.differences(program, e0, w)
        F0 = columns(self.gram, c0, X, w)
        R = frame(program, F0, DIRECTIONS.index(self.gram.element.director[-1]))
        metric = Metric(program, "", R, at_point(program, "F0", F0, at[1], at[2]))
        program.stage("elastic constants over F'F")
        C = metric.pulled(D, self.form.elasticity)
        program.stage("F'F over the Gram pairs")
        rows = self._rows(program, X, at[1], at[2], w)
        program.stage("A")
        n = len(self.gram.pairs)
        moved = [[program.define(f"s{i}_{self.gram.pair(q)}", sum(C[i][k] * rows[k][q] for k in range(len(rows))))
                  for q in range(n)] for i in range(len(rows))]
        A = [sum(rows[i][p] * moved[i][q] for i in range(len(rows))) for p in range(n) for q in range(p, n)]
        program.output("A", A, "N m", "form over Gram pairs, row by row from the diagonal")
        program.output("G0", [c0[a].dot(c0[b]) - self.gram.reference[p] for p, (a, b) in enumerate(self.gram.pairs)],
                       "1", "Gram products of e0, less those of a straight element")

    def _rows(self, program: Program, X: sp.Expr, y: sp.Expr, z: sp.Expr, w: sp.Expr) -> list[list[sp.Expr]]:
        """Return the coefficients over the pairs of (F'F)_ii/2 and (F'F)_ij, in Voigt's order."""
        rows: list[list[sp.Expr]] = []
        known: dict[sp.Expr, sp.Expr] = {}
        for i, j in voigt(self.gram.element.dim):
            row = []
            for polynomial in self.form.strain[i, j]:
                parts = by_section(polynomial, X, w) if polynomial else {}
                value = sum((factor * y**a * z**b for (a, b), factor in parts.items()), sp.S.Zero)
                value = value / 2 if i == j else value
                if value not in known:
                    known[value] = program.define(f"p{len(known)}", value)
                row.append(known[value])
            rows.append(row)
        return rows

    def _strain(self, program: Program, A: np.ndarray, c: np.ndarray) -> list[sp.Expr]:
        """Return Gram products, less those of the stress-free shape."""
        G = super()._strain(program, A, c)
        program.stage("Gram products less those of e0")
        return [program.define(f"g_{self.gram.pair(p)}", value - A[self.form.stop + p]) for p, value in enumerate(G)]

    def _viscous_moduli(self, A: np.ndarray) -> dict[tuple[int, int], Any]:
        return {pq: A[k] for pq, k in self.straight.index.items()}

    def section_forces(self, program: Program, S: np.ndarray, c: np.ndarray, X: sp.Expr, w: sp.Expr,
                       c0: np.ndarray | None = None) -> tuple[Any, ...]:
        """Return force and moment in space, and strain, at X."""
        assert c0 is not None  # the kernel has the stress-free shape
        return resultants(self.gram, self.form.elasticity, program, S, c, c0, X, w)
