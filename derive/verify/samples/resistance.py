"""Samples of friction and buffers."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import Numbers, State


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return the tangent, the speed and the force of a slide, with friction and a buffer."""
    found = {name: random.normal(size=family.dim) for name in ("t", "u", "f")}
    return found | {"friction": np.array([0.4, 0.7, 0.3, 0.0, 1e-30]), "buffer": np.array([5.0, 0.6, 0.2, -1.0])}
