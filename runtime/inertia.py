"""Inertia of a symmetric stiffness on the null space of constraints: how many eigenvalues lie below, at and above zero.

Signs are counted from a factorisation (Sylvester's law of inertia), not from a few computed eigenvalues: the count is
complete, however many eigenvalues there are and however often they repeat.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigvalsh, ldl, null_space, qr
from scipy.sparse import csc_array, csr_array, diags_array, eye_array
from scipy.sparse.linalg import splu

DENSE = 200
"""Unknowns up to which the eigenvalues themselves are computed, by LAPACK."""
ZERO = 1e-13
"""Of the scaled stiffness, whose diagonal is one: an eigenvalue this small cannot be told from zero."""
FLOOR = 1e-6
"""Of the largest stiffness: an unknown less stiff than this is scaled as if it had so much, so that the rounding of a
direction that is free is not scaled up to a stiffness."""
DEPENDENT = 1e-10
"""Of a constraint of unit length: what is left of one that follows from others."""


class Inertia(NamedTuple):
    """Numbers of eigenvalues of the constrained stiffness below zero, zero within rounding, and above zero."""

    negative: int
    zero: int
    positive: int


def inertia(K, C=None, units: np.ndarray | None = None, zero: float = ZERO) -> Inertia:
    """Inertia of K (n, n), symmetric, on the null space of C (m, n); both sparse or dense.

    Rows of C may depend on each other. ``inertia(K - shift * M, C)`` counts the eigenvalues of (K, M) below a shift.
    units (n,): how far a unit of each unknown moves a point, which makes all entries of K comparable (N/m); None: they
    are. K is scaled to a diagonal of about one, which changes no sign; zero: eigenvalues of the scaled K that are
    smaller count as zero.
    Raises ValueError where K is not finite or not symmetric to 1e-8 of its largest entry.
    """
    K = csc_array(K, dtype=float)
    n = K.shape[0]
    _check(K)
    K, C, _ = scaled((K + K.T) / 2, C, units)
    if n <= DENSE:
        return _by_eigenvalues(K.toarray(), C.toarray(), zero)
    below = _negative(K + zero * eye_array(n, format="csc"), C)
    at = _negative(K - zero * eye_array(n, format="csc"), C) - below
    return Inertia(below, at, n - C.shape[0] - below - at)


def scaled(K: csc_array, C=None, units: np.ndarray | None = None) -> tuple[csc_array, csr_array, np.ndarray]:
    """D K D with a diagonal of about one, independent rows of C D of unit length, and D's diagonal (n,)."""
    n = K.shape[0]
    C = csr_array((0, n)) if C is None else csr_array(C, dtype=float)
    scale = _scale(K, np.ones(n) if units is None else np.asarray(units, dtype=float))
    D = diags_array(scale)
    return (D @ K @ D).tocsc(), _independent((C @ D).tocsr()), scale


def _check(K: csc_array) -> None:
    largest = abs(K).max() if K.nnz else 0.0
    if not np.isfinite(largest):
        raise ValueError("the stiffness is not finite")
    if K.nnz and abs(K - K.T).max() > 1e-8 * largest:
        raise ValueError("the stiffness is not symmetric")


def _scale(K: csc_array, units: np.ndarray) -> np.ndarray:
    """(n,): what unknowns are multiplied by, so that no row of K has an entry much above one."""
    units = np.where(units > 0, units, 1.0)
    per_unit = diags_array(1.0 / units)
    stiffness = abs(per_unit @ K @ per_unit).max(axis=1).toarray().ravel()
    largest = stiffness.max(initial=0.0) or 1.0
    return 1.0 / (units * np.sqrt(np.maximum(stiffness, FLOOR * largest)))


def _independent(C: csr_array) -> csr_array:
    """Rows of unit length that span what C does."""
    length = np.sqrt(np.asarray(C.multiply(C).sum(axis=1)).ravel())
    C = (diags_array(1.0 / np.where(length > 0, length, 1.0)) @ C).tocsr()[length > 0]
    if not C.shape[0]:
        return C
    touched = np.unique(C.indices)
    r, order = qr(C[:, touched].toarray().T, mode="r", pivoting=True)
    diagonal = np.abs(np.diag(r))
    return C[np.sort(order[: np.count_nonzero(diagonal > DEPENDENT)])]


def _by_eigenvalues(K: np.ndarray, C: np.ndarray, zero: float) -> Inertia:
    if C.shape[0]:
        free = null_space(C, rcond=DEPENDENT)
        K = free.T @ K @ free
    values = eigvalsh(K) if K.shape[0] else np.zeros(0)
    below, above = int(np.count_nonzero(values < -zero)), int(np.count_nonzero(values > zero))
    return Inertia(below, len(values) - below - above, above)


def _negative(K: csc_array, C: csr_array) -> int:
    """Negative eigenvalues of K on the null space of C, neither singular.

    Of [[K, C'], [C, 0]] as many are negative as of K on the null space, and one more for each row of C (Gould 1985). K
    may be replaced by K + C'C, which is the same on the null space and is seldom singular where K is; the rest follows
    from the negative ones of K and of its complement C K^-1 C' (Haynsworth 1968).
    """
    if C.shape[0]:
        K = (K + C.T @ C).tocsc()
    count, solve = _factored(K)
    if not C.shape[0]:
        return count
    complement = C @ solve(C.toarray().T)
    return count - int(np.count_nonzero(eigvalsh((complement + complement.T) / 2) < 0))


def _factored(K: csc_array):
    """Number of negative eigenvalues of K and its solver: L D L' by SuperLU, or LAPACK where that is not accurate.

    SuperLU factors without exchange of rows, so that K = L U with U = D L'. Whether that was accurate is seen by
    multiplying: the count is that of a matrix as near to K as the product.
    """
    try:
        factor = splu(K, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError:  # a pivot is exactly zero
        factor = None
    if factor is not None and np.array_equal(factor.perm_r, factor.perm_c):
        order = np.argsort(factor.perm_c)
        error = abs(factor.L @ factor.U - K[order][:, order])
        if error.nnz == 0 or error.max() < ZERO / 10:
            return int(np.count_nonzero(factor.U.diagonal() < 0)), factor.solve
    dense = K.toarray()
    _, D, _ = ldl(dense)
    return int(np.count_nonzero(_block_eigenvalues(D) < 0)), lambda right: np.linalg.solve(dense, right)


def _block_eigenvalues(D: np.ndarray) -> np.ndarray:
    """Eigenvalues of a matrix with blocks of 1 and 2 on its diagonal."""
    values, k, n = [], 0, len(D)
    while k < n:
        size = 2 if k + 1 < n and D[k + 1, k] != 0 else 1
        values.extend(np.linalg.eigvalsh(D[k : k + size, k : k + size]))
        k += size
    return np.array(values)
