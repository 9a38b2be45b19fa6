"""Samples of branches beside the law of a cable."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.branch import MEASURES
from ..numbers import Numbers, State


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a bent and stretched point that turns in the step, and a stress that depends on its measures."""
    dim, size = family.dim, MEASURES[family.dim]
    a, D = random.normal(size=dim), random.normal(size=(size, size))
    before = a + 0.3 * random.normal(size=dim)
    m, m_0, d_0 = random.normal(size=(3, size))
    return {
        "i_0": before / np.linalg.norm(before),
        "a": a,
        "b": random.normal(size=dim),
        "n": random.normal(size=size),
        "D": D + D.T,
        "m": m,
        "m_0": m_0,
        "d_0": d_0,
        "k": np.full(size, 3.0),
        "decay": 0.6,
        "share": 0.8,
        "limit": 0.7,
    }
