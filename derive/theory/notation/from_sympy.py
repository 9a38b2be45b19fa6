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
    """Return a product as a sign and factors, those with negative powers below a line."""
    value, rest = term.as_coeff_Mul()
    sign = -1 if value.is_negative else 1
    value = abs(value)
    factors = [f for f in sp.Mul.make_args(rest) if f != 1]
    below = [1 / f for f in factors if f.is_Pow and f.exp.is_Rational and f.exp < 0]
    above = [f for f in factors if not (f.is_Pow and f.exp.is_Rational and f.exp < 0)]
    top, bottom = [_factor(f, names) for f in above], [_factor(f, names) for f in below]
    if value.is_Rational:
        if value.q != 1:
            bottom.insert(0, Number(str(value.q)))
        if value.p != 1:
            top.insert(0, Number(str(value.p)))
    else:
        top.insert(0, number(value))
    if bottom and value.is_Rational and value.q != 1 and len(bottom) == 1 and top and len(above) > 0:
        # a plain fraction in front reads better than a long line
        front = [number(value)]
        return sign, _product(front + [_factor(f, names) for f in above])
    if bottom:
        return sign, Fraction(_product(top), _product(bottom))
    return sign, _product(top)


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
