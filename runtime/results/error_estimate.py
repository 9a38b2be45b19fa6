"""How far a run is off: the error of its steps and that of its mesh, apart, from two more runs.

The first one has smaller steps: its distance from the run is the error of the steps. The second has these steps and
elements half as long: its distance from the first is the error of the mesh, but for the error that the finer mesh has
itself, which is the smaller the higher the order: half of the error where the order is 1, a sixteenth where it is 4.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import FunicularError, FunicularWarning
from ..parts.cable import Cable
from ..parts.part import Part
from ..parts.scene_data import SceneData
from ..parts.settings import RunSettings
from .run import Run
from .trajectories import default_outputs, relative, trajectory

TIGHTER = 0.1
"""Tolerance of the runs that are compared with, over that of the run."""

SHORTER = 0.25
"""Fixed step of the runs that are compared with, over that of the run."""


@dataclass
class ErrorEstimate:
    """Errors of a run over the largest motion, at its output times, as `funicular bench` has them.

    time: of its steps, on its mesh; mesh: of its mesh, against elements half as long; both: of the run against smaller
    steps on the finer mesh; nan where one could not be told, which `messages` explain; outputs: what is compared;
    cpu_s: CPU seconds that the two runs took.
    """

    time: float = np.nan
    mesh: float = np.nan
    both: float = np.nan
    outputs: tuple[str, ...] = ()
    cpu_s: float = 0.0
    messages: list[str] = field(default_factory=list)

    def as_report(self) -> dict[str, Any]:
        """Return the errors as a report holds them."""
        return {"time": self.time, "mesh": self.mesh, "both": self.both, "outputs": list(self.outputs),
                "cpu_s": self.cpu_s}


def error_estimate(scene: SceneData, run: Run, settings: RunSettings, from_a_state: bool,
                   again: Callable[[Iterable[Part], dict[str, Any]], Run]) -> ErrorEstimate:
    """Return the errors of a completed run of a scene, by two more runs.

    settings: those of the run; from_a_state: whether it started from a state that was given to it; again: runs a scene
    of these parts with other settings, by name, and the others as they were.
    """
    found = ErrorEstimate(outputs=tuple(default_outputs(scene)))
    begin = time.process_time()
    steps = {"tol": TIGHTER * settings.tol} if settings.step is None else {"step": SHORTER * settings.step}
    motion = _motion(scene, run, found.outputs)
    tight = _try(found, "steps", lambda: again(scene.parts(), steps))
    if tight is not None:
        found.time = relative(scene, motion, tight)
    if not scene.cables:
        found.mesh, found.both = 0.0, found.time
    elif from_a_state:
        found.messages.append("the error of the mesh is not estimated: the state that the run starts from is of this "
                              "mesh alone")
    elif tight is not None:
        finer = _try(found, "mesh", lambda: again(halved(scene.parts()), steps))
        if finer is not None:
            found.mesh, found.both = relative(scene, tight, finer), relative(scene, motion, finer)
    found.cpu_s = time.process_time() - begin
    return found


def halved(parts: Iterable[Part]) -> Iterator[Part]:
    """Yield the parts, cables with every element halved."""
    for part in parts:
        yield Cable(**part.entries() | {"elements": 2 * part.elements}) if isinstance(part, Cable) else part


def _try(found: ErrorEstimate, what: str, again: Callable[[], Run]) -> dict[str, np.ndarray] | None:
    """Return the motion of another run; None where that fails, with a message."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FunicularWarning)  # the run itself gives these notes
            run = again()
    except FunicularError as error:
        found.messages.append(f"the error of the {what} is not estimated: {error}")
        return None
    return _motion(run.scene, run, found.outputs)


def _motion(scene: SceneData, run: Run, outputs: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Return the trajectories (time, components) of outputs of a run."""
    return {name: trajectory(scene, run, name) for name in outputs}
