"""Cable: 1/2 EA strain^2 + 1/2 EI curvature^2 along the centreline, by Gauss quadrature.

strain "green": (r'.r' - 1)/2, "engineering": |r'| - 1. Curvature "exact": |r' x r''|/|r'|^3 with the green strain
and |r' x r''|/|r'|^2 with the engineering one; "linear": |r''|, a constant bending stiffness, valid while the
stretch is small. At a point all depend on a = r'.r', b = r'.r'' and c = r''.r'' only: the chain rule goes through them
and never through the coordinates.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby

import numpy as np
import sympy as sp
from funicular.derive import moments
from funicular.derive.gram import Gram
from funicular.derive.laws.cable_blocks import by_vectors, named_blocks, spread
from funicular.derive.laws.cable_damping import Damping
from funicular.derive.laws.cable_section import resultants
from funicular.derive.stages import Program, jacobian

SOURCE = "DESIGN 4; Gerstmayr & Shabana, Nonlinear Dyn. 45 (2006) 109-130; Berzeri & Shabana, J. Sound Vib. 235 (2000)"
STIFFNESS_DOC = "axial and bending stiffness EA, EI"


@dataclass(frozen=True)
class Point:
    """A quadrature point on [-1, 1]: weight, and the Legendre series of r' and (l/2) r'' there."""

    weight: sp.Float
    value: tuple[sp.Float, ...]
    slope: tuple[sp.Float, ...]


@dataclass(frozen=True)
class Term:
    """A point's share of the energy: weight times density, its invariants by name, and their rows over Gram pairs."""

    names: str
    point: Point
    density: sp.Expr
    invariants: list[sp.Expr]
    rows: list[list[sp.Expr]]


