"""Stumpff's functions c_k(x) = sum_j (-x)^j/(2 j + k)!, the coefficients of a rotation by a vector of length sqrt(x).

c_0 = cos sqrt x, c_1 = sin sqrt x/sqrt x, and so on. Near zero the series replaces these quotients, which
lose digits there. Source: Stiefel & Scheifele, Linear and Regular Celestial Mechanics, 1971.
"""

from __future__ import annotations

from itertools import count

import sympy as sp

from ..codegen.program import Program

SERIES_BELOW = (sp.Rational(1, 4), sp.Rational(1, 4), sp.Integer(1), sp.Integer(1))
"""Value of x, for each k, below which the series is taken. The quotients of c_0 and c_1 lose no digits, so that fewer
terms suffice; those of c_2 and c_3 lose at most three bits above 1."""
SERIES_ERROR = sp.Rational(1, 2**54)


def stumpff(p: Program, name: str, k: int, x: sp.Expr, root: sp.Expr) -> sp.Expr:
    """Define c_k(x) for k from 0 to 3; root is the name that sqrt(x) has in the program."""
    return p.define(name, sp.Piecewise((_series(k, x), x < SERIES_BELOW[k]), (_quotient(k, x, root), True)))


def _series(k: int, x: sp.Expr) -> sp.Expr:
    """Return the series by Horner's rule, up to the first term below rounding of the leading one."""
    terms = next(j for j in count() if SERIES_BELOW[k]**j * sp.factorial(k) / sp.factorial(2 * j + k) < SERIES_ERROR)
    value = sp.S.Zero
    for j in reversed(range(terms)):
        value = sp.Rational((-1) ** j, sp.factorial(2 * j + k)) + x * value
    return value


def _quotient(k: int, x: sp.Expr, root: sp.Expr) -> sp.Expr:
    return (sp.cos(root), sp.sin(root) / root, (1 - sp.cos(root)) / x, (root - sp.sin(root)) / (x * root))[k]
