"""Samples of the slide of a rider on an element."""

from __future__ import annotations

import numpy as np

from ...codegen.family import SlideFamily
from ...couplings.slide import N_ENDS
from ..numbers import Numbers, State
from .body import rider_state, unturned
from .element import element_state, straight
from .shapes import director, on_axis
from .step import following

FLOW = 0.3
"""Size of the rates of material coordinates, in a sample in which those of nodes are of size 1."""


def sample(family: SlideFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a bent element, a rider not far from its point x, and a direction off the tangent there."""
    state = element_state(family.element, random)
    del state["e0"]
    state |= rider_state(family, on_axis(family.element, state), random)
    state |= following(family, state, random.spawn(1)[0])
    state["director"] = director(family.element, state, random)
    state["f"] = random.normal(size=family.element.dim)
    if family.flows:  # rates and accelerations of s1, s2, slower than the nodes, so that none cancels the others
        state |= {name: np.concatenate([state[name].ravel(), FLOW * random.normal(size=N_ENDS)])
                  for name in ("v", "vdot")}
    return state


def at_rest(family: SlideFamily, exact: Numbers, first: State) -> State:
    """Return the first sample, straight, undeformed, on the joint at zero rotation: roots and inverses have their easy
    limits there.
    """
    return first | straight(family.element) | unturned(family)
