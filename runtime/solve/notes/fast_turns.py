"""Bodies that turn far within a step: no control shortens a fixed one, nor those of "genalpha" enough."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...model.model import Model

MAX_TURN_PER_STEP = 1.0
"""Turn in rad per step beyond which the method does not resolve the motion of the axes."""
PHASE_ERROR_FACTOR = 30.0
"""Multiple of tol: a method of second order that controls positions alone errs by more than tol where its phase error
in rad is larger (tops of tests/benchmarks/choice_scenes.py: 15 to 20)."""


class FastTurns:
    """The largest angle by which each body turned within a step of a fixed length, and when; and the integral over time
    of the third power of its angular velocity, rad³/s².

    step: in s, 0 where tol chooses it; found: angle in rad, time in s, the integral and its end in s, by the body's
    name.
    """

    def __init__(self, model: Model, step: float):
        self._model, self._step = model, step
        self.found: dict[str, Any] = {}

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows."""
        for body in self._model.bodies:
            first = body.dof + self._model.dim
            rates = np.linalg.norm(rows["v"][:, first : first + (3 if self._model.dim == 3 else 1)], axis=1)
            angle, at, cubes, until = self.found.get(body.name, (0.0, 0.0, 0.0, 0.0))
            k = int(np.argmax(rates))
            if self._step * rates[k] > angle:
                angle, at = float(self._step * rates[k]), float(rows["time"][k])
            cubes += float(rates**3 @ np.diff(rows["time"], prepend=until))
            self.found[body.name] = [angle, at, cubes, float(rows["time"][-1])]

    def notes(self) -> list[str]:
        """Return a note for each body that turned too fast for a fixed step."""
        return [f'body "{name}" turns by {angle:.3g} rad within a step at t = {time:.4g} s: take a step of '
                f"{self._step * MAX_TURN_PER_STEP / 10 / angle:.2g} s or less, or none, so that tol chooses it"
                for name, (angle, time, _, _) in self.found.items() if angle > MAX_TURN_PER_STEP]

    def unseen(self, steps: int, tol: float) -> list[str]:
        """Return the bodies that turned too fast for steps that tol has chosen by the error of positions alone.

        In a step of a method of second order what turns by an angle a lags behind by a³/12.
        """
        return [name for name, (_, _, cubes, duration) in self.found.items()
                if cubes * (duration / steps) ** 2 / 12 > PHASE_ERROR_FACTOR * tol]
