"""Samples of springs."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.spring import SPRINGS
from ..numbers import Numbers, State


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a spring, the gap between its points at both ends of a step, and the gap's rate."""
    dim = family.dim
    gap = random.normal(size=dim)
    return {"stiffness": np.float64(5.3), "damping": np.float64(0.7),
            "rest_length": np.float64(0.4 * np.linalg.norm(gap) * SPRINGS[family.name].has_length),
            "h": np.float64(0.13), "gap": gap, "gap_rate": random.normal(size=dim),
            "gap_next": gap + 0.3 * random.normal(size=dim)}
