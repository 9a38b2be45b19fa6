"""Gauss rules of integration."""

from __future__ import annotations

from functools import cache

import numpy as np


@cache
def gauss(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Return places and weights (points,) of the Gauss-Legendre rule between -1 and 1.

    It is exact for polynomials of the degree 2 points - 1. NumPy loads its polynomials when first asked for.
    """
    places, weights = np.polynomial.legendre.leggauss(points)
    places.flags.writeable = weights.flags.writeable = False
    return places, weights
