"""The motion of a run, and other quantities, sampled at points that do not depend on its mesh."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np

from ..errors import SceneError, near
from ..kernels.libraries import kernels_of
from ..kernels.mesh import Mesh
from ..parts.cable import Cable
from ..parts.paths import COMPONENTS
from ..parts.scene_data import SceneData
from ..results.run import Run

STATIONS = 12
"""Equal parts of a cable, at whose ends its motion is compared: what differs between two meshes shows there."""

MOTION = "motion"
"""Name of what is compared where no quantity is named."""

OF_NODES = (".nodal_vectors", ".nodal_velocity", ".position", ".velocity")
"""Ends of the names of results of a cable that depend on its mesh: they are compared at the stations."""


def samples(scene: SceneData, run: Run, quantities: Sequence[str]) -> dict[str, np.ndarray]:
    """Return what is compared of a run, (time, point, components) by name: without quantities the motion.

    Raises SceneError for a quantity that the run has not.
    """
    if not quantities:
        return {MOTION: motion(scene, run)}
    return {name: _sampled(scene, run, name) for name in quantities}


def _sampled(scene: SceneData, run: Run, name: str) -> np.ndarray:
    if (found := _whole(scene, run, name)) is not None:
        return found
    of, _, axis = name.rpartition(".")
    vector = _whole(scene, run, of) if axis in COMPONENTS else None
    if vector is None or vector.shape[2] != len(COMPONENTS):
        raise SceneError("choose", f'there is no quantity "{name}"', near(name, list(run)))
    return vector[..., COMPONENTS[axis], None]


def _whole(scene: SceneData, run: Run, name: str) -> np.ndarray | None:
    """Return (time, point, components) of a result with all its components; None where the run has none."""
    cable = scene.cables.get(name.rpartition(".")[0])
    if cable is not None and name.endswith(OF_NODES):
        return along(cable, run[f"{cable.name}.nodal_vectors"])
    return run[name].reshape(len(run.time), 1, -1) if name in run else None


def motion(scene: SceneData, run: Run) -> np.ndarray:
    """Return (time, point, 3): the stations of all cables and the origins of all bodies, in m, in the scene's order."""
    points = [along(cable, run[f"{cable.name}.nodal_vectors"]) for cable in scene.cables.values()]
    points += [run[f"{name}.position"][:, None] for name in scene.bodies]
    return np.concatenate(points, axis=1)


def along(cable: Cable, nodal_vectors: np.ndarray, parts: int = STATIONS, derivative: int = 0) -> np.ndarray:
    """Return (time, parts + 1, 3): the centreline of a cable at equal distances, or a derivative by arc-length.

    nodal_vectors: (time, node, vector, 3); derivative: 0, 1 or 2.
    """
    element, N = _stations(cable.library, cable.element, cable.elements, cable.length, cable.uneven_nodes, parts,
                           derivative)
    vectors = np.concatenate([nodal_vectors[:, element], nodal_vectors[:, element + 1]], axis=2)
    return np.einsum("pk,tpkd->tpd", N, vectors.reshape(len(nodal_vectors), parts + 1, -1, 3))


@lru_cache(maxsize=256)
def _stations(library: str | None, kind: str, elements: int, total: float, nodes: tuple[float, ...],
              parts: int, derivative: int) -> tuple[np.ndarray, np.ndarray]:
    """Return (parts + 1,) the elements at equal distances and (parts + 1, shapes) their shape functions there, or a
    derivative of them; total: length of the cable; nodes: their arc-lengths where elements are not equal.
    """
    kernel = getattr(kernels_of(library), f"{kind}_on_axis")
    if nodes:
        mesh = Mesh.of_nodes(np.array(nodes))
        on, x = mesh.place(np.arange(parts + 1) / parts * total)
        return on, np.array([_shapes(kernel, *each, derivative) for each in zip(mesh.lengths[on], x, strict=True)])
    length = total / elements
    at = np.arange(parts + 1) / parts * elements
    element = np.minimum((at * (1 + 1e-12)).astype(int), elements - 1)
    return element, np.array([_shapes(kernel, length, x, derivative) for x in length * (at - element)])


def _shapes(kernel: Callable, length: float, x: float, derivative: int) -> np.ndarray:
    """Return the shape functions on the axis at x in an element, or a derivative of them."""
    return kernel(length, x)[derivative] if derivative < 2 else second_derivative(kernel, length, x)


def second_derivative(kernel: Callable, length: float, x: float) -> np.ndarray:
    """Return the second derivative of the shape functions on the axis at x in an element, by difference of the first.
    """
    d = 1e-3 * length
    low, high = max(x - d, 0.0), min(x + d, length)
    return (kernel(length, high)[1] - kernel(length, low)[1]) / (high - low)
