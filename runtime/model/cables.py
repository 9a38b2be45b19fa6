"""Models of cables: constants of their elements, weight, initial state."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

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

FORGET: list[Callable[[], None]] = []
"""Functions that drop the kept arrays, for tests and timings."""


@lru_cache(maxsize=KEPT_CABLES)
def kept_cable(cable: Cable) -> Cable:
    """Return the first of equal cables, which is found again without comparison of its entries."""
    return cable


FORGET.append(kept_cable.cache_clear)


def _kept(arrays: Callable[..., np.ndarray]) -> Callable[..., np.ndarray]:
    """Return a function of a cable, and of tuples, that makes an array, read-only, once for equal cables.

    Elements of cables that are curved without stress have large arrays, each its own, which are not kept.
    """
    @lru_cache(maxsize=KEPT_CABLES)
    def kept(cable: Cable, *given: tuple[float, ...]) -> np.ndarray:
        made = arrays(cable, *given)
        made.flags.writeable = False
        return made

    FORGET.append(kept.cache_clear)

    def of(cable: Cable, *given: tuple[float, ...]) -> np.ndarray:
        return (kept if cable.elements <= MAX_KEPT_ELEMENTS and not cable.is_curved else arrays)(cable, *given)

    return of


def cable_model(cable: Cable, first: int) -> CableModel:
    """Return the model of a cable whose coordinates begin at ``first``."""
    vectors = cable.kind_of_element.nodal_vectors
    return CableModel(
        cable.name, cable.element, cable.kernel_law, cable.mesh, first, cable.material.damping_time,
        cable.material.mass_damping, _mass(cable), _constants(cable), (cable.elements + 1, len(vectors), cable.dim),
        vectors, cable.library)


@_kept
def _mass(cable: Cable) -> np.ndarray:
    """Return m of a `CableModel`."""
    mass, moments = getattr(kernels_of(cable.library), f"{cable.element}_mass"), cable.section.mass_moments()
    return np.array([mass(length, cable.material.density, moments) for length in cable.mesh.lengths])


_constants = _kept(constants)


@_kept
def _nodal_vectors(cable: Cable) -> np.ndarray:
    """Return its nodal vectors as drawn."""
    return cable.nodal_vectors


def drawn_vectors(cable: Cable, dim: int) -> np.ndarray:
    """Return (nodes, vectors, dim): its nodal vectors as drawn."""
    return _nodal_vectors(cable)[..., :dim].copy()


def cable_gravity(cable: Cable, gravity: np.ndarray) -> np.ndarray:
    """Return (coordinates,): generalised gravity of a cable."""
    return _gravity(cable, tuple(gravity.tolist()))


@_kept
def _gravity(cable: Cable, gravity: tuple[float, ...]) -> np.ndarray:
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


@_kept
def cable_weights(cable: Cable) -> np.ndarray:
    """Return the displacement of a point by a unit of each nodal vector: 1 for positions, lengths for slopes, those of
    the longer element at the node.
    """
    area, iyy, izz = cable.section.moments()[:3]
    across, lengths = np.sqrt([iyy / area, izz / area]), cable.mesh.lengths
    vectors = cable.kind_of_element.nodal_vectors
    if len(lengths) == 1:
        return np.repeat(np.tile(list(gauge(vectors, lengths[0], *across)), cable.elements + 1), cable.dim)
    longer = np.maximum(np.append(lengths[0], lengths), np.append(lengths, lengths[-1]))
    return np.repeat([unit for length in longer for unit in gauge(vectors, length, *across)], cable.dim)
