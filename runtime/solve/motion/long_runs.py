"""Runs of very many steps: their expected number and end at the present rate, and the cause."""

from __future__ import annotations

import time
import warnings
from collections import deque

from ...base.interruptions import interruptible
from ...engine import Engine
from ...errors import FunicularWarning
from ...integrators import INTEGRATORS, stable_at
from ...model.model import Model
from ...parts.settings import RunSettings
from ..notes.diagnosis import damping, describe_dof
from .event_handler import EventHandler
from .integrator_choice import fastest_rates
from .progress import ProgressDisplay

MANY_STEPS_LIMIT = 1_000_000
"""Number of steps above which a run reports it."""
MIN_STEPS_FOR_PREDICTION = 2000
"""Steps before the first prediction of their number: the first steps are short."""
RATE_WINDOW = 4.0
"""Wall time in s over which rates are averaged."""
FREQUENT_EVENT_RATE = 0.02
"""Events or node passages per step above which they determine the step size."""
HIGH_REJECTION_RATE = 0.3
"""Rejected steps per step above which they determine the number of steps."""
STABILITY_LIMIT_FRACTION = 0.3
"""Steps longer than this fraction of the stability limit are limited by stability."""


class LongRun:
    """Observes the steps of a run; a call with the time reached in s updates the progress display."""

    def __init__(self, model: Model, engine: Engine, settings: RunSettings, event_handler: EventHandler,
                 progress: ProgressDisplay):
        self._model, self._engine, self._settings = model, engine, settings
        self._events, self._progress = event_handler, progress
        self._marks: deque[tuple[float, float, int]] = deque([(time.monotonic(), engine.time, self._steps)])
        self._warned = False

    @property
    def is_shown(self) -> bool:
        """Return whether the progress is shown."""
        return self._progress.is_shown

    def __call__(self, reached: float) -> None:
        """Show the progress; for a long run also its rate and end, and once a warning with the cause."""
        if self._progress.is_shown:
            with interruptible():
                self._progress(reached)
        now, steps = time.monotonic(), self._engine.n_steps
        self._marks.append((now, reached, steps))
        if steps < MIN_STEPS_FOR_PREDICTION:
            return
        while len(self._marks) > 2 and now - self._marks[1][0] > RATE_WINDOW:
            self._marks.popleft()
        since, start, before = self._marks[0]
        made = steps - before
        if made < MIN_STEPS_FOR_PREDICTION or reached <= start or now <= since:
            return
        more = (self._settings.duration - reached) * made / (reached - start)
        if steps + more <= MANY_STEPS_LIMIT:
            return
        rate = made / (now - since)
        self._progress.describe(f"{steps:.3g} of about {steps + more:.2g} steps, {rate:.2g} a second, "
                         f"{_duration(more / rate)} left")
        if not self._warned:
            self._warned = True
            warnings.warn(f"the run needs about {steps + more:.2g} steps, {_duration(more / rate)} at the "
                          f"present rate of {rate:.2g} a second: {self._why()}", FunicularWarning, stacklevel=7)

    def notes(self) -> list[str]:
        """Return for the report the number of steps of a long run, and the cause; empty for other runs."""
        if self._steps > MANY_STEPS_LIMIT:
            return [f"the run took {self._steps:.3g} steps: {self._why()}"]
        if self._warned and self._engine.time < self._settings.duration:
            return [f"the run took {self._steps:.3g} steps to t = {self._engine.time:.3g} s of "
                    f"{self._settings.duration:.3g} s: {self._why()}"]
        return []

    @property
    def _steps(self) -> int:
        return self._engine.n_steps

    def _why(self) -> str:
        """Return the cause of the step size, and the remedy."""
        engine, settings, counts = self._engine, self._settings, self._engine.statistics
        mean = engine.time / max(counts["steps"], 1)
        if settings.step is not None:
            return f"the step is fixed at {settings.step:.3g} s. Take a larger one, or none, so that tol chooses it"
        if settings.output_step < 2 * mean:
            return f"a step ends at each output time. Take an output_step larger than {settings.output_step:.3g} s"
        if self._engine.breakpoints_passed > FREQUENT_EVENT_RATE * counts["steps"]:
            passed = self._engine.breakpoints_passed
            return (f"a step ends at each of the {passed} breakpoints of signals so far. Give tables "
                    'fewer samples, or interpolation="cubic"')
        events = len(self._events.happened) + counts["element_crossings"]
        if events > FREQUENT_EVENT_RATE * counts["steps"]:
            return (f"there were {events} events and node passages in {counts['steps']} steps, and a step ends "
                    "at each. Look at the slides that stick, strike or cross nodes")
        _, dof, coupling = engine.failure  # of the last step that was rejected
        where = f", most of all at {describe_dof(self._model, dof, coupling)}" if counts["rejected_steps"] else ""
        damped = damping(self._model, max(dof, 0), coupling)
        if counts["rejected_steps"] > HIGH_REJECTION_RATE * counts["steps"]:
            return (f"{counts['rejected_steps']} steps were rejected beside {counts['steps']} taken{where}: forces "
                    f"change within a step, as at contacts and kinks of friction. Take a larger tol{damped}")
        frequency, decay = self._fastest()
        stability = INTEGRATORS[engine.integrator].stability
        if stability is not None and stability.part(mean, frequency, decay) > STABILITY_LIMIT_FRACTION:
            return (f"stability asks the {engine.integrator} method for steps of {mean:.2g} s: the highest frequency "
                    f"is {frequency:.3g} rad/s, the fastest decay {decay:.3g} 1/s. Take "
                    f'integrator="{stable_at(fixed_step=False).name}"'
                    + ", or fewer, longer elements" * bool(self._model.cables))
        return (f"tol = {settings.tol:g} asks for steps of {mean:.2g} s, for vibrations of about {1 / mean:.2g} rad/s"
                f"{where} (the highest frequency is {frequency:.3g} rad/s). Take a larger tol{damped}, or a less stiff "
                "part there")

    def _fastest(self) -> tuple[float, float]:
        """Return the highest frequency in rad/s and rate of decay in 1/s of the state at the start."""
        return fastest_rates(self._model, Engine(self._model))


def _duration(seconds: float) -> str:
    """Return a duration as text, such as 3.2 min."""
    for unit, name in ((86400, "days"), (3600, "h"), (60, "min")):
        if seconds >= unit:
            return f"{seconds / unit:.2g} {name}"
    return f"{seconds:.2g} s"
