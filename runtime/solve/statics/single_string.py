"""A string between two fixed points, without bending and planes: its shape at rest by the tension at its start.

Tensions of its links are T_k = F - sum of the loads before link k, with F the force on the start. Complementary energy
is convex in F,

    sum of l_k (|T_k| + |T_k|²/(2 EA_k)) - F . d,

and its gradient is the gap between the end of the string and its support at the distance d from the start. Newton's
method on the two or three components of F replaces interior points on all nodes (`strings`).
"""

from __future__ import annotations

import numpy as np

from .strings import Rest, Strings

GAP_TOLERANCE = 1e-9
"""Gap at the end of the string, as a fraction of its length."""
MAX_ITERATIONS = 30
MIN_STEP = 1e-3
"""Fraction of a Newton step below which none is tried."""
ROUNDING = 1e-13
"""Of the energy, as a fraction of length times tension."""
DESCENT = 1e-4
"""Of the decrease that the gradient predicts: least decrease of the energy."""


def rest_between(strings: Strings) -> Rest | None:
    """Return a string at rest, without its bending stiffness. Its links are in their order, its ends alone are fixed.

    None where bending over the span resists more than tension, where nothing loads it, or where rest was not found.
    """
    before, l, EA = np.zeros((len(strings.links), strings.r.shape[1])), strings.length, strings.axial
    np.cumsum(strings.load[strings.links[:-1, 1]], axis=0, out=before[1:])
    start, chord = strings.r[strings.links[0, 0]], strings.r[strings.links[-1, 1]] - strings.r[strings.links[0, 0]]
    span, length, loads = float(np.linalg.norm(chord)), float(l.sum()), float(np.linalg.norm(before[-1]))
    if not span > 0 or not loads > 0:
        return None

    def energy(F: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
        T = F - before
        size = np.sqrt((T * T).sum(axis=1))
        return float(l @ (size * (1 + 0.5 * size / EA)) - F @ chord), T, size

    sag = max(span * max(length - span, 0.0), (1e-3 * span) ** 2) ** 0.5
    F, gap = 0.5 * before[-1] + loads / 8 * chord / sag, np.inf
    value, T, size = energy(F)
    for iteration in range(MAX_ITERATIONS):
        if not size.min() > 0:
            return None
        along = T / size[:, None]
        stretched = l * (1 + size / EA)
        gradient = stretched @ along - chord
        gap = float(np.linalg.norm(gradient))
        if gap <= GAP_TOLERANCE * length:
            if strings.bending.sum() > length * span**2 * size.min():  # EI > T L²
                return None
            steps = np.cumsum(stretched[:, None] * along, axis=0)
            r = strings.r.copy()
            r[strings.links[:-1, 1]] = start + steps[:-1]
            return Rest(r, np.ones(len(l), dtype=bool), float((1 + size / EA).min()), iteration)
        across = l / size
        matrix = float((across + l / EA).sum()) * np.eye(len(F)) - (across[:, None] * along).T @ along
        step, part = np.linalg.solve(matrix, gradient), 1.0
        rounding = ROUNDING * length * size.max()
        while (found := energy(F - part * step))[0] > value + rounding - DESCENT * part * float(gradient @ step):
            part *= 0.5
            if part < MIN_STEP:
                return None
        F = F - part * step
        value, T, size = found
    return None
