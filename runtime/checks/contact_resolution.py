"""What lies between the points by which a cable touches a surface, in words: a warning, never a refusal."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..parts.cable import Cable
from ..parts.contact import GAUSS_POINTS, Contact
from ..parts.scene_data import SceneData
from ..parts.surface import Surface
from ..parts.validation import show

APART = float(np.diff(np.polynomial.legendre.leggauss(GAUSS_POINTS)[0]).max()) / 2
"""Of an element: how far points of its quadrature are from each other at most; across a node they are closer."""
SUNK = 1e-2
"""Of the radius of a surface: how far a cable without a radius may sink in unseen before that is noted."""
NONE = 0.01
"""Of the radius of a circle of the section's area: a smaller radius of contact is that of the centreline."""


def radius_of(scene: SceneData, contact: Contact) -> float:
    """Return the radius, in m, that depths of a contact are measured by: 0 where it is that of the centreline, since it
    is none beside the section of the cable.
    """
    assert contact.radius is not None, f"{contact.where} is not complete"
    cable = scene.cables.get(contact.a)
    least = 0.0 if cable is None else NONE * float(np.sqrt(cable.section.moments()[0] / np.pi))
    return contact.radius if contact.radius > least else 0.0


def unseen_contact(scene: SceneData) -> Iterator[str]:
    """Yield a note for each cable that may sink into a surface, by more than its radius, between points that touch."""
    for contact in scene.contacts.values():
        cable, surface = scene.cables.get(contact.a), scene.surfaces[contact.b]
        if cable is not None:
            yield from _between_points(contact, cable, surface, radius_of(scene, contact))


def _between_points(contact: Contact, cable: Cable, surface: Surface, radius: float) -> Iterator[str]:
    apart, bend = APART * float(cable.mesh.lengths.max()), _bend_radius(surface, radius)
    if not np.isfinite(bend):
        return
    allowed = min(radius or SUNK * bend, bend)
    chord = 2 * np.sqrt(allowed * (2 * bend - allowed))  # whose height the cable may sink by
    if apart > chord:
        yield (f'{contact.where}: "{contact.a}" touches by points that are up to {apart:.3g} m apart; between them it '
               f'may be more than {show(allowed, "m")} below "{contact.b}", or pass through it, unseen; where it '
               f'touches, take elements of at most {chord / APART:.3g} m')


def _bend_radius(surface: Surface, own: float) -> float:
    """Return the least radius, in m, of the curve of a cable's axis where it is bent over a surface.

    own: the radius of the cable, in m. The edges of a box have none: what counts is its least size. What lies within a
    hollow is bent over its own ends alone, as a chord between two points of a hollow is in it.
    """
    shape = surface.geometry
    if shape.inside:
        return np.inf if shape.word == "round" and shape.direction.any() else shape.inner_radius - own
    if shape.word == "terrain":
        return own + 1 / shape.bend if shape.bend > 0 else np.inf
    return own + {"flat": np.inf, "box": float(shape.half_size.min())}.get(shape.word, shape.radius)
