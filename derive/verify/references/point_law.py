"""A law of the force between two points as its spec has it: no stages, no chain rule, evaluated at 50 digits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy as sp

from ...codegen.family import PointLawFamily
from ...codegen.program import Program
from ...couplings.point_law import constants
from ..exact import ExactProgram


class _Closed(Program):
    """A program without intermediate values: expressions stand as they are."""

    def define(self, name: str, expr: sp.Expr, derivative_of: sp.Expr | None = None, alias: bool = False) -> sp.Expr:
        return sp.sympify(expr)


def _function(family: PointLawFamily, of: Callable[..., Any]) -> Callable[..., Any]:
    """Return of(law, program, gap, rate, parameters by name) as a function of arrays: parameters, gap, rate."""
    p, law = _Closed(family.name, "", ""), family.point_law
    p.input("parameters", len(law.parameters), "", "")
    gap, rate = p.input("gap", family.dim, "m", ""), p.input("gap_rate", family.dim, "m/s", "")
    p.output("value", of(law, p, gap, rate, constants(p, law)), "", "")
    program = ExactProgram(p)
    return lambda parameters, gap, rate: program((parameters, gap, rate))["value"]


def energy(family: PointLawFamily) -> Callable[..., Any]:
    """Return U(parameters, gap)."""
    U = _function(family, lambda law, p, gap, rate, c: law.energy(p, law.measured(p, gap, c), c))
    return lambda parameters, gap: U(parameters, gap, gap)[0]


def measures(family: PointLawFamily) -> Callable[..., Any]:
    """Return e(parameters, gap)."""
    e = _function(family, lambda law, p, gap, rate, c: law.measured(p, gap, c))
    return lambda parameters, gap: e(parameters, gap, gap)


def rates(family: PointLawFamily) -> Callable[..., Any]:
    """Return e'(parameters, gap, gap_rate)."""
    def rate_of(law, p, gap, rate, c):
        return [sum(sp.diff(e, x) * v for x, v in zip(gap, rate, strict=True)) for e in law.measured(p, gap, c)]
    return _function(family, rate_of)
