"""A function of one variable by cubic segments, whose numbers are an argument of a kernel, with its integral and slope.

The numbers begin with that of the segments; each segment has (start, integral, value, slope, c2, c3) and is

    value + slope d + c2 d^2 + c3 d^3,   d = x - start,   integral its integral from 0.

A segment holds from its start, the first one everywhere before the second. Programs see functions with derivatives; C
finds the segment (kernels.h), and `NUMERICAL` does at any number of digits.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import sympy as sp

SEGMENT = 6
"""Numbers of a segment."""


class PiecewiseCubicBase(sp.Function):
    """Of the first number of the table, an entry of an argument, and of the variable."""

    c_name = ""

    @property
    def table(self) -> tuple[str, int]:
        """Return the name of the argument, and where the table begins in it."""
        name, _, entry = self.args[0].name.partition("[")
        return name, int(entry[:-1])


class CubicSlope(PiecewiseCubicBase):
    """The slope of the function."""

    nargs, c_name = 2, "fu_cubic_slope"


class CubicValue(PiecewiseCubicBase):
    """The function."""

    nargs, c_name = 2, "fu_cubic_value"

    def fdiff(self, argindex: int = 2) -> sp.Expr:
        """Return the slope."""
        return CubicSlope(*self.args)


class CubicIntegral(PiecewiseCubicBase):
    """Its integral from 0."""

    nargs, c_name = 2, "fu_cubic_integral"

    def fdiff(self, argindex: int = 2) -> sp.Expr:
        """Return the value."""
        return CubicValue(*self.args)


class CubicMean(PiecewiseCubicBase):
    """Its mean between two places: the difference of the integral over theirs, where they meet the value."""

    nargs, c_name = 3, "fu_cubic_mean"


def segment_at(table: Sequence[Any], x: Any) -> Sequence[Any]:
    """Return the numbers of the segment that holds x."""
    k = 0
    while k + 1 < int(table[0]) and table[1 + SEGMENT * (k + 1)] <= x:
        k += 1
    return table[1 + SEGMENT * k : 1 + SEGMENT * (k + 1)]


def _integral(table: Sequence[Any], x: Any) -> Any:
    start, integral, value, slope, c2, c3 = segment_at(table, x)
    d = x - start
    return integral + d * (value + d * (slope / 2 + d * (c2 / 3 + d * c3 / 4)))


def _value(table: Sequence[Any], x: Any) -> Any:
    start, _, value, slope, c2, c3 = segment_at(table, x)
    d = x - start
    return value + d * (slope + d * (c2 + d * c3))


def _slope(table: Sequence[Any], x: Any) -> Any:
    start, _, _, slope, c2, c3 = segment_at(table, x)
    d = x - start
    return slope + d * (2 * c2 + d * 3 * c3)


def _mean(table: Sequence[Any], a: Any, b: Any) -> Any:
    return _value(table, a) if a == b else (_integral(table, b) - _integral(table, a)) / (b - a)


NUMERICAL: dict[str, Callable[..., Any]] = {CubicIntegral.c_name: _integral, CubicValue.c_name: _value,
                                            CubicSlope.c_name: _slope, CubicMean.c_name: _mean}
"""The functions of a table, a list of numbers, by name."""