class Cable(Damping):
    """The law over an element's Gram products."""

    source, curved, set_up_kernel = SOURCE, False, "stiffness"

    def __init__(self, gram: Gram, strain: str, curvature: str):
        self.gram, self.strain, self.curvature = gram, strain, curvature
        self.name = f"{strain}_{curvature}"
        self.doc = f"cable with {strain} strain and {curvature} curvature"

    @cached_property
    def degree(self) -> int:
        """Degree of the centreline."""
        return len(self._axis)

    @cached_property
    def axis_indices(self) -> list[int]:
        """The strain vectors along the axis."""
        return [m for m, name in enumerate(self.gram.names) if name.startswith("t")]

    @cached_property
    def _axis(self) -> list:
        """Their polynomials in X."""
        return [self.gram.gradient[m][0] for m in self.axis_indices]

    def points(self, n: int) -> list[Point]:
        """Gauss-Legendre."""
        nodes, weights = np.polynomial.legendre.leggauss(n)
        return [Point(_number(w), tuple(_number(_at(p, x)) for p in self._axis),
                      tuple(_number(_at(p.diff(moments.X), x)) for p in self._axis))
                for x, w in zip(nodes.tolist(), weights.tolist(), strict=True)]

    @property
    def axial_points(self) -> list[Point]:
        """Those of the exact curvature with it; else exact for the green strain, whose square has degree 4(d - 1)."""
        return self.points(2 * self.degree - 1) if self.curvature == "linear" else self.bending_points

    @property
    def bending_points(self) -> list[Point]:
        """Exact for the linear curvature; five, or the degree, where it is a quotient.

        Against converged quadrature, the tip of the pendulum D0 (8 elements, t = 1) is off by 5e-5 with four points
        and by 2e-6 with five on cubic elements, where the mesh is off by 4e-3; by 4e-6 with five on quintic ones (with
        4 elements by 2e-4, where the mesh is off by 4e-3).
        """
        return self.points(self.degree - 1 if self.curvature == "linear" else max(5, self.degree))

    def constants(self, program: Program) -> np.ndarray:
        """Input A."""
        return program.input("A", 2, "N, N m^2", STIFFNESS_DOC)

    def section_stiffness(self, program: Program) -> np.ndarray:
        """Input S."""
        return program.input("S", 2, "N, N m^2", STIFFNESS_DOC)

    def set_up(self, program: Program) -> None:
        """Inputs l, S and output A, which is S."""
        program.input("l", (), "m", "length of the element")
        program.output("A", self.section_stiffness(program), "N, N m^2", STIFFNESS_DOC)

    def section_forces(self, program: Program, S: np.ndarray, c: np.ndarray, X, w, c0=None) -> tuple:
        """Stages: force and moment in space, and strain, at X; c0 of a curved stress-free shape."""
        return resultants(self, program, S, c, X, w, c0)

    # --- the energy through the invariants ------------------------------------------------------------------

    def _axial_strain(self, program: Program, tag: str, a1: sp.Expr) -> sp.Expr:
        """From a - 1, without losing the digits of a small strain."""
        if self.strain == "green":
            return program.define(f"eps{tag}", a1 / 2)
        length = program.define(f"len{tag}", sp.sqrt(1 + a1))
        return program.define(f"eps{tag}", a1 / (1 + length), moves_as=length)  # |r'| - 1

    def _invariants(self, program: Program, tag: str, point: Point, G, names: str) -> tuple[list, list]:
        """a - 1, b, c at a point, as far as named: symbols, and rows over the pairs."""
        every = {"a": ("a1", point.value, point.value), "b": ("b", point.value, point.slope),
                 "c": ("c", point.slope, point.slope)}
        rows = [self._row(*every[name][1:]) for name in names]
        return [program.define(f"{every[name][0]}_{tag}", _dot(row, G))
                for name, row in zip(names, rows, strict=True)], rows

    def _terms(self, program: Program, A, G, w) -> Iterator[Term]:
        """Stages: the energy point by point."""
        program.stage("strain at the quadrature points")
        EA, EI = program.define("EA_l", A[0] / (2 * w)), program.define("EI_l", 2 * A[1] * w)
        if self.curvature == "exact":
            for g, point in enumerate(self.bending_points):
                invariants, rows = self._invariants(program, f"{g}", point, G, "abc")
                strain, k2, _ = self.measures(program, f"_{g}", *invariants)
                yield Term("abc", point, point.weight * (EA * strain**2 + EI * k2) / 2, invariants, rows)
            return
        for g, point in enumerate(self.axial_points):
            invariants, rows = self._invariants(program, f"{g}", point, G, "a")
            strain = self._axial_strain(program, f"_{g}", *invariants)
            yield Term("a", point, point.weight * EA * strain**2 / 2, invariants, rows)
        program.stage("curvature at the quadrature points")
        for g, point in enumerate(self.bending_points):
            invariants, rows = self._invariants(program, f"b{g}", point, G, "c")
            yield Term("c", point, point.weight * EI * invariants[0] / 2, invariants, rows)

    def measures(self, program: Program, tag: str, a1: sp.Expr, b: sp.Expr, c: sp.Expr) -> tuple:
        """Axial strain, squared curvature, and what leads to it from |r' x r''|^2; None where it is |r''|^2."""
        strain = self._axial_strain(program, tag, a1)
        if self.curvature == "linear":
            return strain, c, None
        a = program.define(f"a{tag}", 1 + a1)
        scale = program.define(f"inv_a{tag}", 1 / a) ** (3 if self.strain == "green" else 2)
        return strain, program.define(f"k2{tag}", (a * c - b * b) * scale), scale

    def _row(self, f: Sequence, g: Sequence) -> list[sp.Expr]:
        """Coefficients over the pairs of the product of the series f and g."""
        value, slope = (dict(zip(self.axis_indices, series, strict=True)) for series in (f, g))
        row = []
        for a, b in self.gram.pairs:
            if a not in value or b not in value:
                row.append(sp.S.Zero)
            else:
                row.append(_number(value[a] * slope[b] + (value[b] * slope[a] if a != b else 0)))
        return row

    def energy(self, program: Program, A, G, w) -> sp.Expr:
        """U."""
        return sum(term.density for term in self._terms(program, A, G, w))

    def stress(self, program: Program, A, G, w) -> list[sp.Expr]:
        """Stages: u = dU/dG."""
        u = [sp.S.Zero] * len(self.gram.pairs)
        for term in list(self._terms(program, A, G, w)):
            for d, row in zip(_first(program, term), term.rows, strict=True):
                u = [total + d * r for total, r in zip(u, row, strict=True)]
        program.stage("u = dU/dG")
        return [program.define(f"u_{self.gram.pair(p)}", value) for p, value in enumerate(u)]

    def tangent(self, program: Program, A, G, c, w) -> np.ndarray:
        """Stages: d2U/dc2 over strain vectors."""
        total = np.array(0)
        for _, terms in groupby(list(self._terms(program, A, G, w)), key=lambda term: term.names):
            total = total + self._second(program, list(terms), c)
        program.stage("blocks over strain vectors")
        return named_blocks(program, self.gram.names, total, symmetric=True)

    def _second(self, program: Program, terms: list[Term], c: np.ndarray) -> np.ndarray:
        """Stages: second derivatives of the terms of a rule, over strain vectors."""
        program.stage("second derivatives at the quadrature points")
        names, factors, at_points = terms[0].names, [], []
        for g, term in enumerate(terms):
            point = term.point
            series = {"a": [point.value], "c": [point.slope], "abc": [point.value, point.slope]}[names]
            vectors = [program.vector(f"r{names[i]}{g}", sum(f * v for f, v in zip(s, c, strict=True)))
                       for i, s in enumerate(series)]
            first = _first(program, term)
            second = jacobian(program, np.array(first), term.invariants)
            at_points.append(by_vectors(program, f"{names}{g}", names, vectors, first, second))
            factors.append(series)
        return spread(program, names, factors, at_points, symmetric=True)


def _first(program: Program, term: Term) -> list[sp.Expr]:
    """Derivatives of a term by its invariants."""
    gradient = jacobian(program, np.array([term.density]), term.invariants)[0]
    return [program.define(f"W_{s.name}", d) for s, d in zip(term.invariants, gradient, strict=True)]


def _number(value) -> sp.Expr:
    """A double as the kernels will hold it; small integers are exact."""
    value = float(value)
    return sp.Integer(round(value)) if abs(value - round(value)) < 1e-15 else sp.Float(value)


def _at(p, x: float):
    """Value of a ring polynomial in X."""
    return sum(float(c) * x ** k[0] for k, c in p.terms())


def _dot(row: Sequence[sp.Expr], G: Sequence[sp.Expr]) -> sp.Expr:
    return sum((r * g for r, g in zip(row, G, strict=True)), sp.S.Zero)

