"""Neighbouring states of rest under changes of parameters, and the derivatives of their values.

At rest R(x, p) = 0 with the state x and the parameters p. The target values are functions g(x, p), so that

    dx/dp = -K^-1 dR/dp,    dg/dp = dg/dx dx/dp + dg/dp,

with the factorised tangent K = dR/dx of the state at rest; dg/dp is the central difference of g along (dx/dp, 1). No
other equilibria are sought. dR/dp by loads, weights, motions, positions along cables, lengths, sections and materials
comes from parameter_changes.py. The law of a force between two points changes the equation of that force alone, as
forces are unknowns: this equation is differenced. Any other dR/dp is the central difference of the residual at a fixed
state.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from ...errors import SceneError
from ...model.model import Model
from ...model.point_forces import ForceLaw
from ...model.states import attachment_points
from ...parts.in_plane import in_plane
from ...parts.plane import called
from ...parts.scene_data import SceneData
from ...parts.settings import EquilibriumSettings
from ...parts.spring import Spring
from ..statics.rest_state import RestState
from ..statics.stability import Stability
from ..statics.starts import fitted
from ..statics.static_problem import StaticProblem, StaticState
from ..statics.turned_rest import turned_rest
from .change import Change
from .parameter_changes import Changes
from .parameters import Parameters
from .snapshots import Reader, Snapshots

DIFFERENCE_STEP = 1e-6
"""Step of differences to either side: of the residual, as a fraction of a parameter; of values, of the scene's size."""
MAX_NUMBERS_AT_ONCE = 1_000_000
"""Numbers of the snapshots that are read at once."""

S = TypeVar("S", bound=RestState)


@dataclass
class AtRest:
    """A state of rest with parameters p (n,), and its values g (targets,)."""

    problem: StaticProblem
    p: np.ndarray
    g: np.ndarray


@dataclass(frozen=True)
class Direction:
    """The direction of a difference of values: the step of a parameter to either side, dx/dp (unknowns,), and the
    direct change by the parameter.
    """

    step: float
    rates: np.ndarray
    change: Change

    @classmethod
    def of(cls, problem: StaticProblem, rates: np.ndarray, change: Change) -> Direction:
        """Return the direction of a parameter, with the step that moves the state by a fraction of the scene's size."""
        moves = np.hypot(problem.length(rates), np.linalg.norm(change.c))
        return cls(DIFFERENCE_STEP * problem.size / moves if moves > 0 else 1.0, rates, change)

    def begin(self, kept: dict[str, np.ndarray], step: float) -> dict[str, np.ndarray]:
        """Return a state with prescribed dofs moved by a step of the parameter."""
        if not self.change.c.any():
            return kept
        q = kept["q"].copy()
        q[: len(self.change.c)] += step * self.change.c
        return kept | {"q": q}


@dataclass
class Beside:
    """A state with a changed parameter; order (unknowns,): the number there of each unknown of the first state."""

    state: StaticState
    order: np.ndarray

    def residual(self) -> np.ndarray:
        """Return the residual (unknowns,), in the first state's order."""
        return np.asarray(self.state.residual()[self.order])

    def move(self, change: np.ndarray) -> None:
        """Move the state by a change of the unknowns, in the first state's order."""
        there = np.empty_like(change)
        there[self.order] = change
        self.state.move(there)


