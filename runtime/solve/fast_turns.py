"""Bodies that turn by more than a radian within a fixed step: no error control shortens it."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..model.model import Model

MOST = 1.0
"""rad within a step: beyond it the method does not follow how the axes move."""


class FastTurns:
    """The largest angle by which each body turned within a step of a fixed length, and when.

    step: in s, 0 where tol chooses it; found: angle in rad and time in s, by the body's name.
    """

    def __init__(self, model: Model, step: float):
        self._model, self._step = model, step
        self.found: dict[str, Any] = {}

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows."""
        for body in self._model.bodies if self._step else []:
            first = body.dof + self._model.dim
            rates = rows["v"][:, first : first + (3 if self._model.dim == 3 else 1)]
            angles = self._step * np.linalg.norm(rates, axis=1)
            k = int(np.argmax(angles))
            if angles[k] > self.found.get(body.name, [MOST])[0]:
                self.found[body.name] = [float(angles[k]), float(rows["time"][k])]

    def notes(self) -> list[str]:
        """Return a note for each body that turned too fast."""
        return [f'body "{name}" turns by {angle:.3g} rad within a step at t = {time:.4g} s: take a step of '
                f"{self._step * MOST / 10 / angle:.2g} s or less, or none, so that tol chooses it"
                for name, (angle, time) in self.found.items()]
