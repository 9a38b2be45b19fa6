"""The static problem R(x, p) = 0: residual forces and constraints at a state x under p times all loads.

x are the coordinates, arc-lengths and forces of slides, joints and springs; p is the load fraction. R is linear in p,
also for follower loads: p multiplies the components of a load alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from scipy.sparse import csc_array

from ...engine import Engine
from ...model.build import build
from ...model.model import Model
from ...model.redundant_constraints import drop_redundant_rows
from ...model.states import attachment_points
from ...parts.scene_data import SceneData
from ...parts.settings import IMPENDING, EquilibriumSettings
from ..linear.condensation import condensed, fastest
from ..linear.matrices import MAX_DENSE_UNKNOWNS
from ..linear.solver import solver
from .ropes_at_rest import off_sheaves, with_ropes_at_rest
from .starts import with_moved_supports
from .sticking_ropes import with_sticking_wraps
from .turns import Turns

MAX_CORRECTION_GROWTH = 1e3
"""Ratio of a correction to the smallest one before above which Newton's method diverges."""
LIMIT_OF_FRICTION = 1e-18
"""Square of the share of the limit by which friction of ropes about to slide is below it, at least."""
ZERO_STIFFNESS_RATIO = 1e-14
"""Stiffnesses below this fraction of the fastest vibration's square count as zero."""


class StaticState:
    """The engine's static state and its residual; `load` sets the load fraction."""

    def __init__(self, scene: SceneData, settings: EquilibriumSettings, model: Model | None = None,
                 turned: Mapping[str, float] | None = None):
        """model: of the scene, made if None; turned: prescribed angles of the first state, see `Turns`."""
        self.scene, self.settings = scene, settings
        self.model = static_model(with_sticking_wraps(scene) if settings.sticks else scene) if model is None else model
        self.engine = Engine(self.model)
        drop_redundant_rows(self.model, self.engine)
        self.turns = Turns(scene, self.model, self.engine, turned)
        self.engine.set_state(0.0)
        self.load(1.0)
        self.impend(1.0)
        unknown = self.model.unknown_of_dof
        free = unknown >= 0
        self.weight = np.zeros(self.engine.unknowns)  # forces and arc-lengths do not count in the size of a correction
        self.weight[unknown[free]] = self.model.weight[free]
        self.iterations = 0

    def load(self, fraction: float) -> None:
        """Apply this fraction of all loads, and of gravity unless the settings keep it whole."""
        self.fraction = fraction
        self.engine.load(fraction, self.settings.scale_gravity)

    def impend(self, fraction: float) -> None:
        """Apply this fraction of the limit of friction of ropes, in the motion of the settings; without one, none.

        Regularised friction is this fraction where the rope slides at this multiple of the slip velocity.
        """
        if self.settings.impending is not None:
            slip = fraction / max(1.0 - fraction * fraction, LIMIT_OF_FRICTION) ** 0.5
            self.engine.impend(IMPENDING[self.settings.impending] * slip)

    def residual(self) -> np.ndarray:
        """Return R at the static state under the present load: internal less external forces, and constraints."""
        return self.engine.static_residual()

    def keep(self) -> dict[str, np.ndarray]:
        """Return the static state, the argument of `restore`."""
        return self.engine.state()

    def restore(self, kept: dict[str, np.ndarray], prescribe: bool = True) -> None:
        """Go back to a state that `keep` returned; prescribe: with the prescribed coordinates of motions."""
        self.engine.set_state(0.0, **kept, prescribe=prescribe)

    def move(self, change: np.ndarray) -> None:
        """Move the state by a change of the unknowns; slides that leave their element enter the next."""
        self.engine.move(change)
        if self.model.slides:
            self.engine.set_state(0.0, **self.engine.state(), prescribe=False)

    def load_vector(self) -> np.ndarray:
        """Return -dR/dp (n,) at the static state, p the fraction of the loads."""
        fraction = self.fraction
        self.load(0.0)
        without = self.residual()
        self.load(1.0)
        with_all = self.residual()
        self.load(fraction)
        return np.asarray(without - with_all)

    def tangent(self) -> csc_array:
        """Return the tangent stiffness dR/dx over the unknowns, (n, n), sparse."""
        return self.engine.matrix(0.0, 0.0, 1.0)


