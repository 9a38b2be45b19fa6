"""Samples of straight parts of ropes without mass in space."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import Numbers, State
from .shapes import rotation


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a part between two grooves in any planes, not far from those that it leaves tangentially."""
    size = random.uniform(2, 3)
    direction = random.normal(size=3)
    return {"d": size * direction / np.linalg.norm(direction), "angle": random.uniform(-3, 3, 2),
            "reach": random.choice([-1, 1], 2) * random.uniform(0.3, 0.6, 2),
            "R": random.choice([-1, 1], 2) * random.uniform(0.3, 0.6, 2),
            "aside": random.uniform(-0.3, 0.3, 2), "one": rotation(random, 3), "other": rotation(random, 3),
            "inertia": random.uniform(0.1, 1), "axis": rotation(random, 3)[:, 2], "omega": random.normal(size=3),
            "own": random.normal(), "acc": random.normal(), "z_rate": random.normal(size=4),
            "p_rate": random.normal(size=9)}
