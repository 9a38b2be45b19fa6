"""Sums of linear waves: a row (6,) a wave, of amplitude in m, angular frequency in rad/s, phase in rad, and wave vector
in 1/m.
"""

from __future__ import annotations

import numpy as np


def elevation(waves: np.ndarray, time: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return the elevation a cos(k . r - omega t + phase) of waves (n, 6) in all, m, at times (s) and places (..., 3)
    in m.
    """
    found = np.zeros(np.broadcast_shapes(np.shape(time), np.shape(place)[:-1]))
    for amplitude, frequency, phase, *vector in waves:
        found = found + amplitude * np.cos(place @ np.array(vector) - frequency * np.asarray(time) + phase)
    return found


def moved_to(waves: np.ndarray, origin: np.ndarray) -> np.ndarray:
    """Return waves (n, 6) with their phases for places relative to an origin (3,), m."""
    moved = waves.copy()
    moved[:, 2] += waves[:, 3:] @ origin
    return moved
