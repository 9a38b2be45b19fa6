"""Slopes of centrelines, and the axial strain in the middle of elements, by which they are slack or taut."""

from __future__ import annotations

import numpy as np

from .model import CableModel


def slopes(cable: CableModel, part: float) -> np.ndarray:
    """Return (1 or elements, vectors): what the vectors of each element's nodes have in its slope at a part of its
    length, one row where elements are equal.
    """
    lengths = cable.mesh.lengths
    return cable.kernel("on_axis").rows(len(lengths), lengths, part * lengths)[1]


def middle_strain(cable: CableModel, nodal_vectors: np.ndarray) -> np.ndarray:
    """Return (T, elements): by how much more than its length at rest each element is long in its middle, over that.

    nodal_vectors: (T, nodes, vectors, 2 or 3).
    """
    N, vectors = slopes(cable, 0.5), cable.shape[1]
    slope = (np.einsum("ek,tekd->ted", np.broadcast_to(N[:, :vectors], (cable.n_elements, vectors)),
                       nodal_vectors[:, :-1])
             + np.einsum("ek,tekd->ted", np.broadcast_to(N[:, vectors:], (cable.n_elements, vectors)),
                         nodal_vectors[:, 1:]))
    return np.linalg.norm(slope, axis=-1) - 1.0
