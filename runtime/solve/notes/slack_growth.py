"""How much small errors grow in a motion with cables that become slack and taut again, measured by a second run.

What such a cable does depends on the least difference, though nothing in it is compressed by much. A second run with
ten times the tolerance is ten times its error away from the first one, or more where errors have grown to the size of
the motion. Errors grow late, where a cable snaps taut, so that the second run goes to the end: about half the time of
the run more, where a cable with membrane "tension_only" was slack.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...engine import SLACK_STRAIN, Engine
from ...model.middle_strain import middle_strain
from ...model.model import Model
from ...parts.scene_data import SceneData
from ...parts.settings import RunSettings
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
FIXED_STEP_ERROR_LIMIT = 5e-3
"""Error of a fixed step that a note reports, as a fraction of the largest motion."""

Rows = dict[str, np.ndarray]
Again = Callable[[RunSettings], Rows]


class SlackMotion:
    """Keeps the positions of a motion at some times, and when the first cable was slack.

    found: "times", "positions" at them, and "slack", the time in s of the first row with a slack element, or None.
    """

    def __init__(self, scene: SceneData, model: Model, duration: float):
        self.model, self.cables = model, [cable for cable in model.cables
                                           if scene.cables[cable.name].traits.membrane == "tension_only"]
        self._every = duration / STORED_INTERVALS
        self.found: dict[str, Any] = {}

    def see(self, rows: Rows) -> None:
        """Take further output rows."""
        if not self.cables:
            return
        found = self.found or {"times": [], "positions": [], "slack": None}
        for k, time in enumerate(rows["time"].tolist()):
            if time >= len(found["times"]) * self._every * (1 - 1e-9):
                found["times"].append(time)
                found["positions"].append(positions(self.model, rows["q"][k]).tolist())
        if found["slack"] is None:
            slack = np.zeros(len(rows["time"]), dtype=bool)
            for cable in self.cables:
                vectors = rows["q"][:, cable.coordinates].reshape(-1, *cable.shape)
                slack |= (middle_strain(cable, vectors) < -SLACK_STRAIN).any(axis=1)
            if slack.any():
                found["slack"] = float(rows["time"][np.argmax(slack)])
        self.found = found

    def notes(self) -> list[str]:
        """Return nothing: what it keeps is compared with a second run, see `grown`."""
        return []


def positions(model: Model, q: np.ndarray) -> np.ndarray:
    """Return (n, dim): the places of all nodes and bodies."""
    nodes = [q[cable.coordinates].reshape(cable.shape)[:, cable.vectors.index("r")] for cable in model.cables]
    bodies = [q[None, body.configuration:body.configuration + model.dim] for body in model.bodies]
    return np.concatenate([*nodes, *bodies])


def grown(engine: Engine, settings: RunSettings, seen: SlackMotion, again: Again) -> list[str]:
    """Return a note where errors of a motion with slack cables grow beyond what is allowed; again: runs the scene with
    other settings, and returns its rows.
    """
    begin, times = seen.found.get("slack"), np.array(seen.found.get("times", []))
    if begin is None or not engine.moves or len(times) < STORED_INTERVALS / 2 or settings.quantities:
        return []
    until = times[-1]
    here = times > begin
    if np.count_nonzero(here) < 4:
        return []
    fixed = settings.step is not None
    looser = ({"step": STEP_RATIO * settings.step} if settings.step is not None
              else {"tol": TOLERANCE_RATIO * settings.tol})
    rows = again(settings.model_copy(update={**looser, "duration": float(until), "estimate": True, "save": None}))
    at = np.searchsorted(rows["time"], times[here] - 1e-9 * until)
    if len(at) == 0 or at[-1] >= len(rows["time"]):
        return []  # it ended before
    kept = [np.array(seen.found["positions"][k]) for k in np.flatnonzero(here)]
    apart = [np.linalg.norm(positions(seen.model, rows["q"][k]) - one, axis=1).max()
             for k, one in zip(at, kept, strict=True)]
    share = FINER_ERROR_FRACTION if fixed else 1 / TOLERANCE_RATIO
    motion = engine.controlled_motion
    allowed = FIXED_STEP_ERROR_LIMIT * motion if fixed else settings.tol * motion + max(engine.absolute_tol, 0.0)
    expected = max(apart[-(len(apart) // FINAL_PARTS) - 1:]) * share  # what has died out again has not grown
    if not expected > ERROR_REPORT_RATIO * allowed:
        return []
    since = float(times[here][np.argmax(np.array(apart) * share > 0.1 * expected)])
    return [f'cable "{seen.cables[0].name}" becomes slack: from t = {since:.3g} s on {GROWTH_TEXT}, '
            f"and errors may become {float(f'{expected / allowed:.1g}'):.0f} times what is allowed: a run with "
            f"{'larger steps' if fixed else '10 tol'} is {apart[-1]:.2g} m away at t = {until:.3g} s. Give "
            f"estimate=True, which measures them, or a smaller {'step' if fixed else 'tol'}, or more damping"]
