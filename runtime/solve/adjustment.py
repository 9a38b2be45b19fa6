"""The search for values of parameters with which the state of rest of a scene has given values.

At rest R(x, p) = 0 with the state x and the parameters p. The values asked for are functions g(x, p), so that

    dx/dp = -K^-1 dR/dp,    dg/dp = dg/dx dx/dp + dg/dp,

with the factorised tangent K = dR/dx of the state at rest. dR/dp is the central difference of the residual at a fixed
state, and dg/dp is that of g along (dx/dp, 1): no other equilibria are sought for it. What a law of a force between two
points changes is the equation of that force alone, which is differenced by itself: the forces are unknowns. Newton's
steps on p are damped; each begins from the state x + dx/dp dp and ends in a state of rest.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from ..errors import EquilibriumError, FunicularWarning, SceneError
from ..model.loads import ForceLaw, PointForceModel
from ..model.model import Model
from ..model.states import attachment_points
from ..parts.laid import laid
from ..parts.plane import called
from ..parts.scene_data import SceneData
from ..parts.settings import EquilibriumSettings
from ..parts.spring import Spring
from .parameters import Parameters
from .rest_state import Adjustment, RestState
from .snapshots import Reader, Snapshots
from .stability import Stability
from .stable_search import find_rest
from .static import equilibrium, note
from .static_problem import StaticProblem, StaticState, fitted
from .unreachable import Linear, why_unreachable

STEP = 1e-6
"""Of a parameter, to either side: where the residual is differenced."""
SHORTEST = 2.0**-12
"""Of Newton's step: no nearer to the targets with less, and the search ends."""
ENOUGH = 1e-4
"""Of the decrease that a linear model expects: what a step must bring."""
NEARLY = 100.0
"""Times the tolerance: misfits below that are rounding where no step brings them down."""
AT_ONCE = 1_000_000
"""Numbers of the snapshots that are read together."""

S = TypeVar("S", bound=RestState)


@dataclass
class _At:
    """A state of rest with these values p of the parameters (n,), and its values g (targets,)."""

    problem: StaticProblem
    p: np.ndarray
    g: np.ndarray


