"""What elements leave of the dent that a point force makes in a wire: a compliance in series with what presses there.

A point force F bends a wire under the tension T by an angle F/T over a length of l = sqrt(EI/T), a tenth of a metre.
Cubic elements of some h >> l bend over as much as their own length, and give way less: by about 0.03 h/T. Beside a
dropper of 1e5 N/m or a collector of 5e4 N/m that counts. What is missing is the difference of two functions of Green,
that of the wire, in closed form, and that of its elements. It decays within some elements, so that it is static below
the frequencies that the elements resolve, and the force on the wire alone decides it: a spring in series.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.polynomial.polynomial import polyder, polyval

SAMPLES = 8
"""Of an element, over which the mean is taken."""

ENDS = np.array([[polyval(end, polyder(np.eye(4), order)) for order in (0, 1)] for end in (0.0, 1.0)]).reshape(4, 4)
"""Position and slope at both ends, 0 and 1, of the powers 0 to 3."""
SHAPES = np.linalg.inv(ENDS)
"""(4, 4): by power, the cubics of which one of these is one, and the others are zero."""


def missing_compliance(tension: float, bending: float, nodes: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return (at,): by how much less than a wire its elements give way to a point force where it acts, in m/N.

    tension T in N; bending EI in N m²; nodes: places of the nodes of the wire, which is held at its ends and turns
    freely there, in m; at: places of the forces, in m. The elements are cubic, in position and slope.
    """
    start, span = nodes[0], nodes[-1] - nodes[0]
    x, length = at - start, float(np.sqrt(bending / tension))
    dents = -np.expm1(-2 * x / length) * np.expm1(-2 * (span - x) / length) / np.expm1(-2 * span / length)
    exact = (x * (span - x) / span - length / 2 * dents) / tension
    forces = _shapes(nodes, at)
    return exact - np.einsum("ij,ji->i", forces, np.linalg.solve(_stiffness(tension, bending, nodes), forces.T))


def mean_missing_compliance(tension: float, bending: float, nodes: np.ndarray) -> float:
    """Return the mean of `missing_compliance` for a force that goes along the middle half of the wire, in m/N."""
    places = np.concatenate([a + (b - a) * (np.arange(SAMPLES) + 0.5) / SAMPLES for a, b in pairwise(nodes)])
    weights = np.repeat(np.diff(nodes), SAMPLES)
    middle = np.abs(places - (nodes[0] + nodes[-1]) / 2) < (nodes[-1] - nodes[0]) / 4
    return float(np.average(missing_compliance(tension, bending, nodes, places[middle]), weights=weights[middle]))


def _stiffness(tension: float, bending: float, nodes: np.ndarray) -> np.ndarray:
    """Return the stiffness matrix of position and slope at all nodes; both ends do not move."""
    size = 2 * len(nodes)
    total = np.zeros((size, size))
    points, weights = leggauss(3)  # exact for products of slopes, of the fourth degree
    points, weights = (1 + points) / 2, weights / 2
    slopes, bends = (polyval(points, polyder(SHAPES, order)) for order in (1, 2))
    string, beam = (np.einsum("g,ig,jg->ij", weights, each, each) for each in (slopes, bends))
    for k, h in enumerate(np.diff(nodes)):
        scale = np.outer(_units(h), _units(h))
        total[2 * k:2 * k + 4, 2 * k:2 * k + 4] += scale * (tension / h * string + bending / h**3 * beam)
    for end in (0, size - 2):
        total[end], total[:, end], total[end, end] = 0.0, 0.0, 1.0
    return total


def _shapes(nodes: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return (at, 2 nodes): the cubic shape functions at these places; none of both ends' positions."""
    shapes = np.zeros((len(at), 2 * len(nodes)))
    element = np.clip(np.searchsorted(nodes, at, "right") - 1, 0, len(nodes) - 2)
    h = np.diff(nodes)[element]
    values = polyval((at - nodes[element]) / h, SHAPES) * _units(h)
    for j, value in enumerate(values):
        shapes[np.arange(len(at)), 2 * element + j] = value
    shapes[:, [0, -2]] = 0.0
    return shapes


def _units(h: float | np.ndarray) -> np.ndarray:
    """Return (4,), or (4, n) of h (n,), in m: by what shape functions of the length 1 are multiplied for the length h.
    """
    return np.array([np.ones_like(h), h, np.ones_like(h), h])
