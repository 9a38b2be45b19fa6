"""Constraints of small motions in which ropes stick to the sheaves on which they have friction."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, lil_array

from ...model.model import Model
from ...model.rope_states import moved
from ...model.ropes import SheaveModel
from ...model.states import attachment_points

MOTION_STEP = 1e-6
"""Small motion, in units of the dofs, by which angles are differenced: their errors are of its square."""


def stuck_wraps(model: Model, q: np.ndarray, size: int) -> csc_array:
    """Return the rows (rows, size) over the first unknowns of a model by which the rope does not slide on sheaves.

    The rows of a sheave are w = sigma R (d phi - d psi) - lambda ds = 0 at the ends of the zones of its wrap, in m:
    phi the angle of such a point, psi the rotation of the sheave, lambda the stretch of the wrap, s the material
    coordinate there. q (n_q,): the configuration about which the motions are.
    """
    blocks = [_rows(model, sheave, q) for sheave in model.sheaves if sheave.friction > 0]
    rows = lil_array((sum(len(values) for _, values in blocks), size))
    at = 0
    for dofs, values in blocks:
        unknowns = model.unknown_of_dof[dofs]
        for row in values:
            for unknown, value in zip(unknowns.tolist(), row.tolist(), strict=True):
                if unknown >= 0:
                    rows[at, unknown] += value
            at += 1
    return rows.tocsc()


def _rows(model: Model, sheave: SheaveModel, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the dofs of a sheave and of the body that carries it, and the rows (points, dofs)."""
    dofs = sheave.adjacent[0]
    if (number := sheave.attachments[0].body) >= 0:
        body = model.bodies[number]
        dofs = np.r_[dofs, body.dof : body.dof + model.dim + 1 + body.modes]
    dofs = np.unique(dofs.astype(int))
    steps = np.zeros((len(dofs), model.n_dof))
    steps[np.arange(len(dofs)), dofs] = MOTION_STEP
    change = _angles(model, sheave, moved(model, q, steps)) - _angles(model, sheave, moved(model, q, -steps))
    of_feet = (np.arctan2(np.sin(change), np.cos(change)) / (2 * MOTION_STEP)).T
    share = np.linspace(0.0, 1.0, sheave.n_zones + 1)[:, None]
    rows = sheave.sense * sheave.radius * ((1 - share) * of_feet[0] + share * of_feet[1])
    if sheave.turn >= 0:
        rows[:, dofs == sheave.turn] -= sheave.sense * sheave.radius
    length = q[sheave.s[-1]] - q[sheave.s[0]] + sheave.closing
    on, off = _angles(model, sheave, q[None])[0]
    turns = np.round((length / sheave.radius - sheave.sense * (off - on)) / (2 * np.pi))
    stretch = sheave.radius * (sheave.sense * (off - on) + 2 * np.pi * turns) / length
    for point, s in enumerate(sheave.s):
        rows[point, dofs == s] -= stretch
    return dofs, rows


def _angles(model: Model, sheave: SheaveModel, q: np.ndarray) -> np.ndarray:
    """Return the angles (n, 2) of both tangent points about the centre in configurations (n, n_q), rad."""
    centre = attachment_points(model, sheave.attachments[0], q)
    return np.stack([np.arctan2(q[:, node + 1] - centre[:, 1], q[:, node] - centre[:, 0]) for node in sheave.nodes],
                    axis=1)
