"""Oscillation of the tension by the elastic law within elements too long for the strain at a point."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...base.quadrature import gauss
from ...parts.cable import Cable

POINTS = 6
"""Points of an element."""
MIN_SWING = 0.1
"""Smallest oscillation that is reported, over the largest mean tension of an element."""


def swinging(cable: Cable, s: np.ndarray, tension: Callable[[np.ndarray], np.ndarray]) -> str | None:
    """Return a note if the tension oscillates about its line of best fit in an element that contains one of s (..., n).

    tension: by the elastic law, (T, m) in N, at arc-lengths (1, m) in m.
    """
    mesh, samples = cable.mesh, gauss(POINTS)[0]
    elements = np.unique(np.clip(mesh.element_at(s.ravel()), 0, cable.elements - 1)).astype(int)
    start, length = mesh.each_start(elements), np.broadcast_to(mesh.each_length(elements), elements.shape)
    at = start[:, None] + 0.5 * length[:, None] * (1 + samples)
    found = tension(at.reshape(1, -1)).reshape(-1, *at.shape)
    mean = found.mean(axis=-1, keepdims=True)
    tilt = (found * samples).sum(axis=-1, keepdims=True) / (samples**2).sum()
    swing = np.abs(found - mean - tilt * samples).max(axis=(0, 2))
    largest, k = float(np.abs(mean).max()), int(np.argmax(swing))
    if not swing[k] > MIN_SWING * largest > 0:
        return None
    return (f'cable "{cable.name}": the tension by method="constitutive" swings by {swing[k]:.3g} N within the element '
            f"from s = {start[k]:.6g} to {start[k] + length[k]:.6g} m, where its mean is at most {largest:.3g} N: a "
            'mesh this coarse does not tell the strain at a point. Take method="balance", or shorter elements')
