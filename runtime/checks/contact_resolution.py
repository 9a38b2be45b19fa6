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


def unseen_contact(scene: SceneData) -> Iterator[str]:
    """Yield a note for each cable that may sink into a surface, by more than its radius, between points that touch."""
    for contact in scene.contacts.values():
        cable, surface = scene.cables.get(contact.a), scene.surfaces[contact.b]
        if cable is not None:
            yield from _between_points(contact, cable, surface)


def _between_points(contact: Contact, cable: Cable, surface: Surface) -> Iterator[str]:
    assert contact.radius is not None, f"{contact.where} is not complete"
    apart, bend = APART * float(cable.mesh.lengths.max()), _bend_radius(surface, contact.radius)
    if not np.isfinite(bend):
        return
    allowed = min(contact.radius or SUNK * bend, bend)
    chord = 2 * np.sqrt(allowed * (2 * bend - allowed))  # whose height the cable may sink by
    if apart > chord:
        yield (f'{contact.where}: "{contact.a}" touches by points that are up to {apart:.3g} m apart; between them it '
               f'may be more than {show(allowed, "m")} below "{contact.b}", or pass through it, unseen; where it '
               f'touches, take elements of at most {chord / APART:.3g} m')


def _bend_radius(surface: Surface, own: float) -> float:
    """Return the least radius, in m, of the curve of a cable's axis where it is bent over a surface.

    own: the radius of the cable, in m. The edges of a box have none: what counts is its least size.
    """
    shape = surface.geometry
    if shape.word == "terrain":
        return own + 1 / shape.bend if shape.bend > 0 else np.inf
    return own + {"flat": np.inf, "box": float(shape.half_size.min())}.get(shape.word, shape.radius)