class StaticProblem(StaticState):
    """A static state with its tangent, the scales of the scene, and Newton's method."""

    def __init__(self, scene: SceneData, settings: EquilibriumSettings, turned: Mapping[str, float] | None = None):
        super().__init__(scene, settings, turned=turned)
        self.restore(with_moved_supports(self.model, self.keep()))
        self.as_drawn = self.begin = self.keep()["q"]  # begin: the same, or the state without loads
        drawn = self.residual()
        self.size = self._extent()
        engine = self.engine
        self._matrix: Callable[[float, float, float], Any] = (
            engine.dense_matrix if engine.unknowns <= MAX_DENSE_UNKNOWNS else engine.matrix)
        self.mass = self._matrix(1.0, 0.0, 0.0)
        # rad²/s²; free motions (a rider that may turn about its rope) have no stiffness. Of points, not of directors:
        # the section of a thin beam vibrates so fast that its fraction of mass would stop the beam
        points = np.flatnonzero(self.weight == 1.0)
        stiffness, _ = condensed(self.tangent_matrix(), self.model)
        self.fastest = max(fastest(stiffness, self.mass, points), self._falls(drawn, points))
        self.coordinates = coordinates_of(self.model)
        self.point_entries = _point_entries(self.model)
        self.slack: dict[str, float] = {}  # slack fractions of cables as strings
        self.string_nodes: Any = None  # nodes of cables as those of strings, when first needed
        self.last_strings: dict[tuple[bytes, bool], Any] = {}  # of groups: the last forces on strings, and rest
        self.held = False  # whether short steps have held cables on surfaces
        self.pushed = False  # whether a push off an unstable branch had no preferred direction
        self.left_route = ""  # where a rope left its route in the states that the search tried, in words
        self.messages: list[str] = []

    def _falls(self, drawn: np.ndarray, points: np.ndarray) -> float:
        """Return the square of a pendulum's frequency in rad²/s²: without elasticity only weight restores."""
        inertia = self.mass.diagonal()[points]
        return float(np.max(np.abs(drawn[points]) / inertia, initial=0.0, where=inertia > 0)) / self.size

    def _extent(self) -> float:
        """Return the scene's size in m."""
        model = self.model
        lengths = [cable.mesh.total for cable in model.cables] + [rope.route.length for rope in model.ropes]
        lengths += [float(np.linalg.norm(model.q[b.configuration : b.configuration + model.dim])) for b in model.bodies]
        gaps = [np.subtract(*(attachment_points(model, end, model.q[None]) for end in force.attachments))
                for force in model.point_forces]
        return max([*lengths, *(float(np.linalg.norm(gap)) for gap in gaps)], default=0.0) or 1.0

    def tangent_matrix(self) -> Any:
        """Return the tangent stiffness as the problem's matrices are: an array for few unknowns, else sparse."""
        return self._matrix(0.0, 0.0, 1.0)

    def stiffness(self) -> tuple[Any, Any, np.ndarray]:
        """Return K over the coordinates, constraints C on them, and the displacement in m by a unit of each
        (coordinates,).
        """
        K, C = condensed(self.tangent_matrix(), self.model)
        return K, C, units_of(self.weight, self.model)

    def curvature(self, change: np.ndarray, mass: float) -> float:
        """Return the curvature of the energy along a change, with this factor of the mass, less a tenth of the mass's
        part.
        """
        along = change[self.coordinates]
        K, _ = condensed(self.tangent_matrix(), self.model)
        return float(along @ (K @ along)) + 0.9 * mass * float(change @ (self.mass @ change))

    def distance(self, kept: dict[str, np.ndarray]) -> float:
        """Return the largest change in m of a coordinate of a position from a state."""
        moved = np.abs(self.engine.state()["q"] - kept["q"])[self.point_entries]
        return float(np.max(moved, initial=0.0))

    def solver(self, inertia: float = 0.0) -> Callable[[np.ndarray], np.ndarray]:
        """Return the solver of the tangent plus inertia times the mass. Raises RuntimeError where it is singular."""
        return solver(self.regular_tangent() if inertia == 0.0 else self.tangent_matrix() + inertia * self.mass)

    def regular_tangent(self) -> Any:
        """Return dR/dx, with a mass that regularises free motions."""
        return self.tangent_matrix() + ZERO_STIFFNESS_RATIO * self.fastest * self.mass

    def length(self, change: np.ndarray) -> float:
        """Return the size of a correction in m."""
        size = float(np.linalg.norm(self.weight * change))
        return size if np.isfinite(size) else np.inf

    def newton(self) -> bool:
        """Run Newton's method under the present load, with full steps; return whether it converged.

        Corrections may grow for a while: the second-order term of a rotation stretches axially stiff parts, and the
        next correction removes the stretch. A line search would take hundreds of small steps; `relax` is better.
        """
        least = np.inf
        for _ in range(self.settings.max_iterations):
            self.iterations += 1
            try:
                change = self.solver()(-self.residual())
            except RuntimeError:
                return False
            size = self.length(change)
            if not size < min(MAX_CORRECTION_GROWTH * least, 10.0 * self.size):
                return False
            least = min(least, size)
            self.move(change)
            if size <= self.settings.tolerance * self.size:
                return self.on_cables() and not (self.fraction == 1.0 and self.leaves_route())
        return False

    def cause(self) -> str:
        """Return why no stable state may be found, as the end of a message; empty where the cause is unknown."""
        if left := self.off_sheaves() or self.left_route:
            return f"; {left}"
        if not self.slack:
            return ""
        name, part = max(self.slack.items(), key=lambda item: item[1])
        return (f'; cable "{name}" is so long that {100 * part:.2g} % of it would have no tension as a string: its '
                "bending stiffness alone decides on the shape there; a shorter rest_length, or other supports, put it "
                "in tension")

    def off_sheaves(self) -> str:
        """Return where a rope of the state has left its route, see `off_sheaves`."""
        return off_sheaves(self.model, self.engine)

    def leaves_route(self) -> bool:
        """Return whether a rope of the state has left its route, and note where."""
        left = self.off_sheaves()
        self.left_route = left or self.left_route
        return bool(left)

    def on_cables(self) -> bool:
        """Return whether no slide is past an end of its cable or span, where the last element would continue without
        end.
        """
        state = self.engine.state()
        ends = np.array([j.ends_at(self.model, state["q"]) for j in self.model.slides]).reshape(-1, 2)
        past = np.maximum(ends[:, 0] - state["s"], state["s"] - ends[:, 1])
        return bool(np.all(past <= self.settings.tolerance * self.size))


