"""A state of rest on another mesh: where the search for equilibrium on that mesh begins."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...model.model import CableModel, Model


def carried(kept: Mapping[str, np.ndarray], was: Model, model: Model, drawn: Mapping[str, np.ndarray]) -> dict:
    """Return a static state on the meshes of another model of the same parts; on the same meshes that itself.

    kept: of `was`; drawn: the state that the other model has, of which stays what belongs to elements, and forces of
    contacts where the other model has more or fewer of these.
    """
    fitting = {name: values for name, values in kept.items() if values.shape == np.shape(drawn[name])}
    pairs = list(zip(was.cables, model.cables, strict=True))
    if all(np.array_equal(one.mesh.node_s, other.mesh.node_s) for one, other in pairs):
        return dict(drawn) | fitting
    q = drawn["q"].copy()
    for one, other in pairs:
        q[other.coordinates] = _nodal_vectors(kept["q"][one.coordinates].reshape(one.shape), one, other).ravel()
    q[model.cables[-1].coordinates.stop:] = kept["q"][was.cables[-1].coordinates.stop:]  # of bodies
    return dict(drawn) | fitting | {"q": q}


def _nodal_vectors(vectors: np.ndarray, was: CableModel, cable: CableModel) -> np.ndarray:
    """Return (nodes, vectors, dim): position and slope of the centreline at the nodes of another mesh by the shape
    functions of its elements, what else nodes have linearly between them.

    vectors: (nodes, vectors, dim) on the first mesh.
    """
    kernel, s = was.kernel("on_axis"), cable.mesh.node_s
    found = np.stack([[np.interp(s, was.mesh.node_s, vectors[:, k, i]) for i in range(vectors.shape[2])]
                      for k in range(vectors.shape[1])]).transpose(2, 0, 1)
    for node, (element, x) in enumerate(zip(*was.mesh.place(s), strict=True)):
        shapes = kernel(was.mesh.length(element), min(x, was.mesh.length(element)))
        of_element = np.concatenate([vectors[element], vectors[element + 1]])
        for k, name in enumerate(was.vectors):
            if name in ("r", "r_x"):
                found[node, k] = shapes[("r", "r_x").index(name)] @ of_element
    return found
