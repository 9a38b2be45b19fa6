"""Integrals of polynomials over an element, as rational numbers times moments of its cross-section.

An element is 0 <= x <= l times a cross-section that is symmetric about y and z. Polynomials live in the ring
Q[X, y, z, l, w] with X = 2 x/l - 1 and w = 1/l; an integral is exact term by term, so nothing is expanded,
integrated or simplified as a SymPy expression.
"""

from __future__ import annotations

from typing import Any

import sympy as sp
from sympy.polys.rings import ring

RING, X, Y, Z, L, W = ring("X,y,z,l,w", sp.QQ)

# Even moments of a doubly symmetric section, in the order of the kernels' argument `section`.
SECTION = {(0, 0): 0, (2, 0): 1, (0, 2): 2, (4, 0): 3, (2, 2): 4, (0, 4): 5}
SECTION_UNITS = "m^2, m^4, m^4, m^6, m^6, m^6"
SECTION_DOC = "section moments: integrals over A of 1, y^2, z^2, y^4, y^2 z^2, z^4"


def legendre(n: int) -> Any:
    """Return the Legendre polynomial P_n(X) in the ring of polynomials."""
    p = sp.Poly(sp.legendre(n, sp.Symbol("X")), sp.Symbol("X"))
    return sum((RING(sp.QQ.from_sympy(c)) * X**k for (k,), c in p.terms()), RING(0))


def d_dx(p: Any) -> Any:
    """Return the derivative by x = l (1 + X)/2."""
    return 2 * W * p.diff(X)


def over_element(p: Any) -> dict[tuple[int, int], sp.QQ]:
    """Return the integral over the volume: {(section moment, power of l): rational}."""
    total: dict[tuple[int, int], sp.QQ] = {}
    for (ex, ey, ez, el, ew), c in p.terms():
        if ex % 2 or ey % 2 or ez % 2:
            continue
        key = (SECTION[ey, ez], el - ew + 1)
        total[key] = total.get(key, sp.QQ(0)) + c / (ex + 1)
    return {k: v for k, v in total.items() if v}
