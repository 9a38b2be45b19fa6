"""What lengths, sections and materials of cables change of the residual at a state of rest.

A longer cable keeps its points where they are: with the parts of its length at which they are, and its slopes times its
length, as coordinates, only what acts on each length of it changes. By the ratio of the lengths that is, of weight and
of loads along the cable, the force itself. The elastic energy of an element scales as all lengths do, U(k l, k r,
slopes, S_i k^n_i) = k^3 U, S_i the stiffnesses of the section, an integral of the order n_i over it, and is linear in
S_i. So with f = dU/de the forces on positions and slopes, times the length, change by

    df = sum (2 - n_i) S_i df/dS_i - K e,

e without the directors; those on directors by f more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...model.cables import cable_gravity
from ...model.constants import constants
from ...model.element_coordinates import element_coordinates
from ...model.model import CableModel
from ...parts.cable import Cable
from ...parts.section_stiffness import lengths_in_stiffness, section_stiffness

DIRECTORS = "r_y", "r_z"
DERIVATIVE_ORDERS = {"r_x": 1, "r_xx": 2}
"""Vectors of nodes by how often they are derived by the arc-length."""
DIFFERENCE_STEP = 1e-6
"""Of a length, to either side: where forces of elements are differenced."""


def elastic_force(model: CableModel, A: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return (coordinates,): dU/dq of a cable with constants A (1 or elements, n) of its elements, at q (n_q,)."""
    kernel = model.law_kernel("elastic_force")
    return assembled(model, kernel.rows(model.n_elements, *_given(model, A, q)))


def assembled(model: CableModel, each: np.ndarray) -> np.ndarray:
    """Return (coordinates,): forces (elements, vectors, dim) on the nodes of each element; two meet at an inner one."""
    found = np.zeros(model.shape)
    found[:-1] += each[:, : model.shape[1]]
    found[1:] += each[:, model.shape[1] :]
    return found.ravel()


def by_length(model: CableModel, cable: Cable, q: np.ndarray) -> np.ndarray:
    """Return (coordinates,): derivative of the elastic forces by the ratio of the cable's length to that at q (n_q,),
    see above; differenced where the law takes a stress-free shape or is of another library.
    """
    if cable.reference is not None or cable.library is not None:
        below, above = (_of_length(model, cable, q, 1 + change) for change in (-DIFFERENCE_STEP, DIFFERENCE_STEP))
        return (above - below) / (2 * DIFFERENCE_STEP)
    law = cable.stiffness_law, cable.section, cable.material, cable.dim
    S, orders = section_stiffness(*law), lengths_in_stiffness(*law)
    here = elastic_force(model, model.A, q)
    beside = elastic_force(model, constants(cable, S=S + np.where(orders > 0, 2.0 - orders, 0.0) * S), q)
    directed = np.array([name in DIRECTORS for name in model.vectors])
    on_directors = np.where(directed[:, None], here.reshape(model.shape), 0.0).ravel()
    return beside - here + on_directors - _stiffness_times(model, q, ~directed)


def same_points(model: CableModel, q: np.ndarray) -> np.ndarray:
    """Return (coordinates,): derivative of the coordinates of the same points, q (n_q,), by the ratio of lengths."""
    return -(_slopes(model) * model.nodal(q)).ravel()


@dataclass(frozen=True)
class Own:
    """What a cable gives to the residual by itself, its elastic forces less its weight, at a configuration q (n_q,)."""

    model: CableModel
    q: np.ndarray
    gravity: np.ndarray

    def of(self, cable: Cable) -> np.ndarray:
        """Return (coordinates,): that of the cable with another section or material."""
        return elastic_force(self.model, constants(cable), self.q) - cable_gravity(self.model, cable, self.gravity)


def _of_length(model: CableModel, cable: Cable, q: np.ndarray, ratio: float) -> np.ndarray:
    """Return (coordinates,): elastic forces on positions, and slopes times the length, of a cable that is longer by
    this ratio and has its points where it has them at q (n_q,).
    """
    nodes = {} if cable.nodes is None else {"nodes": [ratio * s for s in cable.nodes]}
    longer = cable.remade({"rest_length": ratio * cable.length} | nodes)
    factors = ratio ** -_slopes(model)
    there = q.copy()
    there[model.coordinates] = (factors * model.nodal(q)).ravel()
    return elastic_force(replace(model, mesh=longer.mesh), constants(longer), there) * np.broadcast_to(
        factors, model.shape).ravel()


def _slopes(model: CableModel) -> np.ndarray:
    """Return (vectors, 1): how often each vector of a node is derived by the arc-length."""
    return np.array([[float(DERIVATIVE_ORDERS.get(name, 0))] for name in model.vectors])


def _stiffness_times(model: CableModel, q: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return (coordinates,): d2U/dq2 times the chosen (vectors,) of the nodal vectors at q (n_q,)."""
    lengths, e, A = _given(model, model.A, q)
    K = model.law_kernel("elastic_tangent").rows(model.n_elements, lengths, e, A)
    along = np.where(np.tile(chosen, 2)[:, None], e, 0.0).reshape(len(e), -1)
    return assembled(model, np.einsum("eij,ej->ei", K, along).reshape(e.shape))


def _given(model: CableModel, A: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return what kernels of a law take of each element: lengths, nodal vectors, constants."""
    n, e = model.n_elements, element_coordinates(model, q[None])[0]
    return (np.ascontiguousarray(np.broadcast_to(model.mesh.lengths, n)), np.ascontiguousarray(e),
            np.ascontiguousarray(np.broadcast_to(A, (n, A.shape[1]))))
