"""The ends of contact along a cable, between the points of its quadrature.

The stiffness of a penalty contact is that of the points in contact. Where the cable leaves the surface, a whole point
enters or leaves contact as the mesh changes: frequencies of a line on a bed scattered by 0.3 %. For a linearisation the
point at the end of the contact has the length up to the zero of the depth.
"""

from __future__ import annotations

import numpy as np

from ...model.contacts import ContactModel
from ...model.model import Model
from ...model.states import distances
from ...parts.scene_data import SceneData


def resolve_contact_edges(model: Model, scene: SceneData, q: np.ndarray) -> None:
    """Give points at the ends of contact, in a model of a scene at a configuration, the length of cable in contact.

    Laws of exponent 1.5 do not change: their stiffness begins at zero.
    """
    for contact in model.contacts:
        if contact.cable >= 0 and not contact.hertz:
            depth = contact.radius - distances(model, scene, contact, q[None]).ravel()
            if np.any(depth > 0) and np.any(depth <= 0):
                _weigh(contact, depth)


def _weigh(contact: ContactModel, depth: np.ndarray) -> None:
    """Change the weights of the points next to a zero of the depth (points,)."""
    for name in ("weights", "N", "hull", "spread"):  # stored for one element on an even mesh
        of_one = getattr(contact, name)
        setattr(contact, name, np.broadcast_to(of_one, (contact.n_elements, *of_one.shape[1:])).copy())
    contact.stride, weights = contact.n_points, contact.weights.ravel()
    ends, active = contact.entries["start"] + np.cumsum(weights), depth > 0
    for k in np.flatnonzero(active[:-1] != active[1:]):
        passed = contact.arc[k] + (contact.arc[k + 1] - contact.arc[k]) * depth[k] / (depth[k] - depth[k + 1])
        if active[k]:
            weights[k] += passed - ends[k]
        else:
            weights[k + 1] += ends[k] - passed
