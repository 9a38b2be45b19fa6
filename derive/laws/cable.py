"""Cable: 1/2 EA strain^2 + 1/2 EI curvature^2 along the centreline, by Gauss quadrature.

strain "green": (r'.r' - 1)/2, "engineering": |r'| - 1. Curvature "exact": |r' x r''|/|r'|^3 with the green strain
and |r' x r''|/|r'|^2 with the engineering one; "linear": |r''|, a constant bending stiffness, valid while the
stretch is small. At a point all depend on a = r'.r', b = r'.r'' and c = r''.r'' only, which are linear in the Gram
products: the chain rule goes through them and never through the coordinates.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import sympy as sp
from funicular.derive import moments
from funicular.derive.gram import Gram
from funicular.derive.laws.cable_section import resultants
from funicular.derive.stages import Derivation, Program, jacobian

SOURCE = "DESIGN 4; Gerstmayr & Shabana, Nonlinear Dyn. 45 (2006) 109-130; Berzeri & Shabana, J. Sound Vib. 235 (2000)"
STIFFNESS_DOC = "axial and bending stiffness EA, EI"


@dataclass(frozen=True)
class Point:
    """A quadrature point on [-1, 1]: weight, and the Legendre series of r' and (l/2) r'' there."""

    weight: sp.Float
    value: tuple[sp.Float, ...]
    slope: tuple[sp.Float, ...]


