"""The state of rest of a scene under its loads, found at once, in load steps, or along the path of equilibria.

A state at the load fraction p is at rest under p times all loads (static_problem.py); a scene drawn with stress first
comes to rest without them.
"""

from __future__ import annotations

import logging
import warnings
from typing import Generic, TypeVar

from ...checks.plausibility import implausible
from ...checks.whole_scene import check_impending, check_sticking
from ...errors import EquilibriumError, FunicularWarning
from ...model.drag_forces import outside_tables
from ...parts.rope import driven_freely, rough_sheaves, running_round
from ...parts.scene_data import SceneData
from ...parts.settings import EquilibriumSettings
from ..notes.row_notes import rest_notes
from .held_wraps import HeldWraps
from .lying import left, lying, not_held
from .path_following import Critical, Point, follow
from .rest_state import CriticalPoint, RestState
from .spinning_sections import spinning
from .stability import stability
from .starts import fitted, on_mesh
from .static_problem import StaticProblem
from .turned_rest import turned_rest

LOG = logging.getLogger(__name__)

S = TypeVar("S", bound=RestState)

MIN_FRICTION_STEP = 1e-2
"""Steps of the friction of ropes below this fraction of its limit are not taken."""
MIN_LOAD_STEP = 1e-3
"""The search ends if load steps of this fraction do not converge."""
POSITIONING_LOAD = 1e-3
"""Load fraction that moves unloaded free parts to their positions."""
POSITION_ROUNDING = 1e-9
"""Rounding error of positions, as a fraction of the scene's size."""


def equilibrium(scene: SceneData, settings: EquilibriumSettings, start: RestState | None, made: type[S]) -> S:
    """Return the scene at rest under gravity, its loads at t = 0 and its springs.

    start: a state to begin from, also of another mesh, else as drawn; made: the class of the states. Raises SceneError,
    EquilibriumError.
    """
    if settings.impending is not None:
        check_impending(scene, settings.impending)
    if settings.sticks:
        check_sticking(scene)
    search, reached = _searched(scene, settings, start, made)
    problem, state = search.problem, search.found
    note(problem, state)
    if reached < 1.0:
        remedy = ('; take method="newton", which goes on to any stable state, or draw the scene nearer to its rest'
                  if settings.method == "arc_length" else
                  "; smaller steps of the load do not converge either: something may be free to move away, or it is a "
                  'limit point, which method="arc_length" passes; or take more load_steps or max_iterations')
        if problem.turns.fraction < 1.0:
            remedy = f"; {problem.turns}" + (f"; {problem.turns.lost}" if problem.turns.lost else remedy)
        if not settings.sticks and (driven := driven_freely(scene.ropes.values())):
            remedy = (f"; friction of ropes is left out at rest, so that sheave {' and '.join(driven)} turns freely "
                      'under its torque; take wraps="stick", prescribe its angle, or leave the torque out')
        if not settings.sticks and (closed := running_round(scene.ropes.values())):
            remedy = (f"; friction of ropes is left out at rest, so that rope {' and '.join(closed)} runs round freely"
                      f'; take wraps="stick"{remedy}')
        if slides := not_held(problem, lying(problem.scene, problem.model, problem.model.q)):
            remedy = f"; {slides}{remedy}"
        at_limit = "" if settings.impending is None else f' with ropes at the limit of friction, "{settings.impending}"'
        if search.slid is not None:
            remedy = (f"; from the state without friction this was raised to {100 * search.slid:.3g} % of its limit"
                      f"{remedy}")
        raise EquilibriumError(
            f"no equilibrium was reached{at_limit}: the path from the drawn state ends at {100 * reached:.4g} % of the "
            f"load{remedy}{problem.cause()}; the state there is kept in .state", state, reached)
    if scene.ropes:
        problem.restore(state.static_state)
    if search.wraps is not None and (cause := search.wraps.causes()):
        raise EquilibriumError(f"ropes do not stick to their sheaves at rest: {cause} is kept in .state", state,
                               reached)
    if scene.ropes and (off := problem.off_sheaves()):
        raise EquilibriumError(f"the state found is not one of rest: {off}; the state is kept in .state", state,
                               reached)
    if settings.seek_stable and settings.method == "newton" and state.unstable_directions:
        problem.restore(state.static_state)
        state.check_stable(problem.cause() or spinning(problem))
    return state


