"""The root of verification of spans: points of the material along the motion, and quadrature over them, at 50 digits.

A material point S stays at (S - s1)/l of an element whose ends and nodal vectors move. Its velocity is a difference of
its places just after and before, with the shape functions of verify/references/element.py at the length that the
element has then; no rate is expanded in shape functions.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np

from ...spec import Element
from . import cable
from .element import Shape, gauss

mp = mpmath.mp
STEP = mp.mpf(10) ** -16
"""In time: a central difference at 50 digits is good to 30."""


def place(element: Element, s: Any, xi: Any, t: Any, order: int = 0) -> np.ndarray:
    """Return the place at the time t of the material point that is at xi at time 0, or a derivative by S there."""
    now = s["l"].item()
    l = now + t * (s["s_rate"][1] - s["s_rate"][0])
    along = xi * now - t * s["s_rate"][0]
    return Shape(element, l)((along, 0, 0), (order, 0, 0)).dot(s["e"] + t * s["v"])


def rate(path: Callable[[Any], np.ndarray]) -> np.ndarray:
    """Return the derivative in time of a path."""
    return np.asarray((path(STEP) - path(-STEP)) / (2 * STEP))


def velocity(element: Element, s: Any, xi: Any, order: int = 0) -> np.ndarray:
    """Return the velocity of a material point, or the rate of a derivative by S there."""
    return rate(lambda t: place(element, s, xi, t, order))


def kinetic_energy(element: Element, s: Any) -> Any:
    """Return rho/2 times the integral of the squared velocity over the material."""
    return sum(weight * v.dot(v) for weight, _, v in _points(element, s)) * s["rho"].item() / 2


def gravity(element: Element, s: Any) -> Any:
    """Return the energy of gravity, by quadrature over the material."""
    return -s["rho"].item() * sum(weight * s["g"].dot(r) for weight, r, _ in _points(element, s))


def _points(element: Element, s: Any) -> list[tuple[Any, np.ndarray, np.ndarray]]:
    """Return weight, place and velocity at points enough for the squared velocity."""
    half = s["l"].item() / 2
    places = [((1 + t) / 2, weight * half) for t, weight in gauss(element.n_vectors)]
    return [(weight, place(element, s, xi, mp.mpf(0)), velocity(element, s, xi)) for xi, weight in places]


def dissipation(element: Element, law: str, s: Any) -> Any:
    """Return the dissipated power of the law, from rates at material points: those of nodal vectors are the rates of
    place and slope of the material points that are at the nodes.
    """
    orders = [name.count("x") for name in element.nodal_vectors]
    v = [velocity(element, s, mp.mpf(int(ratio.p)) / int(ratio.q), order)
         for ratio in element.node_ratios for order in orders]
    return cable.dissipation(element, law, s | {"v": np.array(v)})
