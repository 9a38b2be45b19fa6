"""Functions of one variable by cubic segments, as kernels take them (derive/codegen/piecewise.py)."""

from __future__ import annotations

import numpy as np

from ..kernels.elements import part_of_manifest

RESIDUAL_STIFFNESS, TRANSITION_STRAIN = 1e-4, 1e-6
"""In compression of a cable that gives way there: part of the stiffness that remains, and the strain of the transition.
"""
SEGMENT = 6


def giving_way(x: np.ndarray, y: np.ndarray, slopes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return places, values and slopes of a function from 0 on, with the transition to a small slope below 0."""
    left = RESIDUAL_STIFFNESS * y[1] / x[1]
    below = -TRANSITION_STRAIN * (left + slopes[0]) / 2
    return np.array([-TRANSITION_STRAIN, *x]), np.array([below, *y]), np.array([left, *slopes])


def numbers(x: np.ndarray, y: np.ndarray, slopes: np.ndarray) -> np.ndarray:
    """Return the numbers of the cubic segments through values with these slopes, straight before and beyond them."""
    from scipy.interpolate import CubicHermiteSpline  # slow to import

    law = CubicHermiteSpline(x, y, slopes)
    energy = law.antiderivative()
    segments = np.zeros((len(x) + 1, SEGMENT))
    segments[1:, 0], segments[1:, 1] = x, energy(x) - energy(0.0)
    segments[1:, 2], segments[1:, 3] = y, slopes
    segments[0] = segments[1]
    segments[1:-1, 4:] = law.c[1::-1].T
    found = np.zeros(1 + SEGMENT * part_of_manifest("max_segments"))
    found[0], found[1 : 1 + segments.size] = len(segments), segments.ravel()
    return found


def _segment(table: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the numbers (..., 6) of the segments that hold x, and the distances from their starts."""
    segments = table[1 : 1 + SEGMENT * int(table[0])].reshape(-1, SEGMENT)
    held = segments[np.maximum(np.searchsorted(segments[1:, 0], x, side="right"), 0)]
    return held, x - held[..., 0]


def value(table: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Return the function of numbers of `numbers` at x, an array."""
    at, d = _segment(table, x)
    return np.asarray(at[..., 2] + d * (at[..., 3] + d * (at[..., 4] + d * at[..., 5])))


def integral(table: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Return its integral from 0."""
    at, d = _segment(table, x)
    return np.asarray(at[..., 1] + d * (at[..., 2] + d * (at[..., 3] / 2 + d * (at[..., 4] / 3 + d * at[..., 5] / 4))))
