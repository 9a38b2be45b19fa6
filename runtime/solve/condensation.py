"""The matrices of a state over the coordinates that are left when forces between points are eliminated."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array

from ..model.model import Model


def fastest(K: csc_array, M: csc_array, unknowns: np.ndarray | slice = slice(None)) -> float:
    """Return about the square of the highest frequency of some unknowns, rad²/s²; M may have more after those of K."""
    inertia, stiffness = M.diagonal()[: K.shape[0]][unknowns], K.diagonal()[unknowns]
    heavy = inertia > 0
    return float(np.max(np.abs(stiffness[heavy]) / inertia[heavy], initial=0.0))


def condensed(full: csc_array, model: Model) -> tuple[csc_array, csc_array]:
    """Return the stiffness over coordinates and free arc-lengths, forces between points eliminated; the constraints on
    them.
    """
    n = model.n_band + model.n_border_dof
    dim = model.dim
    arc = np.array([n + slide.unknown for slide in model.slides if slide.drive < 0], dtype=int)
    forces = [n + slide.unknown + 1 + d for slide in model.slides for d in range(dim)]
    forces += [n + joint.unknown + r for joint in model.joints for r in range(joint.rows)
               if r not in joint.redundant_rows]
    between = np.array([n + force.unknown + d for force in model.point_forces for d in range(dim)], dtype=int)
    kept = np.concatenate([np.arange(n), arc])
    full = full.tocsr()
    K = full[kept][:, kept]
    if len(between):  # their rows are F - law(q): F = -C q
        K = K - full[kept][:, between] @ full[between][:, kept]
    return K.tocsc(), full[np.array(forces, dtype=int)][:, kept].tocsc()
