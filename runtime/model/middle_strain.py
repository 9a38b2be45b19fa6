"""Slopes and stretches of centrelines, and the axial strain in the middle of elements, which shows slackness."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .model import CableModel

Rule = tuple[Sequence[float], Sequence[float]]
"""Of quadrature over an element: parts of its length, and weights, whose sum is 1."""


def slopes(cable: CableModel, part: float) -> np.ndarray:
    """Return (1 or elements, vectors): shape functions of the slope at a fraction of the element's length."""
    lengths = cable.mesh.lengths
    return np.asarray(cable.kernel("on_axis").rows(len(lengths), lengths, part * lengths)[1])


def gauss_rule(points: int) -> Rule:
    """Return the rule of Gauss with this number of points."""
    at, weights = np.polynomial.legendre.leggauss(points)
    return (0.5 * (1 + at)).tolist(), (0.5 * weights).tolist()


def stretches(cable: CableModel, first: np.ndarray, last: np.ndarray, element: np.ndarray,
              rule: Rule) -> np.ndarray:
    """Return (..., n): lengths of the centrelines of elements (n,) over their undeformed lengths.

    first, last: the vectors of their nodes, (..., n, vectors, dim); rule: of quadrature.
    """
    e = np.concatenate([first, last], axis=-2)
    found = np.zeros(e.shape[:-2])
    for part, weight in zip(*rule, strict=True):
        N = np.broadcast_to(slopes(cable, part), (cable.n_elements, e.shape[-2]))[element]
        found += weight * np.linalg.norm(np.einsum("nk,...nkd->...nd", N, e), axis=-1)
    return found


def middle_strain(cable: CableModel, nodal_vectors: np.ndarray) -> np.ndarray:
    """Return (T, elements): the axial strain in the middle of each element.

    nodal_vectors: (T, nodes, vectors, 2 or 3).
    """
    return strain_at(cable, nodal_vectors, 0.5)


def strain_at(cable: CableModel, nodal_vectors: np.ndarray, part: float) -> np.ndarray:
    """Return (T, elements): the axial strain at a fraction of the length of each element."""
    return np.asarray(np.linalg.norm(slope_at(cable, nodal_vectors, slopes(cable, part)), axis=-1) - 1.0)


def slope_at(cable: CableModel, nodal_vectors: np.ndarray, shapes: np.ndarray) -> np.ndarray:
    """Return (T, elements, dim): the sums of the vectors of each element's nodes, weighted as `slopes` returns."""
    vectors = cable.shape[1]
    N = np.broadcast_to(shapes, (cable.n_elements, 2 * vectors))
    return np.asarray(np.einsum("ek,tekd->ted", N[:, :vectors], nodal_vectors[:, :-1])
                      + np.einsum("ek,tekd->ted", N[:, vectors:], nodal_vectors[:, 1:]))
