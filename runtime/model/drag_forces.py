"""Forces of fluids along cables at given instants, from results; and what lies beyond their tables."""

from __future__ import annotations

import numpy as np

from ..kernels.libraries import kernels_of
from ..parts.validation import EXACT
from .drags import DragModel
from .element_coordinates import element_coordinates, positions
from .model import Model
from .states import attachment_points, spatial


def densities(model: Model, drag: DragModel, time: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return (T, elements, points, 3): drag and buoyancy on a cable at its points of quadrature, N/m undeformed.

    time (T,) in s, q (T, n_q), v (T, n_dof).
    """
    cable, dim = model.cables[drag.cable], model.dim
    e, rates = (element_coordinates(cable, values) for values in (q, v))
    local = e - np.where(positions(cable)[:, None], e[:, :, :1], 0.0)
    r, slope, velocity = (np.einsum("egk,tekd->tegd", np.broadcast_to(shape, (cable.n_elements, *shape.shape[1:])), of)
                          for shape, of in ((drag.N, e), (drag.N_x, local), (drag.N, rates)))
    flow = _velocity(drag, time[:, None, None], r)
    kernel = getattr(kernels_of(None), f"{drag.kernel}_along_cable")
    n = r[..., 0].size
    f = kernel.rows(n, slope.reshape(n, dim), (flow - velocity).reshape(n, dim), np.array(drag.coefficients))[0]
    if drag.lift[0] != 0:
        lift = getattr(kernels_of(None), f"{drag.kernel}_lift_along_cable")
        f = f + lift.rows(n, slope.reshape(n, dim), (flow - velocity).reshape(n, dim), np.array(drag.lift))[0]
    return spatial(f.reshape(r.shape) + drag.buoyancy)


def _velocity(drag: DragModel, time: np.ndarray, r: np.ndarray) -> np.ndarray:
    """Return the velocity of the fluid (..., dim) at times (s) and places r (..., dim) in m."""
    return drag.fluid.velocity_at(time, drag.base + r @ drag.up, _place(drag, r))[..., : r.shape[-1]]


def _place(drag: DragModel, r: np.ndarray) -> np.ndarray:
    """Return places (..., 3) on the ground's axes of places r (..., dim) in the model's."""
    return drag.origin + r @ drag.axes.reshape(3, 3)[:, : r.shape[-1]].T


def outside_tables(model: Model, q: np.ndarray) -> list[str]:
    """Return a message for each drag on what is beyond the table of its fluid at t = 0; q (n_q,)."""
    found = []
    for drag in model.drags:
        if drag.fluid.table is None:
            continue
        if drag.cable >= 0:
            cable = model.cables[drag.cable]
            r = q[cable.coordinates].reshape(cable.shape)[:, 0]
        else:
            r = attachment_points(model, drag.attachments[0], q[None])[:, : model.dim]
        margin, axis = drag.fluid.table.margin(np.zeros(len(r)), _place(drag, r))
        if margin < -EXACT:
            found.append(f'drag "{drag.name}" is on what lies beyond the table of its fluid along {axis}, by '
                         f"{-margin:.3g} of it: there the velocity is as at its edge; take a larger table")
    return found
