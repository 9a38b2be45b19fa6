"""The motion of a run, and other quantities, sampled at points that do not depend on its mesh."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..errors import SceneError, near
from ..model.rope_states import POINTS_OF_ELEMENT, points_of_spans
from ..parts.cable import Cable
from ..parts.paths import COMPONENTS
from ..parts.rope import Rope
from ..parts.scene_data import SceneData
from ..results.run import Run
from ..results.shape_functions import on_axis

STATIONS = 12
"""Equal parts of a cable, at whose ends motions on two meshes are compared."""

MOTION = "motion"
"""Name of the motion where no quantity is named."""

NODAL_RESULTS = (".nodal_vectors", ".nodal_velocity", ".position", ".velocity")
"""Ends of the names of a cable's results that depend on its mesh: they are compared at the stations."""

POINTS, OF_ROPE_MESH = {"{part}.point"}, ("coordinates", "coordinate_rates")
"""Dimension of the results of a rope at points along it, and results that are no quantities of points."""


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
    part, _, quantity = name.rpartition(".")
    if part in scene.cables and name.endswith(NODAL_RESULTS):
        return along(scene.cables[part], run[f"{part}.nodal_vectors"])
    if part in scene.ropes and quantity in Rope.results and POINTS <= set(Rope.results[quantity].dims):
        return along_rope(scene, scene.ropes[part], run[name])
    if part in scene.ropes and quantity in OF_ROPE_MESH:
        raise SceneError("choose", f'"{name}" depends on the mesh of the rope', f'take "{part}.position"')
    return run[name].reshape(len(run.time), 1, -1) if name in run else None


def motion(scene: SceneData, run: Run) -> np.ndarray:
    """Return (time, point, 3): the stations of all cables, the origins of all bodies, the stations of ropes, and, along
    x, the ways of the rims of sheaves and drums that turn; in m, in the scene's order.
    """
    points = [along(cable, run[f"{cable.name}.nodal_vectors"]) for cable in scene.cables.values()]
    points += [run[f"{name}.position"][:, None] for name in scene.bodies]
    for rope in scene.ropes.values():
        points.append(along_rope(scene, rope, run[f"{rope.name}.position"]))
        points += [(wheel.radius * run[f"{wheel.name}.angle"])[:, None, None] * np.eye(3)[0] for wheel in rope.wheels
                   if wheel.turns_round]
    return np.concatenate(points, axis=1)


def along_rope(scene: SceneData, rope: Rope, values: np.ndarray) -> np.ndarray:
    """Return (time, points, components): results of a rope (time, rope point, ...) at five equal distances along each
    span, which are points of results on any mesh.
    """
    spans = points_of_spans(rope, scene.route_of(rope))
    at = np.concatenate([np.linspace(span.start, span.stop - 1, POINTS_OF_ELEMENT + 1) for span, _ in spans])
    found: np.ndarray = values[:, np.rint(at).astype(int)].reshape(len(values), len(at), -1)
    return found


def along(cable: Cable, nodal_vectors: np.ndarray, parts: int = STATIONS, derivative: int = 0) -> np.ndarray:
    """Return (time, parts + 1, 3): the centreline of a cable at equal distances, or a derivative by arc-length.

    nodal_vectors: (time, node, vector, 3); derivative: 0, 1 or 2.
    """
    s = np.arange(parts + 1) / parts * cable.length
    element = cable.mesh.element_at(s * (1 + 1e-12))
    N = shapes(cable, element, s - cable.mesh.each_start(element), derivative)
    node = cable.mesh.first_node(element)
    vectors = np.concatenate([nodal_vectors[:, node], nodal_vectors[:, node + 1]], axis=2)
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
