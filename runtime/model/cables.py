"""Models of cables: constants of their elements, weight, initial state."""

from __future__ import annotations

from functools import cached_property, lru_cache

import numpy as np

from ..kernels.elements import gauge
from ..kernels.libraries import kernels_of
from ..parts.cable import Cable
from ..parts.scene_data import SceneData
from .constants import constants
from .model import CableModel
from .unknowns import Reduction, as_supports_leave

MAX_SLOPE_DIFFERENCE = 0.01
"""Relative difference of slopes that a rigid tie unites, above which one of the cables is drawn slack."""
KEPT_CABLES, MAX_KEPT_ELEMENTS = 32, 1000
"""Number of cables whose arrays are kept for equal ones, as those of variants of a scene, and the most elements of one.
"""


class CableArrays:
    """A cable, and the arrays of its model, each made once and read-only."""

    def __init__(self, cable: Cable):
        self.cable = cable
        self._gravity: tuple[bytes, np.ndarray] | None = None

    def model(self, first: int) -> CableModel:
        """Return its model, whose coordinates begin at ``first``."""
        cable = self.cable
        vectors, material = cable.kind_of_element.nodal_vectors, cable.material
        return CableModel(
            cable.name, cable.element, cable.kernel_law, cable.mesh, first, material.damping_time,
            material.mass_damping, self._mass, self._constants, (cable.elements + 1, len(vectors), cable.dim),
            vectors, cable.library)

    @cached_property
    def _mass(self) -> np.ndarray:
        """Return m of a `CableModel`."""
        cable = self.cable
        mass, moments = getattr(kernels_of(cable.library), f"{cable.element}_mass"), cable.section.mass_moments()
        return _fixed(np.array([mass(length, cable.material.density, moments) for length in cable.mesh.lengths]))

    @cached_property
    def _constants(self) -> np.ndarray:
        """Return A of a `CableModel`."""
        return _fixed(constants(self.cable))

    @cached_property
    def vectors(self) -> np.ndarray:
        """Return (nodes, vectors, 3): its nodal vectors."""
        return _fixed(self.cable.nodal_vectors)

    @cached_property
    def weights(self) -> np.ndarray:
        """Return the displacement of a point by a unit of each nodal vector: 1 for positions, lengths for slopes, those
        of the longer element at the node.
        """
        cable = self.cable
        area, iyy, izz = cable.section.moments()[:3]
        across, lengths = np.sqrt([iyy / area, izz / area]), cable.mesh.lengths
        vectors = cable.kind_of_element.nodal_vectors
        if len(lengths) == 1:
            return _fixed(np.repeat(np.tile(list(gauge(vectors, lengths[0], *across)), cable.elements + 1), cable.dim))
        longer = np.maximum(np.append(lengths[0], lengths), np.append(lengths, lengths[-1]))
        return _fixed(np.repeat([unit for length in longer for unit in gauge(vectors, length, *across)], cable.dim))

    def gravity(self, gravity: np.ndarray) -> np.ndarray:
        """Return (coordinates,): its generalised gravity."""
        along, kept = gravity.tobytes(), self._gravity
        if kept is None or kept[0] != along:
            kept = self._gravity = along, _fixed(cable_gravity(self.cable, gravity))
        return kept[1]


def _fixed(array: np.ndarray) -> np.ndarray:
    """Return an array, read-only."""
    array.flags.writeable = False
    return array


def arrays_of(cable: Cable) -> CableArrays:
    """Return the arrays of a cable, the same ones for equal cables.

    Elements of cables that are curved without stress have large arrays, each its own, which are not kept.
    """
    return (kept_arrays if cable.elements <= MAX_KEPT_ELEMENTS and not cable.is_curved else CableArrays)(cable)


kept_arrays = lru_cache(maxsize=KEPT_CABLES)(CableArrays)


def cable_gravity(cable: Cable, gravity: np.ndarray) -> np.ndarray:
    """Return (coordinates,): generalised gravity of a cable."""
    kernel, moments = getattr(kernels_of(cable.library), f"{cable.element}_gravity"), cable.section.mass_moments()
    vectors = len(cable.kind_of_element.nodal_vectors)
    each = np.array([kernel(length, cable.material.density, moments, gravity).reshape(2, vectors, cable.dim)
                     for length in cable.mesh.lengths])
    weight = np.zeros((cable.elements + 1, vectors, cable.dim))
    weight[:-1] += each[:, 0]
    weight[1:] += each[:, 1]
    return weight.ravel()


def level_tied_slopes(scene: SceneData, nodal: list[np.ndarray]) -> None:
    """Give slopes that a rigid tie unites the lesser of their lengths where these differ by more than a strain.

    nodal: (nodes, vectors, dim) of each cable as drawn, changed in place. Cables drawn slack by different fractions
    would keep the ratio of their slopes at the tie, and one of them a strain of that size.
    """
    numbers = {name: k for k, name in enumerate(scene.cables)}
    for tie in scene.ties.values():
        if tie.rotation != "rigid":
            continue
        slopes = [nodal[numbers[cable.name]][cable.node(s), cable.kind_of_element.nodal_vectors.index("r_x")]
                  for cable, s in ((scene.cables[tie.cable], tie.s), (scene.cables[tie.to], tie.at))]
        lengths = [float(np.linalg.norm(slope)) for slope in slopes]
        if abs(lengths[0] - lengths[1]) > MAX_SLOPE_DIFFERENCE * max(lengths):
            for slope, length in zip(slopes, lengths, strict=True):
                slope *= min(lengths) / length  # a longer one would turn a short element back on itself


def cable_rates(scene: SceneData, reduction: Reduction) -> np.ndarray:
    """Return the rates of the cables' nodal vectors at the start, as the supports admit them."""
    asked = np.concatenate([*(cable.nodal_rates[..., : scene.dim].ravel() for cable in scene.cables.values()), []])
    return as_supports_leave(asked, reduction.unknown_of_dof, reduction.combinations)
