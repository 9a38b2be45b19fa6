"""Stiffness, constraints and frequencies of a state over its coordinates, with forces between points eliminated."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...model.model import Model
from .matrices import dense, row_maxima

DEPENDENCE_TOLERANCE = 1e-9
"""Part of a contact's row that is independent of the others, as a fraction of the largest, below which they imply
it."""


def fastest(K: Any, M: Any, unknowns: np.ndarray | slice = slice(None)) -> float:
    """Return about the square of the highest frequency of some unknowns in rad²/s²; M may have more unknowns than K."""
    inertia, stiffness = M.diagonal()[: K.shape[0]][unknowns], K.diagonal()[unknowns]
    heavy = inertia > 0
    return float(np.max(np.abs(stiffness[heavy]) / inertia[heavy], initial=0.0))


def condensed(full: Any, model: Model) -> tuple[Any, Any]:
    """Return the stiffness over all coordinates, with forces by laws eliminated, and the constraints on them: arrays of
    an array, else sparse.
    """
    n = model.n_band + model.n_border_dof
    own = [n + k for coupling in model.couplings for k in coupling.free_coordinates]
    forces = [n + k for coupling in model.couplings if not coupling.follows_law for k in coupling.force_unknowns]
    kept = np.concatenate([np.arange(n), np.array(own, dtype=int)])
    is_sparse = not isinstance(full, np.ndarray)
    full = full.tocsr() if is_sparse else full
    K = without_forces(full, kept, model)
    of_contacts = {n + k for contact in model.hard_contacts for k in contact.force_unknowns}
    C = independent(full[np.array(forces, dtype=int)][:, kept],
                     [row for row, k in enumerate(forces) if k in of_contacts])
    return (K.tocsc(), C.tocsc()) if is_sparse else (K, C)


def with_entries(rows: Any) -> Any:
    """Return the rows of a matrix, an array or sparse, without empty ones, of constraints that do not hold in a state.
    """
    return rows[np.flatnonzero(abs(rows).sum(axis=1))]


def independent(rows: Any, of_contacts: list[int]) -> Any:
    """Return the constraints without empty ones, such as of a slide between two supported nodes, and without those of
    contacts that others imply.
    """
    sizes = row_maxima(rows)
    if not sizes.all():
        place = {row: k for k, row in enumerate(np.flatnonzero(sizes).tolist())}
        rows, of_contacts = rows[np.flatnonzero(sizes)], [place[row] for row in of_contacts if row in place]
    if not of_contacts:
        return rows
    from scipy.linalg import qr  # slow to import, and runs do without

    own = dense(rows[of_contacts])
    _, factor, order = qr(own.T, mode="economic", pivoting=True)
    sizes = np.abs(np.diagonal(factor))
    rank = int(np.count_nonzero(sizes > DEPENDENCE_TOLERANCE * max(sizes.max(initial=0.0), np.finfo(float).tiny)))
    others = set(range(rows.shape[0])) - set(of_contacts)
    return rows[sorted(others | {of_contacts[k] for k in order[:rank]})]


def without_forces(full: Any, kept: np.ndarray | slice, model: Model) -> Any:
    """Return a matrix, sparse or an array, over the unknowns kept, with forces between points eliminated."""
    n = model.n_band + model.n_border_dof
    between = [n + k for coupling in model.couplings if coupling.follows_law for k in coupling.force_unknowns]
    own = full[kept][:, kept]
    # their rows are F - law(q): F = -C q
    return own - full[kept][:, between] @ full[between][:, kept] if between else own