def without_waves(model: Model) -> None:
    """Leave the waves of fluids out of a model: statics and modes are those of the still surface."""
    for drag in model.drags:
        drag.entries |= {"n_waves": 0, "move_fluid": False}


def static_model(scene: SceneData) -> Model:
    """Return the model of a scene for statics: with ropes at rest among the bodies as drawn, see `with_ropes_at_rest`,
    and without the added mass of still fluids, which does not act at rest.

    The inertia of a flowing fluid acts at rest, too: by its acceleration, and by a lift where its velocity depends on
    the height.
    """
    model = build(scene)
    for drag in model.drags:
        drag.has_inertia = drag.has_inertia and drag.fluid.moves
    without_waves(model)
    model.q = with_ropes_at_rest(model, scene)
    return model


def coordinates_of(model: Model) -> np.ndarray:
    """Return the numbers of the unknowns that are coordinates, those of couplings last."""
    n = model.n_band + model.n_border_dof
    own = [n + k for coupling in model.couplings for k in coupling.free_coordinates]
    return np.append(np.arange(n), np.array(own, dtype=int))


def units_of(weight: np.ndarray, model: Model) -> np.ndarray:
    """Return (coordinates,): displacement in m by a unit of each; weight: of all unknowns, see `StaticState`."""
    of_coordinates = weight[coordinates_of(model)]
    return np.where(of_coordinates > 0, of_coordinates, 1.0)


def _point_entries(model: Model) -> np.ndarray:
    """Return the entries of the configuration that are coordinates of points."""
    nodes = [node.dofs("r") for cable in model.nodes.values() for node in cable]
    nodes += [range(node.start, node.start + model.dim) for rope in model.ropes for span in rope.spans
              for node in map(span.node, range(span.n_elements + 1))]
    bodies = [range(body.configuration, body.configuration + model.dim) for body in model.bodies]
    return np.array([entry for part in (*nodes, *bodies) for entry in part], dtype=int)
