"""A run: the integration of a scene's model over time, with its messages and its result."""

from __future__ import annotations

import logging
import math
import warnings
import weakref
from collections.abc import Callable, Container, Sequence
from functools import partial
from typing import Any, NamedTuple, Protocol

import numpy as np

from ...base.deferred import dataclass
from ...base.interruptions import interruptible
from ...base.stages import StageClock, Stages, at_once
from ...checks.plausibility import implausible
from ...checks.velocity_jumps import velocity_jumps
from ...engine import Engine
from ...errors import FunicularWarning, SceneError
from ...integrators import Integrator
from ...model.breakpoints import breakpoints
from ...model.build import build
from ...model.controlled import controlled_weights, counted_weights
from ...model.initial_state import InitialState
from ...model.model import Model
from ...model.redundant_constraints import drop_redundant_rows
from ...parts.event import first_times
from ...parts.inputs import Input
from ...parts.scene_data import SceneData
from ...parts.settings import RunSettings
from ..linear.threads import share_elements
from ..notes.diagnosis import notes, trapped
from ..notes.fast_turns import FastTurns
from ..notes.linear_model_errors import beyond_linear_model
from ..notes.row_notes import RowNotes
from ..notes.sensitivity import Sensitivity, sensitive
from ..notes.signal_steps import unresolved
from ..notes.slack_growth import SlackMotion, grown
from ..notes.uncontrolled_errors import NormalForces, uncontrolled_errors
from .event_handler import EventHandler
from .inputs import take_inputs
from .integrator_choice import Rival, choose, tol_of
from .long_runs import LongRun
from .progress import ProgressDisplay
from .row_stream import RowBlocks, RowStream, row_blocks
from .trial_cache import TrialCache
from .trial_run import next_rival, on_trial

LOG = logging.getLogger(__name__)

FAILED_STATUSES = "no_convergence", "singular", "unstable"
"""Statuses of runs that failed: their message gives the cause, and notes do not assess their results."""

MAX_OUTPUT_BYTES = 4e9
"""Bytes of results that a run may keep in memory."""


class Start(Protocol):
    """A state that a run starts from."""

    @property
    def messages(self) -> list[str]:
        """Return its messages for the report."""

    def start(self, model: Model, scene: SceneData) -> None:
        """Put a freshly built model of the scene into this state. Raises SceneError."""


@dataclass
class Simulated:
    """The end of a run: the engine with its last rows, the status, the reason for the integrator, its spectral radius.

    Wall time: set_up_s until the engine starts, start_s from there to its first step, notes_s of the notes on results
    after its last one, total_s of all; solve_cpu_s: CPU time of the integration in s, without other processes and
    without threads of other scenes.
    """

    model: Model
    engine: Engine
    event_handler: EventHandler
    status: str
    messages: list[str]
    reason: str
    spectral_radius: float | None
    set_up_s: float
    start_s: float
    notes_s: float
    total_s: float
    solve_cpu_s: float


def simulate(scene: SceneData, settings: RunSettings, on_progress: ProgressDisplay, initial: Start | None = None,
             stream: RowStream | None = None, trials: TrialCache | None = None) -> Stages[Simulated]:
    """Integrate a checked scene, in stages; calls on_progress(time reached in s) about twenty times a second.

    initial: a state of this scene to start from; stream: takes the rows as they come, so that the engine keeps only the
    last ones; trials: of other scenes of this shape.
    """
    clock = StageClock(of_thread=settings.threads == 1)
    begin = clock.wall
    with interruptible():
        ready = prepared(scene, settings, initial)
    _check_size(ready.engine.row_bytes, settings, stream)
    blocks = row_blocks(settings, ready.engine.row_bytes)
    messages = messages_before(scene, settings, ready, initial)
    with interruptible():
        choice = choose(settings, scene, ready.model, ready.engine, stream.integrator if stream else None)
    method, reason, rival = choice if trials is None else trials.of(scene, *choice)
    set_up, cpu = clock.wall - begin, clock.cpu
    LOG.info("run of %g s: %d degrees of freedom, %s (%s), set up in %.3g s", settings.duration, ready.model.n_dof,
             method.name, reason, set_up)
    size = 0 if stream else ready.engine.row_bytes * math.ceil(settings.duration / settings.output_step)
    yield from clock.pause(size)
    run = begun(scene, settings, ready, method, blocks, on_progress, stream, clock, on_trial=rival is not None)

    def begun_with(other: Integrator, on_trial: bool) -> Begun:
        anew = prepared(scene, settings, initial)
        return begun(scene, settings, anew, other, blocks, on_progress, stream, clock, on_trial)

    yield from clock.pause(size)
    run, status, method, why = tried(scene, run, method, rival, begun_with, settings, blocks, stream, trials)
    messages += messages_at_start(scene, settings, run, initial)
    started = run.began - begin - set_up
    status = _ended(run, blocks.every, stream) if status in (None, "running") else status
    if status == "interrupted" and stream is not None and not stream.has_begun:  # write a checkpoint to resume from
        run = begun_with(method, on_trial=False)
    messages += run.observer.notes() + _warned(run.event_handler.notes())
    cpu = clock.cpu - cpu
    if status != "interrupted":
        yield from clock.pause(size)
    ended = clock.wall
    run.row_notes.see(run.engine)
    messages += controlled_alone(run.engine, settings)
    if status not in FAILED_STATUSES:
        messages += _warned(result_notes(scene, settings, run, partial(_rows_again, scene, initial, method)))
    noted = clock.wall - ended
    total = clock.wall - begin + (stream.elapsed if stream else 0.0)
    LOG.info("run %s after %.3g s", status.replace("_", " "), total)
    for message in messages:
        LOG.info("run: %s", message)
    return Simulated(run.model, run.engine, run.event_handler, status, messages, reason + why,
                     getattr(method, "spectral_radius", None), set_up, started, noted, total, cpu)