class ParameterSearch(Generic[S]):
    """Newton's method on the parameters; misfits are over the scales of the targets."""

    def __init__(self, parameters: Parameters[SceneData], settings: EquilibriumSettings, made: type[S], reader: Reader):
        self.parameters, self.settings, self.made, self.reader = parameters, settings, made, reader

    def in_plane(self, scene: SceneData) -> SceneData:
        """Return a scene of the search in the axes of its plane.

        Raises SceneError where these are not the axes of the first scene: coordinates would mean other positions.
        """
        first, plane = self.parameters.scene.plane, scene.plane
        if (first is None) != (plane is None) or (first is not None and plane is not None
                                                  and not plane.has_same_axes(first)):
            raise SceneError("equilibrium", f"what is adjusted moves or turns {called(first)}, in which the "
                             "scene lies", "adjust what leaves its planar elements in their plane")
        return in_plane(scene)

    def state(self, problem: StaticState) -> S:
        """Return the state of a problem, without its stability."""
        return self.made.of(problem, Stability(0, 0, known=False))

    def begin(self, rest: RestState) -> AtRest:
        """Return the first state of the search."""
        problem = StaticProblem(self.in_plane(rest.scene), self.settings)
        problem.restore(rest.static_state)
        return AtRest(problem, self.parameters.values, self.reader.values(problem))

    def linear(self, at: AtRest) -> tuple[np.ndarray, np.ndarray]:
        """Return dx/dp (unknowns, n) and dg/dp (targets, n) at a state of rest."""
        problem, p = at.problem, at.p
        steps = DIFFERENCE_STEP * np.maximum(np.abs(p), 1e-3 * self.parameters.sizes(problem.size))
        kept, changes = problem.keep(), Changes(problem, dict(enumerate(self.parameters.paths)), self.reader)
        here = {**changes.columns(), **self.by_laws(at, kept["q"], steps)}
        ends = {k: [self.beside(at, k, change, kept) for change in (-steps[k], steps[k])]
                for k in range(len(p)) if k not in here}
        columns = here | {k: (above.residual() - below.residual()) / (2 * steps[k])
                          for k, (below, above) in ends.items()}
        rates = -problem.solver()(np.stack([columns[k] for k in range(len(p))], axis=1))
        G = np.zeros((len(at.g), len(p)))
        G[:, list(here)] = self.along(problem, kept, [
            Direction.of(problem, rates[:, k], changes.found.get(k, Change(problem.model))) for k in here])
        for k, (below, above) in ends.items():
            below.move(-steps[k] * rates[:, k])
            above.move(steps[k] * rates[:, k])
            G[:, k] = (self.reader.values(above.state) - self.reader.values(below.state)) / (2 * steps[k])
        for k, change in changes.found.items():
            rates[:, k] += change.same
        return rates, G

    def without_effect(self, at: AtRest) -> int:
        """Return the number of parameters of the laws of tension-only springs that are slack."""
        slack = {part.name for part, force in zip(at.problem.scene.point_forces.values(),
                                                  at.problem.keep()["point_force"], strict=True)
                 if isinstance(part, Spring) and part.tension_only and not force.any()}
        return sum(self.parameters.law_of(k) in slack for k in range(len(at.p)))

    def by_laws(self, at: AtRest, q: np.ndarray, steps: np.ndarray) -> dict[int, np.ndarray]:
        """Return dR/dp (unknowns,) by the parameters of laws of forces between two points, at a configuration q (n_q,);
        steps (n,): of the differences to either side.
        """
        model, found = at.problem.model, {}
        forces = {force.name: force for force in model.point_forces}
        for k, h in enumerate(steps.tolist()):
            if (name := self.parameters.law_of(k)) is None:
                continue
            laws = [ForceLaw.of(self.parameters.force_with(at.problem.scene.as_drawn, k, at.p[k] + change), model.dim)
                    for change in (-h, h)]
            a, b = (attachment_points(model, end, q[None])[0, : model.dim] for end in forces[name].attachments)
            first = model.n_band + model.n_border_dof + forces[name].unknown
            found[k] = np.zeros(len(at.problem.weight))
            found[k][first : first + model.dim] = (laws[0].at_rest(b - a) - laws[1].at_rest(b - a)) / (2 * h)
        return found

    def along(self, problem: StaticState, kept: dict[str, np.ndarray], directions: Sequence[Direction]) -> np.ndarray:
        """Return (targets, n): derivatives of the values in n directions from a state `kept`, which is restored."""
        def ends(some: Sequence[Direction]) -> Iterator[StaticState]:
            for direction in some:
                for step in (-direction.step, direction.step):
                    problem.restore(direction.begin(kept, step), prescribe=not direction.change.c.any())
                    problem.move(step * direction.rates)
                    yield problem

        found = []
        together = max(1, MAX_NUMBERS_AT_ONCE // max(1, problem.model.n_q))
        for first in range(0, len(directions), together):
            some = directions[first : first + together]
            snapshots = Snapshots.of(ends(some), self.reader.reactions)
            for k, direction in enumerate(some):
                snapshots.reaction[2 * k : 2 * k + 2] += np.outer((-direction.step, direction.step), direction.change.f)
            values = self.reader.read(problem, snapshots)
            found.append((values[1::2] - values[::2]) / (2 * np.array([direction.step for direction in some]))[:, None])
        problem.restore(kept)
        return np.concatenate(found).T if found else np.zeros((len(self.reader.in_metres), 0))

    def beside(self, at: AtRest, k: int, change: float, kept: dict[str, np.ndarray]) -> Beside:
        """Return the state `kept` with parameter k changed."""
        p = at.p.copy()
        p[k] += change
        other = StaticState(self.in_plane(self.parameters.scene_at(p)), self.settings)
        order = self.order(at.problem.model, other.model, k)
        other.restore(fitted(kept, other.model))
        return Beside(other, order)

    def order(self, model: Model, other: Model, k: int) -> np.ndarray:
        """Return (unknowns,): the number of each unknown of a model in the model with parameter k changed.

        A spring whose end moves to the next element changes the numbering. Raises SceneError where other dofs are free.
        """
        here, there = model.unknown_of_dof, other.unknown_of_dof
        free = here >= 0
        if not np.array_equal(free, there >= 0):
            raise SceneError(f'adjust of "{self.parameters.names[k]}"', "changes which coordinates are free, so that "
                             "there are no derivatives by it", "adjust something else")
        found = np.arange(model.n_band + model.n_border_dof + model.n_extra)
        found[here[free]] = there[free]
        return found

    def moved(self, at: AtRest, step: np.ndarray, rates: np.ndarray) -> AtRest | str:
        """Return the state of rest after a step of the parameters, or why there is none, in words."""
        p = at.p + step
        try:
            problem = StaticProblem(self.in_plane(self.parameters.scene_at(p)), self.settings, at.problem.turns.reached)
        except SceneError as error:
            return str(error)
        problem.iterations = at.problem.iterations
        problem.restore(fitted(at.problem.keep(), problem.model))
        is_near = problem.turns.fraction == 1.0
        if is_near:
            problem.move(rates @ step)
        if not (problem.newton() if is_near else turned_rest(problem) is not None):
            return "no state of rest was found there"
        return AtRest(problem, p, self.reader.values(problem))
