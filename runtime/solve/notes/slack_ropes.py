"""Ropes that have left a sheave, and are in compression there: they resist it as they do tension."""

from __future__ import annotations

import numpy as np

from ...engine import outputs_by_name
from ...model.rope_wheels import SheaveModel
from ...parts.validation import show
from .note import Note, Rows

MIN_SLACK_ROWS = 2
"""Output rows in turn with compression, which a wave alone does not cause."""


class SlackRopes(Note):
    """The largest compression of the rope beside each sheave that it has left, in N, its time in s, and the number of
    rows with compression in turn, the present one and the largest.
    """

    measures = (SheaveModel,)

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        if not self.model.sheaves:
            return
        numbers = outputs_by_name("sheave", rows["sheave"])
        pushes = np.where(numbers["gap"] > 0, -numbers["tension_on"], 0.0)
        for k, sheave in enumerate(self.model.sheaves):
            for push, time in zip(pushes[:, k].tolist(), rows["time"].tolist(), strict=True):
                largest, at, turn, longest = self.found.get(sheave.name, (0.0, 0.0, 0, 0))
                turn = turn + 1 if push > 0 else 0
                if push > largest:
                    largest, at = push, time
                if largest:
                    self.found[sheave.name] = (largest, at, turn, max(turn, longest))

    def notes(self) -> list[str]:
        """Return a note for each sheave beside which a rope was slack."""
        return [f'sheave "{name}": the rope that has left it is slack there, with {show(push, "N")} in compression at '
                f"t = {time:.4g} s, which it resists as tension; take a higher tension or more damping"
                for name, (push, time, _, longest) in self.found.items() if longest >= MIN_SLACK_ROWS]
