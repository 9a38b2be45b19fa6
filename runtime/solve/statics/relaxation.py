"""Dynamic relaxation: a scene moves, and is damped, until it rests.

The damping is kinetic (Cundall 1976; Barnes 1999): whenever the kinetic energy has passed a maximum, all velocities are
set to zero. No parameter of it depends on the scene. Between two resets the scene moves by generalised-alpha of
spectral radius 0, whose steps remove the vibrations that they do not resolve. Steps grow while a motion takes many of
them. If the energy rises from one reset to the next, steps were too long: the search returns to the state before, with
shorter steps. Near rest Newton's method finds the state to rounding, and its stability is checked.
"""

from __future__ import annotations

import logging
import warnings
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

import numpy as np

from ...checks.plausibility import implausible
from ...engine import Engine
from ...errors import EquilibriumError, FunicularWarning
from ...integrators import GeneralisedAlpha
from ...model.loads import DeadLoadModel
from ...model.redundant_constraints import drop_redundant_rows
from ...parts.scene_data import SceneData
from ...parts.settings import EquilibriumSettings, RelaxationSettings
from ..notes.diagnosis import describe_dof
from ..notes.row_notes import rest_notes
from .rest_state import Relaxation, RestState
from .stability import PUSH_SIZE, Stability, push_off, stability
from .static_problem import StaticProblem, static_model
from .turned_rest import turned_rest

LOG = logging.getLogger(__name__)

S = TypeVar("S", bound=RestState)

FIRST_TIME_STEP = 1e-3
"""First step, as a fraction of the time of a free fall over the scene's size."""
MAX_TIME_STEP = 100.0
"""Longest step, as a multiple of the same time."""
MIN_TIME_STEP = 1e-10
"""Shortest step, as a fraction of the same time: a scene that needs shorter ones does not come to rest."""
STEP_REVIEW_INTERVAL = 40
"""Steps between two reviews of the step size while the kinetic energy passes no maximum."""
ENERGY_MAXIMUM_RATIO = 0.7
"""The kinetic energy has passed its maximum if it falls below this fraction of its largest value."""
MANY_STEPS, SOME_STEPS = 12, 6
"""Steps up to a maximum of the kinetic energy after which steps become longer."""
STEP_GROWTH, SLOW_STEP_GROWTH, DOUBLE_STEP_GROWTH = 2.0, 1.2, 4.0
"""Growth of the step size after many steps, after some, and if no maximum was reached."""
REJECTED_STEP_RATIO, FAILED_STEP_RATIO = 0.25, 0.125
"""Ratio of the step size to that of a step in which the energy has risen, and of a step that failed."""
ENERGY_ROUNDING = 1e-12
"""Rounding error of an energy, as a fraction of it."""
NEWTON_RESIDUAL = 1e-2
"""Residual force at which Newton's method is tried, as a fraction of the largest load; each failure reduces it to a
third."""
NEWTON_RESIDUAL_AFTER_PUSH = 1e-6
"""The same while the scene is close to an unstable state that it was pushed off."""
MIN_DISTANCE_AFTER_PUSH = 10.0
"""Distance from an unstable state, as a multiple of the push, below which Newton's method would lead back to it."""
MAX_NEWTON_MOVE = 0.1
"""Largest move of Newton's method to the same state of rest, as a fraction of the scene's size."""
MAX_PUSHES = 5
DEFAULT_GRAVITY = 9.81
"""Gravity in m/s² of scenes without gravity, for the time above."""


class _PassedError(Exception):
    """The kinetic energy has passed a maximum."""


@dataclass
class _NoEvents:
    """Watches no events but those of couplings, which the engine handles."""

    event_functions: list[Any] = field(default_factory=list)

    def acts(self, which: int, what: str, time: float, passed: bool, s: float | None) -> None:
        """Ignore an event of a coupling."""

    def slack_event(self, cable: int, what: str, time: float, element: int) -> None:
        """Ignore that a cable becomes slack or taut."""


@dataclass
class _Place:
    """A state with zero velocities: configuration, arc-lengths, energy in J."""

    q: np.ndarray
    s: np.ndarray
    energy: float


