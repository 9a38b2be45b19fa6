"""Kernels of the force between two points, from a law's energy U by its measures e of the gap (`spec.PointLaw`).

A law with a damper takes the power P = c e'.e'. The force on the first point is dU/dgap + d(P/2)/dgap' =
(dU/de + c e') . de/dgap, its opposite acts on the second. Kernels of all laws take the same arguments, so that engine
and verification serve every law.
"""

from __future__ import annotations

from functools import partial
from types import SimpleNamespace

import numpy as np
import sympy as sp

from ..algebra.discrete_gradient import DiscreteGradient
from ..codegen.family import SPACE, PointLawFamily
from ..codegen.program import AXES, DirectionalDerivative, Program
from ..spec import PointLaw

FIRST = "force on the first point"


def families_of(name: str, law: PointLaw) -> list[PointLawFamily]:
    """Return the families of the force between two points by a law, in space and in the plane."""
    return [PointLawFamily(prefix + name, f"{law.doc} in {SPACE[dim]}", partial(build, prefix + name, law, dim),
                           (f"couplings.point_laws.{name}", "couplings.point_law"), role="point_law",
                           missing=missing(law), facts={"dim": dim, "parameters": len(law.parameters)},
                           dim=dim, point_law=law) for dim, prefix in ((3, ""), (2, "planar_"))]


def build(name: str, law: PointLaw, dim: int) -> list[Program]:
    """Return the kernels of a law, whose names begin with `name`, in the plane or in space."""
    kernels = (energy, dissipation, force, tangent, discrete_force) if law.damping else (
        energy, force, tangent, discrete_force)
    return [kernel(name, law, dim) for kernel in kernels]


def missing(law: PointLaw) -> tuple[str, ...]:
    """Return the kernels that a law lacks."""
    return () if law.damping else ("dissipation",)


def constants(p: Program, law: PointLaw) -> SimpleNamespace:
    """Stage: return the parameters by name."""
    p.stage("parameters")
    return SimpleNamespace(**{name: p.define(name, value, alias=True)
                              for name, value in zip(law.parameters, p.symbols["parameters"], strict=True)})


def _program(name: str, law: PointLaw, doc: str, source: str) -> Program:
    p = Program(name, doc, source)
    p.input("parameters", len(law.parameters), ", ".join(unit for unit, _ in law.parameters.values()),
            ", ".join(law.parameters))
    return p


class _Law:
    """A law in a kernel at one instant: inputs, parameters, measures e."""

    def __init__(self, name: str, law: PointLaw, dim: int, doc: str, rate: bool = True):
        self.law = law
        self.program = p = _program(name, law, doc, law.source)
        self.gap = p.input("gap", dim, "m", "second point less the first")
        self.rate = p.input("gap_rate", dim, "m/s", "rate of the gap") if rate else None
        self.c = constants(p, law)
        self.e = law.measured(p, self.gap, self.c)
        self.by_gap = self._by(self.gap, "d")

    def _by(self, symbols: np.ndarray, tag: str) -> list[DirectionalDerivative]:
        """Return the derivations by each of these symbols."""
        return [DirectionalDerivative(self.program, f"{tag}_{axis}", dict(zip(symbols, unit, strict=True)))
                for axis, unit in zip(AXES, np.eye(len(symbols), dtype=int), strict=False)]

    def energy(self) -> sp.Expr:
        """Stage: U."""
        self.program.stage("energy")
        return self.law.energy(self.program, self.e, self.c)

    def directions(self) -> np.ndarray:
        """Stage: de/dgap, a row for each measure."""
        self.program.stage("directions")
        return np.stack([d.array(self.e) for d in self.by_gap], axis=1)

    def rates(self, directions: np.ndarray) -> np.ndarray:
        """Stage: e'."""
        self.program.stage("rates of the measures")
        return np.array([self.program.define("e_rate", row.dot(self.rate)) for row in directions])

    def force(self) -> tuple[np.ndarray, np.ndarray]:
        """Stage: force on the first point, and its derivatives by the gap's rate."""
        p, U, directions = self.program, self.energy(), self.directions()
        damping = getattr(self.c, self.law.damping) if self.law.damping else sp.S.Zero
        rates = self.rates(directions) if self.law.damping else 0 * self.e
        p.stage("force")
        by_measure = self.by_gap if self.e is self.gap else self._by(self.e, "dU")
        tension = [p.define("tension", d(U) + damping * rate) for d, rate in zip(by_measure, rates, strict=True)]
        return p.vector("F", directions.T.dot(tension)), damping * directions.T.dot(directions)


