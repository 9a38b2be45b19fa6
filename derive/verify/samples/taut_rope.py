"""Samples of ropes without mass."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import Numbers, State


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a straight part between two circles, off the axes, and a stretched rope whose lengths change,
    alone and in a chain.
    """
    angle = np.pi / 4 * random.choice([1, 3, 5, 7]) + random.uniform(-0.3, 0.3)
    size, free = random.uniform(1.5, 2.5), random.uniform(1.5, 2.5)
    return {"d": size * np.array([np.cos(angle), np.sin(angle)]),
            "rise": np.float64(random.choice([-1, 1]) * random.uniform(0.3, 0.6)), "w": random.uniform(0.7, 1.4, 2),
            "EA": np.float64(random.uniform(3, 5)), "tau": np.float64(0.37),
            "past": free * np.array([1.0, random.uniform(1.1, 1.2)]), "L": np.float64(free * random.uniform(1.2, 1.4)),
            "lengths": free * np.array([random.uniform(1.2, 1.4), random.choice([-1, 1]) * random.uniform(0.1, 0.2)]),
            "L0": np.float64(free), "growth": np.float64(random.uniform(0.6, 1.0)),
            "rates": np.array([random.uniform(0.6, 1.0), -random.uniform(0.2, 0.5)]),
            "ratio": np.float64(random.uniform(1.5, 2.5)), "x": np.float64(random.uniform(0.1, 0.2)),
            "weights": random.uniform(0.7, 1.4, 2)}
