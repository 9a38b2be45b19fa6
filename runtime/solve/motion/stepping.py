"""A run in steps to times given one after the other, with inputs given in between."""

from __future__ import annotations

import math
import weakref
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...base.interruptions import interruptible
from ...base.stages import StageClock
from ...engine import SteppedEngine
from ...errors import SceneError
from ...model.breakpoints import INSTANT_TOLERANCE
from ...model.model import Model
from ...parts.inputs import Input
from ...parts.scene_data import SceneData
from ...parts.settings import SMALLEST_STEP, RunSettings
from ...parts.signal import DEGREE
from ...parts.validation import show
from ..linear.threads import one_blas_thread
from .event_handler import EventHandler
from .inputs import take_inputs
from .integrator_choice import tol_of
from .progress import ProgressDisplay
from .row_stream import row_blocks
from .run import (
    FAILED_STATUSES,
    Simulated,
    Start,
    begun,
    breakpoints_of,
    controlled_alone,
    messages_at_start,
    messages_before,
    prepared,
    result_notes,
    settled,
)

MAX_ROWS, MAX_ROWS_BYTES = 32, 1 << 20
"""Rows that the engine keeps before notes see them, and their bytes."""
MIN_ROWS = 4
SHORTEST = 4.0 * SMALLEST_STEP
"""Of the duration: shortest step that is taken; a run takes instants nearer to each other as one."""


class Snapshot(NamedTuple):
    """All that a simulation is at a time: engine with inputs, events, and the place in its sequence of steps."""

    image: Any
    settings: RunSettings
    status: str
    happened: list[dict[str, Any]]
    first_times: dict[str, float]
    stopped_by: str | None
    sequence: tuple[float, float, int]


