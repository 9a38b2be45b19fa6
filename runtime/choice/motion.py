"""The motion of a run, and other quantities, sampled at points that do not depend on its mesh."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..errors import SceneError, near
from ..parts.cable import Cable
from ..parts.paths import COMPONENTS
from ..parts.scene_data import SceneData
from ..results.run import Run
from ..results.shape_functions import on_axis

STATIONS = 12
"""Equal parts of a cable, at whose ends motions on two meshes are compared."""

MOTION = "motion"
"""Name of the motion where no quantity is named."""

NODAL_RESULTS = (".nodal_vectors", ".nodal_velocity", ".position", ".velocity")
"""Ends of the names of a cable's results that depend on its mesh: they are compared at the stations."""


def samples(scene: SceneData, run: Run, quantities: Sequence[str]) -> dict[str, np.ndarray]:
    """Return the compared values of a run, (time, point, components) by name: without quantities the motion.

    Raises SceneError for a quantity that the run does not have.
    """
    if not quantities:
        return {MOTION: motion(scene, run)}
    found = {}
    for name in quantities:
        values = _whole(scene, run, name)
        if values is None:
            of, _, axis = name.rpartition(".")
            vector = _whole(scene, run, of) if axis in COMPONENTS else None
            if vector is None or vector.shape[2] != len(COMPONENTS):
                raise SceneError("choose", f'there is no quantity "{name}"', near(name, list(run)))
            values = vector[..., COMPONENTS[axis], None]
        found[name] = values
    return found


def _whole(scene: SceneData, run: Run, name: str) -> np.ndarray | None:
    """Return (time, point, components) of a result with all its components; None where the run does not have it."""
    cable = scene.cables.get(name.rpartition(".")[0])
    if cable is not None and name.endswith(NODAL_RESULTS):
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
    s = np.arange(parts + 1) / parts * cable.length
    element = cable.mesh.element_at(s * (1 + 1e-12))
    N = shapes(cable, element, s - cable.mesh.each_start(element), derivative)
    vectors = np.concatenate([nodal_vectors[:, element], nodal_vectors[:, element + 1]], axis=2)
    found: np.ndarray = np.einsum("pk,tpkd->tpd", N, vectors.reshape(len(nodal_vectors), parts + 1, -1, 3))
    return found


def shapes(cable: Cable, element: np.ndarray, x: np.ndarray, derivative: int) -> np.ndarray:
    """Return (n, shapes): shape functions on the axis at x (n,) in elements (n,), in m, or a derivative of them.

    The second derivative is a difference of the first.
    """
    if derivative < 2:
        return on_axis(cable, element, x)[derivative]
    lengths = np.asarray(cable.mesh.each_length(element))
    low, high = np.maximum(x - 1e-3 * lengths, 0.0), np.minimum(x + 1e-3 * lengths, lengths)
    return np.asarray((on_axis(cable, element, high)[1] - on_axis(cable, element, low)[1]) / (high - low)[:, None])
