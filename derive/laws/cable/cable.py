"""Cable: 1/2 EA strain^2 + 1/2 EI curvature^2 along the centreline, by Gauss quadrature.

strain "green": (r'.r' - 1)/2, "engineering": |r'| - 1. Curvature "exact": |r' x r''|/|r'|^3 with the green strain
and |r' x r''|/|r'|^2 with the engineering one; "linear": |r''|, a constant bending stiffness, valid while the
stretch is small. At a point all depend on a = r'.r', b = r'.r'' and c = r''.r'' only: the chain rule goes through them
and never through the coordinates.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import Any

import numpy as np
import sympy as sp
from sympy.polys.rings import PolyElement

from ...algebra import section_integrals as integrals
from ...algebra.discrete_gradient import DiscreteGradient, staged
from ...algebra.gram import Gram
from ...codegen.program import Program, jacobian
from ...spec import LawTraits
from .blocks import by_vectors, named_blocks, spread
from .damping import Damping
from .points import Point, gathered, on_vectors, values
from .section import resultants

SOURCE = "Gerstmayr & Shabana, Nonlinear Dyn. 45 (2006) 109-130; Berzeri & Shabana, J. Sound Vib. 235 (2000)"


@dataclass(frozen=True)
class Term:
    """A point's share of twice the energy, its invariants by name, the vectors that these are products of, and the
    series of the vectors over the strain vectors.

    Where the energy is also a quadratic form over the strains of several points, `strain` is that of this point and
    `stress` the derivative of twice the form by it. `bending` is the part of `twice` that is proportional to 1/l at
    constant strain vectors; what the term has besides is proportional to l.
    """

    names: str
    twice: sp.Expr
    invariants: list[sp.Expr]
    vectors: list[np.ndarray]
    series: list[tuple[sp.Float, ...]]
    strain: sp.Expr = sp.S.Zero
    stress: sp.Expr = sp.S.Zero
    bending: sp.Expr = sp.S.Zero

    @property
    def share(self) -> sp.Expr:
        """Return the share of twice the energy that the form has: half of the stresses times the strains is the form.
        """
        return self.twice + self.stress * self.strain / 2

    @property
    def varied(self) -> sp.Expr:
        """Return what has the derivatives of twice the energy by the invariants, the stress constant."""
        return self.twice + self.stress * self.strain

    @property
    def constant(self) -> list[sp.Symbol]:
        """Return the stress, where there is one."""
        return [self.stress] if self.stress.is_Symbol else []


def traits(strain: str, curvature: str) -> LawTraits:
    """Return the traits of the law with these measures. Damping depends on the strain alone: laws of one strain share
    it.
    """
    damped_like = "" if curvature == "exact" else f"{strain}_exact"
    return LawTraits("cable", strain, curvature, membrane="full", damped_like=damped_like)


class Cable(Damping):
    """The law over an element's strain vectors."""

    source, set_up_kernel = SOURCE, "stiffness"
    stiffness_units, stiffness_doc = "N, N m^2", "axial and bending stiffness EA, EI"
    axial_name = "EA"

    def __init__(self, gram: Gram, strain: str, curvature: str):
        self.gram, self.strain, self.curvature = gram, strain, curvature
        self.name = f"{strain}_{curvature}"
        self.doc = f"cable with {strain} strain and {curvature} curvature"

    @cached_property
    def degree(self) -> int:
        """Return the degree of the centreline in x."""
        return len(self._axis)

    @cached_property
    def axis_indices(self) -> list[int]:
        """Return the strain vectors along the axis."""
        return [m for m, name in enumerate(self.gram.names) if name.startswith("t")]

    @cached_property
    def _axis(self) -> list[Any]:
        """Return the polynomials in X of the strain vectors along the axis."""
        return [self.gram.gradient[m][0] for m in self.axis_indices]

    def points(self, n: int) -> list[Point]:
        """Return the n points of the Gauss-Legendre rule."""
        nodes, weights = np.polynomial.legendre.leggauss(n)
        return [Point(_number(w), tuple(_number(_at(p, x)) for p in self._axis),
                      tuple(_number(_at(p.diff(integrals.X), x)) for p in self._axis))
                for x, w in zip(nodes.tolist(), weights.tolist(), strict=True)]

    @property
    def axial_points(self) -> list[Point]:
        """Return the points for the axial strain: with the exact curvature those for bending; else enough for
        the exact integral of the squared Green strain, of degree 4(d - 1).
        """
        return self.points(2 * self.degree - 1) if self.curvature == "linear" else self.bending_points

    @property
    def bending_points(self) -> list[Point]:
        """Return the points for bending: exact for the linear curvature; five, or the degree, where it is a quotient.

        Against converged quadrature, the tip of the pendulum D0 (8 elements, t = 1) is off by 5e-5 with four points
        and by 2e-6 with five on cubic elements, where the mesh is off by 4e-3; by 4e-6 with five on quintic ones (with
        4 elements by 2e-4, where the mesh is off by 4e-3).
        """
        return self.points(self.degree - 1 if self.curvature == "linear" else max(5, self.degree))

    def constants(self, program: Program) -> np.ndarray:
        """Declare the input A, which is S; return it."""
        return self._stiffness(program, "A")

    def section_stiffness(self, program: Program) -> np.ndarray:
        """Declare the input S: EA in N, EI in N m^2, and further constants of ``stiffness_doc``; return it."""
        return self._stiffness(program, "S")

    def _stiffness(self, program: Program, name: str) -> np.ndarray:
        return program.input(name, len(self.stiffness_units.split(", ")), self.stiffness_units, self.stiffness_doc)

    def set_up(self, program: Program) -> None:
        """Declare the inputs l and S, and the output A, which is S."""
        program.input("l", (), "m", "length of the element")
        program.output("A", self.section_stiffness(program), self.stiffness_units, self.stiffness_doc)

    def section_forces(self, program: Program, S: np.ndarray, c: np.ndarray, X: sp.Expr, w: sp.Expr,
                       c0: np.ndarray | None = None) -> tuple[Any, ...]:
        """Return force and moment in space, and strain, at X; c0 of a curved stress-free shape."""
        return resultants(self, program, S, c, X, w, c0)

    def membrane(self, program: Program, S: np.ndarray, c: np.ndarray, X: sp.Expr, strain: sp.Expr) -> tuple[Any, ...]:
        """Return the energy per length whose derivative is the membrane's force at X, what is constant in it, and the
        strain.
        """
        return self.twice_axial_energy(program, "", S, self.axial_factor(S), strain) / 2, [], strain

    def axial_factor(self, A: np.ndarray) -> sp.Expr:
        """Return the factor of the axial energy."""
        return A[0]

    def twice_axial_energy(self, program: Program, tag: str, A: np.ndarray, stiffness: sp.Expr,
                           strain: sp.Expr) -> sp.Expr:
        """Return twice the energy of an axial strain, stiffness times its square; A: the constants of the law."""
        return stiffness * strain**2

    # --- the energy through the invariants ------------------------------------------------------------------

    def _axial_strain(self, program: Program, tag: str, a1: sp.Expr) -> sp.Expr:
        """Return the axial strain from a - 1, without losing the digits of a small strain."""
        if self.strain == "green":
            return program.define(f"eps{tag}", a1 / 2)
        length = program.define_once(f"len{tag}", sp.sqrt(1 + a1))
        program.define_once(f"inv_len{tag}", 1 / length)
        return program.define(f"eps{tag}", a1 / (1 + length), derivative_of=length)  # |r'| - 1

    def _at_points(self, program: Program, rule: str, names: str, points: list[Point],
                   c: np.ndarray) -> list[tuple[Any, ...]]:
        """Return invariants, vectors and series at each point: a - 1, b, c of r' and (l/2) r'', as far as named."""
        kinds = {"a": ["value"], "c": ["slope"], "abc": ["value", "slope"]}[names]
        series = [[getattr(point, kind) for point in points] for kind in kinds]
        along = [c[m] for m in self.axis_indices]
        every = [values(program, f"r{1 + (kind == 'slope')}{rule}", s, along)
                 for kind, s in zip(kinds, series, strict=True)]
        found = []
        for g, vectors in enumerate(zip(*every, strict=True)):
            first, last = vectors[0], vectors[-1]
            products = {"a": ("a1", first.dot(first) - 1), "b": ("b", first.dot(last)), "c": ("c", last.dot(last))}
            found.append(([program.define(f"{products[name][0]}{rule}_{g}", products[name][1]) for name in names],
                          list(vectors), [s[g] for s in series]))
        return found

    def _terms(self, program: Program, A: np.ndarray, c: np.ndarray, w: sp.Expr) -> Iterator[Term]:
        """Yield the energy point by point."""
        program.stage("strain at the quadrature points")
        EA = program.define(f"{self.axial_name}_l", self.axial_factor(A) / (2 * w))
        EI = program.define("EI_l", 2 * A[1] * w)
        if self.curvature == "exact":
            points = self.bending_points
            every = self._at_points(program, "", "abc", points, c)
            weighted = [[self._weighted(program, points, g, *stiff) for stiff in ((self.axial_name, EA), ("EI", EI))]
                        for g in range(len(points))]
            for g, ((invariants, vectors, series), (axial, bending)) in enumerate(zip(every, weighted, strict=True)):
                strain, k2, _ = self.measures(program, f"_{g}", invariants, bending)
                yield Term("abc", self.twice_axial_energy(program, f"_{g}", A, axial, strain) + k2, invariants,
                           vectors, series, bending=k2)
            return
        points = self.axial_points
        for g, (invariants, *at) in enumerate(self._at_points(program, "", "a", points, c)):
            strain = self._axial_strain(program, f"_{g}", *invariants)
            axial = self._weighted(program, points, g, self.axial_name, EA)
            yield Term("a", self.twice_axial_energy(program, f"_{g}", A, axial, strain), invariants, *at)
        program.stage("curvature at the quadrature points")
        points = self.bending_points
        for g, (invariants, vectors, series) in enumerate(self._at_points(program, "b", "c", points, c)):
            twice = self._weighted(program, points, g, "EI", EI) * invariants[0]
            yield Term("c", twice, invariants, vectors, series, bending=twice)

    def _weighted(self, program: Program, points: list[Point], g: int, name: str, stiffness: sp.Expr) -> sp.Expr:
        """Return the weight of a point times a stiffness; points that mirror each other share it."""
        first = min(g, len(points) - 1 - g)
        return program.define_once(f"{name}{len(points)}_{first}", points[first].weight * stiffness)

    def measures(self, program: Program, tag: str, invariants: Sequence[sp.Expr],
                 factor: sp.Expr = sp.S.One) -> tuple[Any, ...]:
        """Return axial strain, factor times the squared curvature, and what leads to that from |r' x r''|^2; None where
        it is |r''|^2.
        """
        a1, b, c = invariants
        strain = self._axial_strain(program, tag, a1)
        if self.curvature == "linear":
            return strain, factor * c, None
        a = program.define(f"a{tag}", 1 + a1)
        if self.strain == "green":
            inverse = program.define(f"inv_a{tag}", 1 / a)
        else:
            inverse = program.define(f"inv_a{tag}", sp.Symbol(f"inv_len{tag}") ** 2, derivative_of=1 / a)
        scale = program.define(f"scale{tag}", factor * inverse ** (3 if self.strain == "green" else 2))
        return strain, program.define(f"cross2{tag}", a * c - b * b) * scale, scale

    def energy(self, program: Program, A: np.ndarray, c: np.ndarray, w: sp.Expr) -> sp.Expr:
        """Return the elastic energy U, J."""
        return sum(term.share for term in self._terms(program, A, c, w)) / 2

    def forces(self, program: Program, A: np.ndarray, c: np.ndarray, w: sp.Expr) -> np.ndarray:
        """Return dU/dc on strain vectors."""
        return self._forces(program, list(self._terms(program, A, c, w)), _first)

    def _forces(self, program: Program, every: list[Term], first: First) -> np.ndarray:
        """Return forces on strain vectors from derivatives by the invariants of each term."""
        f = np.zeros((len(self.gram.names), self.gram.element.dim), dtype=object)
        for names, of_rule in groupby(every, key=lambda term: term.names):
            terms = list(of_rule)
            program.stage("forces at the quadrature points")
            forces = [on_vectors(program, f"{names}{g}", term.vectors, first(program, term))
                      for g, term in enumerate(terms)]
            f[self.axis_indices] += self._gathered(program, names, terms, forces)
        return self._named(program, f)

    def forces_and_energies(self, program: Program, A: np.ndarray, c: np.ndarray,
                            w: sp.Expr) -> tuple[np.ndarray, sp.Expr, sp.Expr]:
        """Return dU/dc on strain vectors, and the energies of stretching and of bending, J."""
        terms = list(self._terms(program, A, c, w))
        f = self._forces(program, terms, _first)
        program.stage("energies of stretching and of bending")
        stretching = program.define("U_m", sum(term.share - term.bending for term in terms) / 2)
        return f, stretching, program.define("U_b", sum(term.bending for term in terms) / 2)

    def _gathered(self, program: Program, names: str, terms: list[Term], forces: list[Any]) -> np.ndarray:
        """Return the forces on the strain vectors along the axis from those on the vectors of each point."""
        return np.asarray(sum(
            gathered(program, f"{names}{k + 1}", [term.series[k] for term in terms], [f[k] for f in forces])
            for k in range(len(terms[0].vectors))))

    def _named(self, program: Program, f: np.ndarray) -> np.ndarray:
        program.stage("forces on strain vectors")
        return np.array([program.vector(f"f_{name}", v) for name, v in zip(self.gram.names, f, strict=True)])

    def discrete_forces(self, program: Program, A: np.ndarray, now: np.ndarray, then: np.ndarray,
                        w: sp.Expr) -> np.ndarray:
        """Return forces f on strain vectors with f . (then - now) = the difference of U, by the mean vectors."""
        f = np.zeros((len(self.gram.names), self.gram.element.dim), dtype=object)
        for names, group, discrete in self._discrete_terms(program, A, now, then, w):
            program.stage("forces at the quadrature points")
            forces = []
            for g, term in enumerate(group):
                D = self._discrete_first(program, term, discrete)
                means = [discrete.means(f"mean{k + 1}_{names}{g}", v) for k, v in enumerate(term.vectors)]
                forces.append(on_vectors(program, f"{names}{g}", means, D))
            f[self.axis_indices] += self._gathered(program, names, group, forces)
        return self._named(program, f)

    def discrete_product(self, program: Program, A: np.ndarray, now: np.ndarray, then: np.ndarray,
                         w: sp.Expr) -> Callable[[str, np.ndarray], np.ndarray]:
        """Return the product B c of strain vectors c, under a tag; `discrete_forces` is that of the mean ones."""
        terms = []
        for names, group, discrete in self._discrete_terms(program, A, now, then, w):
            program.stage("derivatives at the quadrature points")
            terms.append((names, group, [self._discrete_first(program, term, discrete) for term in group]))

        def product(tag: str, c: np.ndarray) -> np.ndarray:
            f = np.zeros((len(self.gram.names), self.gram.element.dim), dtype=object)
            along = [c[m] for m in self.axis_indices]
            for names, group, first in terms:
                program.stage("products at the quadrature points")
                vectors = [values(program, f"{tag}{k + 1}_{names}", [term.series[k] for term in group], along)
                           for k in range(len(group[0].vectors))]
                forces = [on_vectors(program, f"{tag}_{names}{g}", at, D)
                          for g, (at, D) in enumerate(zip(zip(*vectors, strict=True), first, strict=True))]
                f[self.axis_indices] += self._gathered(program, f"{tag}_{names}", group, forces)
            program.stage("products over strain vectors")
            return np.array([program.vector(f"{tag}_f_{name}", v) for name, v in zip(self.gram.names, f, strict=True)])

        return product

    def _discrete_terms(self, program: Program, A: np.ndarray, now: np.ndarray, then: np.ndarray,
                        w: sp.Expr) -> Iterator[tuple[str, list[Term], DiscreteGradient]]:
        """Yield the terms of each rule with the discrete gradient of their program."""
        law, c = staged(program, now)
        terms = list(self._terms(law, A, c, w))
        inputs = zip(c.ravel(), zip(now.ravel(), then.ravel(), strict=True), strict=True)
        discrete = DiscreteGradient(program, law, dict(inputs))
        for names, of_rule in groupby(terms, key=lambda term: term.names):
            yield names, list(of_rule), discrete

    def _discrete_first(self, program: Program, term: Term, discrete: DiscreteGradient) -> list[sp.Expr]:
        """Return the discrete derivatives of twice the energy by a term's invariants."""
        return [program.define(f"D_{s.name}", d) for s, d in
                zip(term.invariants, discrete.gradient(term.varied, term.invariants, term.constant), strict=True)]

    def stress_of_turning(self, program: Program, A: np.ndarray, change: np.ndarray, w: sp.Expr) -> np.ndarray:
        """Return blocks (n, n, 1, 1) over strain vectors that the mean stress of a step has more than the stress of the
        mean vectors: EA (dr'.dr')/8, by which a turn reduces the strain. Bending has none.
        """
        program.stage("strain of the change at the quadrature points")
        stiffness = program.define("EA_l", A[0] / (2 * w))
        points = self.points(self.degree)
        along = [change[m] for m in self.axis_indices]
        vectors = values(program, "d", [point.value for point in points], along)
        blocks = np.zeros((len(self.gram.names), len(self.gram.names), 1, 1), dtype=object)
        for g, (point, d) in enumerate(zip(points, vectors, strict=True)):
            u = program.define(f"u_{g}", point.weight * stiffness * d.dot(d) / 8)
            for i, m in enumerate(self.axis_indices):
                for k, n in enumerate(self.axis_indices):
                    blocks[m, n] += u * point.value[i] * point.value[k]
        return blocks

    def tangent(self, program: Program, A: np.ndarray, c: np.ndarray, w: sp.Expr) -> np.ndarray:
        """Return d2U/dc2 over strain vectors."""
        return self._tangent(program, A, c, w, list(self._terms(program, A, c, w)))

    def tangent_and_parts(self, program: Program, A: np.ndarray, c: np.ndarray,
                          w: sp.Expr) -> tuple[np.ndarray, np.ndarray, np.ndarray, sp.Expr]:
        """Return d2U/dc2 over strain vectors, forces of stretching and of bending on these, and the energy of bending,
        J.
        """
        terms = list(self._terms(program, A, c, w))
        blocks = self._tangent(program, A, c, w, terms)
        f = [self._forces(program, terms, first) for first in (_first_of_stretching, _first_of_bending)]
        program.stage("energy of bending")
        return blocks, *f, program.define("U_b", sum(term.bending for term in terms) / 2)

    def _tangent(self, program: Program, A: np.ndarray, c: np.ndarray, w: sp.Expr, every: list[Term]) -> np.ndarray:
        """Return d2U/dc2 from the terms."""
        total = np.array(0)
        for _, terms in groupby(every, key=lambda term: term.names):
            total = total + self._second(program, list(terms))
        program.stage("blocks over strain vectors")
        return named_blocks(program, self.gram.names, total, symmetric=True)

    def _second(self, program: Program, terms: list[Term]) -> np.ndarray:
        """Return second derivatives of the terms of a rule, over strain vectors."""
        program.stage("second derivatives at the quadrature points")
        names, at_points = terms[0].names, []
        for g, term in enumerate(terms):
            first = _first(program, term)
            second = jacobian(program, np.array(first), term.invariants, term.constant)
            at_points.append(by_vectors(program, f"{names}{g}", names, term.vectors, first, second))
        return spread(program, names, [term.series for term in terms], at_points, symmetric=True)