class _Search(Generic[S]):
    """Newton's method on the parameters; misfits are over the scales of the targets."""

    def __init__(self, parameters: Parameters, settings: EquilibriumSettings, made: type[S], reader: Reader):
        self.parameters, self.settings, self.made, self.reader = parameters, settings, made, reader

    def laid(self, scene: SceneData) -> SceneData:
        """Return a scene of the search in the axes of its plane, which are those of the scene that it began with.

        Raises SceneError where they are others: the coordinates of a state would mean another place.
        """
        first, plane = self.parameters.scene.plane, scene.plane
        if (first is None) != (plane is None) or (first is not None and plane is not None
                                                  and not plane.has_same_axes(first)):
            raise SceneError("equilibrium", f"what is adjusted moves or turns {called(first)}, in which the "
                             "scene lies", "adjust what leaves its planar elements in their plane")
        return laid(scene)

    def state(self, problem: StaticState) -> S:
        """Return the state of a problem, whose stability is not looked at."""
        return self.made.of(problem, Stability(0, 0, known=False))

    def begin(self, rest: RestState) -> _At:
        """Return the state of rest from which the parameters are adjusted."""
        problem = StaticProblem(self.laid(rest.scene), self.settings)
        problem.restore(rest.static_state)
        return _At(problem, self.parameters.values, self.reader.values(problem))

    def linear(self, at: _At) -> tuple[np.ndarray, np.ndarray]:
        """Return dx/dp (unknowns, n) and dg/dp (targets, n) at a state of rest."""
        problem, p = at.problem, at.p
        steps = STEP * np.maximum(np.abs(p), 1e-3 * self.parameters.sizes(problem.size))
        kept, forces = problem.keep(), {force.name: force for force in problem.model.point_forces}
        laws = np.array([self.parameters.law_of(k) is not None for k in range(len(p))])
        ends = {k: [self.beside(at, k, change, kept) for change in (-steps[k], steps[k])]
                for k in np.flatnonzero(~laws).tolist()}
        changes = np.zeros((len(problem.weight), len(p)))
        for k, h in enumerate(steps.tolist()):
            if (name := self.parameters.law_of(k)) is not None:
                rows, change = self.by_law(at, kept["q"], forces[name], k, h)
                changes[rows, k] = change / (2 * h)
            else:
                changes[:, k] = (ends[k][1].residual() - ends[k][0].residual()) / (2 * h)
        rates = -problem.solver()(changes)
        G = np.zeros((len(at.g), len(p)))
        G[:, laws] = self.along(problem, kept, rates[:, laws], steps[laws])
        for k, (below, above) in ends.items():
            below.move(-steps[k] * rates[:, k])
            above.move(steps[k] * rates[:, k])
            G[:, k] = (self.reader.values(above) - self.reader.values(below)) / (2 * steps[k])
        return rates, G

    def without_effect(self, at: _At) -> int:
        """Return how many parameters are of the law of a spring that pulls alone and is slack."""
        slack = {part.name for part, force in zip(at.problem.scene.point_forces.values(),
                                                  at.problem.keep()["point_force"], strict=True)
                 if isinstance(part, Spring) and part.tension_only and not force.any()}
        return sum(self.parameters.law_of(k) in slack for k in range(len(at.p)))

    def by_law(self, at: _At, q: np.ndarray, between: PointForceModel, k: int, h: float) -> tuple[slice, np.ndarray]:
        """Return the rows in the residual of the force whose law parameter k is of, and by how much they change at a
        configuration q (n_q,) from the parameter less h to the parameter plus h.
        """
        model = at.problem.model
        a, b = (attachment_points(model, end, q[None])[0, : model.dim] for end in between.attachments)
        laws = [ForceLaw.of(self.parameters.force_with(at.problem.scene.as_drawn, k, at.p[k] + change), model.dim)
                for change in (-h, h)]
        first = model.n_band + model.n_border_dof + between.unknown
        return slice(first, first + model.dim), laws[0].at_rest(b - a) - laws[1].at_rest(b - a)

    def along(self, problem: StaticState, kept: dict, rates: np.ndarray, steps: np.ndarray) -> np.ndarray:
        """Return (targets, n): derivatives of the values along n changes of a state `kept` (unknowns, n), which the
        state is in again afterwards; steps (n,): how far along them.
        """
        def ends(some: range) -> Iterator[StaticState]:
            for k in some:
                for change in (-steps[k], steps[k]):
                    problem.restore(kept)
                    problem.move(change * rates[:, k])
                    yield problem

        n, found = len(steps), []
        together = max(1, AT_ONCE // max(1, problem.model.n_q))
        for first in range(0, n, together):
            some = range(first, min(first + together, n))
            values = self.reader.read(problem, Snapshots.of(ends(some), self.reader.reactions))
            found.append((values[1::2] - values[::2]) / (2 * steps[some])[:, None])
        problem.restore(kept)
        return np.concatenate(found).T if found else np.zeros((len(self.reader.in_metres), 0))

    def beside(self, at: _At, k: int, change: float, kept: dict) -> StaticState:
        """Return the fixed state `kept` with parameter k changed."""
        p = at.p.copy()
        p[k] += change
        other = StaticState(self.laid(self.parameters.scene_at(p)), self.settings)
        self.check_same(at.problem.model, other.model, k)
        other.restore(fitted(kept, other.model))
        return other

    def check_same(self, model: Model, other: Model, k: int) -> None:
        """Raise SceneError where parameter k changes which unknowns there are."""
        if not np.array_equal(model.unknown_of_dof, other.unknown_of_dof):
            raise SceneError(f'adjust of "{self.parameters.names[k]}"', "changes which coordinates are free, so that "
                             "there are no derivatives by it", "adjust something else")

    def moved(self, at: _At, step: np.ndarray, rates: np.ndarray) -> _At | str:
        """Return the state of rest beside another one, or why there is none, in words."""
        p = at.p + step
        try:
            problem = StaticProblem(self.laid(self.parameters.scene_at(p)), self.settings)
        except SceneError as error:
            return str(error)
        problem.iterations = at.problem.iterations
        problem.restore(fitted(at.problem.keep(), problem.model))
        problem.move(rates @ step)
        if not problem.newton():
            return "no state of rest was found there"
        return _At(problem, p, self.reader.values(problem))


def adjusted(scene: SceneData, settings: EquilibriumSettings, start: RestState | None, made: type[S],
             reader: Callable[[S, Sequence[str]], Reader]) -> S:
    """Return the state of rest that has the values ``settings.to``, of the scene with ``settings.adjust`` adjusted.

    reader: returns, of a state and of names of values, what reads these of any such state. Raises SceneError;
    EquilibriumError, which says what is not reached and why.
    """
    adjust, to = settings.adjust, settings.to
    assert adjust is not None, "without parameters there is nothing to adjust"
    assert to is not None, "without targets there is nothing to adjust for"
    parameters = Parameters(scene, adjust)
    if len(adjust) < len(to):
        raise SceneError("equilibrium", f"{len(to)} targets cannot be reached with {len(adjust)} parameters: "
                         + ", ".join(to), "adjust as many parameters as there are targets, or more")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)  # that of the state returned counts
        rest = equilibrium(laid(scene), settings, start, made)
    read = reader(rest, list(to))
    search = _Search(parameters, settings, made, read)
    at = search.begin(rest)
    targets = np.array(list(to.values()))
    scales = np.where(read.in_metres, at.problem.size, np.maximum(np.abs(targets), np.abs(at.g)))
    scales = np.where(scales > 0, scales, 1.0)
    misfits = _found(search, at, to, scales)
    at = misfits.at
    found = find_rest(at.problem)
    state = made.of(at.problem, found or search.state(at.problem).stability)
    g = read.values(at.problem)
    left = float(np.max(np.abs(targets - g) / scales, initial=0.0))
    if found is None or left > NEARLY * settings.tolerance:
        raise EquilibriumError("the targets are met by an unstable state of rest alone, which the search for a stable "
                               "one leaves; take seek_stable=False to have it, or other targets", state, 1.0)
    _, jacobian = search.linear(_At(at.problem, at.p, g))
    names = parameters.names
    state.adjustment = Adjustment(dict(zip(names, at.p.tolist(), strict=True)), dict(to),
                                  dict(zip(to, g.tolist(), strict=True)), jacobian, len(misfits.sizes) - 1,
                                  [*misfits.sizes[:-1], left])
    note(at.problem, state)
    return state


