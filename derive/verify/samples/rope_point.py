"""Samples of material points of ropes."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.rope_point import ELEMENT
from ...elements import ELEMENTS
from ..numbers import Numbers, State
from .element import element_state
from .shapes import rotation


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a bent element within a span, rates of its nodal vectors and of both ends of the span, and a force."""
    spec = ELEMENTS[ELEMENT[family.dim]]
    element = element_state(spec, random)
    share = np.array([random.uniform(0.1, 0.3), random.uniform(0.6, 0.9)])
    length = float(element["l"]) / (share[1] - share[0])  # of the span
    start = random.normal()
    step = random.spawn(1)[0]  # the other numbers stay as they are without it
    S = start + length * (share[0] + random.uniform(0.2, 0.8) * (share[1] - share[0]))
    e_next = element["e"] @ rotation(step, family.dim, angle=0.3).T + 0.05 * step.normal(size=element["e"].shape)
    return {"e_next": e_next, "s_next": start + np.array([0, length]) + 0.03 * length * step.normal(size=2),
            "e": element["e"], "v": random.normal(size=element["e"].shape), "s": np.array([start, start + length]),
            "s_rate": random.normal(size=2), "share": share, "S": np.float64(S), "f": random.normal(size=family.dim),
            "S_rate": np.float64(step.normal()), "g": step.normal(size=family.dim)}
