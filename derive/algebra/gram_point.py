"""Fields at a point of the axis from strain vectors: combinations of them whose factors are polynomials in X."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import sympy as sp

from . import section_integrals as integrals
from .gram import Gram

Expansion = dict[tuple[int, int], np.ndarray]


def expansion(polynomials: Sequence[Any], c: np.ndarray, X: sp.Expr, w: sp.Expr) -> Expansion:
    """Return the sum of ring polynomials times strain vectors as a polynomial in y and z: {(power of y, power of z):
    vector}.
    """
    found: Expansion = {}
    for p, vector in zip(polynomials, c, strict=True):
        for (y, z), factor in by_section(p, X, w).items():
            found[y, z] = found.get((y, z), 0) + factor * vector
    return found


def axis(gram: Gram, c: np.ndarray, X: sp.Expr, w: sp.Expr, order: int) -> np.ndarray:
    """Return the derivative of the centreline by x, `order` times."""
    polynomials = [columns[0] for columns in gram.gradient]
    for _ in range(order - 1):
        polynomials = [integrals.d_dx(p) for p in polynomials]
    zero = np.full(gram.element.dim, sp.S.Zero)
    return expansion(polynomials, c, X, w).get((0, 0), zero)


def by_section(p: Any, X: sp.Expr, w: sp.Expr) -> dict[tuple[int, int], sp.Expr]:
    """Return the factors, Horner's way in X and with one power of w = 1/l each, by the powers of y and z."""
    series: dict[tuple[int, int], dict[int, sp.Expr]] = {}
    for (x, y, z, l, u), c in p.terms():
        powers = series.setdefault((y, z), {}).setdefault(u - l, {})
        powers[x] = sp.Rational(int(c.numerator), int(c.denominator))
    return {section: sum(_horner(powers, X) * w**n for n, powers in sorted(by_w.items()))
            for section, by_w in series.items()}


def _horner(powers: dict[int, sp.Rational], X: sp.Expr) -> sp.Expr:
    value = sp.S.Zero
    for n in range(max(powers), -1, -1):
        value = value * X + powers.get(n, sp.S.Zero)
    return value