@dataclass
class _Leg:
    """A part of the motion: how it ended, its number of steps, its first state, whether that was at rest."""

    status: str
    steps: int
    begin: _Place
    from_rest: bool
    engine: Engine


class _Motion:
    """The damped motion of a scene; `model.q`, `model.v` and the slides of the model hold its state."""

    def __init__(self, scene: SceneData, problem: StaticProblem):
        self.problem, self.model = problem, static_model(scene)
        self.model.v[:] = 0.0
        self.free = self.model.unknown_of_dof >= 0
        self.units = np.where(problem.weight > 0, problem.weight, np.inf)
        self.largest_load = float(np.max(np.abs(problem.load_vector() / self.units), initial=0.0)) or 1.0
        self.has_energy = not (any(not isinstance(load, DeadLoadModel) for load in self.model.loads) or self.model.drags
                               or self.model.ices or any(contact.friction for contact in self.model.contacts)
                               or any(branch.limit for branch in self.model.branches))
        for curve in self.model.working_curves:
            curve.remembers = False
        self.time = float(np.sqrt(problem.size / (np.linalg.norm(scene.gravity) or DEFAULT_GRAVITY)))
        self.step = FIRST_TIME_STEP * self.time
        self.report = Relaxation()

    def over_unknowns(self, dofs: np.ndarray) -> np.ndarray:
        """Return dofs (n_dof,) as unknowns (n,); those that supports combine are left out."""
        found = np.zeros(self.problem.mass.shape[0])
        found[self.model.unknown_of_dof[self.free]] = dofs[self.free]
        return found

    def kinetic_energy(self, v: np.ndarray) -> float:
        """Return the kinetic energy of velocities in J, with the mass as drawn."""
        x = self.over_unknowns(v)
        return 0.5 * float(x @ (self.problem.mass @ x))

    def force(self, acceleration: np.ndarray) -> np.ndarray:
        """Return the forces (n,) on the unknowns in N at accelerations (n_dof,) from rest."""
        return np.asarray(np.abs(self.problem.mass @ self.over_unknowns(acceleration)) / self.units)

    def energy(self, rows: dict[str, np.ndarray], q: np.ndarray) -> float:
        """Return the energy of a first row in J: elastic, of weight, and of loads of constant direction."""
        energy = float(rows["elastic"][0] + rows["potential"][0])
        for load in self.model.loads:
            if isinstance(load, DeadLoadModel):
                scale = 1.0 if load.signal < 0 else self.model.signals[load.signal].at(0.0)
                energy -= scale * float(np.dot(load.values, q[load.dofs]))
        return energy

    def put(self, q: np.ndarray, s: np.ndarray, v: np.ndarray | None = None) -> None:
        """Go to a configuration, at rest or with velocities."""
        self.model.q[:], self.model.v[:] = q, 0.0 if v is None else v
        self.model.place_slides(s)

    def leg(self) -> _Leg:
        """Move until the kinetic energy has passed a maximum, or for `STEP_REVIEW_INTERVAL` steps."""
        engine = Engine(self.model)
        drop_redundant_rows(self.model, engine)
        engine.handle_events(_NoEvents())
        start, duration = (self.model.q.copy(), self.model.v.copy()), STEP_REVIEW_INTERVAL * self.step
        status, _ = engine.start(duration=duration, output_step=duration, tol=1e-2, step=self.step,
                                 method=GeneralisedAlpha(0.0), first_step=self.step)
        s, largest, steps = engine.now()[3], 0.0, 0

        def seen(_time: float) -> None:
            nonlocal largest, steps
            steps += 1
            now = self.kinetic_energy(engine.now()[2])
            largest = max(largest, now)
            if now < ENERGY_MAXIMUM_RATIO * largest:
                raise _PassedError

        if status is None:
            try:
                status = engine.advance(seen, interval=0.0)
            except _PassedError:
                status = "passed"
        if status == "interrupted":
            raise KeyboardInterrupt
        self.report.steps += engine.statistics["steps"]
        return _Leg(status, steps, _Place(start[0], s, np.nan), not np.any(start[1]), engine)

    def go_on(self, leg: _Leg, last: _Place | None) -> None:
        """Choose the next step, and return to a state at rest where this one failed; set velocities to zero at a
        maximum.
        """
        _, q, v, s = leg.engine.now()
        match leg.status:
            case "passed":
                self.put(q, s)
                self.report.resets += 1
                self.step *= (STEP_GROWTH if leg.steps > MANY_STEPS
                              else SLOW_STEP_GROWTH if leg.steps >= SOME_STEPS else 1.0)
            case "completed":
                self.put(q, s, v)
                self.step *= DOUBLE_STEP_GROWTH
            case _:
                begin = last or leg.begin
                self.put(begin.q, begin.s)
                self.step *= FAILED_STEP_RATIO
        self.step = min(self.step, MAX_TIME_STEP * self.time)


