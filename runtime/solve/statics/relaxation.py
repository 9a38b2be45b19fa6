"""Dynamic relaxation: a scene moves, and is damped, until it rests.

The damping is kinetic (Cundall 1976; Barnes 1999): whenever the kinetic energy has passed a maximum, all velocities are
set to zero, which needs no number that depends on the scene. Between two resets the scene moves by generalised-alpha of
spectral radius 0, whose steps remove the vibrations that they do not resolve. Steps grow while a motion takes many of
them; where the energy of a scene has risen from one reset to the next, steps were too long: the state before is taken
back, and they become shorter. Near rest Newton's method finds the state to rounding, and its stability is checked.
"""

from __future__ import annotations

import logging
import warnings
from dataclasses import dataclass, field
from typing import Generic, TypeVar

import numpy as np

from ...checks.plausibility import implausible
from ...engine import Engine
from ...errors import EquilibriumError, FunicularWarning
from ...integrators import GeneralisedAlpha
from ...model.loads import DeadLoadModel, LoadModel
from ...model.redundant_constraints import drop_redundant_rows
from ...parts.scene_data import SceneData
from ...parts.settings import EquilibriumSettings, RelaxationSettings
from ..notes.diagnosis import describe_dof
from ..notes.row_notes import rest_notes
from .rest_state import Relaxation, RestState
from .stability import Stability, lowest_direction, stability
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
PUSH_SIZE = 1e-3
"""Size of the push off an unstable branch, as a fraction of the scene's size."""
MAX_PUSHES = 5
DEFAULT_GRAVITY = 9.81
"""Gravity in m/s² of scenes without gravity, for the time above."""


class _PassedError(Exception):
    """The kinetic energy has passed a maximum."""


@dataclass
class _NoEvents:
    """Watches for no events but those of couplings, which act by themselves."""

    watches: list = field(default_factory=list)

    def acts(self, which: int, what: str, time: float, passed: bool, s: float | None) -> None:
        """Do nothing: what sticks and strikes does so in the engine."""

    def gives_way(self, cable: int, what: str, time: float, element: int) -> None:
        """Do nothing: cables become slack and taut as the motion goes on."""


@dataclass
class _Place:
    """Where a scene was when all velocities were zero: configuration, arc-lengths, energy in J."""

    q: np.ndarray
    s: np.ndarray
    energy: float


class _Motion:
    """The damped motion of a scene: `model.q`, `model.v` and slides are where it is; `leg` goes on."""

    def __init__(self, scene: SceneData, problem: StaticProblem):
        self.problem, self.model = problem, static_model(scene)
        self.model.v[:] = 0.0
        unknown = self.model.unknown_of_dof
        self.free = unknown >= 0
        self.unknown = unknown[self.free]
        self.units = np.where(problem.weight > 0, problem.weight, np.inf)
        self.largest_load = float(np.max(np.abs(problem.load_vector() / self.units), initial=0.0))
        self.has_energy = not (any(isinstance(load, LoadModel) for load in self.model.loads) or self.model.drags
                               or any(contact.friction for contact in self.model.contacts))
        self.time = float(np.sqrt(problem.size / (np.linalg.norm(scene.gravity) or DEFAULT_GRAVITY)))
        self.step = FIRST_TIME_STEP * self.time
        self.report = Relaxation()

    def over_unknowns(self, dofs: np.ndarray) -> np.ndarray:
        """Return dofs (n_dof,) as unknowns (n,); those that supports combine are left out."""
        found = np.zeros(self.problem.mass.shape[0])
        found[self.unknown] = dofs[self.free]
        return found

    def kinetic_energy(self, v: np.ndarray) -> float:
        """Return the kinetic energy of velocities in J, with the mass as drawn."""
        x = self.over_unknowns(v)
        return 0.5 * float(x @ (self.problem.mass @ x))

    def force(self, acceleration: np.ndarray) -> np.ndarray:
        """Return the forces (n,) on the unknowns, in N, that accelerations (n_dof,) from rest show."""
        return np.abs(self.problem.mass @ self.over_unknowns(acceleration)) / self.units

    def energy(self, rows: dict[str, np.ndarray], q: np.ndarray) -> float:
        """Return the energy of a first row, in J: elastic, of weight, and of loads of constant direction."""
        energy = float(rows["elastic"][0] + rows["potential"][0])
        for load in self.model.loads:
            if isinstance(load, DeadLoadModel):
                scale = 1.0 if load.signal < 0 else self.model.signals[load.signal].at(0.0)
                energy -= scale * float(np.dot(load.values, q[load.dofs]))
        return energy

    def put(self, q: np.ndarray, s: np.ndarray, v: np.ndarray | None = None) -> None:
        """Go to a configuration, at rest or with velocities."""
        self.model.q[:], self.model.v[:] = q, 0.0 if v is None else v
        for slide, place in zip(self.model.slides, s, strict=True):
            slide.place_at(float(place), self.model.cables[slide.cable])

    def leg(self) -> _Leg:
        """Move until the kinetic energy has passed a maximum, or for `STEP_REVIEW_INTERVAL` steps."""
        engine = Engine(self.model)
        drop_redundant_rows(self.model, engine)
        engine.watch(_NoEvents())
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


