"""Operations on matrices that are arrays for few unknowns, for which SciPy's sparse matrices are slow, else sparse."""

from __future__ import annotations

from typing import Any

import numpy as np

MAX_DENSE_UNKNOWNS = 200
"""Unknowns up to which matrices are arrays."""


def dense(A: Any) -> np.ndarray:
    """Return a matrix as an array."""
    return A if isinstance(A, np.ndarray) else np.asarray(A.toarray())


def all_finite(A: Any) -> bool:
    """Return whether all entries are finite."""
    return bool(np.isfinite(A if isinstance(A, np.ndarray) else A.data).all())


def row_maxima(A: Any) -> np.ndarray:
    """Return the largest absolute value of each row."""
    if 0 in A.shape:
        return np.zeros(A.shape[0])
    return np.asarray(dense(abs(A).max(axis=1))).ravel()


def between(left: np.ndarray, A: Any, right: np.ndarray) -> Any:
    """Return diag(left) A diag(right)."""
    if isinstance(A, np.ndarray):
        return left[:, None] * A * right
    from scipy.sparse import diags_array  # slow to import, and small scenes do without

    return diags_array(left) @ A @ diags_array(right)
