"""Models of cables: constants of their elements, weight, initial state."""

from __future__ import annotations

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


def cable_model(cable: Cable, first: int) -> CableModel:
    """Return the model of a cable whose coordinates begin at ``first``."""
    element, law, mesh = cable.element, cable.kernel_law, cable.mesh
    kernels, vectors = kernels_of(cable.library), cable.kind_of_element.nodal_vectors
    mass, moments = getattr(kernels, f"{element}_mass"), cable.section.mass_moments()
    m = np.array([mass(length, cable.material.density, moments) for length in mesh.lengths])
    return CableModel(
        cable.name, element, law, mesh, first, cable.material.damping_time,
        cable.material.mass_damping, m, constants(cable), (cable.elements + 1, len(vectors), cable.dim), vectors,
        cable.library)


def cable_gravity(model: CableModel, cable: Cable, gravity: np.ndarray) -> np.ndarray:
    """Return (coordinates,): generalised gravity of a cable."""
    kernel, moments = model.kernel("gravity"), cable.section.mass_moments()
    each = np.array([kernel(length, cable.material.density, moments, gravity).reshape(2, *model.shape[1:])
                     for length in model.mesh.lengths])
    weight = np.zeros(model.shape)
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
