"""Fleet angles of ropes in space beyond what their sheaves and drums are said to take."""

from __future__ import annotations

import numpy as np

from ...engine import outputs_by_name
from ...model.rope_model import RopeModel
from ...model.taut_ropes import TautPointModel
from ...parts.validation import show
from .note import Note, Rows


class FleetAngles(Note):
    """The largest fleet angle of each sheave and drum of a rope in space, in rad, and its time in s."""

    measures = (RopeModel,)
    assesses_rest = True

    def prepare(self) -> None:
        """Select the parts to measure."""
        self._items = {item.name: item for rope in self.model.ropes for item in rope.part.wheels}
        self._names = {kind: [wheel.name for wheel in wheels] for kind, wheels in (
            ("sheave", self.model.sheaves), ("drum", self.model.drums), ("taut_point", self.model.of(TautPointModel)))
            if wheels and self.model.dim == 3}

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        for kind, names in self._names.items():
            numbers = outputs_by_name(kind, rows[kind])
            angle = np.max([np.abs(value) for key, value in numbers.items() if key.startswith("fleet_angle")], axis=0)
            for k, name in enumerate(names):
                if name not in self._items:  # an anchor
                    continue
                row = int(np.argmax(angle[:, k]))
                self.keep(name, angle[row, k], rows["time"][row])

    def notes(self) -> list[str]:
        """Return a note for each wheel whose limit was exceeded."""
        return [self._note(name, "reached", f" at t = {time:.4g} s") for name, (angle, time) in self.found.items()
                if angle > self._items[name].max_fleet_angle]

    def notes_at_rest(self) -> list[str]:
        """Return a note for each wheel whose limit is exceeded."""
        return [self._note(name, "is", "") for name, (angle, _) in self.found.items()
                if angle > self._items[name].max_fleet_angle]

    def _note(self, name: str, verb: str, when: str) -> str:
        item = self._items[name]
        return (f'{item.where}: its fleet angle {verb} {show(self.found[name][0], "rad")}{when}, above '
                f"max_fleet_angle, {show(item.max_fleet_angle, 'rad')}: the rope may leave its groove")
