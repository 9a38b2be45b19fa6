"""Parts of invariances: errors with ceilings, numbers that shift exactly, infinitesimal rotations."""

from __future__ import annotations

from typing import Any

import numpy as np

Invariance = tuple[str, float, float]
ORIGIN_SHIFT = 2.0**13  # above 10^4 lengths of the sample element; a power of two, so that moving there rounds nothing


def quantised(values: np.ndarray) -> np.ndarray:
    """Return values rounded to 2^-20, so that adding ORIGIN_SHIFT is exact."""
    return np.round(values * 2.0**20) / 2.0**20


def relative(value: Any, scale: Any) -> float:
    """Return the largest entry over the scale's largest."""
    return float(np.max(np.abs(value)) / np.max(np.abs(scale)))


def spins(dim: int) -> list[np.ndarray]:
    """Return infinitesimal rotations in every coordinate plane."""
    found = []
    for i in range(dim):
        for j in range(i):
            spin = np.zeros((dim, dim))
            spin[i, j], spin[j, i] = 1.0, -1.0
            found.append(spin)
    return found
