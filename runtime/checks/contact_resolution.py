"""How fine the points must be by which a cable touches a surface."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..parts.contact import GAUSS_POINTS, Contact
from ..parts.scene_data import SceneData
from ..parts.surface import Surface

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


class Resolution(NamedTuple):
    """How deep a cable may be below a surface unseen, and the chord of the surface of that height, in m."""

    allowed: float
    chord: float


def resolved(scene: SceneData, contact: Contact) -> Resolution | None:
    """Return what points of a cable must resolve of a surface; None where it is flat."""
    radius = radius_of(scene, contact)
    bend = _bend_radius(scene.surfaces[contact.b], radius)
    if not np.isfinite(bend):
        return None
    allowed = min(radius or SUNK * bend, bend)
    return Resolution(allowed, float(2 * np.sqrt(allowed * (2 * bend - allowed))))


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
