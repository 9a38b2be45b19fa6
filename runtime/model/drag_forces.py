"""Forces of fluids along cables at given instants, from results, and places outside of their tables."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..kernels.libraries import kernels_of
from ..parts.polar import Polar
from ..parts.validation import LENGTH_TOLERANCE
from .drags import DragModel
from .model import Model
from .states import attachment_points, element_coordinates, positions, spatial


@dataclass(eq=False, repr=False)
class Turning:
    """Moments of a fluid on the sections of a beam, at T instants and points of quadrature (T, elements, points, 3).

    on_slope, on_chord: generalised forces on r_x and on the director along the chord, N; couple: their moment per
    length, N.
    """

    on_slope: np.ndarray
    on_chord: np.ndarray
    couple: np.ndarray


def densities(model: Model, drag: DragModel, time: np.ndarray, q: np.ndarray, v: np.ndarray
              ) -> tuple[np.ndarray, Turning | None]:
    """Return (T, elements, points, 3), drag and buoyancy on its elements at its points of quadrature, N/m undeformed,
    and the moments on sections of a beam with a polar.

    time (T,) in s, q (T, n_q), v (T, n_dof).
    """
    cable, dim = model.cables[drag.cable], model.dim
    own = slice(drag.first, drag.first + drag.n_elements)
    e, rates = (element_coordinates(cable, values)[:, own] for values in (q, v))
    local = e - np.where(positions(cable)[:, None], e[:, :, :1], 0.0)
    r, slope, velocity = (_at_points(shape, of)
                          for shape, of in ((drag.N, e), (drag.N_x, local), (drag.N, rates)))
    flow = _velocity(drag, time[:, None, None], r)
    kernel = getattr(kernels_of(None), f"{drag.kernel}_along_cable")
    n = r[..., 0].size
    t, w = slope.reshape(n, dim), (flow - velocity).reshape(n, dim)
    f, turning = kernel.rows(n, t, w, np.array(drag.coefficients))[0], None
    if drag.lift[0] != 0:
        lift = getattr(kernels_of(None), f"{drag.kernel}_lift_along_cable")
        f = f + lift.rows(n, t, w, np.array(drag.lift))[0]
    if drag.polar is not None:
        d = _at_points(drag.N_chord, local).reshape(n, dim)
        forces = _on_sections(drag, drag.polar, t, d, w)
        f = f + forces[:, 0]
        couple = np.cross(t, forces[:, 1]) + np.cross(d, forces[:, 2])
        turning = Turning(*(values.reshape(r.shape) for values in (forces[:, 1], forces[:, 2], couple)))
    f = f.reshape(r.shape)
    if drag.iced is None:
        return spatial(f + drag.buoyancy), turning
    growth, more = drag.iced.at(time)
    return spatial(growth[:, None, None, None] * f + (drag.buoyancy + more)[:, None, None]), turning


def at_rest(model: Model, drag: DragModel, q: np.ndarray) -> np.ndarray:
    """Return the force (dim,) in N on the point of a drag at rest at t = 0, all of it in the fluid; q (n_q,)."""
    r = attachment_points(model, drag.attachments[0], q[None])[:, : model.dim]
    U = _velocity(drag, np.zeros(1), r)[0]
    return np.asarray(drag.buoyancy + drag.coefficients[0] * np.linalg.norm(U) * U)


def _at_points(shape: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return (T, elements, points, dim) from shape functions (1 or elements, points, vectors) and vectors (T, elements,
    vectors, dim).
    """
    N = np.broadcast_to(shape, (values.shape[1], *shape.shape[1:]))
    return np.asarray(np.einsum("egk,tekd->tegd", N, values))


def _on_sections(drag: DragModel, polar: Polar, t: np.ndarray, d: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Return (n, 3, 3): forces on r, r_x and chord at slopes t, chords d and flows w past them (n, 3)."""
    i = t / np.linalg.norm(t, axis=1, keepdims=True)
    normal = np.cross(i, d)
    angle = np.arctan2(np.sum(normal * w, axis=1), np.sum(np.cross(normal, i) * w, axis=1))
    values = np.zeros((len(t), 6))  # derivatives by the angle are not needed
    values[:, ::2] = polar.coefficients(angle).T
    kernel = getattr(kernels_of(None), f"{drag.kernel}_on_section")
    return np.asarray(kernel.rows(len(t), t, d, w, np.array(drag.section), values)[0]).reshape(-1, 3, 3)


def _velocity(drag: DragModel, time: np.ndarray, r: np.ndarray) -> np.ndarray:
    """Return the velocity of the fluid (..., dim) at times (s) and positions r (..., dim) in m."""
    return drag.fluid.velocity_at(time, drag.base + r @ drag.up, _place(drag, r))[..., : r.shape[-1]]


def _place(drag: DragModel, r: np.ndarray) -> np.ndarray:
    """Return positions (..., 3) along the ground's axes from r (..., dim) along the model's."""
    return np.asarray(drag.origin + r @ drag.axes.reshape(3, 3)[:, : r.shape[-1]].T)


def outside_tables(model: Model, q: np.ndarray) -> list[str]:
    """Return a message for each drag that acts outside of the table of its fluid at t = 0; q (n_q,)."""
    found = []
    for drag in model.drags:
        if drag.fluid.table is None:
            continue
        if drag.cable >= 0:
            cable = model.cables[drag.cable]
            nodes = cable.mesh.first_node(np.arange(drag.first, drag.first + drag.n_elements))
            r = cable.nodal(q)[[*nodes, nodes[-1] + 1], 0]
        elif drag.coordinates is not None:
            r = drag.coordinates.places(q)
        else:
            r = attachment_points(model, drag.attachments[0], q[None])[:, : model.dim]
        height = drag.base + r @ drag.up
        r = r + (np.clip(height, drag.bottom, drag.surface) - height)[:, None] * drag.up  # nearest point of the fluid
        margin, axis = drag.fluid.table.margin(np.zeros(len(r)), _place(drag, r))
        if margin < -LENGTH_TOLERANCE:
            found.append(f'drag "{drag.name}" acts outside of the table of its fluid along {axis}, by {-margin:.3g} '
                         "of its length: the velocity there is that at the edge; take a larger table")
    return found