def energy(name: str, law: PointLaw, dim: int) -> Program:
    """Return the kernel of U."""
    at = _Law(f"{name}_energy", law, dim, "stored energy", rate=False)
    at.program.output("U", at.energy(), "J", "stored energy")
    return at.program


def dissipation(name: str, law: PointLaw, dim: int) -> Program:
    """Return the kernel of P."""
    at = _Law(f"{name}_dissipation", law, dim, "power of the damper")
    rates = at.rates(at.directions())
    at.program.output("P", getattr(at.c, law.damping) * rates.dot(rates), "W", "dissipated power c e'.e'")
    return at.program


def force(name: str, law: PointLaw, dim: int) -> Program:
    """Return the kernel of the force alone."""
    at = _Law(f"{name}_force", law, dim, "force between the points")
    at.program.output("f", at.force()[0], "N", FIRST)
    return at.program


def tangent(name: str, law: PointLaw, dim: int) -> Program:
    """Return the kernel of the force with its derivatives."""
    at = _Law(f"{name}_tangent", law, dim, "force between the points, and its derivatives")
    f, by_rate = at.force()
    at.program.stage("derivatives of the force")
    by_gap = np.stack([d.array(f) for d in at.by_gap], axis=1)
    at.program.output("f", f, "N", FIRST)
    at.program.output("K", by_gap, "N/m", "derivatives of f by the gap")
    at.program.output("D", by_rate, "N s/m", "derivatives of f by the gap's rate")
    return at.program


def discrete_force(name: str, law: PointLaw, dim: int) -> Program:
    """Return the kernel of the force over a step, whose work is the energy stored and dissipated."""
    p = _program(f"{name}_discrete_force", law, "force over a step, whose work is stored and dissipated",
                 "discrete gradient of the energy; Gonzalez, J. Nonlinear Sci. 6 (1996) 449-467")
    h = p.input("h", (), "s", "step")
    gap = p.input("gap", dim, "m", "second point less the first, at the start of the step")
    gap_next = p.input("gap_next", dim, "m", "gap at the end of the step")
    c = constants(p, law)
    staged = Program("law", "measures and energy at one state", "")
    at = np.array([staged.input(f"gap_{axis}", (), "m", "gap") for axis in AXES[:dim]])
    e = law.measured(staged, at, c)
    staged.stage("energy")
    U = law.energy(staged, e, c)
    discrete = DiscreteGradient(p, staged, dict(zip(at, zip(gap, gap_next, strict=True), strict=True)))
    p.stage("discrete derivatives of the measures")
    directions = np.array([p.vector("D_e", discrete.gradient(each, list(at))) for each in e])
    rates = _mean_rates(p, directions, gap_next - gap, h) if law.damping else 0 * e
    damping = getattr(c, law.damping) if law.damping else sp.S.Zero
    p.stage("force")
    tension = [p.define("tension", by + damping * rate)
               for by, rate in zip(discrete.gradient(U, list(e)), rates, strict=True)]
    p.output("f", directions.T.dot(tension), "N", FIRST)
    p.output("P", damping * rates.dot(rates), "W", "dissipated power")
    return p


def _mean_rates(p: Program, directions: np.ndarray, difference: np.ndarray, h: sp.Expr) -> np.ndarray:
    """Stage: rates of the measures over a step."""
    p.stage("rates of the measures over the step")
    change = p.vector("change", difference)
    inverse = p.define("inv_h", 1 / h)
    return np.array([p.define("e_rate", inverse * row.dot(change)) for row in directions])
