"""Formulas from SymPy expressions."""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp

from .tree import Call, Cases, Fraction, Name, Node, Number, Power, Product, Root, Sum

Names = Callable[[sp.Symbol], Node]


def formula(expr: sp.Expr, names: Names) -> Node:
    """Return the formula of an expression; names gives what stands for a symbol."""
    expr = sp.sympify(expr)
    terms = expr.as_ordered_terms() if expr.is_Add else [expr]
    signed = [_term(term, names) for term in terms]
    if len(signed) == 1 and signed[0][0] > 0:
        return signed[0][1]
    if signed[0][0] < 0:  # a sum does not begin with a minus where it need not
        signed.sort(key=lambda term: term[0] < 0)
    return Sum(tuple(signed))


def signed_sum(terms: list[tuple[int, Node]]) -> Node:
    """Return a sum of terms with signs, a lone one as it is."""
    return terms[0][1] if len(terms) == 1 and terms[0][0] > 0 else Sum(tuple(terms))


def coefficient(value: sp.Expr) -> tuple[int, list[Node]]:
    """Return sign and factors of a number; none for one."""
    sign = -1 if value.is_negative else 1
    value = abs(value)
    if value == 1:
        return sign, []
    return sign, [number(value)]


def number(value: sp.Expr) -> Node:
    """Return a number that is not negative: an integer, a fraction, or the shortest decimals of a double."""
    if value.is_Integer:
        return Number(str(value))
    if value.is_Rational:
        return Fraction(Number(str(value.p)), Number(str(value.q)))
    return Number(_decimals(float(value)))


def _decimals(value: float) -> str:
    text = repr(value)
    return text if "e" not in text else f"{value:.25f}".rstrip("0")


def _term(term: sp.Expr, names: Names) -> tuple[int, Node]:
    """Return a product as a sign and factors, those with negative powers below a line.

    A number alone makes no line below everything: its fraction in front reads better.
    """
    value, rest = term.as_coeff_Mul()
    factors = [f for f in sp.Mul.make_args(rest) if f != 1]
    above = [_factor(f, names) for f in factors if not _divides(f)]
    below = [_factor(1 / f, names) for f in factors if _divides(f)]
    sign, front = coefficient(value)
    if not below:
        return sign, _product(front + above)
    numerator, denominator = (coefficient(part)[1] for part in value.as_numer_denom())
    return sign, Fraction(_product(numerator + above), _product(denominator + below))


def _divides(factor: sp.Expr) -> bool:
    """Return whether a factor is a negative power, of which the inverse goes below the line."""
    return bool(factor.is_Pow and factor.exp.is_Rational and factor.exp < 0)


def _product(factors: list[Node]) -> Node:
    return Number("1") if not factors else factors[0] if len(factors) == 1 else Product(tuple(factors))


def _factor(expr: sp.Expr, names: Names) -> Node:
    if expr.is_Symbol:
        return names(expr)
    if expr.is_Number:
        return number(expr)
    if expr.is_Pow:
        if expr.exp == sp.Rational(1, 2):
            return Root(formula(expr.base, names))
        if expr.exp == sp.Rational(3, 2):
            return Product((formula(expr.base, names), Root(formula(expr.base, names))))
        base = formula(expr.base, names)
        return Power(base, int(expr.exp))
    if expr.is_Piecewise:
        (below, condition), (other, _) = expr.args
        return Cases(formula(below, names), formula(condition.lhs, names), formula(condition.rhs, names),
                     formula(other, names))
    if isinstance(expr, (sp.sin, sp.cos)):
        return Call(expr.func.__name__, formula(expr.args[0], names))
    return formula(expr, names)


def plain_names(table: dict[sp.Symbol, Name]) -> Names:
    """Return names from a table; a symbol that is not in it keeps its letter."""
    return lambda symbol: table.get(symbol, Name(symbol.name))
