"""Elements near a surface that are too long for their contact: their points may lie on both sides of an obstacle."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...checks.contact_placement import max_point_distance, resolved
from ...engine import Engine
from ...model.contacts import ContactModel
from ...model.states import distances
from ...parts.validation import show
from .note import Note, Rows

PATH_POSITIONS = 17
"""Positions on the straight path from the drawing to a state of rest at which contact is assessed."""


class _LongElements(NamedTuple):
    """A contact with elements that are too long: their numbers, the largest distance in m of the contact points of
    each, the depth in m that the check allows, and the longest distance in m of points that resolves it.
    """

    contact: ContactModel
    elements: np.ndarray
    apart: np.ndarray
    allowed: float
    chord: float


class CoarseContact(Note):
    """The largest distance in m of the contact points of an element that came near a surface and is too long for it."""

    measures = (ContactModel,)
    assesses_rest = True

    def prepare(self) -> None:
        """Select the parts to measure."""
        self._coarse = []
        for contact in self.model.contacts:
            part = self.scene.contacts[contact.name]
            if contact.cable >= 0 and (limit := resolved(self.scene, part, contact.radius)) is not None:
                cable = self.model.cables[contact.cable]
                own = slice(contact.first, contact.first + contact.n_elements)
                apart = max_point_distance() * np.broadcast_to(cable.mesh.lengths, cable.n_elements)[own]
                long = np.flatnonzero(apart > limit.chord)
                if len(long):
                    self._coarse.append(_LongElements(contact, long, apart[long], *limit))

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        for contact, elements, apart, _, _ in self._coarse:
            away = distances(self.model, self.scene, contact, rows["q"], elements).min(axis=(0, 2)) - contact.radius
            self.keep(contact.name, apart[away <= apart].max(initial=0.0))

    def see_rest(self, rows: Rows, engine: Engine) -> None:
        """Measure the straight path from the drawing to the state of rest."""
        drawn = self.model.q
        self.see({"q": drawn + np.linspace(0, 1, PATH_POSITIONS)[:, None] * (rows["q"] - drawn)})

    def notes(self) -> list[str]:
        """Return a note for each contact with such an element."""
        return [f'{part.where}: "{part.a}" has contact points that are up to {self.found[name][0]:.3g} m apart; '
                f'between them it may be more than {show(each.allowed, "m")} below "{part.b}", or pass through it, '
                f"undetected; in the contact zone, take elements of at most {each.chord / max_point_distance():.3g} m"
                for each in self._coarse if (name := each.contact.name) in self.found
                for part in (self.scene.contacts[name],)]
