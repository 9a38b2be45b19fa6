"""Distances of the contact points of cables from surfaces."""

from __future__ import annotations

import numpy as np

from ..base.rotations import conjugate, rotate
from ..parts.scene_data import SceneData
from .contacts import ContactModel
from .model import Model
from .states import body_state, spatial


def distances(model: Model, scene: SceneData, contact: ContactModel, q: np.ndarray,
              elements: np.ndarray | None = None) -> np.ndarray:
    """Return (T, elements, points): distances in m of the points of a contact from its surface, in configurations q (T,
    n_q), of some elements or of all.
    """
    cable, surface = model.cables[contact.cable], scene.surfaces[scene.contacts[contact.name].b]
    elements = np.arange(cable.n_elements) if elements is None else elements
    vectors = cable.nodal(q)
    both = np.concatenate([vectors[:, elements], vectors[:, elements + 1]], axis=2)
    N = np.broadcast_to(contact.N, (cable.n_elements, *contact.N.shape[1:]))[elements]
    points = spatial(np.einsum("egk,tekd->tegd", N, both))
    if surface.on is not None:
        frame = body_state(model, next(body for body in model.bodies if body.name == surface.on), q)
        turned = conjugate(frame["orientation"])[:, None, None]
        points = rotate(turned, points - frame["position"][:, None, None])
    return surface.geometry.distance(points)
