"""Separate estimates of the errors of the steps and of the mesh of a run, by two more runs.

The first one has smaller steps: its distance from the run is the error of the steps. The second one has these steps and
elements of half the length, and wraps of ropes with friction twice the zones: its distance from the first is the error
of the mesh, less the error of the finer mesh, which is a half of it at order 1 and a sixteenth at order 4. Wraps that
cannot have twice the zones have half of them, whose error is the larger one.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

from ..errors import FunicularError, FunicularWarning
from ..parts.cable import Cable
from ..parts.part import Part
from ..parts.rope import Rope
from ..parts.rope_items import MAX_ZONES
from ..parts.scene_data import SceneData
from ..parts.settings import RunSettings
from .run import Run
from .trajectories import default_outputs, relative, trajectory

S = TypeVar("S", bound=SceneData)

TOLERANCE_RATIO = 0.1
"""Tolerance of the reference runs over that of the run."""
STEP_RATIO = 0.25
"""Fixed step of the reference runs over that of the run."""


@dataclass
class ErrorEstimate:
    """Errors of a run over the largest motion, at its output times, as by `funicular bench`.

    time: of the steps, on the same mesh; mesh: of the mesh, against elements of half the length; both: of the run
    against smaller steps on the finer mesh; nan if unknown, which `messages` explain; outputs: the compared outputs;
    cpu_s: CPU time of the two runs in s.
    """

    time: float = np.nan
    mesh: float = np.nan
    both: float = np.nan
    outputs: tuple[str, ...] = ()
    cpu_s: float = 0.0
    messages: list[str] = field(default_factory=list)

    def as_report(self) -> dict[str, Any]:
        """Return the errors for the report."""
        return {"time": self.time, "mesh": self.mesh, "both": self.both, "outputs": list(self.outputs),
                "cpu_s": self.cpu_s}


def error_estimate(scene: S, run: Run, settings: RunSettings, from_a_state: bool,
                   again: Callable[[S, dict[str, Any]], Run]) -> ErrorEstimate:
    """Return the errors of a completed run of a scene, by two more runs.

    settings: of the run; from_a_state: whether it started from a given state; again: runs a scene with some settings
    changed.
    """
    found = ErrorEstimate(outputs=tuple(default_outputs(scene)))
    begin = time.process_time()
    steps = {"tol": TOLERANCE_RATIO * settings.tol} if settings.step is None else {"step": STEP_RATIO * settings.step}
    motion = _motion(scene, run, found.outputs)
    tight = _try(found, "steps", lambda: scene, lambda other: again(other, steps))
    if tight is not None:
        found.time = relative(scene, motion, tight)
        found.messages += _beyond(found.time, settings)
    if not found.outputs:
        found.time = np.nan
        found.messages.append("the errors are not estimated: the scene has no body, cable or slide by whose motion "
                              "they are measured")
    elif not scene.cables and not scene.ropes:
        found.mesh, found.both = 0.0, found.time
    elif from_a_state:
        found.messages.append("the error of the mesh is not estimated: the state that the run starts from is of this "
                              "mesh alone")
    elif tight is not None:
        finer = _try(found, "mesh", lambda: scene.with_parts(map(_finer, scene.parts())),
                     lambda other: again(other, steps))
        if finer is not None:
            found.mesh, found.both = relative(scene, tight, finer), relative(scene, motion, finer)
            if halved := [name for rope in scene.ropes.values() for name in rope.zones_halved]:
                found.messages.append(f"the error of the zones of {', '.join(halved)} is estimated by half of them, as "
                                      f"twice exceeds {MAX_ZONES}: it is that of the half, and too large")
    for what in ("time", "mesh", "both"):
        if np.isinf(getattr(found, what)):
            setattr(found, what, np.nan)
            found.messages.append(f'the error "{what}" is not estimated: nothing moves by more than rounding')
    found.cpu_s = time.process_time() - begin
    return found


def _finer(part: Part) -> Part:
    """Return a cable or a rope with elements of half the length, and other zones, see `Rope.refined`."""
    if isinstance(part, Cable):
        return part.remade(part.mesh_entries(2 * part.elements))
    return part.refined() if isinstance(part, Rope) else part


def _beyond(error: float, settings: RunSettings) -> list[str]:
    """Return a note if the error of the steps exceeds tol times the motion."""
    if settings.step is not None or settings.quantities or settings.absolute_tol or not error > settings.tol:
        return []
    return [f"the error of the steps is {error:.2g} of the largest motion, more than tol = {settings.tol:g}: take a "
            "smaller one"]


def _try(found: ErrorEstimate, what: str, make: Callable[[], S],
         again: Callable[[S], Run]) -> dict[str, np.ndarray] | None:
    """Return the motion of a run of the scene that `make` returns; None after a failure, with a message."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FunicularWarning)  # notes of the run itself
            scene = make()
            run = again(scene)
    except FunicularError as error:
        found.messages.append(f"the error of the {what} is not estimated: {error}")
        return None
    return _motion(scene, run, found.outputs)


def _motion(scene: SceneData, run: Run, outputs: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Return the trajectories (time, components) of outputs of a run."""
    return {name: trajectory(scene, run, name) for name in outputs}
