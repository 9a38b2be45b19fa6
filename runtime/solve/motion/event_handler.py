"""The event functions of a scene's events in the engine, and the events that a run reports."""

from __future__ import annotations

from bisect import insort
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ...base.interruptions import interruptible
from ...checks.placement import AXES
from ...errors import SceneError, near
from ...model.middle_strain import middle_strain
from ...model.model import CableModel, Model
from ...model.rope_states import rope_state
from ...model.rope_wheels import DrumModel
from ...model.states import body_rates, body_state, spatial
from ...model.taut_ropes import TautPointModel
from ...parts.event import Event
from ...parts.scene_data import SceneData
from ..notes.diagnosis import EMPTY

LEAVES_TABLE_TEXT = "leaves the table of its fluid"
"""Text of the engine's event (engine/events/fluid_table.c)."""


class EventFunction:
    """The event function of an event: kind, index, value, direction.

    kind: "q" or "v" with the index of an entry; "s", "s_rate", "traction" with the number of a slide among the
    couplings; "function".
    """

    def __init__(self, event: Event, scene: SceneData, model: Model):
        self.event, self.value = event, event.value
        self.direction = {"rising": 1, "falling": -1, "both": 0}[event.direction]
        if event.function is not None:
            self.kind, self.index = "function", 0
            return
        name, what, *axis = _quantity(event).split(".")
        if what == "least_strain":
            self.kind, self.index = "function", 0
            return
        if name in scene.slides:
            slide = model.slides[list(scene.slides).index(name)]
            self.kind, self.index = what, [c is slide for c in model.couplings].index(True)
            return
        of = "configuration" if what == "position" else "dof"
        self.kind = "q" if what == "position" else "v"
        if name in scene.bodies and np.any(getattr(scene.bodies[name], "centre", 0.0)):
            self.kind, self.index = "function", 0  # the engine has the mass centre alone, not the body's origin
            return
        if name in scene.bodies:
            start = getattr(model.bodies[list(scene.bodies).index(name)], of)
        else:
            assert event.s is not None, f"{event.where} is not complete"
            start = model.nodes[name][scene.cables[name].node(event.s)].dofs("r")[0]
        self.index = start + AXES.index(axis[0])


def _quantity(event: Event) -> str:
    assert event.quantity is not None, f"{event.where} has a function"
    return event.quantity


class State:
    """Quantities at one instant, by the names of results: positions, velocities, nodal vectors, s."""

    def __init__(self, model: Model, q: np.ndarray, v: np.ndarray, s: np.ndarray):
        """q (n_q,), v (n_dof,), s (slides,): the engine's state."""
        self._model, self._q, self._v, self._s = model, q, v, s

    def __getitem__(self, name: str) -> np.ndarray | float:
        """Return position, orientation, velocity, angular_velocity of a body (3 or 4,); nodal_vectors, nodal_velocity
        of a cable (nodes, vectors, 3); s of a slide; position (points, 3) and s (points,) of a rope, along the ground's
        axes. Raises KeyError.
        """
        of, _, quantity = name.partition(".")
        found = self._model.results(of, self._all(of))
        if quantity not in found:
            raise KeyError(f'the state has no "{name}"; {near(quantity, found) if found else "known: "}'
                           + ("" if found else ", ".join(self.names())))
        return found[quantity]

    def strained(self, cable: CableModel) -> np.ndarray:
        """Return (1, nodes, vectors, 3): `CableModel.strained` of a cable."""
        return spatial(cable.strained(self._q[None]))

    def names(self) -> list[str]:
        """Return the bodies, cables, ropes and slides with quantities in the state."""
        model = self._model
        return [*(body.name for body in model.bodies), *(cable.name for cable in model.cables),
                *(rope.part.name for rope in model.ropes if rope.part.mass), *(slide.name for slide in model.slides)]

    def _all(self, name: str) -> dict[str, Any]:
        model = self._model
        for body in model.bodies:
            if body.name == name:
                state = body_state(model, body, self._q[None])
                state |= body_rates(model, body, state["orientation"], self._v[None])
                return {name: values[0] for name, values in state.items()}
        for cable in model.cables:
            if cable.name == name:
                return {"nodal_vectors": spatial(cable.nodal(self._q)),
                        "nodal_velocity": spatial(cable.nodal(self._v))}
        for rope in model.ropes:
            if rope.part.name == name and rope.part.mass:
                return {key: values[0] for key, values in rope_state(model, rope, self._q[None]).items()}
        slides = [slide.name for slide in model.slides]
        return {"s": float(self._s[slides.index(name)])} if name in slides else {}


