"""The compliance of a wire at a point force that its elements lack: a spring in series with the force.

A point force F bends a wire under the tension T by an angle F/T over a length of l = sqrt(EI/T), a tenth of a metre.
Cubic elements of length h >> l bend over their own length and are stiffer: they lack a compliance of about 0.03 h/T,
which is not small beside a dropper of 1e5 N/m or a collector of 5e4 N/m. The missing compliance is the difference of
two Green's functions, that of the wire, in closed form, and that of its elements. It decays within some elements. So it
is static below the frequencies that the elements resolve and depends on the force alone.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from ..base.quadrature import gauss
from ..kernels.libraries import kernels_of

SAMPLES = 8
"""Samples of an element for the mean."""

CUBIC = "cable8p"
"""The element with the shape functions: position and slope at two nodes."""


def missing_compliance(tension: float, bending: float, nodes: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return (at,): the compliance of a wire at a point force that its elements lack, in m/N.

    tension T in N; bending EI in N m²; nodes: places of the nodes of the wire, which is held at its ends and turns
    freely there, in m; at: places of the forces, in m. The elements are cubic, in position and slope.
    """
    start, span = nodes[0], nodes[-1] - nodes[0]
    x, length = at - start, float(np.sqrt(bending / tension))
    dents = -np.expm1(-2 * x / length) * np.expm1(-2 * (span - x) / length) / np.expm1(-2 * span / length)
    exact = (x * (span - x) / span - length / 2 * dents) / tension
    forces = _shapes(nodes, at)
    return np.asarray(exact - np.einsum("ij,ji->i", forces,
                                        np.linalg.solve(_stiffness(tension, bending, nodes), forces.T)))


def mean_missing_compliance(tension: float, bending: float, nodes: np.ndarray) -> float:
    """Return the mean of `missing_compliance` for a force that moves along the middle half of the wire, in m/N."""
    places = np.concatenate([a + (b - a) * (np.arange(SAMPLES) + 0.5) / SAMPLES for a, b in pairwise(nodes)])
    weights = np.repeat(np.diff(nodes), SAMPLES)
    middle = np.abs(places - (nodes[0] + nodes[-1]) / 2) < (nodes[-1] - nodes[0]) / 4
    return float(np.average(missing_compliance(tension, bending, nodes, places[middle]), weights=weights[middle]))


def _stiffness(tension: float, bending: float, nodes: np.ndarray) -> np.ndarray:
    """Return the stiffness matrix of position and slope at all nodes; both ends are fixed."""
    size = 2 * len(nodes)
    total = np.zeros((size, size))
    places, weights = gauss(3)  # exact for products of slopes, of the fourth degree
    for k, h in enumerate(np.diff(nodes)):
        slopes, bends = np.moveaxis(_kernel("slopes").rows(3, h, h * (1 + places) / 2)[:, 0, :2], 1, 0)
        string, beam = (np.einsum("g,gi,gj->ij", h * weights / 2, each, each) for each in (slopes, bends))
        total[2 * k:2 * k + 4, 2 * k:2 * k + 4] += tension * string + bending * beam
    for end in (0, size - 2):
        total[end], total[:, end], total[end, end] = 0.0, 0.0, 1.0
    return total


def _shapes(nodes: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return (at, 2 nodes): the cubic shape functions at these places; none of both ends' positions."""
    shapes = np.zeros((len(at), 2 * len(nodes)))
    if not len(at):
        return shapes
    element = np.clip(np.searchsorted(nodes, at, "right") - 1, 0, len(nodes) - 2)
    values = _kernel("on_axis").rows(len(at), np.diff(nodes)[element], at - nodes[element])[0]
    for j in range(4):
        shapes[np.arange(len(at)), 2 * element + j] = values[:, j]
    shapes[:, [0, -2]] = 0.0
    return shapes


def _kernel(name: str) -> Any:
    """Return a kernel of the cubic element."""
    return getattr(kernels_of(None), f"{CUBIC}_{name}")
