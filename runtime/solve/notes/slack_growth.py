"""Growth of small errors in motions with cables that become slack and taut again, measured by a second run.

Such a motion is sensitive to the smallest difference, though nothing in it is compressed by much. A second run with
ten times the tolerance differs from the first one by ten times its error, or by more where errors have grown to the
size of the motion. Errors grow late, where a cable snaps taut, so that the second run goes to the end: it adds about
half the time of the run, where a cable with membrane "tension_only" was slack.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...engine import SLACK_STRAIN, Engine
from ...model.middle_strain import middle_strain
from ...model.model import CableModel, Model
from ...parts.settings import RunSettings
from .note import Note, Rows, allowed_error
from .sensitivity import GROWTH_TEXT

STORED_INTERVALS = 32
"""Intervals of the run at whose ends positions are stored."""
TOLERANCE_RATIO, STEP_RATIO = 10.0, 2.0
"""Tolerance and fixed step of the second run over those of the first."""
FINER_ERROR_FRACTION = 1 / 3
"""Error of the finer of two runs with fixed steps, of second order, as a fraction of their distance."""
FINAL_PARTS = 4
"""The last of this number of parts of the second run gives the grown errors."""
ERROR_REPORT_RATIO = 2.0
"""Ratio of the expected error to the allowed one above which a note reports it."""


class SlackMotion(Note):
    """Positions at some times, and the time in s of the first row with a slack element.

    found: "times", "positions" at these, and "slack", None without a slack element; `grown` compares them with a second
    run.
    """

    measures = (CableModel,)

    def prepare(self) -> None:
        """Select the cables that can become slack."""
        self.cables = [cable for cable in self.model.cables if cable.gives_way]

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        if not self.cables:
            return
        found = self.found or {"times": [], "positions": [], "slack": None}
        for k, time in enumerate(rows["time"].tolist()):
            if time >= len(found["times"]) * self.duration / STORED_INTERVALS * (1 - 1e-9):
                found["times"].append(time)
                found["positions"].append(_positions(self.model, rows["q"][k]).tolist())
        if found["slack"] is None:
            slack = np.any([(middle_strain(cable, cable.strained(rows["q"])) < -SLACK_STRAIN).any(axis=1)
                            for cable in self.cables], axis=0)
            if slack.any():
                found["slack"] = float(rows["time"][np.argmax(slack)])
        self.found = found


def _positions(model: Model, q: np.ndarray) -> np.ndarray:
    """Return (n, dim): positions of all nodes and bodies."""
    bodies = [q[None, body.configuration : body.configuration + model.dim] for body in model.bodies]
    return np.concatenate([*(cable.positions(q) for cable in model.cables), *bodies])


def grown(engine: Engine, settings: RunSettings, seen: SlackMotion | None,
          again: Callable[[RunSettings], Rows]) -> list[str]:
    """Return a note where errors of a motion with slack cables grow beyond the allowed one.

    again: runs the scene with other settings, and returns its rows.
    """
    begin = None if seen is None else seen.found.get("slack")
    if seen is None or begin is None or not engine.moves or settings.quantities:
        return []
    times = np.array(seen.found["times"])
    if len(times) < STORED_INTERVALS / 2:
        return []
    here = np.flatnonzero(times > begin)
    if len(here) < 4:
        return []
    fixed, until = settings.step is not None, float(times[-1])
    looser = ({"step": STEP_RATIO * settings.step} if settings.step is not None
              else {"tol": TOLERANCE_RATIO * settings.tol})
    rows = again(settings.model_copy(update={**looser, "duration": until, "estimate": True, "save": None}))
    at = np.searchsorted(rows["time"], times[here] - 1e-9 * until)
    if at[-1] >= len(rows["time"]):  # the second run ended before
        return []
    apart = np.array(
        [np.linalg.norm(_positions(seen.model, rows["q"][k]) - np.array(seen.found["positions"][one]), axis=1).max()
         for k, one in zip(at, here, strict=True)])
    errors, allowed = apart * (FINER_ERROR_FRACTION if fixed else 1 / TOLERANCE_RATIO), allowed_error(engine, settings)
    expected = errors[-(len(errors) // FINAL_PARTS) - 1:].max()  # an error that has decayed has not grown
    if not expected > ERROR_REPORT_RATIO * allowed:
        return []
    since = times[here][np.argmax(errors > 0.1 * expected)]
    return [f'cable "{seen.cables[0].name}" becomes slack: from t = {since:.3g} s on {GROWTH_TEXT}, '
            f"and errors may become {float(f'{expected / allowed:.1g}'):.0f} times what is allowed: a run with "
            f"{'larger steps' if fixed else '10 tol'} is {apart[-1]:.2g} m away at t = {until:.3g} s. Give "
            f"estimate=True, which measures them, or a smaller {'step' if fixed else 'tol'}, or more damping"]
