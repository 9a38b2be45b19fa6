"""Constraints of small motions in which ropes stick to the sheaves on which they have friction."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, lil_array

from ...model.model import Model
from ...model.rope_states import in_groove, moved
from ...model.rope_wheels import SheaveModel
from ...model.states import attachment_points

MOTION_STEP = 1e-6
"""Small motion, in units of the dofs, by which angles are differenced: their errors are of its square."""

TURNS = {2: 1, 3: 3}
"""Rotations of a body by the dimension of space."""


def stuck_wraps(model: Model, q: np.ndarray, size: int) -> csc_array:
    """Return the rows (rows, size) over the first unknowns of a model by which the rope does not slide on sheaves.

    The rows of a sheave are w = sigma R (d phi - d psi) - lambda ds = 0 at the ends of the zones of its wrap, in m:
    phi the angle of such a point, psi the rotation of the sheave with its carrier, lambda the stretch of the wrap, s
    the material coordinate there. A short wrap has one, the mean of those at its ends; a sheave that the rope has left
    has none. q (n_q,): the configuration about which the motions are.
    """
    blocks = [_rows(model, sheave, q) for sheave in model.sheaves if sheave.friction > 0 and sheave.has_contact(q)]
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
    carrier = sheave.attachments[0]
    of_carrier: dict[int, float] = {}  # its angular velocity about the axis, by rates of dofs; in space it has none
    if carrier.body >= 0:
        body = model.bodies[carrier.body]
        rotation = body.dof + model.dim
        dofs = np.r_[dofs, body.dof : rotation + TURNS[model.dim] + body.modes]
        if model.dim == 2:
            of_carrier[rotation] = 1.0
            if carrier.modal is not None:
                of_carrier |= enumerate(np.sum(carrier.modal[2], axis=1).tolist(), start=rotation + 1)
    dofs = np.unique(dofs.astype(int))
    steps = np.zeros((len(dofs), model.n_dof))
    steps[np.arange(len(dofs)), dofs] = MOTION_STEP
    change = _angles(model, sheave, moved(model, q, steps)) - _angles(model, sheave, moved(model, q, -steps))
    of_feet = (np.arctan2(np.sin(change), np.cos(change)) / (2 * MOTION_STEP)).T
    share = np.linspace(0.0, 1.0, sheave.n_zones + 1)[:, None]
    rows = sheave.sense * sheave.radius * ((1 - share) * of_feet[0] + share * of_feet[1])
    for dof, rate in ({sheave.turn: 1.0} | of_carrier).items():
        rows[:, dofs == dof] -= sheave.sense * sheave.radius * rate
    length = q[sheave.s[-1]] - q[sheave.s[0]] + sheave.closing
    on, off = _angles(model, sheave, q[None])[0]
    turns = np.round((length / sheave.radius - sheave.sense * (off - on)) / (2 * np.pi))
    stretch = sheave.radius * (sheave.sense * (off - on) + 2 * np.pi * turns) / length
    for point, s in enumerate(sheave.s):
        rows[point, dofs == s] -= stretch
    if stretch * length < sheave.least_wrap * sheave.radius:
        rows = (rows[:1] + rows[-1:]) / 2
    return dofs, rows


def _angles(model: Model, sheave: SheaveModel, q: np.ndarray) -> np.ndarray:
    """Return the angles (n, 2) of both tangent points about the centre in configurations (n, n_q), rad."""
    centre = attachment_points(model, sheave.attachments[0], q)[:, : model.dim]
    places = [in_groove(model, sheave, q, q[:, node : node + model.dim] - centre) for node in sheave.nodes]
    return np.stack([np.arctan2(place[:, 1], place[:, 0]) for place in places], axis=1)
