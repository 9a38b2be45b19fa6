"""The solver of a matrix, an array or sparse."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.linalg.lapack import dgetrf, dgetrs
from scipy.sparse.linalg import splu


def solver(matrix: Any) -> Callable[[np.ndarray], np.ndarray]:
    """Return the solver of a matrix. Raises RuntimeError where it is exactly singular."""
    if not matrix.shape[0]:
        return lambda right: right
    if isinstance(matrix, np.ndarray):
        factors, exchanges, zero_pivot = dgetrf(matrix)
        if zero_pivot:
            raise RuntimeError("the matrix is exactly singular")
        return lambda right: np.asarray(dgetrs(factors, exchanges, right)[0])
    factor = splu(matrix.tocsc(), permc_spec="COLAMD")
    return lambda right: np.asarray(factor.solve(right))
