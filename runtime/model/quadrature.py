"""Quadrature along the elements of a cable."""

from __future__ import annotations

from typing import Any

import numpy as np


def along_elements(on_axis: Any, lengths: np.ndarray,
                   rule: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the shape functions of the axis and their slopes, (elements, points, vectors) each, by the kernel on_axis,
    and the weights (elements, points) in m.

    lengths (elements,) in m; rule: points and weights between -1 and 1, as of `numpy.polynomial.legendre.leggauss`.
    """
    places, weights = rule
    shapes = [[on_axis(length, length * (1 + x) / 2) for x in places] for length in lengths]
    N, N_x = (np.array([[shape[k] for shape in each] for each in shapes]) for k in range(2))
    return N, N_x, np.outer(lengths, weights) / 2