def _found(search: _Search[S], at: _At, to: Mapping[str, float], scales: np.ndarray) -> _Approach:
    """Return the state of rest with the values that are asked for. Raises EquilibriumError.

    Where so many of the parameters are of slack springs that the others cannot do it, what all taut springs would do is
    looked at first, and else last: a slack spring changes nothing, so that no derivative says by how much it must be
    shorter.
    """
    few = len(search.parameters.names) - search.without_effect(at) < len(to)
    taut = _with_all_taut(search, to, scales) if few else None
    if taut is None:
        try:
            return _approach(search, at, to, scales)
        except EquilibriumError:
            if few or (taut := _with_all_taut(search, to, scales)) is None:
                raise
    found = _approach(search, taut.at, to, scales)
    found.sizes[:0] = taut.sizes[:-1]  # of the same values
    return found


def _with_all_taut(search: _Search[S], to: Mapping[str, float], scales: np.ndarray) -> _Approach | None:
    """Return a state of rest of the scene with the values that a scene finds whose springs push, too, where they pull
    alone; None where there is none, or no such spring. Where all are taut in the end, both scenes are at rest in the
    same state.
    """
    scene, settings = search.parameters.scene, search.settings
    pulling = [part for part in scene.point_forces.values() if isinstance(part, Spring) and part.tension_only
               and part.table is None]
    if not pulling:
        return None
    assert settings.adjust is not None, "the search has parameters"
    both = scene.changed([(part, {"tension_only": False}) for part in pulling])
    pushing = _Search(Parameters(both, settings.adjust), settings, search.made, search.reader)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FunicularWarning)  # as above
            rest = equilibrium(laid(both), settings, None, search.made)
        found = _approach(pushing, pushing.begin(rest), to, scales)
        at = found.at
        problem = StaticProblem(search.laid(search.parameters.scene_at(at.p)), settings)
    except (EquilibriumError, SceneError):
        return None
    problem.restore(fitted(at.problem.keep(), problem.model))
    if find_rest(problem) is None:
        return None
    problem.iterations += at.problem.iterations
    return _Approach(_At(problem, at.p, search.reader.values(problem)), found.sizes)


@dataclass
class _Approach:
    """Where the steps have led, and the largest misfits on the way."""

    at: _At
    sizes: list[float]


def _approach(search: _Search[S], at: _At, to: Mapping[str, float], scales: np.ndarray) -> _Approach:
    """Take steps until the targets are met. Raises EquilibriumError where they cannot be."""
    targets, settings, parameters = np.array(list(to.values())), search.settings, search.parameters
    sizes: list[float] = []
    linear = None
    for _ in range(settings.max_iterations + 1):
        misfit = (targets - at.g) / scales
        sizes.append(float(np.max(np.abs(misfit), initial=0.0)))
        if sizes[-1] <= settings.tolerance:
            return _Approach(at, sizes)
        rates, G = search.linear(at)
        linear = Linear.of(parameters, at.p, G, scales, misfit, parameters.sizes(at.problem.size))
        nearer, reason = _step(search, at, linear, rates, targets, scales)
        if nearer is None:
            if sizes[-1] <= NEARLY * settings.tolerance:
                return _Approach(at, sizes)
            raise EquilibriumError(why_unreachable(parameters, linear, at.g, to, reason), search.state(at.problem), 1.0)
        at = nearer
    assert linear is not None, "there is one iteration at least"
    reason = f"{settings.max_iterations} steps were not enough; take more max_iterations"
    raise EquilibriumError(why_unreachable(parameters, linear, at.g, to, reason), search.state(at.problem), 1.0)


def _step(search: _Search[S], at: _At, linear: Linear, rates: np.ndarray, targets: np.ndarray,
          scales: np.ndarray) -> tuple[_At | None, str]:
    """Return a state nearer to the targets, by a part of Newton's step; None where there is none, and why, in words."""
    reason = "no step comes nearer"
    before, part = float(np.linalg.norm(linear.misfit)), 1.0
    if not linear.gains > 0:
        return None, reason
    while part >= SHORTEST:
        found = search.moved(at, part * linear.step, rates)
        if isinstance(found, str):
            reason = found
        elif np.linalg.norm((targets - found.g) / scales) <= before - ENOUGH * part * linear.gains:
            return found, ""
        part *= 0.5
    return None, reason
