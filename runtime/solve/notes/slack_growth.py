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
from .sensitivity import GROWS

KEPT = 32
"""Intervals of the run, at whose ends positions are kept."""
LOOSER, COARSER = 10.0, 2.0
"""Tolerance and fixed step of the second run, over those of the first."""
OF_COARSER = 1 / 3
"""Of the distance of two runs of fixed steps: the error of the finer one, of second order."""
LAST = 4
"""Of the second run the last part, one of so many, tells what errors have grown to."""
SAID = 2.0
"""Of what is allowed: expected errors that are noted."""
FIXED_ERROR = 5e-3
"""Of the largest motion: errors of a fixed step that are noted."""

Rows = dict[str, np.ndarray]
Again = Callable[[RunSettings], Rows]


class SlackMotion:
    """Keeps the positions of a motion at some times, and when the first cable was slack.

    found: "times", "positions" at them, and "slack", the time in s of the first row with a slack element, or None.
    """

    def __init__(self, scene: SceneData, model: Model, duration: float):
        self.model, self.cables = model, [cable for cable in model.cables
                                           if scene.cables[cable.name].traits.membrane == "tension_only"]
        self._every = duration / KEPT
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
    if begin is None or not engine.moves or len(times) < KEPT / 2 or settings.quantities:
        return []
    until = times[-1]
    here = times > begin
    if np.count_nonzero(here) < 4:
        return []
    fixed = settings.step is not None
    looser = {"step": COARSER * settings.step} if settings.step is not None else {"tol": LOOSER * settings.tol}
    rows = again(settings.model_copy(update={**looser, "duration": float(until), "estimate": True, "save": None}))
    at = np.searchsorted(rows["time"], times[here] - 1e-9 * until)
    if len(at) == 0 or at[-1] >= len(rows["time"]):
        return []  # it ended before
    kept = [np.array(seen.found["positions"][k]) for k in np.flatnonzero(here)]
    apart = [np.linalg.norm(positions(seen.model, rows["q"][k]) - one, axis=1).max()
             for k, one in zip(at, kept, strict=True)]
    share = OF_COARSER if fixed else 1 / LOOSER
    motion = engine.controlled_motion
    allowed = FIXED_ERROR * motion if fixed else settings.tol * motion + max(engine.absolute_tol, 0.0)
    expected = max(apart[-(len(apart) // LAST) - 1:]) * share  # what has died out again has not grown
    if not expected > SAID * allowed:
        return []
    since = float(times[here][np.argmax(np.array(apart) * share > 0.1 * expected)])
    return [f'cable "{seen.cables[0].name}" becomes slack: from t = {since:.3g} s on {GROWS}, '
            f"and errors may become {float(f'{expected / allowed:.1g}'):.0f} times what is allowed: a run with "
            f"{'larger steps' if fixed else '10 tol'} is {apart[-1]:.2g} m away at t = {until:.3g} s. Give "
            f"estimate=True, which measures them, or a smaller {'step' if fixed else 'tol'}, or more damping"]
