"""Samples of the frame of two vectors."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.frame import TURNS
from ..numbers import Numbers, State


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return two vectors with their first and second rates, and a moment."""
    names = ("a", "b", "a_rate", "b_rate", "a_second", "b_second")
    found = {name: random.normal(size=family.dim) for name in names}
    return found | {"m": random.normal(size=TURNS[family.dim])}
