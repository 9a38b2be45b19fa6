"""Loads on cables as strings: constant forces on the dofs, of weight, loads and fluids."""

from __future__ import annotations

import numpy as np

from ...model.drag_forces import densities
from ...model.drags import DragModel
from ...model.loads import GAUSS, DeadLoadModel
from ...model.model import Model
from .static_problem import StaticProblem


def string_loads(problem: StaticProblem, q: np.ndarray) -> np.ndarray:
    """Return (n_dof,): forces on the dofs of cables at a configuration under the present load, in N."""
    model, engine, p = problem.model, problem.engine, problem.fraction
    force = model.gravity * (p if problem.settings.scale_gravity else 1.0)
    for k, load in enumerate(model.loads):
        if isinstance(load, DeadLoadModel):
            scale = 1.0 if load.signal < 0 else float(model.signals[load.signal].value(np.zeros(1))[0])
            force[load.dofs] += p * scale * np.array(load.values)
        else:
            force -= engine.external_forces(k, k + 1)[0]
    for drag in model.drags:
        if drag.cable >= 0:
            _add_drag(model, drag, q, p, force)
    return force


def depend_on_shape(model: Model) -> bool:
    """Return whether loads on cables depend on their shape: those of flowing fluids."""
    return any(drag.cable >= 0 and (drag.velocity.any() or drag.degree) for drag in model.drags)


def _add_drag(model: Model, drag: DragModel, q: np.ndarray, p: float, force: np.ndarray) -> None:
    """Add p times the forces of a fluid on a cable at rest, distributed linearly to the nodes of each element."""
    cable = model.cables[drag.cable]
    f = densities(model, drag, np.zeros(1), q[None], np.zeros((1, model.n_dof)))[0][0, ..., : model.dim]
    f = p * f * np.broadcast_to(drag.weights, f.shape[:2])[:, :, None]
    share, at = (1 + GAUSS[0]) / 2, cable.vectors.index("r")
    own = cable.nodal(force)
    own[:-1, at] += np.einsum("egd,g->ed", f, 1 - share)
    own[1:, at] += np.einsum("egd,g->ed", f, share)
