"""Where the nodes of a cable belong: close where the curvature of a run jumps from element to element.

Cubic elements err in energy by about the integral of h^4 (d2 kappa/ds2)^2 ds, h the length of the element at s, and the
jump of the curvature kappa at a node is about h^2 of that second derivative. For a number of elements the integral is
least where h ~ density^-1, with a density ~ (jump/h^2)^(2/5).
"""

from __future__ import annotations

import numpy as np

from ..kernels.libraries import kernels_of
from ..parts.cable import Cable
from ..parts.scene_data import SceneData
from .motion import second_derivative
from .remeshing import node_places

ORDER = 4
"""Power of the elements' length in the energy of what they leave out."""

LEAST = 0.02
"""Of its mean: the density nowhere falls below, lest elements be far longer than what a later instant asks for."""

GROWTH = 2.0
"""By which neighbours differ at most, in length."""


def curvature_jumps(cable: Cable, nodal_vectors: np.ndarray) -> np.ndarray:
    """Return (elements - 1,): the largest jump of the curvature over time at each inner node, 1/m.

    nodal_vectors: (time, nodes, vectors, 3).
    """
    kernel, mesh = getattr(kernels_of(cable.library), f"{cable.element}_on_axis"), cable.mesh
    e = np.concatenate([nodal_vectors[:, :-1], nodal_vectors[:, 1:]], axis=2)
    ends = np.empty((2, len(e), cable.elements, 3))
    for k in range(cable.elements):
        length = mesh.length(k)
        for side, x in enumerate((0.0, length)):
            r_x = np.einsum("k,tkd->td", kernel(length, x)[1], e[:, k])
            r_xx = np.einsum("k,tkd->td", second_derivative(kernel, length, x), e[:, k])
            ends[side, :, k] = np.cross(r_x, r_xx) / np.sum(r_x * r_x, axis=-1, keepdims=True)
    jumps = ends[0, :, 1:] - ends[1, :, :-1]
    return np.linalg.norm(jumps - (jumps[:1] if cable.is_curved else 0.0), axis=-1).max(axis=0, initial=0.0)


def density(cable: Cable, nodal_vectors: np.ndarray) -> np.ndarray:
    """Return (elements,): how densely each element should be divided, over the mean along the cable.

    nodal_vectors: (time, nodes, vectors, 3). Uniform where no curvature jumps.
    """
    lengths = np.broadcast_to(cable.mesh.lengths, cable.elements)
    jumps = curvature_jumps(cable, nodal_vectors) if cable.elements > 1 else np.zeros(1)
    beside = np.maximum(np.append(jumps[0], jumps), np.append(jumps, jumps[-1]))
    found = (beside / lengths**2) ** (2 / (ORDER + 1))
    mean = float(found @ lengths) / cable.length
    found = np.maximum(found / mean, LEAST) if mean > 0 else np.ones(cable.elements)
    for k in range(1, cable.elements):  # a coarse element beside a fine one may hide a layer's end
        found[k] = max(found[k], found[k - 1] / GROWTH)
    for k in reversed(range(cable.elements - 1)):
        found[k] = max(found[k], found[k + 1] / GROWTH)
    return found / (float(found @ lengths) / cable.length)


def saving(cable: Cable, nodal_vectors: np.ndarray) -> float:
    """Return about how many elements are needed with graded lengths, over those with equal ones, at equal error."""
    lengths = np.broadcast_to(cable.mesh.lengths, cable.elements) / cable.length
    wanted = density(cable, nodal_vectors)
    return float(wanted ** (ORDER + 1) @ lengths) ** (-1 / ORDER)


def graded(scene: SceneData, cable: Cable, nodal_vectors: np.ndarray, elements: int) -> tuple[float, ...]:
    """Return the arc-lengths in m of the nodes of about so many elements, as close as a run's `density` has it.

    There are nodes at supports, ties, point loads and joints. nodal_vectors: (time, nodes, vectors, 3).
    """
    lengths = np.broadcast_to(cable.mesh.lengths, cable.elements)
    needed = np.append(0.0, np.cumsum(density(cable, nodal_vectors) * lengths))
    places = np.unique([0.0, cable.length, *node_places(scene, cable)])
    places = places[np.append(True, np.diff(places) > 1e-6 * cable.length)]
    places[-1] = cable.length
    at = np.interp(places, cable.node_s, needed) / needed[-1]
    nodes = [0.0]
    for k in range(len(places) - 1):
        parts = max(1, round(elements * float(at[k + 1] - at[k])))
        inner = np.interp(np.linspace(at[k], at[k + 1], parts + 1)[1:-1] * needed[-1], needed, cable.node_s)
        nodes += [*inner.tolist(), float(places[k + 1])]
    return tuple(nodes)
