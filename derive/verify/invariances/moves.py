"""Invariances of the moves of bodies."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..motion import Motions
from ..numbers import EPS, Numbers, State
from .measures import Invariance


def moves(rider: Motions, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that moves keep the size of the attitude, also where the formulas of small and large turns meet."""
    dim = rider.dim
    for kernel, output in (("move", "b_next"), ("cayley_move", "b_next"), ("halfway", "b_half")):
        size = np.linalg.norm(k(kernel, s)[output][dim:])
        yield "attitudes keep their size", abs(float(size) - 1), 4 * EPS
    direction = np.eye(rider.n_velocity)[dim] + 0.5 * np.eye(rider.n_velocity)[-1]
    for kernel, output in (("move", "b_next"), ("move_tangent", "T")):
        for length in (1.0, 2.0):  # series below one of these, quotients above
            step = length / np.linalg.norm(direction) * direction
            below, above = (k(kernel, s, step=(1 + sign * 1e-15) * step)[output] for sign in (-1, 1))
            yield "no jump from series to quotients", float(np.abs(above - below).max()), 32 * EPS
