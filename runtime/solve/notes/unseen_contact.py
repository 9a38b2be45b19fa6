"""What lies between the points by which a cable touches a surface: elements near it that are too long to see it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...checks.contact_resolution import APART, resolved
from ...model.contact_points import distances
from ...model.contacts import ContactModel
from ...model.model import Model
from ...parts.scene_data import SceneData
from ...parts.validation import show

PATH_POSITIONS = 17
"""Positions on the straight path from the drawing to a state of rest at which contact is assessed."""


class _Coarse(NamedTuple):
    """A contact with elements that are too long: their numbers; the depth in m that goes unseen, and the chord."""

    contact: ContactModel
    elements: np.ndarray
    allowed: float
    chord: float


class UnseenContact:
    """The longest element of each contact that came near the surface and is too long to see it.

    found: the distance of its points in m, by the name of the contact. Elements that stay away are left out.
    """

    def __init__(self, scene: SceneData, model: Model):
        self._scene, self._model = scene, model
        self._coarse = []
        for contact in model.contacts:
            if contact.cable >= 0 and (limit := resolved(scene, scene.contacts[contact.name])) is not None:
                long = np.flatnonzero(self._apart(contact) > limit.chord)
                if len(long):
                    self._coarse.append(_Coarse(contact, long, *limit))
        self.found: dict[str, Any] = {}

    def _apart(self, contact: ContactModel) -> np.ndarray:
        """Return (elements,): how far the points of each element of a cable are from each other at most, in m."""
        cable = self._model.cables[contact.cable]
        return APART * np.broadcast_to(cable.mesh.lengths, cable.n_elements)

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows."""
        for contact, elements, _, _ in self._coarse:
            apart = self._apart(contact)[elements]
            away = distances(self._model, self._scene, contact, rows["q"], elements).min(axis=(0, 2)) - contact.radius
            near = apart[away <= apart]
            if len(near):
                self.found[contact.name] = max(float(near.max()), self.found.get(contact.name, 0.0))

    def notes(self) -> list[str]:
        """Return a note for each contact with such an element."""
        return [f'{part.where}: "{part.a}" touches by points that are up to {self.found[name]:.3g} m apart; between '
                f'them it may be more than {show(each.allowed, "m")} below "{part.b}", or pass through it, unseen; '
                f"where it touches, take elements of at most {each.chord / APART:.3g} m"
                for each in self._coarse if (name := each.contact.name) in self.found
                for part in (self._scene.contacts[name],)]


def unseen_contact(scene: SceneData, model: Model, q: np.ndarray) -> list[str]:
    """Return the notes on a state of rest at a configuration (n,), to which a scene came from where it is drawn."""
    found = UnseenContact(scene, model)
    found.see({"q": model.q + np.linspace(0, 1, PATH_POSITIONS)[:, None] * (q - model.q)})
    return found.notes()
