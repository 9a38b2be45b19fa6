"""The axial strain in the middle of the elements of a cable, by which they are slack or taut."""

from __future__ import annotations

import numpy as np

from .model import CableModel


def middle_strain(cable: CableModel, nodal_vectors: np.ndarray) -> np.ndarray:
    """Return (T, elements): by how much more than its length at rest each element is long in its middle, over that.

    nodal_vectors: (T, nodes, vectors, 2 or 3).
    """
    lengths = [cable.mesh.length(element) for element in range(cable.n_elements)]
    slopes = np.array([cable.kernel("on_axis")(length, length / 2)[1] for length in lengths])
    e = np.concatenate([nodal_vectors[:, :-1], nodal_vectors[:, 1:]], axis=2)
    return np.linalg.norm(np.einsum("ek,tekd->ted", slopes, e), axis=-1) - 1.0