def _searched(scene: SceneData, settings: EquilibriumSettings, start: RestState | None, made: type[S]
              ) -> tuple[_Search[S], float]:
    """Return the search and the fraction of the load that it reached.

    The state with friction of ropes at its limit is sought from that without friction, then from the drawn state.
    """
    search = _Search(_begun(scene, settings, start), made)
    if settings.method == "arc_length":
        return search, search.along_path(start)
    if settings.sticks:
        return search, search.sticking()
    if settings.impending is None:
        return search, search.in_steps()
    search.problem.impend(0.0)
    slid = slide_to_limit(search.problem) if search.in_steps() == 1.0 else None
    if slid == 1.0:
        search.path = []
        search.remember(made.of(search.problem, stability(search.problem)))
        return search, 1.0
    search = _Search(_begun(scene, settings, start), made)
    search.slid = slid
    return search, search.in_steps()


def _begun(scene: SceneData, settings: EquilibriumSettings, start: RestState | None) -> StaticProblem:
    """Return the problem at the state to begin from."""
    problem = StaticProblem(scene, settings, {} if start is None else start.turned)
    if start is not None:
        problem.restore(fitted(on_mesh(start.static_state, start.model, problem.model, problem.keep()), problem.model))
    return problem


def slide_to_limit(problem: StaticProblem) -> float:
    """Raise the friction of ropes from none to its limit, in steps from state to state; return the fraction reached."""
    reached, step = 0.0, 1.0
    while reached < 1.0:
        kept, target = problem.keep(), min(1.0, reached + step)
        problem.impend(target)
        if problem.newton():
            reached, step = target, 2 * step
            continue
        problem.restore(kept)
        step = 0.5 * (target - reached)
        if step < MIN_FRICTION_STEP:
            break
    return reached


def note(problem: StaticProblem, state: RestState) -> None:
    """Complete a state's messages; what a user must know is a warning, too."""
    scene = problem.scene
    for parts, what in (([f'"{name}"' for name, slide in scene.slides.items() if slide.friction is not None], "slides"),
                        ([f'"{name}"' for name, joint in scene.joints.items() if joint.friction is not None], "joints"),
                        ([contact.where for contact in scene.contacts.values()
                          if contact.friction_coefficient and not (
                              contact.has_friction_spring and contact.a not in scene.ropes)], "contacts"),
                        ([] if problem.settings.has_friction else rough_sheaves(scene.ropes.values()), "ropes")):
        if parts:
            problem.messages.append(f"friction of {' and '.join(parts)} is left out: at rest {what} move freely")
    problem.messages += rest_notes(problem.scene, problem.model, problem.engine, state.static_state, state.couplings)
    problem.messages += outside_tables(problem.model, state.static_state["q"])
    if not state.stable:
        leaves = "; a small disturbance leaves it" * state.stability.known
        problem.messages.append(f"the state is {state.stability}{leaves}")
    LOG.info("equilibrium: load fraction %g after %d iterations, residual %.3g N", state.load_fraction,
             state.iterations, state.residual)
    if state.load_fraction == 1.0:
        problem.messages += left(problem, lying(problem.scene, problem.model, problem.model.q))
    state.messages = problem.messages + implausible(problem.scene)
    for message in problem.messages:
        warnings.warn(message, FunicularWarning, stacklevel=4)


