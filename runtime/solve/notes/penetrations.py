"""Penetration of penalty contacts and crossings beside the radius of the cable or body."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...checks.contact_placement import radius_of
from ...engine import Engine, outputs_by_name
from ...model.contacts import ContactModel, RopeContactModel
from ...model.crossings import CrossingModel
from .note import Note, Rows

PENETRATION_LIMIT = 0.1
"""Penetration of a surface that a note reports, as a fraction of the radius of the cable or of the round body."""


class _Limit(NamedTuple):
    """A contact: its penalty stiffness, the depth in m that a note reports, the radius in m, and where it is deep."""

    name: str
    stiffness: float
    depth: float
    radius: float
    below: str


class Penetrations(Note):
    """The largest penetration in m of each contact and crossing, also between output times."""

    measures = (ContactModel, RopeContactModel, CrossingModel)
    assesses_rest = True

    def prepare(self) -> None:
        """Select the parts to measure."""
        self._limits: dict[str, list[_Limit]] = {"contact": [], "rope contact": [], "crossing": []}
        contacts: list[ContactModel | RopeContactModel] = [*self.model.contacts, *self.model.rope_contacts]
        for contact in contacts:
            radii = radius_of(self.scene, self.scene.contacts[contact.name], contact.radius), contact.round_radius
            radius = min((r for r in radii if r > 0), default=np.inf)
            self._limits[contact.type].append(
                _Limit(contact.name, contact.stiffness, PENETRATION_LIMIT * radius, radius, "below its surface"))
        for each in self.model.crossings:  # deeper, lines are past each other's axes; without a radius that is contact
            self._limits["crossing"].append(_Limit(each.name, each.stiffness, each.law[0] or np.inf, each.law[0],
                                                   "beyond the contact of its lines"))

    def see(self, rows: Rows) -> None:
        """Measure further output rows: those of ropes, whose extremes the engine does not record."""
        if self._limits["rope contact"]:
            of = outputs_by_name("rope contact", rows["rope contact"])
            self._take("rope contact", of["penetration"].max(axis=0))

    def see_steps(self, engine: Engine) -> None:
        """Measure extremes that the engine records at the ends of its steps."""
        for kind in self._limits:
            self._take(kind, engine.deepest(kind))

    def see_rest(self, rows: Rows, engine: Engine) -> None:
        """Measure a state of rest."""
        for kind, limits in self._limits.items():
            if limits:
                of = outputs_by_name(kind, rows[kind][0])
                is_apart = kind == "crossing" and of["normal_force"] <= 0  # lines past each other, beyond their ends
                self._take(kind, np.where(is_apart, 0.0, of["penetration"]))

    def _take(self, kind: str, penetrations: np.ndarray) -> None:
        for limit, penetration in zip(self._limits[kind], penetrations, strict=True):
            self.keep(limit.name, penetration)

    def notes(self) -> list[str]:
        """Return a note for each contact or crossing with a large penetration."""
        return [f'contact "{limit.name}" is up to {depth:.3g} m {limit.below}, {100 * depth / limit.radius:.3g} % of '
                f"the radius of {limit.radius:.3g} m: a stiffness greater than {limit.stiffness:.3g} keeps it up"
                for limits in self._limits.values() for limit in limits
                if (depth := self.found.get(limit.name, [0.0])[0]) > limit.depth]
