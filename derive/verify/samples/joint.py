"""Samples of joints."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.frame import TURNS
from ..motion import turned_axes
from ..numbers import Numbers, State


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return two frames in any attitude, not on the joint, with velocities, and the driven quantity."""
    dim, turns = family.dim, TURNS[family.dim]
    c = random.uniform(0.3, 1.2)
    step = random.spawn(1)[0]  # the other numbers stay as they are without it
    return {"gap_next": step.normal(size=dim), "gap": random.normal(size=dim),
            "A1": _attitude(random, dim), "A2": _attitude(random, dim),
            "c": np.array([c, np.cos(c), np.sin(c)]), "f": random.normal(size=family.facts["rows"]),
            "gap_rate": random.normal(size=dim), "c_rate": random.normal(size=2),
            "omega1": random.uniform(0.5, 1.5, turns), "omega2": -random.uniform(0.5, 1.5, turns)}


def _attitude(random: np.random.Generator, dim: int) -> np.ndarray:
    turn = random.normal(size=3)
    turn[: 3 - TURNS[dim]] = 0
    return turned_axes(np, turn[3 - TURNS[dim] :], np.eye(dim))
