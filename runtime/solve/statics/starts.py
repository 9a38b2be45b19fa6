"""States from which the search for rest begins, where supports have moved, and on another mesh."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...model.model import CableModel, Model
from ...model.unknowns import as_supports_leave

COORDINATE_ROUNDING = 1e-13
"""Relative difference, due to rounding, of a coordinate from the value that a support prescribes."""


def with_moved_supports(model: Model, begin: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the state as drawn with each cable's free nodes moved, too: linearly along the cable between those that
    motions prescribe.

    A prescribed node that passes its free neighbour would turn the element between them back on itself, where Newton's
    method may leave it.
    """
    if not model.motions or not model.cables:
        return begin
    q = begin["q"].copy()
    free = model.unknown_of_dof[: model.cables[-1].coordinates.stop] != -1
    for cable in model.cables:
        s, r = cable.mesh.node_s, cable.positions(q)
        fixed, moved = ~cable.positions(free), r - cable.positions(model.q)
        for axis in range(cable.shape[2]):
            at = fixed[:, axis]
            if at.any():
                r[~at, axis] += np.interp(s, s[at], moved[at, axis])[~at]
    return begin | {"q": q}


def fitted(kept: dict[str, np.ndarray], model: Model) -> dict[str, np.ndarray]:
    """Return a static state with the supports of a model, which may be drawn elsewhere: fixed coordinates are as drawn,
    tied ones follow, and free ones stay to the bit.
    """
    q = kept["q"].copy()
    for rope in model.ropes:
        q[rope.held] = model.q[rope.held]
    q[model.driven] = model.q[model.driven]
    if not model.cables:
        return kept | {"q": q}
    own = slice(0, model.cables[-1].coordinates.stop)
    drawn = model.q[own]
    change = q[own] - drawn
    left = as_supports_leave(change, model.unknown_of_dof[own], model.combinations)
    q[own] = np.where(np.abs(left - change) > COORDINATE_ROUNDING * (1 + np.abs(q[own])), drawn + left, q[own])
    return kept | {"q": q}


def on_mesh(kept: Mapping[str, np.ndarray], was: Model, model: Model, drawn: Mapping[str, np.ndarray]
            ) -> dict[str, np.ndarray]:
    """Return a static state on the meshes of another model of the same parts; itself on the same meshes.

    kept: of `was`; drawn: the state of the other model, which keeps the numbers of its elements, and the forces of
    contacts and sheaves where their number differs.
    """
    fitting = {name: values for name, values in kept.items() if values.shape == np.shape(drawn.get(name, np.zeros(0)))}
    pairs = list(zip(was.cables, model.cables, strict=True))
    is_same = all(np.array_equal(one.mesh.node_s, other.mesh.node_s) for one, other in pairs)
    if is_same and "q" in fitting:
        return dict(drawn) | fitting
    q = drawn["q"].copy()
    for one, other in pairs:
        vectors = one.nodal(kept["q"])
        q[other.coordinates] = (vectors if is_same else _nodal_vectors(vectors, one, other)).ravel()
    first = [each.cables[-1].coordinates.stop if each.cables else 0 for each in (was, model)]
    q[first[1] : model.driven.start] = kept["q"][first[0] : was.driven.start]
    if len(model.driven) == len(was.driven):
        q[model.driven] = kept["q"][was.driven]
    q[model.driven.stop :] = kept["q"][was.driven.stop :]
    return dict(drawn) | fitting | {"q": q}


def _nodal_vectors(vectors: np.ndarray, was: CableModel, cable: CableModel) -> np.ndarray:
    """Return (nodes, vectors, dim): nodal vectors on another mesh, position and slope by the shape functions, others
    linear between nodes.
    """
    kernel, s = was.kernel("on_axis"), cable.mesh.node_s
    found = np.stack([[np.interp(s, was.mesh.node_s, vectors[:, k, i]) for i in range(vectors.shape[2])]
                      for k in range(vectors.shape[1])]).transpose(2, 0, 1)
    for node, (element, x) in enumerate(zip(*was.mesh.place(s), strict=True)):
        shapes = kernel(was.mesh.length(element), min(x, was.mesh.length(element)))
        at = int(was.mesh.first_node(element))
        of_element = np.concatenate([vectors[at], vectors[at + 1]])
        for k, name in enumerate(was.vectors):
            if name in ("r", "r_x"):
                found[node, k] = shapes[("r", "r_x").index(name)] @ of_element
    return found
