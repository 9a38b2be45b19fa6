"""Samples of spans of ropes."""

from __future__ import annotations

import numpy as np

from ...codegen.family import ElementFamily
from ...couplings import span_step
from ...laws import law_traits
from ...spec import Element
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
    change = random.normal(size=2) * state["l"] / 20
    state |= {"h": np.float64(0.1), "s_change": change, "l_next": state["l"] + change[1] - change[0],
              "e_change": state["e_next"] - state["e"], "P": random.normal(size=(span_step.POINTS, element.dim)),
              "U_m": random.uniform(1, 2, 2), "U_b": random.uniform(1, 2, 2)}
    state |= of_force(element, state, random.spawn(1)[0]) | of_energy(element, random.spawn(1)[0])
    return state | {
        "A": state["S"], "rho": np.float64(rho), "a": random.normal(size=state["v"].shape),
        "s_rate": random.normal(size=2), "s_acc": random.normal(size=2), "xi": np.float64(random.uniform(0.2, 0.8))}


def of_force(element: Element, state: State, random: np.random.Generator) -> State:
    """Return a force of a length with its derivatives, its weight, and a material point between the ends."""
    square = {name: random.normal(size=(element.dim, element.dim)) for name in ("F_r", "F_t", "F_v")}
    first = random.normal()
    stored = {"H": square["F_r"] + square["F_r"].T, "u": np.float64(random.normal())}
    return square | stored | {
        "F": random.normal(size=element.dim), "part": np.float64(random.uniform(0.2, 0.4)),
        "ends": np.array([first, first + float(state["l"])]),
        "at": np.float64(first + random.uniform(0.2, 0.8) * float(state["l"]))}


def of_energy(element: Element, random: np.random.Generator) -> State:
    """Return a kinetic energy of a length with its derivatives, at a point with a weight."""
    dim = element.dim
    half = random.normal(size=(3 * dim, 3 * dim))
    return {**{f"T_{key}": random.normal(size=dim) for key in "rtv"}, "rate": random.normal(size=dim),
            "T": np.float64(random.normal()), "second": half + half.T, "rate_by": random.normal(size=(dim, 6 * dim))}


def at_rest(family: ElementFamily, exact: Numbers, first: State) -> State:
    """Return the first sample, straight and undeformed."""
    return first | straight(family.element)
