"""Normal forces of slides with friction that vibrate about zero: what friction does then depends on each reversal."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...engine import outputs_by_name
from ...model.model import Model
from ...parts.scene_data import SceneData

MIN_REVERSALS, MIN_REVERSAL_RATE = 5, 0.1
"""A normal force vibrates if it changes its sign this number of times, and in this fraction of the output intervals. A
zip line whose rider rebounds from its buffer has 11 reversals in 500 intervals and errs by 0.02 tol; released wires
have 7 and 13 in 40."""


class NormalForces:
    """How often the force on the rider of each slide with friction reversed between two output times.

    found: by the slide's name the count, the number of output times, and the last force in N.
    """

    def __init__(self, scene: SceneData, model: Model):
        self._slides = [(k, slide.name) for k, slide in enumerate(model.slides) if has_friction(scene, slide.name)]
        self.found: dict[str, Any] = {}

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows."""
        for k, name in self._slides:
            rider = outputs_by_name("slide", rows["slide"][:, k])["force"]
            count, times, last = self.found.get(name, (0, 0, [0.0, 0.0, 0.0]))
            force = np.concatenate([[last], rider])
            count += int(np.sum(np.sum(force[1:] * force[:-1], axis=1) < 0))
            self.found[name] = [count, times + len(rows["time"]), force[-1].tolist()]

    def notes(self) -> list[str]:
        """Return nothing: whether steps follow the reversals depends on the integrator, see `uncontrolled`."""
        return []

    @property
    def vibrating(self) -> list[str]:
        """Return the slides whose normal force vibrates about zero."""
        return [name for name, (count, times, _) in self.found.items()
                if count >= max(MIN_REVERSALS, MIN_REVERSAL_RATE * times)]


def has_friction(scene: SceneData, name: str) -> bool:
    """Return whether a slide has friction that depends on its normal force."""
    friction = scene.slides[name].friction
    return friction is not None and bool(friction.coefficient or friction.rolling)
