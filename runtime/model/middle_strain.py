"""Slopes and stretches of centrelines, and the axial strain in the middle of elements, which shows slackness."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ..base.quadrature import gauss
from ..engine import slope_lengths
from ..kernels.libraries import kernels_of
from .model import CableModel

Rule = tuple[Sequence[float], Sequence[float]]
"""Of quadrature over an element: parts of its length, and weights, whose sum is 1."""


def slopes(cable: CableModel, *parts: float) -> np.ndarray:
    """Return (parts, 1 or elements, vectors): shape functions of the slope at fractions of the element's length."""
    return _slopes(cable.element, cable.library, cable.mesh.lengths.tobytes(), parts)


@lru_cache(maxsize=64)
def _slopes(element: str, library: str | None, lengths: bytes, parts: tuple[float, ...]) -> np.ndarray:
    """Return `slopes`, once for all meshes of these lengths (1 or elements,), in m."""
    on_axis, h = getattr(kernels_of(library), f"{element}_on_axis"), np.frombuffer(lengths)
    return np.array([on_axis.rows(len(h), h, part * h)[1] for part in parts])


def gauss_rule(points: int) -> Rule:
    """Return the rule of Gauss with this number of points."""
    at, weights = gauss(points)
    return (0.5 * (1 + at)).tolist(), (0.5 * weights).tolist()


def stretches(cable: CableModel, first: np.ndarray, last: np.ndarray, element: np.ndarray,
              rule: Rule) -> np.ndarray:
    """Return (..., n): lengths of the centrelines of elements (n,) over their undeformed lengths.

    first, last: the vectors of their nodes, (..., n, vectors, dim); rule: of quadrature.
    """
    parts, weights = rule
    shapes = slopes(cable, *parts)
    in_rows = first.reshape(-1, *first.shape[-3:]), last.reshape(-1, *last.shape[-3:])
    lengths = slope_lengths(shapes if shapes.shape[1] == 1 else shapes[:, element], *in_rows)
    return np.asarray(np.dot(weights, lengths.reshape(len(parts), -1))).reshape(first.shape[:-2])


def middle_strain(cable: CableModel, nodal_vectors: np.ndarray) -> np.ndarray:
    """Return (T, elements): the axial strain in the middle of each element.

    nodal_vectors: (T, nodes, vectors, 2 or 3).
    """
    found: np.ndarray = strains_at(cable, nodal_vectors, (0.5,))[0]
    return found


def strains_at(cable: CableModel, nodal_vectors: np.ndarray, parts: Sequence[float]) -> np.ndarray:
    """Return (parts, T, elements): the axial strain at fractions of the length of each element."""
    return slope_lengths(slopes(cable, *parts), nodal_vectors[:, cable.mesh.first],
                         nodal_vectors[:, cable.mesh.last]) - 1.0


def slopes_at(cable: CableModel, nodal_vectors: np.ndarray, shapes: np.ndarray) -> np.ndarray:
    """Return (parts, T, elements, dim): the sums of the vectors of each element's nodes, weighted as `slopes` returns.

    Products of whole arrays take a third of the time of `numpy.einsum` for few elements.
    """
    mesh, vectors = cable.mesh, nodal_vectors.shape[-2]
    first, last = nodal_vectors[:, mesh.first], nodal_vectors[:, mesh.last]
    N, counted = shapes.reshape(len(shapes), 1, *shapes.shape[1:], 1), np.any(shapes, axis=(0, 1))
    ends = (sum(N[..., offset + k, :] * end[..., k, :] for k in range(vectors) if counted[offset + k])
            for offset, end in ((0, first), (vectors, last)))
    return np.asarray(sum(ends))
