"""Samples of an element's kernels, and of all kernels that take an element."""

from __future__ import annotations

import numpy as np
import sympy as sp

from ...codegen.family import ElementFamily
from ...spec import Element, x
from ..numbers import Numbers, State
from .shapes import HEIGHT, LENGTH, WIDTH, reference, rotation, section
from .step import following


def sample(family: ElementFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a bent element with accelerations a, its mass matrix m, loads c and M."""
    element = family.element
    state = element_state(element, random)
    del state["e0"]
    state |= following(family, state, random.spawn(1)[0])
    state["f"] = random.normal(size=element.dim)
    state["a"] = random.normal(size=(element.n_vectors, element.dim))
    state["m"] = exact("mass", exact.state(state))["m"].astype(float)
    return state | loads(element, random)


def at_rest(family: ElementFamily, exact: Numbers, first: State) -> State:
    """Return the first sample, straight and undeformed."""
    return first | straight(family.element)


def straight(element: Element) -> State:
    """Return the nodal vectors e of the straight reference, and its middle x."""
    return {"e": reference(element, LENGTH), "x": np.float64(LENGTH / 2)}


def element_state(element: Element, random: np.random.Generator) -> State:
    """Return a bent, stretched, sheared and turned element with its rates, and the data of the section and the law."""
    dim, n = element.dim, element.n_vectors
    mild = 3 / max(int(sp.degree(b, x)) for b in element.basis)  # curvatures of the same size for any degree
    e = reference(element, LENGTH) @ rotation(random, dim).T
    per_node = len(element.nodal_vectors)
    for k in range(len(element.nodes)):
        e[k * per_node : (k + 1) * per_node] @= rotation(random, dim, angle=0.4 * mild).T
    e += random.normal(size=(n, dim)) * 0.15 * mild**2
    e[element.is_position] += random.normal(size=dim)
    of_shape, = random.spawn(1)  # its own stream: the other samples are the same with and without
    e0 = reference(element, LENGTH) @ rotation(of_shape, dim).T
    e0 += of_shape.normal(size=(n, dim)) * 0.1 * mild**2
    return {
        "l": np.float64(LENGTH), "rectangle": np.array([HEIGHT, WIDTH]), "section": section(), "e": e, "e0": e0,
        "v": random.normal(size=(n, dim)), "vdot": random.normal(size=(n, dim)),
        "x": np.float64(LENGTH * random.uniform(0.2, 0.8)), "density": np.float64(2.9), "g": random.normal(size=dim),
        "tau": np.float64(0.37), "rate": np.float64(2.3),
        "at": np.array([0.3 * LENGTH, 0.4 * HEIGHT, -0.3 * WIDTH]),
    }


def loads(element: Element, random: np.random.Generator) -> State:
    """Return the components of a follower force and of a moment on the element."""
    local = element.dim if element.dim == 2 or element.director else 1
    return {"c": random.normal(size=local), "M": random.normal(size=1 if element.dim == 2 else 3)}
