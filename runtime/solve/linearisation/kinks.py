"""Kinks of forces at a state of rest, where one linear model does not hold on both sides.

Along a motion d that moves everything, R(hd) - 2 R(0) + R(-hd) is of the order h² where forces are smooth, and of the
order h at a kink, such as of a spring without compression at its stress-free length, or of a contact that just touches.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from ...errors import SceneError
from ..statics.balance import place_of
from .equations import Equations

STEP = 1e-6
"""Largest of three steps, of displacements in m or rad; each is half of the one before."""
MIN_SECOND_DIFFERENCE = 1e-4
"""Of the change of the force itself, below which nothing is a kink."""
RATIOS = 1.6, 2.5
"""Of the second differences of successive steps at a kink, which are 4 where forces are smooth."""
FORCE_ROUNDING = 1e-13
"""Of the sum of forces, within which second differences are rounding."""


def refuse_kinks(own: Equations, Z: np.ndarray) -> None:
    """Raise SceneError where forces on coordinates, or those of laws, have a kink by motions Z (coordinates, n)."""
    if not Z.size:
        return
    static, rows = own.static, np.concatenate([own.kept, own.laws])
    along = Z @ np.random.default_rng(1).choice([-1.0, 1.0], Z.shape[1]) / np.maximum(
        np.abs(Z).max(axis=0), np.finfo(float).tiny).max()
    along /= np.abs(along).max() or 1.0
    change, state = np.zeros(static.engine.unknowns), static.keep()
    change[own.kept] = along

    def residual(h: float) -> np.ndarray:
        static.restore(state, prescribe=False)
        static.move(h * change)
        return np.asarray(static.residual()[rows])

    stiffness = np.concatenate([abs(own.K) @ np.abs(along), abs(own.law_stiffness) @ np.abs(along)])
    at = _kink(residual, stiffness)
    static.restore(state, prescribe=False)
    if at is not None:
        raise SceneError("linearise", f"forces have a kink at this state, largest on {_place(own, int(rows[at]))}: "
                         "they change differently in the two directions of a motion, as of a spring without "
                         "compression at its stress-free length or a contact that just touches",
                         "linearise about a state beside it")


def _place(own: Equations, unknown: int) -> str:
    """Return the place of an unknown in words."""
    model = own.model
    n = model.n_band + model.n_border_dof
    for coupling in model.couplings:
        if coupling.unknown <= unknown - n < coupling.unknown + coupling.n_coordinates + coupling.n_forces:
            return f'{coupling.type.replace("_", " ")} "{coupling.name}"'
    return place_of(own.static, own.kept, int(np.flatnonzero(own.kept == unknown)[0]))


def _kink(residual: Callable[[float], np.ndarray], stiffness: np.ndarray) -> int | None:
    """Return the row with the largest kink, None without; stiffness (n,): of rows, for the size of forces."""
    here, second, first = residual(0.0), [], []
    for k in range(3):
        above, below = residual(STEP / 2**k), residual(-STEP / 2**k)
        second.append(np.abs(above + below - 2 * here))
        first.append(np.abs(above - below) / 2)
    noise = FORCE_ROUNDING * max(np.max(stiffness, initial=0.0), np.max(np.abs(here), initial=0.0))
    large = np.all([each > MIN_SECOND_DIFFERENCE * size.max(initial=0.0) + noise
                    for each, size in zip(second, first, strict=True)], axis=0)
    ratios = [coarse / np.maximum(fine, np.finfo(float).tiny) for coarse, fine in pairwise(second)]
    kinks = large & np.all([(RATIOS[0] < each) & (each < RATIOS[1]) for each in ratios], axis=0)
    return int(np.argmax(np.where(kinks, second[0], 0.0))) if kinks.any() else None
