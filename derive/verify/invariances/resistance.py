"""Friction and buffers in cases known without derivation."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import EPS, Numbers, State
from .measures import Invariance


def resistance(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that friction acts against the motion with mu times the normal force, and the force of a buffer."""
    i = s["t"] / np.linalg.norm(s["t"])
    length, v = np.linalg.norm(s["t"]), i @ s["u"]
    N = np.linalg.norm(s["f"] - (s["f"] @ i) * i)
    none = np.zeros(4)
    for slip_direction in (1.0, -1.0):
        R = k("force", {**s, "friction": np.array([0.4, 0.0, 0.3, slip_direction, 1e-30]), "buffer": none})["R"][0]
        yield "friction with a direction is the coefficient's", abs(R + slip_direction * 0.4 * N * length), 64 * EPS
    fast = k("force", {**s, "friction": np.array([0.4, 0.0, 1e-12 * abs(v), 0.0, 1e-30]), "buffer": none})["R"][0]
    yield "fast friction has the direction of the motion", abs(fast + np.sign(v) * 0.4 * N * length), 64 * EPS
    slow = k("force", {**s, "friction": np.array([0.0, 0.7, 0.3, 0.0, 1e-30]), "buffer": none})["R"][0]
    yield "viscous friction goes with the speed", abs(slow + 0.7 * v * length), 64 * EPS
    at_rest = k("force", {**s, "u": 0 * i, "friction": np.array([0.4, 0.7, 0.3, 0.0, 1e-30])})["R"][0]
    yield "at rest there is the buffer's spring alone", abs(at_rest - 5.0 * 0.2), 64 * EPS
