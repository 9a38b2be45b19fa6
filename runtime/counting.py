"""How many eigenvalues of a symmetric matrix are negative on the vectors that constraints leave.

By Sylvester's law of inertia the pivots of a symmetric factorisation have the signs of the eigenvalues, so that all of
them are counted at the cost of one factorisation.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import ldl
from scipy.sparse import block_array, csc_array, diags_array
from scipy.sparse.linalg import SuperLU, splu

SMALL = 300
"""Up to so many rows the factorisation is dense, by Bunch and Kaufman."""

BACKWARD = 1e-9
"""Error of a factorisation in parts of the matrix, from which its pivots do not count: 1e-15 is usual."""


def negatives(K: csc_array, C: csc_array) -> int:
    """How many eigenvalues of K on C x = 0 are negative.

    K: (n, n) sparse and symmetric; C: (m, n) sparse, of rank m. Raises ArithmeticError where no factorisation is
    accurate enough to count, as where K is singular on C x = 0.

    The eigenvalues of [[K, C'], [C, 0]] are counted: m of them are negative, and m positive, of the constraints
    (Gould, Math. Program. 32 (1985) 90-99).
    """
    n, m = K.shape[0], C.shape[0]
    whole = block_array([[K, C.T], [C, None]], format="csc") if m else K.tocsc()
    scale = equilibrating(whole)
    whole = (diags_array(scale) @ whole @ diags_array(scale)).tocsc()
    if n + m <= SMALL:
        return _negatives_of_blocks(whole.toarray()) - m
    # multipliers, and coordinates without stiffness and mass of their own, have no pivot before others are eliminated
    late = np.flatnonzero(np.abs(whole.diagonal()) < 1e-12)
    early = np.setdiff1d(np.arange(n + m), late)
    inner, border = whole[early][:, early].tocsc(), whole[early][:, late]
    pivots, factor = _pivots(inner)
    count = int(np.count_nonzero(pivots < 0)) - m
    if len(late):
        count += _negatives_of_blocks(whole[late][:, late].toarray() - border.T @ factor.solve(border.toarray()))
    return count


def equilibrating(K: csc_array) -> np.ndarray:
    """(n,): d such that the largest entry of each row and column of d_i K_ij d_j is 1 (Ruiz, RAL-TR-2001-034)."""
    size, scale = abs(K).tocsc(), np.ones(K.shape[0])
    for _ in range(6):
        largest = np.asarray(size.max(axis=1).todense()).ravel()
        step = 1 / np.sqrt(np.where(largest > 0, largest, 1.0))
        size = (diags_array(step) @ size @ diags_array(step)).tocsc()
        scale = scale * step
    return scale


def _pivots(K: csc_array) -> tuple[np.ndarray, SuperLU]:
    """Pivots of K on its diagonal, in the order of a factorisation whose error is looked at, and its factors."""
    right = np.random.default_rng(0).standard_normal(K.shape[0])
    for order in ("MMD_AT_PLUS_A", "NATURAL"):
        try:
            factor = splu(K, permc_spec=order, diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        except RuntimeError:  # a pivot that is exactly zero
            continue
        found = factor.solve(right)
        error = np.abs(K @ found - right).max() / (np.abs(found).max() * abs(K).sum(axis=1).max())
        if error <= BACKWARD and np.array_equal(factor.perm_r, factor.perm_c):
            return factor.U.diagonal(), factor
    raise ArithmeticError("the pivots of the stiffness are too small for their signs to be known")


def _negatives_of_blocks(K: np.ndarray) -> int:
    """The same of a dense matrix, by the pivots of Bunch and Kaufman of one and two rows."""
    if not len(K):
        return 0
    scale = 1 / np.sqrt(np.maximum(np.abs(K).max(axis=1), 1e-300))
    blocks = ldl(scale[:, None] * (K + K.T) / 2 * scale)[1]
    count, k = 0, 0
    while k < len(blocks):
        if k + 1 < len(blocks) and blocks[k + 1, k] != 0:  # a block of two rows has one of each sign
            count, k = count + 1, k + 2
        else:
            count, k = count + (blocks[k, k] < 0), k + 1
    return int(count)