def messages_before(scene: SceneData, settings: RunSettings, ready: Prepared, initial: Start | None) -> list[str]:
    """Return the messages on a scene, its model, and the state to start from."""
    of_state = [] if initial is None else [f"state to start from: {message}" for message in initial.messages]
    return implausible(scene) + ready.messages + of_state + _divided_step(settings)


def messages_at_start(scene: SceneData, settings: RunSettings, run: Begun, initial: Start | None) -> list[str]:
    """Return the messages on the start of a run, after a warning for each."""
    given = initial if isinstance(initial, InitialState) else ()  # a state of rest starts at the scene's velocities
    return run.gaps + _warned([*_broken_velocities(run.model, run.change, given),
                               *velocity_jumps(scene.as_drawn, settings.duration, given),
                               *unresolved(scene.as_drawn, settings)])


def tried(scene: SceneData, run: Begun, method: Integrator, rival: Rival | None,
          begun_with: Callable[[Integrator, bool], Begun], settings: RunSettings, blocks: RowBlocks,
          stream: RowStream | None, trials: TrialCache | None) -> tuple[Begun, str | None, Integrator, str]:
    """Return a run after the trials of its method and of its rivals, its status, its method, and the reasons for it.

    begun_with: returns the run anew with a method, and whether that is on trial.
    """
    status, why = run.status, ""
    lost_trials: list[str] = []
    while rival is not None and status is None:
        status, lost, cost = on_trial(run.engine, rival, method, settings.duration, blocks.every, run.observer, stream)
        if lost:
            if trials is not None:
                trials.note(scene, method, rival)
            lost_trials.append(method.name)
            again = rival.method.name in lost_trials  # its cost has been measured
            after = None if again else next_rival(method, cost, rival)
            method, why, rival = rival.method, f"{why}; {lost}", after
            run = begun_with(method, rival is not None)
            status = run.status
        elif stream is not None:
            stream.settled()
    return run, status, method, why


def result_notes(scene: SceneData, settings: RunSettings, run: Begun,
                 again: Callable[[RunSettings], dict[str, np.ndarray]] | None = None) -> list[str]:
    """Return the notes on the results of a run; again: returns the rows of a second run with other settings, without
    which the growth of slack motions is not measured.
    """
    seen, engine = run.row_notes, run.engine
    unmeasured = [] if settings.estimate else [
        *sensitive(engine, settings, seen[Sensitivity]),
        *([] if again is None else grown(engine, settings, seen[SlackMotion], again)),
        *uncontrolled_errors(scene, engine, settings, seen[FastTurns], seen[NormalForces])]
    return [*notes(engine, settings), *beyond_linear_model(engine, settings), *trapped(scene, engine), *seen.notes(),
            *unmeasured]


