"""A simulation: the run of a scene in steps, with inputs and results in between."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..base.interruptions import uninterrupted
from ..errors import SceneError, near
from ..model.breakpoints import INSTANT_TOLERANCE
from ..parts.inputs import Input
from ..parts.scene_data import SceneData
from ..parts.settings import RunSettings
from ..parts.validation import number, show, shown
from ..solve.linear.threads import one_blas_thread
from ..solve.motion.run import Start
from ..solve.motion.stepping import Snapshot, Stepping
from .quantities import ComputedWhenRead, labelled
from .recording import coordinates, named, recorded
from .run import ReadScene, Run, SceneText, raise_where_stopped

WHERE = "simulation"


class State:
    """The state of a simulation at a time, for `Simulation.state` of the same one."""

    def __init__(self, of: Simulation, time: float, kept: Snapshot):
        self._of, self.time, self._kept = of, time, kept

    def __repr__(self) -> str:
        """Return the time of the state."""
        return f"<state of a funicular.Simulation at {self.time:.6g} s>"


class Simulation:
    """A scene that is simulated in steps: inputs are given and results are read in between, see `Scene.simulation`.

    ``sim["A.position"]`` is a result at the time reached, as in a row of a `Run`, ``sim["push.value.x"] = 3.0`` gives
    an input, ``sim.step(0.01)`` continues for 0.01 s, ``sim.run()`` to the end; ``sim.state`` is kept, and returned to.
    """

    def __init__(self, scene: SceneData, flat: SceneData, settings: RunSettings, initial: Start | None,
                 inputs: Mapping[str, Input], known_end: bool, read_scene: ReadScene):
        """scene: of the inputs, checked; flat: in the axes of its plane; known_end: whether the duration is one given.
        """
        self._scene, self._flat, self._known_end = scene, flat, known_end
        self._inputs = {path: k for k, path in enumerate(inputs)}
        self._text = SceneText(scene, read_scene, scene.libraries)
        with uninterrupted(), one_blas_thread:
            self._stepping = Stepping(flat, settings, initial, list(inputs.values()), known_end)
        self._read_scene = read_scene
        self._row: Run | None = None
        self._raise_where_stopped()

    @property
    def time(self) -> float:
        """Return the time reached, s."""
        return self._stepping.time

    @property
    def status(self) -> str:
        """Return "running", or "event" after one that stops it."""
        return self._stepping.status

    @property
    def events(self) -> list[dict[str, Any]]:
        """Return the events so far, see `Run.events`."""
        return [*self._stepping.event_handler.happened]

    @property
    def messages(self) -> list[str]:
        """Return the messages on the scene and the start, and the notes on all rows so far."""
        return [*self._scene.messages, *self._stepping.simulated().messages]

    @property
    def inputs(self) -> dict[str, float]:
        """Return the values of the inputs by path, in the units of the scene."""
        return {path: self._stepping.engine.input_value(k) for path, k in self._inputs.items()}

    @property
    def integrator(self) -> str:
        """Return the name of the integrator."""
        return self._stepping.engine.integrator

    def step(self, length: float | None = None) -> None:
        """Continue for ``length`` s, by default the output_step; the integrator chooses its own steps within.

        The last one ends there. Results are those of `Scene.run` at equal times, bit for bit where ``length`` is its
        output_step. Where an event stops the scene, ``status`` is "event" and ``time`` that of the event. Raises
        SceneError after such an end; EndOfCableError, RopeLeftError and ConvergenceError, as `Scene.run` does.
        """
        stepping = self._stepping
        if stepping.status != "running":
            raise SceneError(WHERE, f"has ended at t = {show(self.time, 's')}: {self._why()}",
                             "return to a state before, or begin anew")
        if length is None:
            length = stepping.settings.output_step
        elif not isinstance(length, float) or not 0.0 < length < np.inf:
            length = _length(length)
        self._row = None
        stepping.step(length)
        if stepping.status != "running":
            self._raise_where_stopped()

    def run(self, duration: float | None = None) -> Run:
        """Continue in steps of output_step to the end; return the run from here on, its first row the state now.

        duration: the time of the end, s, by default that of the scene or of `Scene.simulation`.
        """
        stepping = self._stepping
        if duration is None and not self._known_end:
            raise SceneError(WHERE, "has no known end", "give run(duration=...), or a duration to simulation()")
        end = stepping.settings.duration if duration is None else _length(duration)
        if not end > self.time:
            raise SceneError(WHERE, f"has reached t = {show(self.time, 's')} already, and the end is "
                             f"{show(end, 's')}", "give a later duration")
        rows, recorded_rows = [stepping.engine.last_row()], stepping.engine.n_rows
        while stepping.status == "running" and self.time < end:
            length = stepping.settings.output_step
            if self.time + length < end * (1 + INSTANT_TOLERANCE):
                stepping.step(length)
            else:
                stepping.reach(end)
            if stepping.engine.n_rows > recorded_rows:  # an event may stop a run at a row
                rows.append(stepping.engine.last_row())
                recorded_rows = stepping.engine.n_rows
        self._row = None
        run = self._run_of(rows)
        raise_where_stopped(run)
        return run

    def __getitem__(self, name: str) -> np.ndarray:
        """Return a result at the time reached, an array without the time of a run's; or the value of an input."""
        if name in self._inputs:
            return np.asarray(self._stepping.engine.input_value(self._inputs[name]))
        if name == "time":
            return np.asarray(self.time)
        found: np.ndarray = self._now()[name][0]
        return found

    def __setitem__(self, name: str, value: float) -> None:
        """Give an input a value, see `set`."""
        self.set(name, value)

    def __contains__(self, name: object) -> bool:
        """Return whether there is a result or an input of this name."""
        return name in self._inputs or name in self._now()

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of results."""
        return iter(self.keys())

    def keys(self) -> list[str]:
        """Return the names of all results."""
        return self._now().keys()

    def set(self, name: str, value: float, rate: float = 0.0) -> None:
        """Give an input a value from now on, in its unit; rate: with which it goes on, 1/s.

        Forces, torques and velocities of drives jump to the value. A position, such as the angle of a joint, moves to
        it over the next step with a constant velocity, and takes no rate. The work of inputs is in ``energy.external``.
        Raises SceneError.
        """
        if name not in self._inputs:
            raise SceneError(WHERE, f'"{name}" is no input', near(str(name), self._inputs) if self._inputs
                             else f'there are none: give inputs=["{name}"] to simulation()')
        k = self._inputs[name]
        value, rate = _finite(f'input "{name}"', value), _finite(f'rate of "{name}"', rate)
        if rate and self._stepping.engine.is_position(k):
            raise SceneError(WHERE, f'"{name}" is a position, which moves to its value over the next step',
                             "leave the rate out, or take a velocity as the input")
        self._stepping.engine.set_input(k, value, rate)

    @property
    def state(self) -> State:
        """The state now; assigned, the simulation returns to one that was kept, with the same bits from there on."""
        return State(self, self.time, self._stepping.snapshot())

    @state.setter
    def state(self, kept: State) -> None:
        if not isinstance(kept, State) or kept._of is not self:
            raise SceneError(WHERE, f"{shown(kept)} is no state of this simulation", "give one of its states")
        self._stepping.return_to(kept._kept)
        self._row = None

    def __repr__(self) -> str:
        """Return the time, status and inputs."""
        given = "".join(f", {path} = {value:.6g}" for path, value in self.inputs.items())
        return f"<funicular.Simulation: {self.status} at {self.time:.6g} s{given}>"

    def _now(self) -> Run:
        """Return the last row as a run."""
        if self._row is None:
            model, rows = self._stepping.model, self._stepping.engine.last_row()
            variables = ComputedWhenRead(lambda part: labelled(named(model, self._flat, rows, part)))
            self._row = Run(variables, coordinates(model, rows["time"]), {}, self._text)
        return self._row

    def _run_of(self, rows: list[dict[str, np.ndarray]]) -> Run:
        """Return a run with these rows."""
        stepping = self._stepping
        simulated = stepping.simulated()
        if simulated.status == "running":
            simulated = replace(simulated, status="completed")
        recording = recorded(simulated, self._flat, stepping.settings)
        joined = {name: np.concatenate([row[name] for row in rows]) for name in rows[0]}
        recording = replace(recording, rows=joined, coords=coordinates(stepping.model, joined["time"]))
        return Run.from_recording(recording, self._scene, stepping.settings, self._read_scene)

    def _why(self) -> str:
        stopped = self._stepping.event_handler.stopped_by
        return f"stopped by {stopped}" if stopped is not None else self.status.replace("_", " ")

    def _raise_where_stopped(self) -> None:
        """Raise the error of a run that cannot continue."""
        if self.status not in ("running", "event"):
            raise_where_stopped(self._run_of([self._stepping.engine.last_row()]))


def _length(value: Any) -> float:
    """Return a time in s. Raises SceneError."""
    found = _finite("a time", value)
    if not found > 0.0:
        raise SceneError(WHERE, f"a time must be positive, got {show(found, 's')}")
    return found


def _finite(what: str, value: Any) -> float:
    """Return a finite number. Raises SceneError."""
    try:
        return number(value.item() if isinstance(value, np.ndarray | np.generic) else value)
    except ValueError as error:
        raise SceneError(WHERE, f"{what} {error.args[0]}") from None
