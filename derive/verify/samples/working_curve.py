"""Samples of working curves of a rope."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import Numbers, State
from .law import segments


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a stretched point that is below its highest strain, with tables of first loading and of the shape."""
    a = random.normal(size=family.dim)
    return {
        "a": a,
        "e": np.float64(0.21),
        "highest": np.float64(0.34),
        "permanent": np.float64(0.3),
        "first": np.array(segments(50.0, random)),
        "shape": np.array(segments(1.1, random, end=1.0)),
        "n": random.normal(),
        "D": random.normal(),
    }
