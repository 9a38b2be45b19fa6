"""Cables as the engine takes them: constants of their elements, weight, and how they start."""

from __future__ import annotations

import numpy as np

from ..kernels.elements import gauge
from ..kernels.libraries import kernels_of
from ..parts.cable import Cable
from ..parts.scene_data import SceneData
from .constants import constants
from .model import CableModel
from .unknowns import Reduction, as_supports_leave


def cable_model(cable: Cable, first: int) -> CableModel:
    """Make the model of a cable whose coordinates begin at ``first``."""
    element, law, length = cable.element, cable.kernel_law, cable.length / cable.elements
    kernels, vectors = kernels_of(cable.library), cable.kind_of_element.nodal_vectors
    m = getattr(kernels, f"{element}_mass")(length, cable.material.density, cable.section.mass_moments())
    return CableModel(
        cable.name, element, law, cable.elements, first, length, cable.material.damping_time,
        cable.material.mass_damping, m, constants(cable), (cable.elements + 1, len(vectors), cable.dim), vectors,
        cable.library)


def cable_gravity(model: CableModel, cable: Cable, gravity: np.ndarray) -> np.ndarray:
    """Return (coordinates,): generalised weight of a cable; two elements meet at an inner node."""
    first, second = model.kernel("gravity")(model.length, cable.material.density, cable.section.mass_moments(),
                                            gravity).reshape(2, *model.shape[1:])
    weight = np.zeros(model.shape)
    weight[:-1] += first
    weight[1:] += second
    return weight.ravel()


def cable_rates(scene: SceneData, reduction: Reduction) -> np.ndarray:
    """Return the rates of the cables' nodal vectors at the start, but for what supports hold."""
    asked = np.concatenate([*(cable.nodal_rates[..., : scene.dim].ravel() for cable in scene.cables.values()), []])
    return as_supports_leave(asked, reduction.unknown_of_dof, reduction.combinations)


def cable_weights(cable: Cable) -> np.ndarray:
    """Return how far a unit of each nodal vector moves a point: 1 for positions, and lengths for the slopes."""
    area, iyy, izz = cable.section.moments()[:3]
    unit = gauge(cable.kind_of_element.nodal_vectors, cable.length / cable.elements, np.sqrt(iyy / area),
                 np.sqrt(izz / area))
    return np.repeat(np.tile(list(unit), cable.elements + 1), cable.dim)