def _rows_again(scene: SceneData, initial: Start | None, method: Integrator,
                settings: RunSettings) -> dict[str, np.ndarray]:
    """Return the rows of a second run of a scene with other settings and the same method, without warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)
        second = settings.model_copy(update={"integrator": method.name})
        return at_once(simulate(scene, second, ProgressDisplay(), initial)).engine.rows()


def _warned(messages: list[str]) -> list[str]:
    """Return messages after a warning for each."""
    for message in messages:
        warnings.warn(message, FunicularWarning, stacklevel=7)
    return messages


class Prepared(NamedTuple):
    """The model of a scene, an engine that is not started, the event_handler of its events, the observers of its rows,
    and messages.
    """

    model: Model
    engine: Engine
    event_handler: EventHandler
    row_notes: RowNotes
    messages: list[str]


def prepared(scene: SceneData, settings: RunSettings, initial: Start | None,
             made: type[Engine] | None = None) -> Prepared:
    """Return the model, engine, event_handler and row notes of a run: all that does not belong to its integration.

    made: another class of engines.
    """
    model = build(scene)
    if initial is not None:
        initial.start(model, scene)
    engine, event_handler = (made or Engine)(model), EventHandler(scene, model)
    engine.handle_events(event_handler)
    messages = drop_redundant_rows(model, engine) + share_elements(engine, settings.threads)
    row_notes = RowNotes(scene, model, settings.step_taken or 0.0, settings.duration)
    return Prepared(model, engine, event_handler, row_notes, messages)


class Begun(NamedTuple):
    """A run after its start: the status where it has ended, else None, messages on closed gaps, changes of velocities
    (n_dof,), the observers of its steps and rows, and the time of the clock in s.
    """

    model: Model
    engine: Engine
    event_handler: EventHandler
    status: str | None
    gaps: list[str]
    change: np.ndarray
    observer: LongRun
    row_notes: RowNotes
    began: float


def begun(scene: SceneData, settings: RunSettings, ready: Prepared, method: Integrator, blocks: RowBlocks,
          progress: ProgressDisplay, stream: RowStream | None, clock: StageClock, on_trial: bool = False,
          capacity: int | None = None) -> Begun:
    """Start a prepared run, with its stream; on_trial: it may begin anew with another method; capacity: of the engine
    in rows, by default that of the stream's blocks, or all rows.
    """
    model, engine, event_handler, row_notes, _ = ready
    tol = tol_of(settings, scene, method)
    status, gaps, change = _start(scene, settings, model, engine, method, tol,
                                  capacity if stream is None else blocks.capacity)
    changed = weakref.proxy(engine)  # which has the handler: without a cycle a run that ends is freed at once
    event_handler.change_signals = lambda restarts: changed.change_signals(
        model, breakpoints_of(model, settings, method, tol), restarts)
    if stream is not None and status is None:
        stream.start(model, engine, blocks, event_handler.happened, row_notes, on_trial)
        event_handler.switch("scene", first_times(event_handler.happened), restarts=False)
    observer = LongRun(model, engine, settings, event_handler, progress)
    return Begun(model, engine, event_handler, status, gaps, change, observer, row_notes, clock.wall)


def breakpoints_of(model: Model, settings: RunSettings, method: Integrator,
                   tol: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the instants at which steps of a run end, see `breakpoints`."""
    return breakpoints(model, settings.duration, tol, turns=settings.step is None,
                       nodes=method.order > 2)


def _start(scene: SceneData, settings: RunSettings, model: Model, engine: Engine, method: Integrator, tol: float,
           capacity: int | None) -> tuple[str | None, list[str], np.ndarray]:
    """Start the engine; return the status where the run has ended, else None. Raises SceneError for a singular start.
    """
    status, change = engine.start(**_for_engine(scene, settings, model, engine, method, tol), capacity=capacity)
    if status == "singular" and engine.self_locking >= 0:
        slide = scene.slides[model.couplings[engine.self_locking].name]
        raise SceneError(slide.where, "friction is self-locking at the start: the larger it is, the harder it presses "
                         "the rider on the cable",
                         "take a smaller coefficient, or the rider's point nearer to its centre of mass")
    if status == "singular":
        raise SceneError("scene", "the equations are singular at the start: a mass is zero, or a cable's director lies "
                         "along its tangent", "look at masses and inertias, and at up")
    closed = engine.closed > 1e-9 * engine.extent
    gaps = [f"gaps of joints were closed at the start: things moved by up to {engine.closed:.3g} m"] * closed
    return status, gaps, change


def _for_engine(scene: SceneData, settings: RunSettings, model: Model, engine: Engine, method: Integrator,
                tol: float) -> dict[str, Any]:
    """Return the settings of a run for the engine, which takes a linear model here where the method needs one."""
    if method.is_linear:
        from .linear_model import take_linear_model  # loads SciPy, which other runs do without

        take_linear_model(engine, scene, model)
    return {"duration": settings.duration, "output_step": settings.output_step, "tol": tol,
            "step": settings.step or 0.0, **_control(settings, scene, model), "method": method,
            "first_step": min(settings.output_step, 1e-3 * settings.duration),
            "breakpoints": breakpoints_of(model, settings, method, tol)}


class ReadyRun(NamedTuple):
    """A run before its start: its integrator, the reason for that, and the rows between its pauses."""

    model: Model
    engine: Engine
    event_handler: EventHandler
    method: Integrator
    reason: str
    every: int


