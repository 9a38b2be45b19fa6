"""The change of equations by a parameter at a state of rest, and the state that it is computed from."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from ...engine import Engine
from ...model.model import CableModel, Model
from ...parts.part import Part
from ...parts.paths import COMPONENTS
from ...parts.plane import aligned
from ...parts.scene_data import SceneData
from ..statics.static_problem import StaticProblem
from .snapshots import Reader


class Change:
    """The change by a unit of a parameter of the forces on the dofs f (n_dof,), of the equations of couplings g
    (n_extra,), of prescribed dofs c (n_dof,), and of the unknowns at fixed points of cables, same (unknowns,).
    """

    def __init__(self, model: Model):
        n = model.n_band + model.n_border_dof + model.n_extra
        self.f, self.g = np.zeros(model.n_dof), np.zeros(model.n_extra)
        self.c, self.same = np.zeros(model.n_dof), np.zeros(n)

    def subtract(self, factor: float, other: Change) -> None:
        """Subtract the forces and equations of another parameter times a factor."""
        self.f -= factor * other.f
        self.g -= factor * other.g


class Rest:
    """A state of rest; reader: of the target values, of which some depend on parameters directly: forces in sections of
    cables on loads.
    """

    def __init__(self, problem: StaticProblem, reader: Reader):
        self.problem, self.reader = problem, reader
        self.scene: SceneData = problem.scene
        self.model = problem.model

    def along(self, component: str) -> np.ndarray | None:
        """Return an axis of the ground in the axes of the model, (dim,); None where it leaves the plane."""
        direction = np.array(axis_of(component))
        if self.scene.plane_axes is not None:
            direction = aligned(self.scene.plane_axes.plane.into(direction))
        stays = direction.any() and not direction[self.model.dim :].any()
        return direction[: self.model.dim] if stays else None

    def shape(self, cable: str, s: float, derivative: int = 0) -> tuple[np.ndarray, slice]:
        """Return the shape functions (vectors,) at s on a cable, or their derivatives, and the dofs of its element."""
        model = self.model_of(cable)
        element = int(model.mesh.element_at(s))
        N = model.kernel("on_axis")(model.mesh.length(element), s - model.mesh.start(element))[derivative]
        return N, model.dofs_of(element)

    def model_of(self, cable: str) -> CableModel:
        """Return the model of a cable, by its name."""
        return next(model for model in self.model.cables if model.name == cable)

    def names(self, cable: str, groups: Iterable[str]) -> bool:
        """Return whether a part of these groups of the scene is on a cable."""
        return any(cable in named(part) for group in groups for part in getattr(self.scene, group).values())

    def engine(self, model: Model) -> Engine:
        """Return an engine of another model of the scene, in the state of the problem."""
        engine = Engine(model)
        engine.redundant_rows([(k, row) for k, joint in enumerate(model.joints) for row in joint.redundant_rows])
        engine.set_state(0.0, **self.problem.keep(), prescribe=False)
        return engine


def named(part: Part) -> set[str]:
    """Return the names of other parts that a part is on."""
    return {name for _, value in part for name in (value, getattr(value, "on", None)) if isinstance(name, str)}


def axis_of(component: str) -> tuple[float, ...]:
    """Return the unit vector (3,) along an axis, such as x or 0; zeros for another component."""
    return tuple(float(component in (name, str(k))) for name, k in COMPONENTS.items())


def altered(model: Model, **changes: Any) -> Model:
    """Return a model with other values of some arrays or couplings, and the same border."""
    made = replace(model, **changes)
    made.newton, made.accelerations = model.newton, model.accelerations
    return made
