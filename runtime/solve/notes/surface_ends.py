"""Contact beyond the end of a surface that the model continues there: a cylinder, or the table of a height field."""

from __future__ import annotations

import numpy as np

from ...engine import Engine
from ...model.contacts import ContactModel, HardContactModel
from ...parts.solids import Cylinder
from .note import Note, Rows

END_TOLERANCE = 1e-9
"""Distance beyond the end of a surface that counts as its end, as a fraction of its extent."""
KINDS = "contact", "hard_contact"


class SurfaceEnds(Note):
    """The largest distance in m beyond the ends of its surface at which each contact acts."""

    measures = (ContactModel, HardContactModel)
    assesses_rest = True

    def see_steps(self, engine: Engine) -> None:
        """Measure extremes that the engine records at the ends of its steps."""
        for kind in KINDS:
            self._take(kind, engine.farthest(kind))

    def see_rest(self, rows: Rows, engine: Engine) -> None:
        """Measure the static state."""
        for kind in KINDS:
            self._take(kind, engine.static_farthest(kind))

    def _take(self, kind: str, distances: np.ndarray) -> None:
        contacts = self.model.contacts if kind == "contact" else self.model.hard_contacts
        for contact, distance in zip(contacts, distances, strict=True):
            self.keep(contact.name, distance)

    def notes(self) -> list[str]:
        """Return a note for each contact beyond an end."""
        notes = []
        for name, (distance,) in self.found.items():
            contact = self.scene.contacts[name]
            surface = self.scene.surfaces[contact.b]
            if isinstance(surface.shape, Cylinder):
                extent, end = surface.shape.length, "end"
                what = ("which the contact continues without end: give it a greater length, or take a Capsule, which "
                        "ends in half spheres")
            else:
                axes = [each for each in (surface.geometry.first, surface.geometry.second) if each is not None]
                extent, end = float(max(np.ptp(each) for each in axes)), "table"
                what = "where its height stays that of the edge: give a table that reaches farther"
            if distance > END_TOLERANCE * extent:
                notes.append(f'{contact.where} acts up to {distance:.3g} m beyond the {end} of "{contact.b}", '
                             f"{what}")
        return notes