@dataclass
class _Leg:
    """A part of the motion: how it ended, after how many steps, where it began, whether at rest."""

    status: str
    steps: int
    begin: _Place
    from_rest: bool
    engine: Engine


def relax(scene: SceneData, settings: RelaxationSettings, made: type[S]) -> S:
    """Return the scene at rest under gravity, its constant loads and its springs, come to by a damped motion as drawn.

    made: what the state is. Raises EquilibriumError, which keeps the state reached.
    """
    state = _Search(scene, settings, made).found()
    state.check_stable()
    return state


class _Search(Generic[S]):
    """A damped motion that is taken to rest, and looked at wherever its velocities have been set to zero."""

    def __init__(self, scene: SceneData, settings: RelaxationSettings, made: type[S]):
        self.settings, self.made = settings, made
        self.problem = StaticProblem(scene, EquilibriumSettings(), {})
        self.motion = _Motion(scene, self.problem)
        if self.problem.turns.fraction < 1.0:
            self._turn()
        self.sticking = [n for n, slide in scene.slides.items() if slide.friction is not None]
        self.last: _Place | None = None
        self.near, self.pushes, self.force = NEWTON_RESIDUAL, 0, np.zeros(0)
        self.branch: dict | None = None

    def _turn(self) -> None:
        """Begin where prescribed angles have been followed, without loads."""
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
            _go_on(motion, leg, self.last)
        raise _not_at_rest(self.problem, motion, self.force, self.last, self.settings, self.made)

    def _rest_at(self, here: _Place) -> S | None:
        """Return the state at rest that a place is, or is near to; None where the motion has to go on."""
        motion, load = self.motion, self.motion.largest_load or 1.0
        left = float(np.max(self.force, initial=0.0)) / load
        motion.report.note(here.energy, left * load)
        if self.sticking:
            return _held(self.problem, motion, here, self.sticking, self.made) if left <= self.settings.tol else None
        if not (left <= self.near
                and (left <= NEWTON_RESIDUAL_AFTER_PUSH or _is_away(self.problem, here, self.branch))):
            return None
        found = _polished(self.problem, here)
        if found is None:
            if left <= self.settings.tol:
                return _unpolished(self.problem, motion, here, self.made)
            self.near /= 3.0
            return None
        if not (found.unstable and self.pushes < MAX_PUSHES):
            return _finished(self.problem, motion, found, self.pushes, self.made)
        self._push()
        return None

    def _push(self) -> None:
        """Move the scene off an unstable state, along its lowest direction, and forget the last place."""
        problem = self.problem
        self.pushes, self.branch = self.pushes + 1, problem.keep()
        problem.move(PUSH_SIZE * problem.size * lowest_direction(problem))
        pushed = problem.keep()
        self.motion.put(pushed["q"], pushed["s"])
        self.last = None


def _go_on(motion: _Motion, leg: _Leg, last: _Place | None) -> None:
    """Choose the next step, and begin anew where this one could not be made; set velocities to zero at a maximum."""
    _, q, v, s = leg.engine.now()
    match leg.status:
        case "passed":
            motion.put(q, s)
            motion.report.resets += 1
            motion.step *= (STEP_GROWTH if leg.steps > MANY_STEPS
                            else SLOW_STEP_GROWTH if leg.steps >= SOME_STEPS else 1.0)
        case "completed":
            motion.put(q, s, v)
            motion.step *= DOUBLE_STEP_GROWTH
        case _:
            motion.put(*((last.q, last.s) if last else (leg.begin.q, leg.begin.s)))
            motion.step *= FAILED_STEP_RATIO
    motion.step = min(motion.step, MAX_TIME_STEP * motion.time)


def _is_away(problem: StaticProblem, here: _Place, branch: dict | None) -> bool:
    """Return whether a place is far from the unstable state that the scene was pushed off, if any."""
    problem.engine.set_state(0.0, q=here.q, s=here.s)
    return branch is None or problem.distance(branch) > MIN_DISTANCE_AFTER_PUSH * PUSH_SIZE * problem.size


