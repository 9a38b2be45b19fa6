"""Hard contact of points of bodies with surfaces, as the engine takes it: a coupling for each point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from ..parts.attachment import Attachment
from ..parts.contact import Contact
from ..parts.scene_data import SceneData
from .attachments import AttachmentBuilder, AttachmentModel
from .contacts import ContactModel, surface_entries

GIVES_WAY = 1e-10
"""m: what a hard contact gives way by in statics under the weight of its body."""


@dataclass(kw_only=True)
class HardContactModel(ContactModel):
    """fu_hard_contact of hard_contact.h, of one point of a body; without what a penalty has.

    restitution: of the normal velocity; rest_velocity: m/s, below which what would part stays; sliding: Coulomb's
    coefficient; weight: N, of the body;
    static_stiffness: N/m, of the little by which it gives way in statics, so that points that hold the same share it.
    """

    restitution: float
    rest_velocity: float
    sliding: float
    weight: float
    static_stiffness: float

    @property
    def ends(self) -> Sequence[AttachmentModel]:
        """Return the point and what carries the surface."""
        return [*self.attachments, *self.on]


def hard_contact_models(part: Contact, scene: SceneData, attachments: AttachmentBuilder) -> list[HardContactModel]:
    """Return the models of a hard contact of the scene, one for each of its points, and in a hollow box each wall."""
    assert part.restitution is not None and part.points is not None, f"{part.where} is not complete"
    models, rows = [], scene.dim if part.friction_coefficient else 1
    weight = scene.bodies[part.a].mass * (float(np.linalg.norm(scene.gravity)) or 1.0)
    surface = scene.surfaces[part.b]
    walls = [surface_entries(surface, scene, attachments, wall) for wall in surface.geometry.walls(scene.dim)]
    for point, wall in product(part.points, walls):
        at = attachments.model(Attachment(on=part.a, at=point))
        models.append(HardContactModel(
            **wall, type="hard_contact", name=part.name or "", stiffness=0.0, damping=0.0, friction=0.0,
            tangential=0.0, hertz=0, cable=-1, radius=part.radius or 0.0, n_points=1, attachments=[at],
            scale=[at.mass] * rows, n_multipliers=rows, sliding=part.friction_coefficient,
            restitution=part.restitution, rest_velocity=part.rest_velocity, weight=weight,
            static_stiffness=weight / GIVES_WAY))
    return models