First = Callable[[Program, Term], list[sp.Expr]]
"""Returns derivatives by a term's invariants."""


def _first(program: Program, term: Term) -> list[sp.Expr]:
    """Return the derivatives of twice the energy by a term's invariants."""
    gradient = jacobian(program, np.array([term.varied]), term.invariants, term.constant)[0]
    return [program.define(f"D_{s.name}", d) for s, d in zip(term.invariants, gradient, strict=True)]


def _first_of_stretching(program: Program, term: Term) -> list[sp.Expr]:
    """Return the part of `_first` without bending."""
    gradient = jacobian(program, np.array([term.varied - term.bending]), term.invariants, term.constant)[0]
    return [program.define(f"Dm_{s.name}", d) for s, d in zip(term.invariants, gradient, strict=True)]


def _first_of_bending(program: Program, term: Term) -> list[sp.Expr]:
    """Return the part of bending: what `_first` has staged less what `_first_of_stretching` has."""
    of_stretching = [sp.Symbol(f"Dm_{s.name}") for s in term.invariants]
    return [sp.Symbol(f"D_{s.name}") - (part if part in program.definition else 0)
            for s, part in zip(term.invariants, of_stretching, strict=True)]


def _number(value: Any) -> sp.Expr:
    """Return a double as the kernels will hold it; small integers are exact."""
    value = float(value)
    return sp.Integer(round(value)) if abs(value - round(value)) < 1e-15 else sp.Float(value)


def _at(p: PolyElement, x: float) -> sp.Expr:
    """Return the value of a polynomial in X."""
    return sum(float(c) * x ** k[0] for k, c in p.terms())

