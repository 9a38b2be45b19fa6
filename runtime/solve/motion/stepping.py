"""A run in steps to times given one after the other, with inputs given in between."""

from __future__ import annotations

import math
import weakref
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ...base.interruptions import interruptible
from ...base.stages import StageClock
from ...engine import SteppedEngine
from ...errors import SceneError
from ...model.breakpoints import driving_signals
from ...model.model import Model
from ...parts.inputs import Held, Input, Term, terms_of
from ...parts.scene_data import SceneData
from ...parts.settings import SMALLEST_STEP, RunSettings
from ...parts.validation import show
from ..linear.threads import one_blas_thread
from .event_handler import EventHandler
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
AT_ONCE = 1e-12
"""Of the duration: distance of equal times, as in engine/equations/run.h."""


class _Driven(NamedTuple):
    """A signal of a model that inputs give: its number, its terms, whether it drives a motion."""

    number: int
    terms: list[Term]
    drives: bool


class Snapshot(NamedTuple):
    """All that a simulation is at a time: the engine, its events, inputs, and the place in its sequence of steps."""

    image: Any
    settings: RunSettings
    status: str
    happened: list[dict[str, Any]]
    first_times: dict[str, float]
    stopped_by: str | None
    values: dict[int, tuple[float, float, float]]
    changed: set[int]
    sequence: tuple[float, float, int]


class Stepping:
    """The run of a scene in steps.

    status: "running", or that of a run which has ended before its time; messages: on the scene and the start; reason:
    for the integrator.
    """

    def __init__(self, scene: SceneData, settings: RunSettings, initial: Start | None, inputs: Iterable[Input],
                 known_end: bool):
        """scene: checked, in the axes of the model; inputs: of `with_inputs`; known_end: whether it pauses as a run of
        the duration in settings does, with whose bits it then agrees.
        """
        self.scene, self.settings = scene, settings
        clock = StageClock(of_thread=False)
        begin = clock.wall
        with interruptible():
            method, self.reason = settled(scene, settings, initial)
            ready = prepared(scene, settings, initial, SteppedEngine)
            self.messages = messages_before(scene, settings, ready, initial)
            capacity = max(MIN_ROWS, min(MAX_ROWS, MAX_ROWS_BYTES // ready.engine.row_bytes))
            blocks = row_blocks(int(np.ceil(settings.duration / settings.output_step)) + 1, ready.engine.row_bytes)
            self._set_up = clock.wall - begin
            self._run = begun(scene, settings, ready, method, blocks, ProgressDisplay(), None, clock,
                              capacity=capacity)
            self.messages += messages_at_start(scene, settings, self._run, initial)
        self._begin, self._clock, self._method = begin, clock, method
        self.status = self._run.status or "running"
        self._tol = tol_of(settings, scene, method)
        self._row_limit, self._every = capacity - MIN_ROWS + 1, blocks.every if known_end else 0
        self._sequence = 0.0, settings.output_step, 0
        self._inputs = self._driven_by(inputs)
        self._values = {id(each.held): (0.0, each.held.start, 0.0) for each in inputs}
        self._changed: set[int] = set()
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
        if time > self.settings.duration * (1 + AT_ONCE):
            self._extend(time)
        if self._inputs:
            self._give(time)
        engine = self.engine
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
        if self.status == "rope_left" and self.event_handler.stops_empty(engine.left[0]):
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

    # inputs

    def _driven_by(self, inputs: Iterable[Input]) -> list[_Driven]:
        """Return the signals that inputs give. Raises SceneError for one that acts beside other functions of time."""
        driving = driving_signals(self.model)
        inertial = {drag.signal for drag in self.model.drags if drag.has_inertia}
        found, used = [], set[int]()
        for number, each in enumerate(self.model.signals):
            if each.of is None or each.of.is_known:
                continue
            try:
                terms = list(terms_of(each.of))
            except ValueError as error:
                raise SceneError("simulation", f"an input {error.args[0]}",
                                 "drive other directions by numbers") from None
            used |= {id(term.held) for term in terms}
            found.append(_Driven(number, terms, number in driving or number in inertial))
        for path in (given.path for given in inputs if id(given.held) not in used):
            raise SceneError("simulation", f'nothing depends on the input "{path}"', "leave it out")
        return found

    def is_position(self, held: Held) -> bool:
        """Return whether an input prescribes a position, which cannot jump."""
        return any(term.held is held and term.order == 0 for each in self._inputs if each.drives
                   for term in each.terms)

    def value(self, held: Held) -> float:
        """Return the value of an input at the time reached, or that it will have after the next step."""
        since, value, rate = self._values[id(held)]
        return value + rate * (self.time - since)

    def give(self, held: Held, value: float, rate: float = 0.0) -> None:
        """Give an input a value from now on, and a rate; a position reaches its value at the end of the next step."""
        self._values[id(held)] = self.time, value, rate
        self._changed.add(id(held))

    def _give(self, until: float) -> None:
        """Give the engine's signals the values of inputs for a step; forces and rates may jump."""
        jumps = of_rates = False
        engine, now = self.engine, self.time
        for number, terms, drives in self._inputs:
            if not drives and not any(id(term.held) in self._changed for term in terms):
                continue
            value, rate = engine.signal_at(number)
            made = self._polynomial(terms, drives, value, now, until)
            if made[0] == value and made[1] == rate and not any(id(term.held) in self._changed for term in terms):
                continue
            jumps |= not drives and made[0] != value
            of_rates |= drives and made[1] != rate
            engine.set_signal(number, now, made)
        self._changed.clear()
        if jumps or of_rates:
            try:
                engine.jump(of_rates)
            except ArithmeticError as error:
                raise SceneError("simulation", f"{error} with the inputs at t = {show(now, 's')}") from None

    def _polynomial(self, terms: list[Term], drives: bool, value: float, now: float, until: float) -> list[float]:
        """Return a signal as a polynomial of the time from now on; value: of the signal now."""
        made, target = [0.0, 0.0, 0.0], 0.0
        integrates = any(term.order for term in terms)
        for factor, order, held in terms:
            if held is None:
                target += factor
                continue
            _, given, rate = self._values[id(held)]
            given += rate * (now - self._values[id(held)][0])
            made[order] += factor * given
            made[order + 1] += factor * rate / (order + 1)
        if not drives:
            return [made[0] + target, made[1]]
        if integrates:
            return [value, made[1], made[2]]
        return [value, (made[0] + target - value) / (until - now)]

    def _write_inputs(self) -> None:
        """Write the present polynomials of inputs into the model, from which the engine reads signals anew."""
        for number, _, _ in self._inputs:
            value, rate = self.engine.signal_at(number)
            signal = self.model.signals[number]
            signal.breaks, signal.coefficients = self.time + np.array([0.0, 1.0]), np.zeros((1, 7))
            signal.coefficients[0, :2] = value, rate

    # states

    def snapshot(self) -> Snapshot:
        """Return all that it is now."""
        handler = self.event_handler
        return Snapshot(self.engine.image(), self.settings, self.status, [*handler.happened],
                        dict(self.model.signals.happened), handler.stopped_by, dict(self._values), set(self._changed),
                        self._sequence)

    def return_to(self, kept: Snapshot) -> None:
        """Return to what it was, with the same bits."""
        handler = self.event_handler
        self.engine.take_image(kept.image)
        self.settings, self.status, handler.stopped_by = kept.settings, kept.status, kept.stopped_by
        handler.happened[:] = kept.happened
        self.model.signals.return_to(kept.first_times)
        self._values, self._changed, self._sequence = dict(kept.values), set(kept.changed), kept.sequence

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
