"""Balance of a scene as drawn: forces of joints, slides and springs that balance it, and the residual."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from ..notes.diagnosis import describe_dof
from .static_problem import StaticState, coordinates_of, units_of

BALANCE_TOLERANCE = 1e-6
"""Residual force of a state in balance, as a fraction of the largest load."""
FORCE_ROUNDING = 1e-15
"""Rounding error of a force, as a fraction of the largest row sum of the stiffness; 9e-17 was measured."""


NO_FORCE = 1e-20
"""Residual force below which a state without loads and stiffness is in balance, N."""


@dataclass(frozen=True)
class Balance:
    """The residual forces on a scene as drawn: the largest in N, its place, and whether the scene is at rest."""

    left: float
    where: str
    at_rest: bool

    def __str__(self) -> str:
        """Return it in words."""
        return f"residual forces are up to {self.left:.3g} N, largest on {self.where}"


def balance(static: StaticState) -> Balance:
    """Set the internal forces of a static state as drawn to those that balance it best; return the residual.

    Springs and other laws have the force of their gap. Joints and slides balance the rest in the least squares. Without
    balance the forces return to their former values, zero.
    """
    drawn = static.keep()
    rows = coordinates_of(static.model)
    found = imbalance(static, balance_forces(static)[rows][:, rows])
    if not found.at_rest:
        static.restore(drawn)
    return found


def imbalance(static: StaticState, stiffness: csr_array) -> Balance:
    """Return the residual of a static state with its present forces; stiffness: the tangent over its coordinates."""
    rows, units = coordinates_of(static.model), units_of(static.weight, static.model)
    left = np.abs(static.residual()[rows]) / units
    load = np.max(np.abs(static.load_vector()[rows]) / units, initial=0.0)
    sums = np.max(_size_of_sums(static, stiffness) / units, initial=0.0)
    at_rest = bool(np.all(left <= BALANCE_TOLERANCE * load + FORCE_ROUNDING * sums + NO_FORCE))
    most = int(np.argmax(left)) if len(left) else 0
    return Balance(float(np.max(left, initial=0.0)), place_of(static, rows, most), at_rest)


def balance_forces(static: StaticState) -> csr_array:
    """Set the internal forces of a static state as drawn to those that balance it best; return the tangent stiffness
    without them.
    """
    model = static.model
    n, rows, units = model.n_band + model.n_border_dof, coordinates_of(model), units_of(static.weight, model)
    by_law, free = ([n + k for coupling in model.couplings for k in coupling.force_unknowns
                     if coupling.follows_law == is_law] for is_law in (True, False))
    stiffness = static.tangent().tocsr()
    change = np.zeros(stiffness.shape[0])
    change[by_law] = -static.residual()[by_law] / stiffness.diagonal()[by_law]
    static.move(change)
    change[:] = 0.0
    change[free] = _shared(stiffness[rows][:, free], static.residual()[rows], units)
    static.move(change)
    return stiffness


def _shared(columns: csr_array, residual: np.ndarray, units: np.ndarray) -> np.ndarray:
    """Return the forces with the smallest residual, in the least squares of N."""
    occupied = np.flatnonzero(np.diff(columns.indptr))
    if not len(occupied):
        return np.zeros(columns.shape[1])
    over = 1.0 / units[occupied]
    matrix = over[:, None] * columns[occupied].toarray()
    return np.asarray(np.linalg.lstsq(matrix, -over * residual[occupied], rcond=None)[0])


def _size_of_sums(static: StaticState, stiffness: csr_array) -> np.ndarray:
    """Return (rows,): an upper bound of the sum of the terms of each row's force, for points at the scene's size."""
    largest = np.ones(stiffness.shape[0])
    free = static.model.unknown_of_dof >= 0
    points = static.model.unknown_of_dof[free & (static.model.weight == 1.0)]
    largest[points] = max(1.0, float(np.abs(static.keep()["q"]).max(initial=0.0)))
    return np.asarray(abs(stiffness) @ largest)


def place_of(static: StaticState, rows: np.ndarray, most: int) -> str:
    """Return the place of the row with the largest residual force."""
    model = static.model
    n = model.n_band + model.n_border_dof
    if not len(rows):
        return "nothing"
    if rows[most] >= n:
        coupling = next(k for k, each in enumerate(model.couplings) if rows[most] - n in each.free_coordinates)
        return describe_dof(model, 0, coupling)
    return describe_dof(model, int(np.flatnonzero(model.unknown_of_dof == rows[most])[0]))
