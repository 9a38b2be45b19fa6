"""How deep the penalty law of contact lets cables and bodies sink below surfaces."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..model.model import Model
from ..parts.scene_data import SceneData
from ..parts.surface_shapes import Geometry

DEEP = 0.1
"""Of the radius of the cable or of what is round: deeper than that is noted."""


class Penetrations:
    """Sees the rows of contacts; notes where one is deep below its surface."""

    def __init__(self, scene: SceneData, model: Model):
        self.found: dict[str, Any] = {}
        self.contacts = [(contact.name, contact.stiffness, radius) for contact, radius in _radii(scene, model)]

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows, by name, time first."""
        for k, (name, *_) in enumerate(self.contacts):
            self.found[name] = max(self.found.get(name, 0.0), float(rows["contact"][:, k, 6].max(initial=0.0)))

    def notes(self) -> list[str]:
        """Return the notes on all rows that were seen."""
        return [note for name, stiffness, radius in self.contacts
                if (note := too_deep(name, stiffness, radius, self.found.get(name, 0.0)))]


def _radii(scene: SceneData, model: Model) -> Iterator[tuple[Any, float]]:
    """Yield the contacts of a model with the radius that their depth is to be small against, in m."""
    for contact in model.contacts:
        shape: Geometry = scene.surfaces[scene.contacts[contact.name].b].geometry
        yield contact, min((radius for radius in (contact.radius, shape.radius) if radius > 0), default=np.inf)


def penetrations(scene: SceneData, model: Model, outputs: np.ndarray) -> list[str]:
    """Return the notes on a state of rest; outputs: (contacts, 10), the engine's."""
    found = [too_deep(contact.name, contact.stiffness, radius, float(depth))
             for (contact, radius), depth in zip(_radii(scene, model), outputs[:, 6], strict=True)]
    return [note for note in found if note]


def too_deep(name: str, stiffness: float, radius: float, depth: float) -> str:
    """Return a note on a depth in m that is large beside a radius in m, or nothing."""
    if depth <= DEEP * radius:
        return ""
    return (f'contact "{name}" is up to {depth:.3g} m below its surface, {100 * depth / radius:.3g} % of the radius of '
            f"{radius:.3g} m: a stiffness greater than {stiffness:.3g} keeps it up")