class _Search(Generic[S]):
    """The states of rest found so far, and the searches for the next ones; the last one is `state`."""

    def __init__(self, problem: StaticProblem, made: type[S]):
        self.problem, self.made = problem, made
        self.state: S | None = None
        self.path: list[S] = []
        self.critical: list[CriticalPoint] = []
        self.wraps: HeldWraps | None = None  # of ropes that stick
        self.slid: float | None = None  # the fraction of the friction of ropes reached before, None without any

    @property
    def found(self) -> S:
        """Return the last state of the search."""
        assert self.state is not None, "no state was sought yet"
        return self.state

    def remember(self, state: S) -> None:
        """Add a state to the path."""
        self.state = state
        self.path.append(state)
        state.path, state.critical_points = list(self.path), list(self.critical)

    def in_steps(self) -> float:
        """Take load steps, halved where no state of rest is found; return the fraction of the load reached.

        A single step seeks the state of rest under all loads at once.
        """
        problem, steps = self.problem, self.problem.settings.load_steps
        begin, reached, step = problem.keep(), 0.0, 1.0 / steps
        if steps == 1:
            if (found := turned_rest(problem)) is not None:
                self.remember(self.made.of(problem, found))
                return 1.0
            step = 0.5
            problem.restore(begin)
            if problem.turns.lost:
                self.state = self.made.of(problem, stability(problem))
                return 0.0
        if not self.without_loads():
            return 0.0
        largest = step
        while reached < 1.0:
            kept, target = problem.keep(), reached + step
            if target > 1.0 - MIN_LOAD_STEP / 2:  # a sum of steps is not 1 to the last digit
                target = 1.0
            problem.load(target)
            if (found := turned_rest(problem)) is not None:
                reached, step = target, min(2 * step, largest)
                self.remember(self.made.of(problem, found))
                continue
            problem.restore(kept)
            problem.load(reached)
            step = 0.5 * (target - reached)
            if step < MIN_LOAD_STEP:
                break
        return reached

    def sticking(self) -> float:
        """Do the same with ropes that stick to their sheaves, then with points that slide at the limit of friction."""
        self.wraps = HeldWraps(self.problem)
        if (reached := self.in_steps()) < 1.0:
            return reached
        if self.wraps.settle():
            self.path.pop()
            self.remember(self.made.of(self.problem, stability(self.problem)))
        return reached

    def without_loads(self) -> bool:
        """Bring the static state to rest without loads; return whether that was found."""
        problem = self.problem
        drawn = problem.keep()
        problem.load(0.0)
        found = turned_rest(problem)
        if found is None:
            problem.restore(drawn)
        self.state = self.made.of(problem, found or stability(problem))
        problem.begin = problem.keep()["q"]
        moved = problem.distance(drawn)
        if found is not None and moved > POSITION_ROUNDING * problem.size:
            what = "loads" if problem.settings.scale_gravity else "loads, under its weight"
            problem.messages.append(f"the scene is drawn with stress: it first came to rest without {what}, which "
                                    f"moved points by up to {moved:.3g} m")
        return found is not None

    def lightly_loaded(self) -> float:
        """Begin the path at a small load, which positions parts that are free without loads; return its fraction."""
        problem = self.problem
        free = problem.keep()
        problem.load(POSITIONING_LOAD)
        if (found := turned_rest(problem)) is None:
            problem.restore(free)
            problem.load(0.0)
            return 0.0
        self.remember(self.made.of(problem, found))
        problem.messages.append("without loads something is free to move: the path begins at "
                                f"{100 * POSITIONING_LOAD:g} % of them")
        return POSITIONING_LOAD

    def along_path(self, start: RestState | None) -> float:
        """Follow the path from rest without loads, or from a state of rest on it; return the fraction of the load
        reached.
        """
        problem = self.problem
        if start is None or start.load_fraction >= 1.0:
            reached, heading = 0.0, None
            if not self.without_loads():
                return reached
            if self.found.neutral_directions:
                reached = self.lightly_loaded()
        else:
            reached, heading = start.load_fraction, start.heading
            problem.load(reached)
            found = problem.newton() if problem.turns.fraction == 1.0 else turned_rest(problem) is not None
            self.state = self.made.of(problem, stability(problem))
            if not found:
                return reached
        for point in follow(problem, reached, heading):
            if isinstance(point, Critical):
                self.critical.append(CriticalPoint(point.point.fraction, point.kind, point.directions,
                                                   self.at(point.point)))
            else:
                self.remember(self.at(point))
                reached = point.fraction
        return min(reached, 1.0)

    def at(self, point: Point) -> S:
        """Return a point of the path as a state."""
        fraction, kept = self.problem.fraction, self.problem.keep()
        self.problem.restore(point.kept)
        self.problem.load(point.fraction)
        state = self.made.of(self.problem, point.stability, point.heading)
        self.problem.restore(kept)
        self.problem.load(fraction)
        return state
