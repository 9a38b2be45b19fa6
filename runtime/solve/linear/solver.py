"""The solver of a sparse matrix."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu


def solver(matrix: csc_array) -> Callable[[np.ndarray], np.ndarray]:
    """Return the solver of a sparse matrix. Raises RuntimeError where it is exactly singular."""
    if not matrix.shape[0]:
        return lambda right: right
    factor = splu(matrix.tocsc(), permc_spec="COLAMD")
    return lambda right: np.asarray(factor.solve(right))
