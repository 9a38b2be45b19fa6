"""C text of SymPy expressions, the same on every machine.

Terms stand in SymPy's canonical order. Small integer powers become products. Halves, quarters and eighths become
decimals; other rationals become quotients that the compiler folds. Square roots, sines, cosines and exponentials are
macros, so that the same text serves double and complex numbers.
"""
# ruff: noqa: N802  (SymPy dispatches on these names)

from __future__ import annotations

from typing import Any

import sympy as sp
from sympy.printing.c import C99CodePrinter
from sympy.printing.precedence import PRECEDENCE

from .piecewise import PiecewiseCubicBase
from .program import two_cases

_PRINTED = (sp.Symbol, sp.Rational, sp.Float, sp.Add, sp.Mul, sp.Pow, sp.sin, sp.cos, sp.exp, sp.Piecewise,
            PiecewiseCubicBase)
_ADD, _MUL, _ATOM = PRECEDENCE["Add"], PRECEDENCE["Mul"], PRECEDENCE["Atom"]


class KernelPrinter(C99CodePrinter):
    """C99 with products for powers; raises on anything but arithmetic, sine, cosine, exponential, a choice of two."""

    def _print_Symbol(self, expr: sp.Symbol) -> str:
        return str(expr.name)

    def _print_Integer(self, expr: sp.Integer) -> str:
        return f"{int(expr)}.0"

    def _print_Rational(self, expr: sp.Rational) -> str:
        return repr(float(expr)) if _is_short(expr) else f"{int(expr.p)}.0/{int(expr.q)}.0"

    def parenthesize(self, item: sp.Expr, level: int, strict: bool = False) -> str:
        """Return the text of a part of an expression, in brackets where they are needed: a short decimal needs none."""
        return self._print(item) if _is_short(item) else super().parenthesize(item, level, strict)

    def _print_Float(self, expr: sp.Float) -> str:
        return repr(float(expr))

    def _print_Add(self, expr: sp.Add) -> str:
        text = ""
        for term in self._as_ordered_terms(expr):
            negative = term.as_coeff_Mul()[0].is_negative
            body = self.parenthesize(-term if negative else term, _ADD)
            text += (" - " if negative else " + ") + body if text else ("-" if negative else "") + body
        return text

    def _print_Pow(self, expr: sp.Pow) -> str:
        base, exponent = expr.base, expr.exp
        if exponent == sp.Rational(1, 2):
            return f"FU_SQRT({self._print(base)})"
        if exponent.is_Integer and exponent > 1:
            factor = self.parenthesize(base, _ATOM, strict=True)
            return "*".join([factor] * int(exponent))
        if exponent.is_Rational and exponent < 0:
            below = sp.Pow(base, -exponent, evaluate=False) if exponent != -1 else base
            text = self.parenthesize(below, _ATOM, strict=True) if exponent == -1 else f"({self._print(below)})"
            return f"1.0/{text}"
        raise ValueError(f"power {exponent} of {base} has no kernel form")

    def _print_Mul(self, expr: sp.Mul) -> str:
        if expr.as_coeff_Mul()[0].is_negative:
            return "-" + self.parenthesize(-expr, _MUL)
        above, below = [], []
        for arg in expr.as_ordered_factors():
            if arg.is_Pow and arg.exp.is_Rational and arg.exp < 0:
                below.append(sp.Pow(arg.base, -arg.exp))
            else:
                above.append(arg)
        text = "*".join(self.parenthesize(a, _MUL) for a in above) or "1.0"
        if below:
            denominator = "*".join(self.parenthesize(b, _MUL) for b in below)
            text += f"/({denominator})" if len(below) > 1 or "*" in denominator else f"/{denominator}"
        return text

    def _print_sin(self, expr: sp.Expr) -> str:
        return f"FU_SIN({self._print(expr.args[0])})"

    def _print_cos(self, expr: sp.Expr) -> str:
        return f"FU_COS({self._print(expr.args[0])})"

    def _print_exp(self, expr: sp.Expr) -> str:
        return f"FU_EXP({self._print(expr.args[0])})"

    def _print_PiecewiseCubicBase(self, expr: PiecewiseCubicBase) -> str:
        name, entry = expr.table
        return f"{expr.c_name}({name} + {entry}, {', '.join(self._print(x) for x in expr.args[1:])})"

    def _print_Piecewise(self, expr: sp.Piecewise) -> str:
        below, above, condition = two_cases(expr)
        return (f"(FU_REAL({self._print(condition.lhs)}) < {self._print(condition.rhs)} ? {self._print(below)} "
                f": {self._print(above)})")

    def _print(self, expr: Any, **kwargs: Any) -> str:
        # SymPy's printer knows many functions and constants; the kernels must not
        if not isinstance(expr, _PRINTED):
            raise ValueError(f"{type(expr).__name__} has no kernel form: {expr}")
        return str(super()._print(expr, **kwargs))


def _is_short(expr: sp.Expr) -> bool:
    """Return whether a number is a positive fraction with exact short decimals."""
    return expr.is_Rational and expr > 0 and int(expr.q) in (2, 4, 8)


_PRINTER = KernelPrinter({"order": "lex"})


def c_expression(expr: sp.Expr) -> str:
    """Return the C text of an expression."""
    return str(_PRINTER.doprint(expr))
