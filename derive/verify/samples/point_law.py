"""Samples of forces between two points."""

from __future__ import annotations

import numpy as np

from ...codegen.family import PointLawFamily
from ..numbers import Numbers, State
from .shapes import rotation


def sample(family: PointLawFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return parameters of order one, the gap at both ends of a step, longer than they are, and the gap's rate."""
    dim = family.dim
    gap = 2.1 * rotation(random, dim)[0]
    return {"parameters": random.uniform(0.4, 1.6, len(family.point_law.parameters)), "h": np.float64(0.13),
            "gap": gap, "gap_rate": random.normal(size=dim), "gap_next": 1.3 * rotation(random, dim, angle=0.4) @ gap}


def undamped(family: PointLawFamily, parameters: np.ndarray) -> np.ndarray:
    """Return the parameters without the damper's."""
    return parameters * [int(name != family.point_law.damping) for name in family.point_law.parameters]


def damping(family: PointLawFamily, parameters: np.ndarray) -> object:
    """Return the damper's parameter, 0 where there is none."""
    names = list(family.point_law.parameters)
    return parameters[names.index(family.point_law.damping)] if family.point_law.damping else 0 * parameters[0]