def relax(scene: SceneData, settings: RelaxationSettings, made: type[S]) -> S:
    """Return the scene at rest under gravity, its constant loads and its springs, reached by a damped motion as drawn.

    made: the class of the state. Raises EquilibriumError, which keeps the state reached.
    """
    search = _Search(scene, settings, made)
    state = search.found()
    for message in search.problem.messages:
        warnings.warn(message, FunicularWarning, stacklevel=3)
    state.check_stable()
    return state


class _Search(Generic[S]):
    """A damped motion to rest; each state with zero velocities is assessed."""

    def __init__(self, scene: SceneData, settings: RelaxationSettings, made: type[S]):
        self.settings, self.made = settings, made
        self.problem = StaticProblem(scene, EquilibriumSettings(), {})
        self.motion = _Motion(scene, self.problem)
        if self.problem.turns.fraction < 1.0:
            self._turn()
        self.sticking = [f'"{part.given_name}"' for part in scene.rubbing if part.friction and part.friction.sliding]
        self.last: _Place | None = None
        self.near, self.pushes, self.force = NEWTON_RESIDUAL, 0, np.zeros(0)
        self.branch: dict[str, np.ndarray] | None = None

    def _turn(self) -> None:
        """Follow prescribed angles without loads, before the motion begins."""
        problem = self.problem
        problem.load(0.0)
        found = turned_rest(problem)
        problem.load(1.0)
        if found is None:
            why = f"{problem.turns}; {problem.turns.lost}" if problem.turns.lost else str(problem.turns)
            raise EquilibriumError(f"the scene did not come to rest without loads, where the motion begins: {why}",
                                   self.made.of(problem, stability(problem)), 0.0)
        turned = problem.keep()
        self.motion.put(turned["q"], turned["s"])

    def found(self) -> S:
        """Return the state at rest, or raise EquilibriumError."""
        motion = self.motion
        while motion.report.steps < self.settings.max_steps and motion.step > MIN_TIME_STEP * motion.time:
            leg = motion.leg()
            rows = leg.engine.rows()
            if leg.from_rest and len(rows["acceleration"]):
                self.force, here = motion.force(rows["acceleration"][0]), leg.begin
                here.energy = motion.energy(rows, here.q)
                if (self.last and motion.has_energy
                        and here.energy > self.last.energy + ENERGY_ROUNDING * abs(self.last.energy)):
                    motion.step *= REJECTED_STEP_RATIO
                    motion.put(self.last.q, self.last.s)
                    continue
                self.last = here
                found = self._rest_at(here)
                if found is not None:
                    return found
                if self.last is None:  # pushed off a state that is unstable
                    continue
            motion.go_on(leg, self.last)
        raise self._not_at_rest()

    def _rest_at(self, here: _Place) -> S | None:
        """Return the state at rest at or near a place; None where the motion has to go on."""
        problem, left = self.problem, float(np.max(self.force, initial=0.0)) / self.motion.largest_load
        self.motion.report.note(here.energy, left * self.motion.largest_load)
        if self.sticking:  # Newton's method leaves friction out, and would move the state
            return self._as_it_is(here) if left <= self.settings.tol else None
        if not (left <= self.near and (left <= NEWTON_RESIDUAL_AFTER_PUSH or self._is_away(here))):
            return None
        self._go_to(here)
        kept = problem.keep()
        if not (problem.newton() and problem.distance(kept) <= MAX_NEWTON_MOVE * problem.size):
            self.near /= 3.0
            return self._as_it_is(here) if left <= self.settings.tol else None
        found = stability(problem)
        if found.unstable and self.pushes < MAX_PUSHES:
            self._push()
            return None
        if self.pushes:
            problem.messages.append("the scene came to rest on an unstable branch and was pushed off it; nothing says "
                                    "to which side, so that there may be more such states")
        if found.unstable or not found.known:
            problem.messages.append(f"the state is {found}")
        return self._reported(found)

    def _push(self) -> None:
        """Move the scene off an unstable state along its lowest direction, and forget the last place."""
        problem = self.problem
        self.pushes, self.branch = self.pushes + 1, problem.keep()
        push_off(problem)
        pushed = problem.keep()
        self.motion.put(pushed["q"], pushed["s"])
        self.last = None

    def _is_away(self, here: _Place) -> bool:
        """Return whether a place is far from the unstable state that the scene was pushed off, if any."""
        self.problem.engine.set_state(0.0, q=here.q, s=here.s)
        return (self.branch is None
                or self.problem.distance(self.branch) > MIN_DISTANCE_AFTER_PUSH * PUSH_SIZE * self.problem.size)

    def _go_to(self, here: _Place) -> None:
        """Put the static problem into a place, with the forces of slides, joints and springs that leave the least
        residual on nodes and bodies, in the least squares. Slides may bear forces along their cables, by friction.
        """
        problem = self.problem
        problem.engine.set_state(0.0, q=here.q, s=here.s)
        tangent, residual = problem.tangent().tocsr(), problem.residual()
        forces = np.setdiff1d(np.arange(tangent.shape[0]), problem.coordinates)
        rows = problem.coordinates[problem.coordinates < problem.model.n_band + problem.model.n_border_dof]
        if len(forces):
            change = np.zeros(tangent.shape[0])
            change[forces] = np.linalg.lstsq(tangent[rows][:, forces].toarray(), -residual[rows], rcond=None)[0]
            problem.engine.move(change)

    def _as_it_is(self, here: _Place) -> S:
        """Return a state of rest to the tolerance: with friction, or one that Newton's method does not find."""
        self._go_to(here)
        found = stability(self.problem)
        if off := self.problem.off_sheaves():
            raise EquilibriumError(f"the scene came to rest where {off}; the state is kept in .state",
                                   self.made.of(self.problem, found), 1.0)
        if self.sticking:
            message = (f"friction of {' and '.join(self.sticking)} has part in this state, which is one of many: where "
                       "it stops depends on how the motion is damped")
            found = Stability(0, 0, known=False) if found.unstable else found
        else:
            doubt = f"; it is {found}" if found.unstable or not found.known else ""
            message = f"Newton's method does not find this state to rounding: forces are left over{doubt}"
        self.problem.messages.append(message)
        state = self._reported(found)
        state.residual = self.motion.report.residuals[-1]
        return state

    def _reported(self, found: Stability) -> S:
        """Return the problem's state with its messages."""
        problem, report = self.problem, self.motion.report
        state = self.made.of(problem, found)
        state.relaxation = report
        problem.messages += rest_notes(problem.scene, problem.model, problem.engine, state.static_state,
                                       state.couplings)
        LOG.info("relaxation: %d steps, %d resets, %.3g N left over", report.steps, report.resets, state.residual)
        state.messages = [str(report), *problem.messages, *implausible(problem.scene)]
        return state

    def _not_at_rest(self) -> EquilibriumError:
        """Return the error of a scene that has not come to rest, with the place that is farthest from it."""
        problem, model, report = self.problem, self.motion.model, self.motion.report
        if self.last:
            problem.engine.set_state(0.0, q=self.last.q, s=self.last.s)
        state = self.made.of(problem, stability(problem))
        state.relaxation = report
        where = ""
        if np.any(self.force):
            most = int(np.argmax(self.force))
            dof = int(np.flatnonzero(model.unknown_of_dof == most)[0])
            where = (f"; {describe_dof(model, dof)} is farthest from rest, {self.force[most]:.3g} N are left over "
                     "there")
        why = (f"after {report.steps} steps" if report.steps >= self.settings.max_steps else
               "where steps that are shorter do not help either")
        return EquilibriumError(f"the scene did not come to rest, {why}{where}: something may be free to move away or "
                                "to run off its cable; take more max_steps, or a larger tol; the state is kept in "
                                ".state", state, 1.0)
