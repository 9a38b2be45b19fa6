"""A scene at T instants, as its pictures need it, whatever it is taken from: where points of cables and bodies are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ...base.rotations import rotate
from ...kernels.libraries import kernels_of
from ...parts.attachment import Attachment
from ...parts.cable import Cable
from ...parts.modal_body import ModalBody
from ...parts.scene_data import SceneData


class SectionForces(Protocol):
    """Returns what a cable bears in its sections."""

    def __call__(self, cable: str, s: np.ndarray) -> dict[str, np.ndarray]:
        """Return force, moment (T, n, 3) and components (T, n) at arc-lengths s (n,) in m."""


def no_forces(cable: str, s: np.ndarray) -> dict[str, np.ndarray]:
    """Return nothing: what cables bear in these frames is not known."""
    return {}


@dataclass(frozen=True)
class Frames:
    """A scene at T instants.

    time (T,) in s, or what stands in its place; value: results by the names that a run has for them, (T, ...);
    reference: the same of one instant, without the time, that displacements are measured from; load (T,): how much of
    the loads is on; has: whether there is a result of a name; moves: whether loads follow their signals over the time.
    """

    scene: SceneData
    time: np.ndarray
    value: Callable[[str], np.ndarray]
    has: Callable[[str], bool]
    reference: Callable[[str], np.ndarray]
    load: np.ndarray
    section_forces: SectionForces = no_forces
    moves: bool = False

    def __len__(self) -> int:
        """Return the number of instants."""
        return len(self.time)


def weights(cable: Cable, s: np.ndarray, slope: int | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Return the elements (n,) that arc-lengths s (n,) are in, and shape functions (n, vectors of two nodes) there.

    slope: 0, 1, 2 for those of r_x, r_y, r_z instead of the point's.
    """
    element, x = cable.mesh.place(s)
    length = cable.mesh.each_length(element)
    x = np.clip(x, 0.0, length)
    kernels = kernels_of(cable.library)
    if slope is None:
        return element, getattr(kernels, f"{cable.element}_on_axis").rows(len(s), length, x)[0]
    return element, getattr(kernels, f"{cable.element}_slopes").rows(len(s), length, x)[:, slope, 0]


def along(cable: Cable, s: np.ndarray, nodal_vectors: np.ndarray, slope: int | None = None) -> np.ndarray:
    """Return the points (..., n, 3) of a cable at arc-lengths s (n,) in m, as its elements draw them, or a slope there.

    nodal_vectors: (..., nodes, vectors, 3); slope: as of `weights`.
    """
    element, N = weights(cable, s, slope)
    pairs = np.concatenate([nodal_vectors[..., element, :, :], nodal_vectors[..., element + 1, :, :]], axis=-2)
    return np.einsum("nk,...nkd->...nd", N, pairs, optimize=True)


def moving(cable: Cable, s: np.ndarray, nodal_vectors: np.ndarray) -> np.ndarray:
    """Return the points (T, 3) of a cable at one arc-length s (T,) of each instant.

    nodal_vectors: (T, nodes, ...), or (1, nodes, ...) of a cable that stands still.
    """
    element, N = weights(cable, s)
    instants = np.arange(len(s)) if len(nodal_vectors) > 1 else np.zeros(len(s), dtype=int)
    pairs = np.concatenate([nodal_vectors[instants, element], nodal_vectors[instants, element + 1]], axis=1)
    return np.einsum("tk,tkd->td", N, pairs)


def place(frames: Frames, attachment: Attachment) -> np.ndarray:
    """Return where an attachment is, (T, 3) in m; (1, 3) of the ground."""
    if attachment.on is None:
        return np.array([attachment.point])
    if attachment.on in frames.scene.cables:
        s = np.array([attachment.arc_length])
        return along(frames.scene.cables[attachment.on], s, frames.value(f"{attachment.on}.nodal_vectors"))[:, 0]
    body = frames.scene.bodies[attachment.on]
    orientation = frames.value(f"{attachment.on}.orientation")
    if isinstance(body, ModalBody):  # its point goes with the section at its node
        node = int(np.argmin(np.linalg.norm(body.shape.nodes - attachment.point, axis=1)))
        arm = np.array(attachment.point) - body.shape.nodes[node]
        turn = frames.value(f"{attachment.on}.modal_coordinates") @ body.shape.rotations[:, node]
        return frames.value(f"{attachment.on}.nodes")[:, node] + rotate(orientation, arm + np.cross(turn, arm))
    return frames.value(f"{attachment.on}.position") + rotate(orientation, attachment.point)


def one_or_all(position: np.ndarray) -> np.ndarray:
    """Return places (T, 3) as they are, and (1, 3) of what stands still as (3,)."""
    return position[0] if len(position) == 1 else position
