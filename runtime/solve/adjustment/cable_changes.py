"""Derivatives of the residual by lengths, sections and materials of cables at a state of rest.

With the relative arc-lengths of its points, and its slopes times its length, as coordinates, the points of a longer
cable stay, and only forces per unit length change. The derivative of weight and of loads along the cable by the ratio
of the lengths is the force itself. The elastic energy of an element scales as all lengths do, U(k l, k r, slopes, S_i
k^n_i) = k^3 U, with the stiffnesses S_i of the section, integrals of the order n_i over it, and is linear in S_i. With
f = dU/de, the forces on positions and slopes, times the length, therefore change by

    df = sum (2 - n_i) S_i df/dS_i - K e,

e without the directors; those on directors by f more.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...model.cables import cable_gravity
from ...model.constants import constants
from ...model.model import CableModel, per_grown
from ...model.states import element_coordinates
from ...parts.cable import Cable
from ...parts.section_stiffness import lengths_in_stiffness

DIRECTORS = "r_y", "r_z"
DIFFERENCE_STEP = 1e-6
"""Relative step of a length, to either side, of differences of element forces."""


def elastic_force(model: CableModel, A: np.ndarray, q: np.ndarray, growth: np.ndarray | None = None) -> np.ndarray:
    """Return (coordinates,): dU/dq of a cable with constants A (1 or elements, n) of its elements, at q (n_q,).

    growth: (elements,) factors of their stress-free lengths, by default those at q.
    """
    g = model.growth_in(q) if growth is None else growth
    kernel = model.law_kernel("elastic_force")
    return assembled(model, per_grown(model.vectors, g) * kernel.rows(model.n_elements, *_given(model, A, q, g)))


def by_temperature(model: CableModel, cable: Cable, q: np.ndarray) -> np.ndarray:
    """Return (coordinates,): derivative of the elastic forces at q (n_q,) by the temperature of a cable, N/K and N m/K:
    their difference by the growth of its pieces.
    """
    expansion = [piece.material.thermal_expansion or 0.0 for piece in cable.uniform_pieces]
    if not (largest := max(map(abs, expansion))):
        return np.zeros(math.prod(model.shape))
    step = DIFFERENCE_STEP / largest

    def warmer(change: float) -> np.ndarray:
        growth = [each.start + change * own for each, own in zip(cable.growth, expansion, strict=True)]
        return elastic_force(model, constants(cable, growth=growth), q, cable.repeated(growth))

    return np.asarray((warmer(step) - warmer(-step)) / (2 * step))


def assembled(model: CableModel, each: np.ndarray) -> np.ndarray:
    """Return (coordinates,): the sums at the nodes of forces (elements, vectors, dim) on the nodes of each element."""
    found = np.zeros(model.shape)
    found[model.mesh.first] += each[:, : model.shape[1]]
    found[model.mesh.last] += each[:, model.shape[1] :]
    return found.ravel()


def by_length(model: CableModel, cable: Cable, q: np.ndarray) -> np.ndarray:
    """Return (coordinates,): derivative of the elastic forces at q (n_q,) by the ratio of the cable's lengths, see
    above; a difference where the law takes a stress-free shape or is of another library.
    """
    if cable.reference is not None or cable.library is not None:
        below, above = (_of_length(model, cable, q, 1 + change) for change in (-DIFFERENCE_STEP, DIFFERENCE_STEP))
        return np.asarray((above - below) / (2 * DIFFERENCE_STEP))
    orders = lengths_in_stiffness(cable.stiffness_law, cable.section, cable.material, cable.dim)
    here = elastic_force(model, model.A, q)
    beside = elastic_force(model, constants(cable, change=lambda S: S + np.where(orders > 0, 2.0 - orders, 0.0) * S), q)
    directed = np.array([name in DIRECTORS for name in model.vectors])
    on_directors = np.where(directed[:, None], here.reshape(model.shape), 0.0).ravel()
    return np.asarray(beside - here + on_directors - _stiffness_times(model, q, ~directed))


def same_points(model: CableModel, q: np.ndarray) -> np.ndarray:
    """Return (coordinates,): derivative of the coordinates of the same points, q (n_q,), by the ratio of lengths."""
    return np.asarray(-(_slopes(model) * model.nodal(q)).ravel())


@dataclass(frozen=True)
class Own:
    """The elastic forces of a cable less its weight, at a configuration q (n_q,)."""

    model: CableModel
    q: np.ndarray
    gravity: np.ndarray

    def of(self, cable: Cable) -> np.ndarray:
        """Return (coordinates,): those of the cable with another section or material."""
        weight = cable_gravity(cable, self.gravity)
        return np.asarray(elastic_force(self.model, constants(cable), self.q) - weight)


def _of_length(model: CableModel, cable: Cable, q: np.ndarray, ratio: float) -> np.ndarray:
    """Return (coordinates,): elastic forces on positions, and slopes times the length, of a cable that is longer by
    this ratio and has its points at those of q (n_q,).
    """
    nodes = {} if cable.nodes is None else {"nodes": [ratio * s for s in cable.nodes]}
    longer = cable.remade({"rest_length": ratio * cable.length} | nodes)
    factors = ratio ** -_slopes(model)
    there = q.copy()
    there[model.coordinates] = (factors * model.nodal(q)).ravel()
    return elastic_force(replace(model, mesh=longer.mesh), constants(longer), there) * np.broadcast_to(
        factors, model.shape).ravel()


def _slopes(model: CableModel) -> np.ndarray:
    """Return (vectors, 1): the order of the derivative by the arc-length of each nodal vector."""
    return model.orders[:, None].astype(float)


def _stiffness_times(model: CableModel, q: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return (coordinates,): d2U/dq2 times the chosen (vectors,) of the nodal vectors at q (n_q,)."""
    g = model.growth_in(q)
    lengths, e, A = _given(model, model.A, q, g)
    K = model.law_kernel("elastic_tangent").rows(model.n_elements, lengths, e, A)
    along = np.where(np.tile(chosen, 2)[:, None], e, 0.0).reshape(len(e), -1)
    return assembled(model, per_grown(model.vectors, g) * np.einsum("eij,ej->ei", K, along).reshape(e.shape))


def _given(model: CableModel, A: np.ndarray, q: np.ndarray, growth: np.ndarray
           ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the arguments of a law's kernels by element: lengths, nodal vectors, constants, as the law takes them."""
    n, e = model.n_elements, per_grown(model.vectors, growth) * element_coordinates(model, q[None])[0]
    return (np.ascontiguousarray(np.broadcast_to(growth * model.mesh.lengths, n)), np.ascontiguousarray(e),
            np.ascontiguousarray(np.broadcast_to(A, (n, A.shape[1]))))