def _polished(problem: StaticProblem, here: _Place) -> Stability | None:
    """Bring a state near rest to rest by Newton's method; None where that fails, or leads away."""
    problem.engine.set_state(0.0, q=here.q, s=here.s)
    _share_forces(problem)
    kept = problem.keep()
    if problem.newton() and problem.distance(kept) <= MAX_NEWTON_MOVE * problem.size:
        return stability(problem)
    return None


def _finished(problem: StaticProblem, motion: _Motion, found: Stability, pushes: int, made: type[S]) -> S:
    """Return the state of rest that Newton's method has found."""
    if pushes:
        problem.messages.append("the scene came to rest on an unstable branch and was pushed off it; nothing says to "
                                "which side, so that there may be more such states")
    if found.unstable or not found.known:
        problem.messages.append(f"the state is {found}")
    return _told(problem, motion, found, made)


def _unpolished(problem: StaticProblem, motion: _Motion, here: _Place, made: type[S]) -> S:
    """Return a state of rest to the tolerance, which Newton's method does not find."""
    problem.engine.set_state(0.0, q=here.q, s=here.s)
    _share_forces(problem)
    found = stability(problem)
    doubt = f"; it is {found}" if found.unstable or not found.known else ""
    problem.messages.append(f"Newton's method does not find this state to rounding: forces are left over{doubt}")
    state = _told(problem, motion, found, made)
    state.residual = motion.report.residuals[-1]
    return state


def _held(problem: StaticProblem, motion: _Motion, here: _Place, sticking: list[str], made: type[S]) -> S:
    """Return a state of rest that friction has part in: Newton's method, which leaves friction out, would move it."""
    problem.engine.set_state(0.0, q=here.q, s=here.s)
    _share_forces(problem)
    free = stability(problem)
    names = " and ".join(f'"{name}"' for name in sticking)
    problem.messages.append(f"friction of {names} has part in this state, which is one of many: where it stops depends "
                            "on how the motion is damped")
    state = _told(problem, motion, Stability(0, 0, known=False) if free.unstable else free, made)
    state.residual = motion.report.residuals[-1]
    return state


def _share_forces(problem: StaticProblem) -> None:
    """Give slides, joints and springs the forces that leave the least on nodes and bodies, in the least squares; that
    slides bear nothing along their cables is not asked for: friction does.
    """
    tangent, residual = problem.tangent().tocsr(), problem.residual()
    forces = np.setdiff1d(np.arange(tangent.shape[0]), problem.coordinates)
    rows = problem.coordinates[problem.coordinates < problem.model.n_band + problem.model.n_border_dof]
    change = np.zeros(tangent.shape[0])
    if len(forces):
        change[forces] = np.linalg.lstsq(tangent[rows][:, forces].toarray(), -residual[rows], rcond=None)[0]
        problem.engine.move(change)


def _told(problem: StaticProblem, motion: _Motion, found: Stability, made: type[S]) -> S:
    """Return the problem's state with what is to be said of it; what a user must know is a warning, too."""
    state = made.of(problem, found)
    state.relaxation = motion.report
    problem.messages += rest_notes(problem.scene, problem.model, problem.engine, state.static_state, state.couplings)
    for message in problem.messages:
        warnings.warn(message, FunicularWarning, stacklevel=5)
    LOG.info("relaxation: %d steps, %d resets, %.3g N left over", motion.report.steps, motion.report.resets,
             state.residual)
    state.messages = [str(motion.report), *problem.messages, *implausible(problem.scene)]
    return state


def _not_at_rest(problem: StaticProblem, motion: _Motion, force: np.ndarray, last: _Place | None,
                 settings: RelaxationSettings, made: type[S]) -> EquilibriumError:
    """Return the error of a scene that has not come to rest, which says what is farthest from it."""
    if last:
        problem.engine.set_state(0.0, q=last.q, s=last.s)
    state = made.of(problem, stability(problem))
    state.relaxation = motion.report
    where = ""
    if np.any(force):
        most = int(np.argmax(force))
        dof = int(np.flatnonzero(motion.model.unknown_of_dof == most)[0])
        where = f"; {describe_dof(motion.model, dof)} is farthest from rest, {force[most]:.3g} N are left over there"
    why = (f"after {motion.report.steps} steps" if motion.report.steps >= settings.max_steps else
           "where steps that are shorter do not help either")
    return EquilibriumError(f"the scene did not come to rest, {why}{where}: something may be free to move away or to "
                            "run off its cable; take more max_steps, or a larger tol; the state is kept in .state",
                            state, 1.0)
