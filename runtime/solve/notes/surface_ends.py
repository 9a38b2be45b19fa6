"""Contact beyond the end of a surface whose shape goes on there: a cylinder, or the table of a height field."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...engine import Engine
from ...model.model import Model
from ...parts.contact import Contact
from ...parts.scene_data import SceneData
from ...parts.solids import Cylinder

END_TOLERANCE = 1e-9
"""Contact less far beyond the end of a surface, as a fraction of its extent, is contact with its end."""


class SurfaceEnds:
    """Sees how far beyond the ends of its surface each contact touches; notes which do.

    found: how far, in m, by the contact's name.
    """

    def __init__(self, scene: SceneData, model: Model):
        self.found: dict[str, Any] = {}
        self._scene = scene
        self._names = {"contact": [each.name for each in model.contacts],
                       "hard_contact": [each.name for each in model.hard_contacts]}

    def see(self, engine: Engine) -> None:
        """Take what the engine has found at the ends of its steps."""
        for kind in self._names:
            self._take(kind, engine.farthest(kind))

    def see_rest(self, engine: Engine) -> None:
        """Take what the engine's static state has."""
        for kind in self._names:
            self._take(kind, engine.static_farthest(kind))

    def _take(self, kind: str, distances: np.ndarray) -> None:
        for name, distance in zip(self._names[kind], distances.tolist(), strict=True):
            if distance > self.found.get(name, 0.0):
                self.found[name] = distance

    def notes(self) -> list[str]:
        """Return the notes on all that was seen."""
        return [note for name, distance in self.found.items()
                if (note := _note(self._scene, self._scene.contacts[name], distance))]


def _note(scene: SceneData, contact: Contact, distance: float) -> str:
    """Return a note on contact so far beyond the ends of its surface, in m; empty where that is rounding."""
    surface = scene.surfaces[contact.b]
    if isinstance(surface.shape, Cylinder):
        extent, end = surface.shape.length, "end"
        what = "which goes on without ends: give it a greater length, or take a Capsule, which ends in half spheres"
    else:
        knots = [each for each in (surface.geometry.first, surface.geometry.second) if each is not None]
        extent, end = float(max(np.ptp(each) for each in knots)), "table"
        what = "where its height stays that of the edge: give a table that reaches farther"
    if distance <= END_TOLERANCE * extent:
        return ""
    return f'{contact.where} touches up to {distance:.3g} m beyond the {end} of "{contact.b}", {what}'


def beyond_ends(scene: SceneData, model: Model, engine: Engine) -> list[str]:
    """Return the notes on the static state of an engine."""
    found = SurfaceEnds(scene, model)
    found.see_rest(engine)
    return found.notes()