class EventHandler:
    """The events of a run: the callbacks of the engine, and the list of events."""

    def __init__(self, scene: SceneData, model: Model):
        self.model = model
        self.event_functions = [EventFunction(event, scene, model) for event in scene.events.values()]
        self.happened: list[dict[str, Any]] = []
        self.change_signals: Callable[[bool], None] | None = None  # by events, see `switch`
        self.stopped_by: str | None = None

    def call(self, which: int, time: float, q: np.ndarray, v: np.ndarray, s: np.ndarray) -> float:
        """Return the function of an event at a state. Raises SceneError where it fails or gives no number."""
        event = self.event_functions[which].event
        try:
            with interruptible():
                value = float((event.function or self._of_quantity(event))(time, State(self.model, q, v, s)))
        except Exception as error:
            raise SceneError(event.where, f"its function failed at t = {time:.6g} s: {type(error).__name__}: {error}",
                             "it gets (time, state) and must give a number") from error
        if not np.isfinite(value):
            raise SceneError(event.where, f"its function gave {value} at t = {time:.6g} s", "it must give a number")
        return value

    def _of_quantity(self, event: Event) -> Callable[[float, State], float]:
        """Return the function of a threshold on a body's origin, or on the smallest strain of a cable."""
        name, axis = _quantity(event).rsplit(".", 1)
        if axis == "least_strain":
            cable = next(cable for cable in self.model.cables if cable.name == name)
            return lambda time, state: middle_strain(cable, state.strained(cable)).min() - event.value
        return lambda time, state: np.asarray(state[name])[AXES.index(axis)] - event.value

    def acts(self, which: int, what: str, time: float, passed: bool, s: float | None) -> None:
        """Record an event of the coupling with this number, such as sticking or an impact on an end stop.

        An event without a text, such as a corner of a table, is not reported. passed: it lies within a step; s: of a
        slide, in m.
        """
        if not what:
            return
        happened: dict[str, Any] = {"name": self.model.couplings[which].name, "time": time, "what": what}
        if passed:
            happened["passed"] = True
        self._note(happened if s is None else happened | {"s": s})

    def slack_event(self, cable: int, what: str, time: float, element: int) -> None:
        """Record that the first element of a cable has become slack, or that the last one is taut again; element: its
        number.
        """
        self._note({"name": self.model.cables[cable].name, "time": time, "what": what, "element": element,
                    "passed": True})

    def _note(self, happened: dict[str, Any]) -> None:
        """Insert an event by its time: events within a step are reported at its end, out of order."""
        insort(self.happened, happened, key=lambda each: each["time"])

    def notes(self) -> list[str]:
        """Return a message for each drag that has left the table of its fluid."""
        first: dict[str, float] = {}
        for happened in self.happened:
            if happened.get("what") == LEAVES_TABLE_TEXT:
                first.setdefault(happened["name"], happened["time"])
        return [f'drag "{name}" leaves the table of its fluid at t = {time:.6g} s: beyond the edges the velocity stays '
                "as it is there; take a larger table" for name, time in first.items()]

    def stops_empty(self, number: int, reason: int) -> bool:
        """Return whether a rope's coupling with this number, which the rope has left for a reason, is a drum that has
        run empty and whose end stops the run; record that it did.
        """
        drum = self.model.couplings[number]
        if reason != EMPTY or not isinstance(drum, DrumModel | TautPointModel) or drum.ends_run_by != "stop":
            return False
        self.stopped_by = f'drum "{drum.name}", which has run empty,'
        return True

    def happens(self, which: int, time: float, q: np.ndarray, v: np.ndarray, s: np.ndarray) -> bool:
        """Record an event; return whether the run continues."""
        event, state = self.event_functions[which].event, State(self.model, q, v, s)
        at = {f"{body.name}.{k}": np.asarray(state[f"{body.name}.{k}"]).tolist() for body in self.model.bodies
              for k in ("position", "velocity")}
        at |= {f"{slide.name}.s": state[f"{slide.name}.s"] for slide in self.model.slides}
        self._note({"name": event.name, "time": time, "state": at})
        if event.action == "stop":
            self.stopped_by = f'event "{event.name}"'
            return False
        self.switch(event.where, {event.name or "": time}, restarts=True)
        return True

    def switch(self, where: str, events: Mapping[str, float], *, restarts: bool) -> None:
        """Begin and end loads and friction with events, which have happened at these times in s; restarts: now."""
        changed = [self.model.signals.switch(name, time) for name, time in events.items()]
        if any(changed) and self.change_signals is not None:
            try:
                self.change_signals(restarts)
            except ArithmeticError as error:
                raise SceneError(where, f"{error} with the loads and the friction from there on",
                                 "look at coefficients of friction") from None