def settled(scene: SceneData, settings: RunSettings, initial: Start | None,
            ready: Prepared) -> tuple[Integrator, str]:
    """Return the integrator of a run that is prepared, after trials of its rivals with others as at its start, and the
    reason. Raises SceneError.
    """
    method, reason, rival = choose(settings, scene, ready.model, ready.engine, None)
    if rival is None:
        return method, reason
    blocks, clock = row_blocks(settings, ready.engine.row_bytes), StageClock(of_thread=False)

    def begun_with(other: Integrator, on_trial: bool) -> Begun:
        anew = prepared(scene, settings, initial)
        return begun(scene, settings, anew, other, blocks, ProgressDisplay(), None, clock, on_trial)

    _, _, method, why = tried(scene, begun_with(method, True), method, rival, begun_with, settings, blocks, None, None)
    return method, reason + why


def made_ready(scene: SceneData, settings: RunSettings, initial: Start | None = None, inputs: Sequence[Input] = (),
               like: ReadyRun | None = None) -> ReadyRun:
    """Return a run of a checked scene as `simulate` starts it, with room for one row; inputs: of the scene, of
    `with_inputs`; like: a run of the same scene and settings, whose integrator it takes. Raises SceneError.
    """
    model, engine, event_handler, _, _ = prepared(scene, settings, initial)
    take_inputs(model, engine, inputs, "export")
    blocks = row_blocks(settings, engine.row_bytes)
    if like is None:  # by an engine of its own: the choice leaves numbers in it
        method, reason = settled(scene, settings, initial, prepared(scene, settings, initial))
    else:
        method, reason = like.method, like.reason
    tol = tol_of(settings, scene, method)
    engine.make_ready(**_for_engine(scene, settings, model, engine, method, tol), capacity=1)
    return ReadyRun(model, engine, event_handler, method, reason, blocks.every)


def _control(settings: RunSettings, scene: SceneData, model: Model) -> dict[str, Any]:
    """Return the arguments of the engine on the controlled error and the absolute tolerance; none for a fixed step.

    Raises SceneError for a quantity whose error is not estimated.
    """
    weights: Any = None
    if settings.quantities is not None:
        weights = controlled_weights(settings.quantities, scene, model)
        weights = weights, counted_weights(settings.quantities, weights, scene, model)
    if settings.step is not None:
        return {}
    return {"absolute_tol": -1.0 if settings.absolute_tol is None else settings.absolute_tol, "controlled": weights}


def controlled_alone(engine: Engine, settings: RunSettings) -> list[str]:
    """Return a message on the quantities that the steps control, where the user named some."""
    if settings.quantities is None:
        return []
    named = ", ".join(settings.quantities)
    if settings.step is not None:
        return [f"the step is fixed: no error is controlled, of {named} or else"]
    return [f"steps were chosen by the error of {named} alone, whose largest motion is "
            f"{engine.controlled_motion:.3g} m: other results may be less accurate"]


def _divided_step(settings: RunSettings) -> list[str]:
    """Return a message where a fixed step is made smaller, so that steps end on output times."""
    step = settings.step_taken
    if settings.step is None or step is None or step >= settings.step * (1 - 1e-6):
        return []
    return [f"step {settings.step:.6g} s was made {step:.6g} s, so that steps end on output times"]


def _ended(run: Begun, every: int, stream: RowStream | None) -> str:
    """Return the status where a run ends; a drum that has run empty may stop it as an event does."""
    status = run.engine.advance(run.observer, every, stream, shown=run.observer.is_shown)
    if status == "rope_left" and run.event_handler.stops_empty(*run.engine.left):
        return "event"
    return str(status)


def _broken_velocities(model: Model, change: np.ndarray, given: Container[str]) -> list[str]:
    """Return a message where the start changed velocities (n_dof,), which broke a joint.

    given: names of a state to start from. A rope in space whose rates are not among them starts with those of a rope
    without sag: the start changes them, and those of its bodies a little.
    """
    if not change.any():
        return []
    counted, tolerance = model.weight.copy(), 1e-9  # rates of slopes and turns as those of points
    for rope in model.ropes:
        if rope.part.dim == 3 and f"{rope.part.name}.coordinate_rates" not in given:
            counted[rope.coordinates], tolerance = 0.0, 1e-6
    largest = float(np.max(np.abs(change) * counted, initial=0.0))
    if largest <= tolerance * (1.0 + np.max(np.abs(model.v) * model.weight, initial=0.0)):
        return []
    return [f"initial velocities broke a joint: changed by up to {largest:.3g} m/s to keep it"]


def _check_size(row_bytes: int, settings: RunSettings, stream: RowStream | None) -> None:
    """Raise SceneError for results beyond the memory or, for a stream, beyond its disk."""
    need = row_bytes * settings.duration / settings.output_step
    most, where = (MAX_OUTPUT_BYTES, "") if stream is None else (stream.free, " that are free on the disk")
    if not need < most:
        raise SceneError("run", f"output_step {settings.output_step:.6g} s makes {need:.3g} bytes of results, more "
                         f"than the {most:.3g}{where}", "take a larger output_step")
