"""How deep the penalty law of contact lets cables and bodies sink below surfaces."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..model.model import Model

DEEP = 0.1
"""Of the radius of the cable or of what is round: deeper than that is noted."""


class Penetrations:
    """Sees the rows of contacts; notes where one is deep below its surface."""

    def __init__(self, model: Model):
        self.found: dict[str, Any] = {}
        self.contacts = list(_radii(model))

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows, by name, time first."""
        if not self.contacts:
            return
        depths = rows["contact"][..., 6].max(axis=0, initial=0.0)
        for k in np.flatnonzero(depths):
            name = self.contacts[k][0].name
            self.found[name] = max(self.found.get(name, 0.0), float(depths[k]))

    def notes(self) -> list[str]:
        """Return the notes on all rows that were seen."""
        depths = np.array([self.found.get(contact.name, 0.0) for contact, _ in self.contacts])
        return _notes(self.contacts, depths)


def _radii(model: Model) -> Iterator[tuple[Any, float]]:
    """Yield the contacts of a model with the radius that their depth is to be small against, in m."""
    for contact in model.contacts:
        radii = (contact.radius, contact.round_radius)
        yield contact, min((radius for radius in radii if radius > 0), default=np.inf)


def penetrations(model: Model, outputs: np.ndarray) -> list[str]:
    """Return the notes on a state of rest; outputs: (contacts, 10), the engine's."""
    return _notes(list(_radii(model)), outputs[:, 6]) if len(outputs) else []


def _notes(contacts: list[tuple[Any, float]], depths: np.ndarray) -> list[str]:
    """Return the notes on depths (contacts,), in m, of contacts with the radii that these are to be small against."""
    return [too_deep(contacts[k][0].name, contacts[k][0].stiffness, contacts[k][1], float(depths[k]))
            for k in np.flatnonzero(depths > DEEP * np.array([radius for _, radius in contacts]))]


def too_deep(name: str, stiffness: float, radius: float, depth: float) -> str:
    """Return a note on a depth in m that is large beside a radius in m."""
    return (f'contact "{name}" is up to {depth:.3g} m below its surface, {100 * depth / radius:.3g} % of the radius of '
            f"{radius:.3g} m: a stiffness greater than {stiffness:.3g} keeps it up")
