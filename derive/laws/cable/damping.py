"""Kelvin-Voigt damping of a cable: EA tau strain'^2 + EI tau |D_t r''|^2 along the centreline.

D_t is the rate as seen from the tangent, which turns with i x di/dt and does not spin about itself: smooth where the
cable is straight (the rate of |r''| is not). A bent cable that spins as a whole about its own tangent is braked,
P = EI tau (Omega.i)^2 |i x r''|^2: no continuous law that damps the vibration of a straight cable is free of that.
Damping need not be integrated exactly: as many points as the degree.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
import sympy as sp

from ...algebra.gram import Gram
from ...codegen.program import DirectionalDerivative, Program, jacobian
from ...spec import Element, x
from .blocks import named_blocks, spread
from .points import Point


class Damping:
    """Of a cable with a Green or an engineering strain; any curvature is damped alike."""

    gram: Gram
    strain: str

    @property
    def degree(self) -> int:
        """Return the degree of the centreline in x."""
        raise NotImplementedError

    @property
    def axis_indices(self) -> list[int]:
        """Return the indices of the strain vectors along the axis."""
        raise NotImplementedError

    def points(self, n: int) -> list[Point]:
        """Return the n points of the Gauss-Legendre rule."""
        raise NotImplementedError

    @staticmethod
    def rates(element: Element) -> dict[str, int]:
        """Return the number of strain rates that the damping of an element has, and whether a spin about the tangent is
        one.
        """
        degree = sum(sp.sympify(monomial).free_symbols <= {x} for monomial in element.basis) - 1
        return {"rates": degree + (degree - 1) * element.dim, "spins": int(element.dim == 3)}

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
        r, d = (program.vector(f"{name}{order}_{tag}",
                               np.asarray(sum(series[k] * v[m] for k, m in enumerate(self.axis_indices))))
                for name, v in (("r", c), ("d", dc)))
        return r, d

    def _damping_points(self, program, A, tau, c, dc, w, strain: Callable = list) -> Iterator[tuple]:
        """At every point: factors, positions, rates, forces on r' (and (l/2) r''); strain: of the rates there, what the
        stress follows.
        """
        for factors, viscosity, still, moving, rates in list(self._rates(program, A, tau, c, dc, w)):
            by_rate = jacobian(program, np.array(rates), list(moving))
            stress = strain(rates)
            force = [program.define(f"F_{s.name}", viscosity * sum(e * d for e, d in zip(stress, column, strict=True)))
                     for s, column in zip(moving, by_rate.T, strict=True)]
            yield factors, still, moving, np.array(force)

    def damping_forces(self, program, A, tau, c, dc, w) -> np.ndarray:
        """Return the damping forces on the strain vectors, (vectors, dim), N m."""
        return self._summed(program, list(self._damping_points(program, A, tau, c, dc, w)))

    def algorithmic_forces(self, program, A, weight, relaxed_strain, c, dc, w) -> tuple[np.ndarray, Sequence[sp.Expr]]:
        """Return the forces on strain vectors of the stiffnesses times weight dE - relaxed_strain, and dE, the rates
        that dc makes.
        """
        dE: list[sp.Expr] = []

        def strain(rates):
            dE.extend(rates)
            return [program.define(f"excess_{s.name}", weight * s - relaxed_strain[k])
                    for k, s in enumerate(rates, len(dE) - len(rates))]

        return self._summed(program, list(self._damping_points(program, A, sp.S.One, c, dc, w, strain))), dE

    def _summed(self, program: Program, points: list[tuple]) -> np.ndarray:
        """Return forces on strain vectors from those at the points."""
        dim = self.gram.element.dim
        f: np.ndarray = np.zeros((len(self.gram.names), dim), dtype=object)
        for factors, _, _, force in points:
            for k, m in enumerate(self.axis_indices):
                f[m] = f[m] + sum(x[k] * force[i * dim:(i + 1) * dim] for i, x in enumerate(factors))
        program.stage("forces on strain vectors")
        return np.array([program.vector(f"f_{name}", v) for name, v in zip(self.gram.names, f, strict=True)])

    def damping_blocks(self, program, A, tau, c, dc, rate, w) -> np.ndarray:
        """df/dc + rate df/d(dc) over strain vectors."""
        dim = self.gram.element.dim
        rules: dict[int, tuple[list, list]] = {}
        for factors, still, moving, force in list(self._damping_points(program, A, tau, c, dc, w)):
            columns = []
            for s, v in zip(still, moving, strict=True):
                others = {o: 0 for o in (*still, *moving) if o not in (s, v)}
                columns.append(DirectionalDerivative(program, f"d_{s.name}", {s: 1, v: rate, **others}).array(force))
            K = np.array([[program.define(f"K_{a.name}_{b.name}", columns[j][i]) for j, b in enumerate(still)]
                          for i, a in enumerate(still)])
            d = range(len(factors))
            parts = {(i, j): K[i * dim:(i + 1) * dim, j * dim:(j + 1) * dim] for i in d for j in d}
            for kept, new in zip(rules.setdefault(len(factors), ([], [])), (factors, parts), strict=True):
                kept.append(new)
        total = np.array(0)
        for order, (series, blocks) in rules.items():
            total = total + spread(program, f"d{order}", series, blocks, symmetric=False)
        program.stage("blocks over strain vectors")
        return named_blocks(program, self.gram.names, total, symmetric=False)

    def dissipation(self, program, A, tau, c, dc, w) -> sp.Expr:
        """Return the dissipated power, W."""
        return sum(viscosity * sum(e * e for e in rates)
                   for _, viscosity, _, _, rates in list(self._rates(program, A, tau, c, dc, w)))
