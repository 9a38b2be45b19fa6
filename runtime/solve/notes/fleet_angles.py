"""Fleet angles of ropes in space beyond what their sheaves are said to take."""

from __future__ import annotations

import numpy as np

from ...engine import outputs_by_name
from ...parts.validation import show
from .note import Note, Rows


class FleetAngles(Note):
    """The largest fleet angle of each sheave of a rope in space, in rad, and its time in s."""

    assesses_rest = True

    def prepare(self) -> None:
        """Select the parts to measure."""
        self._limits = {item.name: item.max_fleet_angle for rope in self.model.ropes for item in rope.part.sheaves}
        self._names = [sheave.name for sheave in self.model.sheaves] if self.model.dim == 3 else []

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        if not self._names:
            return
        numbers = outputs_by_name("sheave", rows["sheave"])
        angle = np.maximum(np.abs(numbers["fleet_angle_on"]), np.abs(numbers["fleet_angle_off"]))
        for k, name in enumerate(self._names):
            row = int(np.argmax(angle[:, k]))
            self.keep(name, angle[row, k], rows["time"][row])

    def notes(self) -> list[str]:
        """Return a note for each sheave whose limit was exceeded."""
        return [self._note(name, "reached", f" at t = {time:.4g} s") for name, (angle, time) in self.found.items()
                if angle > self._limits[name]]

    def notes_at_rest(self) -> list[str]:
        """Return a note for each sheave whose limit is exceeded."""
        return [self._note(name, "is", "") for name, (angle, _) in self.found.items() if angle > self._limits[name]]

    def _note(self, name: str, verb: str, when: str) -> str:
        return (f'sheave "{name}": its fleet angle {verb} {show(self.found[name][0], "rad")}{when}, above '
                f"max_fleet_angle, {show(self._limits[name], 'rad')}: the rope may leave its groove")
