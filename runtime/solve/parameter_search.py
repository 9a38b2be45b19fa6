"""States of rest beside each other along changes of parameters, and the derivatives of their values.

At rest R(x, p) = 0 with the state x and the parameters p. The values asked for are functions g(x, p), so that

    dx/dp = -K^-1 dR/dp,    dg/dp = dg/dx dx/dp + dg/dp,

with the factorised tangent K = dR/dx of the state at rest. dR/dp is the central difference of the residual at a fixed
state, and dg/dp is that of g along (dx/dp, 1): no other equilibria are sought for it. What a law of a force between two
points changes is the equation of that force alone, which is differenced by itself: the forces are unknowns.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from ..errors import SceneError
from ..model.loads import ForceLaw, PointForceModel
from ..model.model import Model
from ..model.states import attachment_points
from ..parts.laid import laid
from ..parts.plane import called
from ..parts.scene_data import SceneData
from ..parts.settings import EquilibriumSettings
from ..parts.spring import Spring
from .parameters import Parameters
from .rest_state import RestState
from .snapshots import Reader, Snapshots
from .stability import Stability
from .static_problem import StaticProblem, StaticState, fitted

STEP = 1e-6
"""Of a parameter, to either side: where the residual is differenced."""
AT_ONCE = 1_000_000
"""Numbers of the snapshots that are read together."""

S = TypeVar("S", bound=RestState)


@dataclass
class AtRest:
    """A state of rest with these values p of the parameters (n,), and its values g (targets,)."""

    problem: StaticProblem
    p: np.ndarray
    g: np.ndarray


class ParameterSearch(Generic[S]):
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

    def begin(self, rest: RestState) -> AtRest:
        """Return the state of rest from which the parameters are adjusted."""
        problem = StaticProblem(self.laid(rest.scene), self.settings)
        problem.restore(rest.static_state)
        return AtRest(problem, self.parameters.values, self.reader.values(problem))

    def linear(self, at: AtRest) -> tuple[np.ndarray, np.ndarray]:
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

    def without_effect(self, at: AtRest) -> int:
        """Return how many parameters are of the law of a spring that pulls alone and is slack."""
        slack = {part.name for part, force in zip(at.problem.scene.point_forces.values(),
                                                  at.problem.keep()["point_force"], strict=True)
                 if isinstance(part, Spring) and part.tension_only and not force.any()}
        return sum(self.parameters.law_of(k) in slack for k in range(len(at.p)))

    def by_law(self, at: AtRest, q: np.ndarray, between: PointForceModel, k: int, h: float) -> tuple[slice, np.ndarray]:
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

    def beside(self, at: AtRest, k: int, change: float, kept: dict) -> StaticState:
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

    def moved(self, at: AtRest, step: np.ndarray, rates: np.ndarray) -> AtRest | str:
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
        return AtRest(problem, p, self.reader.values(problem))
