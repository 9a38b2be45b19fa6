"""The end of a step that begins at a sample."""

from __future__ import annotations

import numpy as np

from ...codegen.family import Family
from ..motion import RIDERS
from ..numbers import State
from .shapes import LENGTH, rotation


def following(family: Family, state: State, random: np.random.Generator) -> State:
    """Return the end of a step, far enough from its start to tell differences from derivatives."""
    found = {}
    if family.element:
        e = state["e"] @ rotation(random, family.element.dim, angle=0.3).T
        found["e_next"] = e + 0.05 * random.normal(size=e.shape)
        found["x_next"] = np.float64(state["x"] + 0.1 * LENGTH)
        found["l_next"] = np.float64(1.07 * state["l"]) if getattr(family, "flows", False) else state["l"]
    if family.rider:
        rider = RIDERS[family.rider]
        found["b_next"] = rider.moved(np, state["b"], 0.2 * random.normal(size=rider.n_velocity))
    return found