class Stepping:
    """The run of a scene in steps.

    status: "running", or that of a run which has ended before its time; messages: on the scene and the start; reason:
    for the integrator.
    """

    def __init__(self, scene: SceneData, settings: RunSettings, initial: Start | None, inputs: Sequence[Input],
                 known_end: bool):
        """scene: checked, in the axes of the model; inputs: of `with_inputs`; known_end: whether it pauses as a run of
        the duration in settings does, with whose bits it then agrees.
        """
        self.scene, self.settings = scene, settings
        clock = StageClock(of_thread=False)
        begin = clock.wall
        with interruptible():
            ready = prepared(scene, settings, initial, SteppedEngine)
            method, self.reason = settled(scene, settings, initial, ready)
            take_inputs(ready.model, ready.engine, inputs, "simulation")
            self.messages = messages_before(scene, settings, ready, initial)
            capacity = max(MIN_ROWS, min(MAX_ROWS, MAX_ROWS_BYTES // ready.engine.row_bytes))
            blocks = row_blocks(settings, ready.engine.row_bytes)
            self._set_up = clock.wall - begin
            self._run = begun(scene, settings, ready, method, blocks, ProgressDisplay(), None, clock,
                              capacity=capacity)
            self.messages += messages_at_start(scene, settings, self._run, initial)
        self._begin, self._clock, self._method = begin, clock, method
        self.status = self._run.status or "running"
        self._tol = tol_of(settings, scene, method)
        self._row_limit, self._every = capacity - MIN_ROWS + 1, blocks.every if known_end else 0
        self._sequence = 0.0, settings.output_step, 0
        self._has_inputs = bool(inputs)
        changed = weakref.proxy(self)
        self.event_handler.change_signals = lambda restarts: changed._change_signals(restarts)

    @property
    def model(self) -> Model:
        """Return the model of the scene."""
        return self._run.model

    @property
    def engine(self) -> SteppedEngine:
        """Return the engine of the run."""
        assert isinstance(self._run.engine, SteppedEngine)
        return self._run.engine

    @property
    def event_handler(self) -> EventHandler:
        """Return the handler of its events."""
        return self._run.event_handler

    @property
    def time(self) -> float:
        """Return the time reached, s."""
        return self.engine.time

    def step(self, length: float) -> None:
        """Step by a length in s, unless the run ends before; status then says why.

        Steps of one length end on its multiples from the first one's start. Raises SceneError.
        """
        begin, last, count = self._sequence
        if length != last:
            begin, count = self.time, 0
        self._sequence = begin, length, count + 1
        target = begin + (count + 1) * length
        if not length > SHORTEST * max(self.settings.duration, target):
            self._sequence = begin, last, count
            raise SceneError("simulation", f"a step of {show(length, 's')} is not above {SHORTEST:g} of the duration "
                             f"{show(max(self.settings.duration, target), 's')}", "take longer steps, or a shorter "
                             "duration")
        self.reach(target)
        is_of_run = begin == 0.0 and length == self.settings.output_step
        if self._every and is_of_run and self.status == "running" and (count + 2) % self._every == 0:
            self.engine.pause()

    def reach(self, time: float) -> None:
        """Step to a time in s, unless the run ends before."""
        if time > self.settings.duration * (1 + INSTANT_TOLERANCE):
            self._extend(time)
        engine = self.engine
        if self._has_inputs:
            try:
                engine.give_inputs(time)
            except ArithmeticError as error:
                raise SceneError("simulation", f"{error} with the inputs at t = {show(self.time, 's')}") from None
        if engine.n_rows_kept >= self._row_limit:
            self._run.row_notes.see(engine)
            engine.take_rows()
        try:
            if engine.needs_lapack:
                with one_blas_thread:
                    self.status = engine.reach(time) or "running"
            else:  # it would take longer than the rest of this function
                self.status = engine.reach(time) or "running"
        except BaseException:
            self._sequence = self.time, math.nan, 0
            raise
        if self.status == "rope_left" and self.event_handler.stops_empty(*engine.left):
            self.status = "event"

    def _extend(self, time: float) -> None:
        """Take a later end."""
        self.settings = self.settings.model_copy(update={"duration": max(2.0 * self.settings.duration, time)})
        try:
            self.engine.extend(self.settings.duration, self._breakpoints())
        except ArithmeticError as error:
            raise SceneError("simulation", f"{error} at t = {show(self.time, 's')}") from None

    def _breakpoints(self) -> tuple[np.ndarray, np.ndarray]:
        return breakpoints_of(self.model, self.settings, self._method, self._tol)

    def _change_signals(self, restarts: bool) -> None:
        """Take the signals that an event has changed, and those of inputs as they are."""
        self._write_inputs()
        self.engine.change_signals(self.model, self._breakpoints(), restarts)

    def _write_inputs(self) -> None:
        """Write the present polynomials of inputs into the model, from which the engine reads signals anew."""
        for number, signal in enumerate(self.model.signals):
            if signal.of is not None and not signal.of.is_known:
                value, rate, second = self.engine.signal_at(number)
                signal.breaks, signal.coefficients = self.time + np.array([0.0, 1.0]), np.zeros((1, DEGREE + 1))
                signal.coefficients[0, :3] = value, rate, second / 2

    # states

    def snapshot(self) -> Snapshot:
        """Return all that it is now."""
        handler = self.event_handler
        return Snapshot(self.engine.image(), self.settings, self.status, [*handler.happened],
                        dict(self.model.signals.happened), handler.stopped_by, self._sequence)

    def return_to(self, kept: Snapshot) -> None:
        """Return to what it was, with the same bits."""
        handler = self.event_handler
        self.engine.take_image(kept.image)
        self.settings, self.status, handler.stopped_by = kept.settings, kept.status, kept.stopped_by
        handler.happened[:] = kept.happened
        self.model.signals.return_to(kept.first_times)
        self._sequence = kept.sequence

    # results

    def simulated(self) -> Simulated:
        """Return its end as that of a run, with the messages so far."""
        run, clock = self._run, self._clock
        run.row_notes.see(self.engine)
        self.engine.take_rows()
        total = clock.wall - self._begin
        messages = [*self.messages, *run.observer.notes(), *run.event_handler.notes(),
                    *controlled_alone(run.engine, self.settings)]
        if self.status not in FAILED_STATUSES:
            messages += result_notes(self.scene, self.settings, run)
        return Simulated(run.model, run.engine, run.event_handler, self.status, messages, self.reason,
                         getattr(self._method, "spectral_radius", None), self._set_up, run.began - self._begin, 0.0,
                         total, clock.cpu)
