"""How far the tension of the elastic law swings within elements that are too long for the strain at a point."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...parts.cable import Cable

PLACES = np.polynomial.legendre.leggauss(6)[0]
"""Of half an element's length from its middle: where its tension is looked at."""
SWING = 0.1
"""Of the largest mean tension of an element: a swing that is noted."""


def swinging(cable: Cable, s: np.ndarray, tension: Callable[[np.ndarray], np.ndarray]) -> str | None:
    """Return a note where the tension swings far about its line of best fit in an element that holds one of s (..., n).

    tension: that of the elastic law over time at arc-lengths (1, m) in m, as (T, m) in N.
    """
    mesh = cable.mesh
    elements = np.unique(np.clip(mesh.element_at(s.ravel()), 0, cable.elements - 1)).astype(int)
    start, length = mesh.each_start(elements), np.broadcast_to(mesh.each_length(elements), elements.shape)
    at = start[:, None] + 0.5 * length[:, None] * (1 + PLACES)
    found = tension(at.reshape(1, -1)).reshape(-1, *at.shape)
    mean = found.mean(axis=-1, keepdims=True)
    tilt = (found * PLACES).sum(axis=-1, keepdims=True) / (PLACES**2).sum()
    swing = np.abs(found - mean - tilt * PLACES).max(axis=(0, 2))
    largest, k = float(np.abs(mean).max()), int(np.argmax(swing))
    if not swing[k] > SWING * largest > 0:
        return None
    return (f'cable "{cable.name}": the tension by method="constitutive" swings by {swing[k]:.3g} N within the element '
            f"from s = {start[k]:.6g} to {start[k] + length[k]:.6g} m, where its mean is at most {largest:.3g} N: a "
            'mesh this coarse does not tell the strain at a point. Take method="balance", or shorter elements')
