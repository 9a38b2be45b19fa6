"""How deep the penalty laws of contact let cables and bodies sink."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...checks.contact_resolution import radius_of
from ...engine import Engine, outputs_by_name
from ...model.model import Model
from ...parts.scene_data import SceneData

PENETRATION_LIMIT = 0.1
"""Penetration that a note reports, as a fraction of the radius of the cable or of the round body."""


@dataclass
class _Limit:
    """From which depth in m a contact's is noted, beside which length in m, and how the two are told."""

    name: str
    stiffness: float
    depth: float
    radius: float
    below: str

    def note(self, depth: float) -> str:
        """Return a note on a depth in m that is large beside the radius."""
        return (f'contact "{self.name}" is up to {depth:.3g} m {self.below}, {100 * depth / self.radius:.3g} % of the '
                f"radius of {self.radius:.3g} m: a stiffness greater than {self.stiffness:.3g} keeps it up")


def _of_surfaces(scene: SceneData, model: Model) -> list[_Limit]:
    """Return the limits of contacts with surfaces."""
    limits = []
    for contact in model.contacts:
        own = radius_of(scene, scene.contacts[contact.name])
        radius = min((r for r in (own, contact.round_radius) if r > 0), default=np.inf)
        limits.append(_Limit(contact.name, contact.stiffness, PENETRATION_LIMIT * radius, radius, "below its surface"))
    return limits


def _of_crossings(model: Model) -> list[_Limit]:
    """Return the limits of crossings: where they are as deep, their lines are beyond each other's axes; none of lines
    without a radius, which touch there.
    """
    return [_Limit(each.name, each.stiffness, each.law[0] or np.inf, each.law[0], "past where its lines touch")
            for each in model.crossings]


class Penetrations:
    """Sees how deep contacts and crossings are; notes where one is too deep."""

    def __init__(self, scene: SceneData, model: Model):
        self.found: dict[str, Any] = {}
        self._limits = {"contact": _of_surfaces(scene, model), "crossing": _of_crossings(model)}

    def see(self, engine: Engine) -> None:
        """Take how deep the engine has found them at the ends of its steps, rows of output among them."""
        for kind, limits in self._limits.items():
            self._take(limits, engine.deepest(kind))

    def see_rest(self, outputs: dict[str, np.ndarray]) -> None:
        """Take a state of rest, by the engine's numbers of each kind of coupling, (couplings, numbers)."""
        if len(outputs["contact"]):
            self._take(self._limits["contact"], outputs_by_name("contact", outputs["contact"])["penetration"])
        if len(outputs["crossing"]):  # beyond their ends lines may be past each other's axes and not touch
            of = outputs_by_name("crossing", outputs["crossing"])
            self._take(self._limits["crossing"], np.where(of["normal_force"] > 0, of["penetration"], 0.0))

    def _take(self, limits: list[_Limit], depths: np.ndarray) -> None:
        """Keep the depths, in m, that are larger than those before."""
        for limit, depth in zip(limits, depths, strict=True):
            if depth > self.found.get(limit.name, 0.0):
                self.found[limit.name] = float(depth)

    def notes(self) -> list[str]:
        """Return the notes on all that was seen."""
        return [limit.note(self.found[limit.name]) for limits in self._limits.values() for limit in limits
                if self.found.get(limit.name, 0.0) > limit.depth]


def penetrations(scene: SceneData, model: Model, outputs: dict[str, np.ndarray]) -> list[str]:
    """Return the notes on a state of rest; outputs: the engine's of each kind of coupling, (couplings, numbers)."""
    found = Penetrations(scene, model)
    found.see_rest(outputs)
    return found.notes()
