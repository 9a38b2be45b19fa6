"""Kelvin-Voigt damping of a cable: N_strain tau strain'^2 + EI tau |D_t r''|^2 along the centreline.

N_strain is the axial stiffness at the strain there: EA, or of a law that gives way in compression the derivative of its
force: a slack cable has little damping, as it has little stiffness.

D_t is the rate as seen from the tangent, which turns with i x di/dt and does not spin about itself: smooth where the
cable is straight (the rate of |r''| is not). A bent cable that spins as a whole about its own tangent is braked,
P = EI tau (Omega.i)^2 |i x r''|^2: no continuous law that damps the vibration of a straight cable is free of that.
Damping need not be integrated exactly: the number of points is the degree.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby
from typing import Any

import numpy as np
import sympy as sp

from ...algebra.gram import Gram
from ...codegen.program import Program
from ...spec import Element, x
from .blocks import PointBlocks, named_block, named_blocks, spread
from .points import Point

Pair = tuple[np.ndarray, np.ndarray]
"""A vector at a point and its rate, (dim,) each."""
Share = Callable[[str, np.ndarray], tuple[sp.Expr, sp.Expr]]
"""Axial stiffness over EA and its derivative by the strain, from a tag and r' (dim,) at a point."""


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

    def stiffness_share(self, program: Program, A: np.ndarray) -> Share | None:
        """Define the part of the axial stiffness over EA that all points share, and return the function of a tag and
        r' (dim,) for its value and its derivative by the strain at a point; None where the stiffness is EA.
        """
        return None

    def _points(self, program: Program, A: np.ndarray, tau: sp.Expr, c: np.ndarray, dc: np.ndarray,
                w: sp.Expr, is_full: bool = False) -> list[AxialPoint | BendingPoint]:
        """Return the quadrature points with the rates there, in two stages; is_full: with EA at any strain."""
        program.stage("rate of axial strain at the quadrature points")
        viscosity = program.define("EA_tau", tau * A[0] / (2 * w))
        of_axial = self.points(self.degree)
        at_axial = [self._at_point(program, f"{g}", "1", point.value, c, dc) for g, point in enumerate(of_axial)]
        weighted = [point.weight * viscosity for point in of_axial]
        share = None if is_full else self.stiffness_share(program, A)
        if share:  # points that mirror each other have the same weight
            weighted = [program.define_once(f"EA_tau_{min(g, len(weighted) - 1 - g)}", value)
                        for g, value in enumerate(weighted)]
        axial: list[AxialPoint | BendingPoint] = []
        for g, (point, r) in enumerate(zip(of_axial, at_axial, strict=True)):
            axial.append(AxialPoint(program, f"{g}", point, weighted[g], r, self.strain == "engineering",
                                    share and share(f"_{g}", r[0])))
        program.stage("rate of curvature at the quadrature points")
        viscosity = program.define("EI_tau", 2 * tau * A[1] * w)
        of_bending = self.points(self.degree - 1)
        at_bending = [[self._at_point(program, f"b{g}", order, series, c, dc)
                       for order, series in (("1", point.value), ("2", point.slope))]
                      for g, point in enumerate(of_bending)]
        return axial + [BendingPoint(program, f"b{g}", point, point.weight * viscosity, *at)
                        for g, (point, at) in enumerate(zip(of_bending, at_bending, strict=True))]

    def _at_point(self, program: Program, tag: str, order: str, series: Sequence[sp.Expr], c: np.ndarray,
                  dc: np.ndarray) -> Pair:
        """Return the sum of a series of strain vectors at a point, and that of their rates."""
        r, d = (program.vector(f"{name}{order}_{tag}",
                               np.asarray(sum(series[k] * v[m] for k, m in enumerate(self.axis_indices))))
                for name, v in (("r", c), ("d", dc)))
        return r, d

    def damping_forces(self, program: Program, A: np.ndarray, tau: sp.Expr, c: np.ndarray, dc: np.ndarray,
                       w: sp.Expr) -> np.ndarray:
        """Return the damping forces on the strain vectors, (vectors, dim), N m."""
        points = self._points(program, A, tau, c, dc, w)
        return self._summed(program, [(point, point.forces(point.rates)) for point in points])

    def algorithmic_forces(self, program: Program, A: np.ndarray, weight: sp.Expr, relaxed_strain: np.ndarray,
                           c: np.ndarray, dc: np.ndarray, w: sp.Expr) -> tuple[np.ndarray, Sequence[sp.Expr]]:
        """Return the forces on strain vectors of the stiffnesses times weight dE - relaxed_strain, and dE, the rates
        that dc makes.
        """
        points = self._points(program, A, sp.S.One, c, dc, w, is_full=True)
        program.stage("forces at the quadrature points")
        forces: list[tuple[AxialPoint | BendingPoint, list[np.ndarray]]] = []
        dE: list[sp.Expr] = []
        for point in points:
            excess = [program.define(f"excess_{s.name}", weight * s - relaxed_strain[k])
                      for k, s in enumerate(point.rates, len(dE))]
            forces.append((point, point.forces(np.array(excess))))
            dE.extend(point.rates)
        return self._summed(program, forces), dE

    def _summed(self, program: Program,
                points: list[tuple[AxialPoint | BendingPoint, list[np.ndarray]]]) -> np.ndarray:
        """Return forces on strain vectors from those at the points, in a stage."""
        f: np.ndarray = np.zeros((len(self.gram.names), self.gram.element.dim), dtype=object)
        for point, forces in points:
            for k, m in enumerate(self.axis_indices):
                f[m] = f[m] + sum(x[k] * force for x, force in zip(point.series, forces, strict=True))
        program.stage("forces on strain vectors")
        return np.array([program.vector(f"f_{name}", v) for name, v in zip(self.gram.names, f, strict=True)])

    def damping_blocks(self, program: Program, A: np.ndarray, tau: sp.Expr, c: np.ndarray, dc: np.ndarray,
                       rate: sp.Expr, w: sp.Expr) -> np.ndarray:
        """Return df/dc + rate df/d(dc) over strain vectors, (vectors, vectors, dim, dim)."""
        points = self._points(program, A, tau, c, dc, w)
        program.stage("derivatives at the quadrature points")
        total = self._spread(program, "d", points, lambda point: point.blocks(rate), symmetric=False)
        program.stage("blocks over strain vectors")
        return named_blocks(program, self.gram.names, total, symmetric=False)

    def damping_parts(self, program: Program, A: np.ndarray, tau: sp.Expr, c: np.ndarray, dc: np.ndarray,
                      w: sp.Expr) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return forces of stretching and of bending on strain vectors, and derivatives of their sum by c and dc."""
        points = self._points(program, A, tau, c, dc, w)
        groups = [list(of_order) for _, of_order in groupby(points, key=lambda point: len(point.series))]
        f = [self._summed(program, [(point, point.forces(point.rates)) for point in group]) for group in groups]
        program.stage("derivatives at the quadrature points")
        by_c = self._spread(program, "d", points, lambda point: point.blocks(sp.S.Zero), symmetric=False)
        by_dc = self._spread(program, "v", points, lambda point: point.rate_blocks(), symmetric=True)
        program.stage("blocks over strain vectors")
        names = self.gram.names
        return (f[0], f[1], named_blocks(program, names, by_c, symmetric=False),
                named_blocks(program, [f"d{name}" for name in names], by_dc, symmetric=True))

    def _spread(self, program: Program, tag: str, points: list[AxialPoint | BendingPoint],
                blocks: Callable[[Any], PointBlocks], symmetric: bool) -> np.ndarray:
        """Return the sum over the points of their blocks over strain vectors."""
        total = np.array(0)
        for order, of_order in groupby(points, key=lambda point: len(point.series)):
            group = list(of_order)
            total = total + spread(program, f"{tag}{order}", [point.series for point in group],
                                   [blocks(point) for point in group], symmetric=symmetric)
        return total

    def dissipation(self, program: Program, A: np.ndarray, tau: sp.Expr, c: np.ndarray, dc: np.ndarray,
                    w: sp.Expr) -> sp.Expr:
        """Return the dissipated power, W."""
        return sum(point.viscosity * point.rates.dot(point.rates) for point in self._points(program, A, tau, c, dc, w))


class AxialPoint:
    """Rate of the axial strain where it is integrated.

    series: factors of the strain vectors in r'; viscosity: times the weight; rates: of the strain; share: see
    `Damping.stiffness_share`.
    """

    def __init__(self, program: Program, tag: str, point: Point, viscosity: sp.Expr, r1: Pair, engineering: bool,
                 share: tuple[sp.Expr, sp.Expr] | None = None):
        self.program, self.tag, self.series = program, tag, [point.value]
        self.viscosity, self.change = viscosity, sp.S.Zero  # of the viscosity by the strain
        if share is not None:
            self.viscosity, self.change = program.define(f"viscosity_{tag}", viscosity * share[0]), viscosity * share[1]
        self.r, self.d = r1
        self.inverse = sp.S.One
        if engineering:
            self.inverse = program.define(f"inv_{tag}", 1 / program.define(f"len_{tag}", sp.sqrt(self.r.dot(self.r))))
        self.engineering = engineering
        self.rates = np.array([program.define(f"deps_{tag}", self.r.dot(self.d) * self.inverse)])

    def forces(self, stress: np.ndarray) -> list[np.ndarray]:
        """Return the force on r' of a stress in units of the viscosity: stress times d(rate)/d(dr'/dt)."""
        return [self._vector("F", self._force(stress) * self.r)]

    def _force(self, stress: np.ndarray) -> sp.Expr:
        return self.program.define(f"N_{self.tag}", self.viscosity * stress[0] * self.inverse)

    def blocks(self, rate: sp.Expr) -> PointBlocks:
        """Return dF/dr' + rate dF/d(dr'/dt)."""
        N, eye = self._force(self.rates), np.eye(len(self.r), dtype=int)
        if not self.engineering:
            along, across = self.r, self.viscosity * (self.d + rate * self.r)
        else:
            # with the tangent i and its rate turn: d(i) = (1 - i i) dr/|r|, d(strain rate) = (turn + rate i) . dr
            along = self._vector("i", self.inverse * self.r)
            turn = self._vector("di", self.inverse * (self.d - self.rates[0] * along))
            across = self.viscosity * (turn + rate * along) - N * along
        if self.change != 0:  # the strain changes by along . dr
            across = across + self.program.define(f"change_{self.tag}", self.change * self.rates[0]) * along
        return {(0, 0): named_block(self.program, f"K_{self.tag}",
                                    N * eye + np.outer(along, self._vector("by", across)))}

    def rate_blocks(self) -> PointBlocks:
        """Return dF/d(dr'/dt)."""
        along = self._vector("by_rate", self.viscosity * self.inverse**2 * self.r)
        return {(0, 0): named_block(self.program, f"Kv_{self.tag}", np.outer(self.r, along), symmetric=True)}

    def _vector(self, name: str, value: np.ndarray) -> np.ndarray:
        return self.program.vector(f"{name}_{self.tag}", value)


class BendingPoint:
    """Rate of (l/2) r'' as seen from the tangent, where it is integrated: D_t r2 = d2 - (i.r2) di + (di.r2) i.

    series: factors of the strain vectors in r1 = r' and r2 = (l/2) r''; viscosity: times the weight; rates: D_t r2.
    """

    def __init__(self, program: Program, tag: str, point: Point, viscosity: sp.Expr, first: Pair, second: Pair):
        self.program, self.tag, self.viscosity, self.series = program, tag, viscosity, [point.value, point.slope]
        (r1, d1), (self.r2, self.d2) = first, second
        self.inverse = program.define(f"inv_{tag}", 1 / program.define(f"len_{tag}", sp.sqrt(r1.dot(r1))))
        self.i = self._vector("i", self.inverse * r1)
        self.stretch = self._number("stretch", self.i.dot(d1))
        self.turn = self._vector("di", self.inverse * (d1 - self.stretch * self.i))
        self.along = self._number("along", self.i.dot(self.r2))
        self.across = self._number("across", self.turn.dot(self.r2))
        self.rates = self._vector("rate", self.d2 - (self.along * self.turn - self.across * self.i))

    def forces(self, stress: np.ndarray) -> list[np.ndarray]:
        """Return the forces on r1 and r2 of a stress in units of the viscosity: stress . d(D_t r2)/d(dr1/dt) and
        stress . d(D_t r2)/d(dr2/dt).

        d(di) = (1 - i i) d(dr1/dt)/|r1|, and (stress.i) r2 - (i.r2) stress is across i already.
        """
        inward = self._number("inward", self.viscosity * self.inverse * self.i.dot(stress))
        lever = self._number("lever", self.viscosity * self.inverse * self.along)
        return [self._vector("F1", inward * self.r2 - lever * stress), self._vector("F2", self.viscosity * stress)]

    def blocks(self, rate: sp.Expr) -> PointBlocks:
        """Return dF/dr + rate dF/d(dr/dt) of the forces F1 = viscosity/|r1| h, h = growth r2 - along D_t r2, with
        growth the rate of along = i.r2, and F2 = viscosity D_t r2.

        With p = r2 - along i: d(i) = (1 - i i) dr1/|r1|, d(along) = p.dr1/|r1| + i.dr2, d(di) = W dr1 with
        W = k (1 - i i) - (i di + di i)/|r1| and k = (rate - stretch/|r1|)/|r1|.
        """
        i, turn, inv, along, eye = self.i, self.turn, self.inverse, self.along, np.eye(len(self.i), dtype=int)
        k = self._number("k", inv * (rate - self.stretch * inv))
        level = self._number("level", inv * self.across - along * k)
        p = self._vector("p", self.r2 - along * i)
        by_turn = self._vector("by_turn", inv * (along * i - p))
        by_i = self._vector("by_i", k * p - self._number("by_i_i", inv * self.across + level) * i)
        second = {"1": level * eye + np.outer(turn, by_turn) + np.outer(i, by_i),
                  "2": rate * eye + np.outer(i, turn) - np.outer(turn, i)}
        K21, K22 = (named_block(self.program, f"K2{n}_{self.tag}", self.viscosity * block)
                    for n, block in second.items())
        stiff = self._number("stiff", self.viscosity * inv)
        lever = self._number("lever", along * inv)
        growth = self._number("growth", self.rates.dot(i))
        pushed = self._vector("pushed", stiff * (inv * self.d2 + k * p - inv * along * turn - 2 * inv * growth * i))
        turned = self._vector("turned", stiff * by_turn)
        K11 = np.outer(self.r2, pushed) + np.outer(self.rates, turned) - lever * K21
        follows = self._vector("follows", stiff * (rate * i + turn))
        stiff_i = self._vector("stiff_i", stiff * i)
        K12 = stiff * growth * eye + np.outer(self.r2, follows) - np.outer(self.rates, stiff_i) - lever * K22
        return {(0, 0): named_block(self.program, f"K11_{self.tag}", K11),
                (0, 1): named_block(self.program, f"K12_{self.tag}", K12), (1, 0): K21, (1, 1): K22}

    def rate_blocks(self) -> PointBlocks:
        """Return dF/d(dr/dt): viscosity J' J with J = (i r2 - along)/|r1|, 1 the derivatives of D_t r2."""
        eye = np.eye(len(self.i), dtype=int)
        J = named_block(self.program, f"J_{self.tag}",
                        self.inverse * (np.outer(self.i, self.r2) - self.along * eye))
        K12 = named_block(self.program, f"Kv12_{self.tag}", self.viscosity * J.T)
        K11 = named_block(self.program, f"Kv11_{self.tag}", K12.dot(J), symmetric=True)
        return {(0, 0): K11, (0, 1): K12, (1, 1): self.viscosity * eye}

    def _number(self, name: str, value: sp.Expr) -> sp.Expr:
        return self.program.define(f"{name}_{self.tag}", value)

    def _vector(self, name: str, value: np.ndarray) -> np.ndarray:
        return self.program.vector(f"{name}_{self.tag}", value)
