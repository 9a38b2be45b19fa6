"""Bodies that turn far within a step: no control shortens a fixed one, nor those of "genalpha" enough."""

from __future__ import annotations

from ...base.rotations import sizes
from ...model.model import BodyModel
from .note import Note, Rows, intervals

MAX_TURN_PER_STEP = 1.0
"""Turn in rad per step beyond which the method does not resolve the motion of the axes."""
PHASE_ERROR_FACTOR = 30.0
"""Multiple of tol: a method of second order that controls positions alone errs by more than tol where its phase error
in rad is larger (tops of tests/benchmarks/choice_scenes.py: 15 to 20)."""


class FastTurns(Note):
    """The largest turn of each body within a fixed step in rad, its time in s, the integral over time of the third
    power of its angular velocity in rad³/s², and the end of that in s.
    """

    measures = (BodyModel,)

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        time, size = rows["time"], 3 if self.model.dim == 3 else 1
        for body in self.model.bodies:
            first = body.dof + self.model.dim
            rates = sizes(rows["v"][:, first : first + size])
            angle, at, cubes, until = self.found.get(body.name, (0.0, 0.0, 0.0, 0.0))
            k = int(rates.argmax())
            if self.step * rates[k] > angle:
                angle, at = float(self.step * rates[k]), float(time[k])
            cubes += float(rates**3 @ intervals(time, until))
            self.found[body.name] = [angle, at, cubes, float(time[-1])]

    def notes(self) -> list[str]:
        """Return a note for each body that turned too fast for a fixed step."""
        return [f'body "{name}" turns by {angle:.3g} rad within a step at t = {time:.4g} s: take a step of '
                f"{self.step * MAX_TURN_PER_STEP / 10 / angle:.2g} s or less, or none, so that tol chooses it"
                for name, (angle, time, _, _) in self.found.items() if angle > MAX_TURN_PER_STEP]

    def uncontrolled(self, steps: int, tol: float) -> list[str]:
        """Return the bodies that turned too fast for steps that tol has chosen by the error of positions alone.

        In a step of a method of second order a turn by an angle a lags behind by a³/12.
        """
        return [name for name, (_, _, cubes, duration) in self.found.items()
                if cubes * (duration / steps) ** 2 / 12 > PHASE_ERROR_FACTOR * tol]
