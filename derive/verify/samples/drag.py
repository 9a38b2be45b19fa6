"""Samples of drag."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import Numbers, State


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return the slope of a cable, the velocity of the fluid past it, and coefficients along and across."""
    return {name: random.normal(size=family.dim) for name in ("t", "w")} | {
        "c": np.array([0.8, 0.3, 1e-30]), "c_point": np.array([0.7, 1e-30])}
