"""A scene at T instants for its pictures, from any source, and the positions of points of cables and bodies."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ...base.rotations import rotate
from ...parts.attachment import Attachment
from ...parts.cable import Cable
from ...parts.modal_body import ModalBody
from ...parts.scene_data import SceneData
from ..shape_functions import of_slopes, on_axis

SectionForces = Callable[[str, np.ndarray], dict[str, np.ndarray]]
"""Returns force, moment (T, n, 3) and components (T, n) of a cable at arc-lengths (n,) in m."""


def no_forces(cable: str, s: np.ndarray) -> dict[str, np.ndarray]:
    """Return no section forces."""
    return {}


@dataclass(frozen=True)
class Frames:
    """A scene at T instants.

    time (T,) in s, or another parameter; value: results (T, ...) by their names in a run; has: whether there is a
    result of a name; reference: results at one instant, without the time, the origin of displacements; load (T,): the
    applied part of the loads; moves: whether loads and waves follow time; happened: the first times of
    events, s.
    """

    scene: SceneData
    time: np.ndarray
    value: Callable[[str], np.ndarray]
    has: Callable[[str], bool]
    reference: Callable[[str], np.ndarray]
    load: np.ndarray
    section_forces: SectionForces = no_forces
    moves: bool = False
    happened: Mapping[str, float] = field(default_factory=dict)

    def __len__(self) -> int:
        """Return the number of instants."""
        return len(self.time)


def weights(cable: Cable, s: np.ndarray, slope: int | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Return the elements (n,) of arc-lengths s (n,), and shape functions (n, vectors of two nodes) there.

    slope: 0, 1, 2 for those of r_x, r_y, r_z instead of positions.
    """
    element, x = cable.mesh.place(s)
    x = np.clip(x, 0.0, cable.mesh.each_length(element))
    return element, on_axis(cable, element, x)[0] if slope is None else of_slopes(cable, element, x)[:, slope]


def along(cable: Cable, s: np.ndarray, nodal_vectors: np.ndarray, slope: int | None = None) -> np.ndarray:
    """Return the points (..., n, 3) of a cable at arc-lengths s (n,) in m, or a slope there.

    nodal_vectors: (..., nodes, vectors, 3); slope: as of `weights`.
    """
    element, N = weights(cable, s, slope)
    node = cable.mesh.first_node(element)
    pairs = np.concatenate([nodal_vectors[..., node, :, :], nodal_vectors[..., node + 1, :, :]], axis=-2)
    return np.asarray(np.einsum("nk,...nkd->...nd", N, pairs, optimize=True))


def moving(cable: Cable, s: np.ndarray, nodal_vectors: np.ndarray, slope: int | None = None) -> np.ndarray:
    """Return the points (T, 3) of a cable at one arc-length s (T,) of each instant, or a slope there.

    nodal_vectors: (T, nodes, ...), or (1, nodes, ...) of a cable at rest; slope: as of `weights`.
    """
    element, N = weights(cable, s, slope)
    instants = np.arange(len(s)) if len(nodal_vectors) > 1 else np.zeros(len(s), dtype=int)
    node = cable.mesh.first_node(element)
    pairs = np.concatenate([nodal_vectors[instants, node], nodal_vectors[instants, node + 1]], axis=1)
    return np.asarray(np.einsum("tk,tkd->td", N, pairs))


def place(frames: Frames, attachment: Attachment) -> np.ndarray:
    """Return the positions (T, 3) of an attachment in m; (1, 3) of the ground."""
    if attachment.on is None:
        return np.array([attachment.point])
    if attachment.on in frames.scene.cables:
        s = np.array([attachment.arc_length])
        return along(frames.scene.cables[attachment.on], s, frames.value(f"{attachment.on}.nodal_vectors"))[:, 0]
    if attachment.on in frames.scene.ropes:
        return on_rope(frames, attachment.on, attachment.arc_length)
    body = frames.scene.bodies[attachment.on]
    orientation, position = (frames.value(f"{attachment.on}.{what}") for what in ("orientation", "position"))
    if isinstance(body, ModalBody):  # the point is fixed to the section at the nearest node
        node = int(np.argmin(np.linalg.norm(body.shape.nodes - attachment.point, axis=1)))
        arm = np.array(attachment.point) - body.shape.nodes[node]
        turn = frames.value(f"{attachment.on}.modal_coordinates") @ body.shape.rotations[:, node]
        position, arm = frames.value(f"{attachment.on}.nodes")[:, node], arm + np.cross(turn, arm)
    else:
        arm = np.array(attachment.point)
    return np.asarray(position + rotate(orientation, arm))


def on_rope(frames: Frames, name: str, s: np.ndarray | float) -> np.ndarray:
    """Return the points (T, 3) of a rope at one arc-length s, m, or one (T,) of each instant."""
    return _on_line(frames.value(f"{name}.position"), frames.value(f"{name}.s"), s)


def _on_line(position: np.ndarray, s: np.ndarray, at: np.ndarray | float) -> np.ndarray:
    """Return the points (T, 3) at an arc-length, or at one (T,) of each instant, of lines (T, points, 3) that are drawn
    through arc-lengths (T, points).
    """
    last = s.shape[1] - 2
    k = np.clip(np.sum(s <= np.reshape(at, (-1, 1)), axis=1) - 1, 0, last)
    rows = np.arange(len(s))
    share = ((at - s[rows, k]) / (s[rows, k + 1] - s[rows, k]))[:, None]
    return np.asarray(position[rows, k] + share * (position[rows, k + 1] - position[rows, k]))


def one_or_all(position: np.ndarray) -> np.ndarray:
    """Return positions (T, 3) unchanged, and (1, 3) as (3,)."""
    return position[0] if len(position) == 1 else position
