"""Samples of spans of ropes."""

from __future__ import annotations

import numpy as np

from ...codegen.family import ElementFamily
from ...laws import law_traits
from ..numbers import Numbers, State
from .element import element_state, straight
from .law import section_stiffness
from .step import following


def sample(family: ElementFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a bent element, rates and accelerations of its nodal vectors and of both ends, and a material point."""
    element = family.element
    state = element_state(element, random)
    del state["e0"]
    state |= following(family, state, random.spawn(1)[0])
    assert family.law is not None
    state |= section_stiffness(law_traits(family.law), element.dim, state["section"], random)
    rho = state["density"] * np.prod(state["rectangle"])
    return state | {"A": state["S"], "rho": np.float64(rho), "a": random.normal(size=state["v"].shape),
                    "s_rate": random.normal(size=2), "s_acc": random.normal(size=2),
                    "xi": np.float64(random.uniform(0.2, 0.8))}


def at_rest(family: ElementFamily, exact: Numbers, first: State) -> State:
    """Return the first sample, straight and undeformed."""
    return first | straight(family.element)
