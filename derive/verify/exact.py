"""Staged programs evaluated at 50 digits, through generated Python source, without C printer and compiler."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..codegen.piecewise import NUMERICAL, PiecewiseCubicBase
from ..codegen.program import Program, two_cases

DIGITS = 50


def source(expr: sp.Expr) -> str:
    """Return the Python text of plain arithmetic; every rational is a quotient q(p, q) of the number type."""
    if expr.is_Symbol:
        return str(expr.name)
    if expr.is_Integer:
        return str(int(expr)) if expr >= 0 else f"({int(expr)})"
    if expr.is_Rational:
        return f"q({int(expr.p)}, {int(expr.q)})"
    if expr.is_Float:
        return f"number({float(expr)!r})"
    if expr.is_Add:
        return "(" + " + ".join(source(a) for a in expr.args) + ")"
    if expr.is_Mul:
        return "(" + "*".join(source(a) for a in expr.args) + ")"
    if expr.is_Pow and (2 * expr.exp).is_Integer:
        base = source(expr.base)
        return f"sqrt({base})**{int(2 * expr.exp)}" if expr.exp.q == 2 else f"{base}**{int(expr.exp)}"
    if isinstance(expr, (sp.sin, sp.cos, sp.exp)):
        return f"{expr.func.__name__}({source(expr.args[0])})"
    if isinstance(expr, PiecewiseCubicBase):
        name, entry = expr.table
        return f"{expr.c_name}({name}[{entry}:], {', '.join(source(x) for x in expr.args[1:])})"
    if expr.is_Piecewise:
        below, above, condition = two_cases(expr)
        return f"({source(below)} if {source(condition.lhs)} < {source(condition.rhs)} else {source(above)})"
    raise ValueError(f"{type(expr).__name__} is not plain arithmetic: {expr}")


class ExactProgram:
    """A program as a function of arrays of mpmath numbers; compiled at the first call."""

    def __init__(self, program: Program):
        self.program = program
        self._function: Callable[..., Any] | None = None

    def _compile(self) -> Callable[..., Any]:
        lines = [f"def kernel({', '.join(a.name for a in self.program.inputs)}):"]
        lines += [f"    {symbol.name} = {source(expr)}"
                  for stage in self.program.stages for symbol, expr in stage.definitions]
        results = (f"[{', '.join(source(e) for e in self.program.values[a.name].ravel())}]"
                   for a in self.program.outputs)
        lines.append(f"    return [{', '.join(results)}]")
        space = {"sqrt": mpmath.mp.sqrt, "sin": mpmath.mp.sin, "cos": mpmath.mp.cos, "exp": mpmath.mp.exp,
                 "q": lambda p, q: mpmath.mpf(p) / q, "number": mpmath.mpf, **NUMERICAL}
        exec(compile("\n".join(lines), f"<{self.program.name} at {DIGITS} digits>", "exec"), space)
        kernel: Callable[..., Any] = space["kernel"]
        return kernel

    def __call__(self, inputs: Iterable[np.ndarray]) -> dict[str, np.ndarray]:
        """Return the outputs by name, as arrays of mpmath numbers."""
        self._function = self._function or self._compile()
        arguments = [v.item() if a.shape == () else list(v.ravel())
                     for a, v in zip(self.program.inputs, map(np.asarray, inputs), strict=True)]
        results = self._function(*arguments)
        return {a.name: np.array([mpmath.mp.convert(v) for v in values], dtype=object).reshape(a.shape)
                for a, values in zip(self.program.outputs, results, strict=True)}