class Cable:
    """The law over an element's Gram products."""

    source = SOURCE

    def __init__(self, gram: Gram, strain: str, curvature: str):
        self.gram, self.strain, self.curvature = gram, strain, curvature
        self.name = f"{strain}_{curvature}"
        self.doc = f"cable with {strain} strain and {curvature} curvature"

    @cached_property
    def degree(self) -> int:
        """Degree of the centreline."""
        return len(self._axis)

    @cached_property
    def _axis(self) -> list:
        """Polynomials in X of the strain vectors along the axis."""
        return [self.gram.gradient[m][0] for m in self._axis_indices]

    def points(self, n: int) -> list[Point]:
        """Gauss-Legendre."""
        nodes, weights = np.polynomial.legendre.leggauss(n)
        return [Point(_number(w), tuple(_number(_at(p, x)) for p in self._axis),
                      tuple(_number(_at(p.diff(moments.X), x)) for p in self._axis))
                for x, w in zip(nodes.tolist(), weights.tolist(), strict=True)]

    @property
    def axial_points(self) -> list[Point]:
        """Exact for the green strain, whose square has degree 4(d - 1)."""
        return self.points(2 * self.degree - 1)

    @property
    def bending_points(self) -> list[Point]:
        """Exact for the linear curvature; three points more where it is a quotient.

        Against converged quadrature, the tip of the pendulum D0 (8 elements, t = 1) is off by 5e-5 with four points
        and by 2e-6 with five; the mesh by 4e-3.
        """
        return self.points(self.degree - 1 if self.curvature == "linear" else self.degree + 2)

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

    def section_forces(self, program: Program, S: np.ndarray, c: np.ndarray, X: sp.Expr, w: sp.Expr) -> tuple:
        """Stages: force and moment in space, and strain, at X."""
        return resultants(self, program, S, c, X, w)

    # --- the energy through the invariants ------------------------------------------------------------------

    def axial_strain(self, program: Program, name: str, a1: sp.Expr) -> sp.Expr:
        """From a - 1, without losing the digits of a small strain."""
        if self.strain == "green":
            return program.define(name, a1 / 2)
        length = program.define("len", sp.sqrt(1 + a1))
        return program.define(name, a1 / (1 + length), moves_as=length)  # |r'| - 1

    def curvature_scale(self, program: Program, a1: sp.Expr) -> sp.Expr | None:
        """From |r' x r''|^2 to the squared curvature; None where it is |r''|^2."""
        if self.curvature == "linear":
            return None
        return program.define("inv_a", 1 / program.define("a", 1 + a1)) ** (3 if self.strain == "green" else 2)

    def squared_curvature(self, scale: sp.Expr | None, a1: sp.Expr, b: sp.Expr, c: sp.Expr) -> sp.Expr:
        """In the units of r''^2."""
        return c if scale is None else ((1 + a1) * c - b * b) * scale

    def _terms(self, program: Program, A, G, w) -> Iterator[tuple[sp.Expr, sp.Expr, list, list]]:
        """At every point: weight times stiffness, half squared strain, its invariants, their rows over the pairs."""
        program.stage("axial strain at the quadrature points")
        half = program.define("EA_l", A[0] / (2 * w))
        for g, point in enumerate(self.axial_points):
            rows = [self._row(point.value, point.value)]
            a1 = program.define(f"a1_{g}", _dot(rows[0], G))
            strain = self.axial_strain(program, f"eps_{g}", a1)
            yield point.weight * half, strain**2 / 2, [a1], rows
        program.stage("curvature at the quadrature points")
        bending = program.define("EI_l", 2 * A[1] * w)
        for g, point in enumerate(self.bending_points):
            rows = [self._row(point.value, point.value), self._row(point.value, point.slope),
                    self._row(point.slope, point.slope)]
            used = rows[2:] if self.curvature == "linear" else rows
            names = ("c",) if self.curvature == "linear" else ("a1", "b", "c")
            invariants = [program.define(f"{name}_b{g}", _dot(row, G)) for name, row in zip(names, used, strict=True)]
            full = invariants if len(invariants) == 3 else [None, None, invariants[0]]
            scale = self.curvature_scale(program, full[0])
            k2 = program.define(f"k2_{g}", self.squared_curvature(scale, *full))
            yield point.weight * bending, k2 / 2, invariants, used

    def _row(self, f: Sequence, g: Sequence) -> list[sp.Expr]:
        """Coefficients over the pairs of the product of the series f and g."""
        value, slope = (dict(zip(self._axis_indices, series, strict=True)) for series in (f, g))
        row = []
        for a, b in self.gram.pairs:
            if a not in value or b not in value:
                row.append(sp.S.Zero)
            else:
                row.append(_number(value[a] * slope[b] + (value[b] * slope[a] if a != b else 0)))
        return row

    def energy(self, program: Program, A, G, w) -> sp.Expr:
        """U."""
        return sum(weight * density for weight, density, _, _ in self._terms(program, A, G, w))

    def stress(self, program: Program, A, G, w) -> list[sp.Expr]:
        """Stages: u = dU/dG."""
        return self._gradients(program, A, G, w)[0]

    def stress_and_moduli(self, program: Program, A, G, w):
        """Stages: u, and d2U/dG2 by its non-zero entries."""
        return self._gradients(program, A, G, w, second=True)

    def _gradients(self, program: Program, A, G, w, second=False):
        n = len(self.gram.pairs)
        u = [sp.S.Zero] * n
        moduli: dict[tuple[int, int], sp.Expr] = {}
        for weight, density, invariants, rows in list(self._terms(program, A, G, w)):
            first = [program.define(f"W_{s.name}", weight * d)
                     for s, d in zip(invariants, jacobian(program, np.array([density]), invariants)[0], strict=True)]
            for d, row in zip(first, rows, strict=True):
                u = [total + d * r for total, r in zip(u, row, strict=True)]
            if second:
                H = jacobian(program, np.array(first), invariants)
                H = [[program.define(f"H_{s.name}_{t.name}", H[i, j]) if j >= i else None
                      for j, t in enumerate(invariants)] for i, s in enumerate(invariants)]
                along = [[program.define(f"h_{s.name}_{self.gram.pair(q)}",
                                         sum((H[min(i, j)][max(i, j)] * rows[j][q] for j in range(len(rows))),
                                             sp.S.Zero)) for q in range(n)] for i, s in enumerate(invariants)]
                for p in range(n):
                    for q in range(p, n):
                        value = sum((rows[i][p] * along[i][q] for i in range(len(rows))), sp.S.Zero)
                        if value != 0:
                            moduli[p, q] = moduli.get((p, q), sp.S.Zero) + value
        program.stage("u = dU/dG")
        u = [program.define(f"u_{self.gram.pair(p)}", value) for p, value in enumerate(u)]
        if not second:
            return u, None
        program.stage("A = d2U/dG2")
        for (p, q), value in list(moduli.items()):
            moduli[p, q] = moduli[q, p] = program.define(f"A_{self.gram.pair(p)}_{self.gram.pair(q)}", value)
        return u, moduli

    # --- Kelvin-Voigt damping: EA strain'^2 + EI |D_t r''|^2 -------------------------------------------------
    # D_t is the rate as seen from the tangent, which turns with i x di/dt and does not spin about itself: smooth
    # where the cable is straight (the rate of |r''| is not). A bent cable that spins as a whole about its own
    # tangent is braked, P = EI tau (Omega.i)^2 |i x r''|^2: no continuous law that damps the vibration of a straight
    # cable is free of that. Damping need not be integrated exactly: as many points as the degree.

    def _rates(self, program: Program, A, tau, c, dc, w) -> Iterator[tuple]:
        """At every point: factors of the strain vectors in r' and (l/2) r'', weight times viscosity, positions and
        rates of the two (one where the strain is measured), rates of the measures.
        """
        program.stage("rate of axial strain at the quadrature points")
        viscosity = program.define("EA_tau", tau * A[0] / (2 * w))
        for g, point in enumerate(self.points(self.degree)):
            r1, d1 = self._at_point(program, f"{g}", "1", point.value, c, dc)
            rate = r1.dot(d1)
            if self.strain == "engineering":
                rate = rate * program.define(f"inv_{g}", 1 / program.define(f"len_{g}", sp.sqrt(r1.dot(r1))))
            yield [point.value], point.weight * viscosity, r1, d1, [program.define(f"deps_{g}", rate)]
        program.stage("rate of curvature at the quadrature points")
        viscosity = program.define("EI_tau", 2 * tau * A[1] * w)
        for g, point in enumerate(self.points(self.degree - 1)):
            r1, d1 = self._at_point(program, f"b{g}", "1", point.value, c, dc)
            r2, d2 = self._at_point(program, f"b{g}", "2", point.slope, c, dc)
            inverse = program.define(f"inv_b{g}", 1 / program.define(f"len_b{g}", sp.sqrt(r1.dot(r1))))
            i = program.vector(f"i_b{g}", inverse * r1)
            stretch = program.define(f"stretch_b{g}", i.dot(d1))
            turn = program.vector(f"di_b{g}", inverse * (d1 - stretch * i))
            along, across = program.define(f"along_b{g}", i.dot(r2)), program.define(f"across_b{g}", turn.dot(r2))
            rate = program.vector(f"rate_b{g}", d2 - (along * turn - across * i))
            yield ([point.value, point.slope], point.weight * viscosity, np.concatenate([r1, r2]),
                   np.concatenate([d1, d2]), list(rate))

    def _at_point(self, program: Program, tag: str, order: str, series, c, dc) -> tuple[np.ndarray, np.ndarray]:
        return tuple(program.vector(f"{name}{order}_{tag}",
                                    sum(series[k] * v[m] for k, m in enumerate(self._axis_indices)))
                     for name, v in (("r", c), ("d", dc)))

    @cached_property
    def _axis_indices(self) -> list[int]:
        return [m for m, name in enumerate(self.gram.names) if name.startswith("t")]

    def _damping_points(self, program, A, tau, c, dc, w) -> Iterator[tuple]:
        """At every point: factors, positions, rates, forces on r' (and (l/2) r'')."""
        for factors, viscosity, still, moving, rates in list(self._rates(program, A, tau, c, dc, w)):
            by_rate = jacobian(program, np.array(rates), list(moving))
            force = [program.define(f"F_{s.name}", viscosity * sum(e * d for e, d in zip(rates, column, strict=True)))
                     for s, column in zip(moving, by_rate.T, strict=True)]
            yield factors, still, moving, np.array(force)

    def damping_forces(self, program, A, tau, c, dc, w) -> np.ndarray:
        """Forces on strain vectors."""
        dim = self.gram.element.dim
        f = np.zeros((len(self.gram.names), dim), dtype=object)
        for factors, _, _, force in list(self._damping_points(program, A, tau, c, dc, w)):
            for k, m in enumerate(self._axis_indices):
                f[m] = f[m] + sum(x[k] * force[i * dim:(i + 1) * dim] for i, x in enumerate(factors))
        program.stage("forces on strain vectors")
        return np.array([program.vector(f"f_{name}", v) for name, v in zip(self.gram.names, f, strict=True)])

    def damping_blocks(self, program, A, tau, c, dc, rate, w) -> np.ndarray:
        """df/dc + rate df/d(dc) over strain vectors."""
        n, dim, names = len(self.gram.names), self.gram.element.dim, self.gram.names
        block = np.zeros((n, n, dim, dim), dtype=object)
        for factors, still, moving, force in list(self._damping_points(program, A, tau, c, dc, w)):
            columns = []
            for s, v in zip(still, moving, strict=True):
                others = {o: 0 for o in (*still, *moving) if o not in (s, v)}
                columns.append(Derivation(program, f"d_{s.name}", {s: 1, v: rate, **others}).array(force))
            K = np.array([[program.define(f"K_{a.name}_{b.name}", columns[j][i]) for j, b in enumerate(still)]
                          for i, a in enumerate(still)])
            for k, m in enumerate(self._axis_indices):
                for h, q in enumerate(self._axis_indices):
                    for i, x in enumerate(factors):
                        for j, y in enumerate(factors):
                            part = K[i * dim:(i + 1) * dim, j * dim:(j + 1) * dim]
                            block[m, q] = block[m, q] + x[k] * y[h] * part
        program.stage("blocks over strain vectors")
        return np.array([[[[program.define(f"K_{names[m]}_{names[k]}_{i}{j}", block[m, k, i, j]) for j in range(dim)]
                           for i in range(dim)] for k in range(n)] for m in range(n)], dtype=object)

    def dissipation(self, program, A, tau, c, dc, w) -> sp.Expr:
        """Power."""
        return sum(viscosity * sum(e * e for e in rates)
                   for _, viscosity, _, _, rates in list(self._rates(program, A, tau, c, dc, w)))


def _number(value) -> sp.Expr:
    """A double as the kernels will hold it; small integers are exact."""
    value = float(value)
    return sp.Integer(round(value)) if abs(value - round(value)) < 1e-15 else sp.Float(value)


def _at(p, x: float):
    """Value of a ring polynomial in X."""
    return sum(float(c) * x ** k[0] for k, c in p.terms())


def _dot(row: Sequence[sp.Expr], G: Sequence[sp.Expr]) -> sp.Expr:
    return sum((r * g for r, g in zip(row, G, strict=True)), sp.S.Zero)

