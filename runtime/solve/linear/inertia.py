"""Inertia of a symmetric stiffness on the null space of constraints: how many eigenvalues lie below, at and above zero.

Signs are counted from a factorisation (Sylvester's law of inertia), not from a few computed eigenvalues: the count is
complete, however many eigenvalues there are and however often they repeat. `inertia` is for states of rest, where what
is zero counts apart and constraints may be redundant; `negatives` is for the spectrum, at a shift.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import cholesky_banded, eigvalsh, ldl, null_space, qr
from scipy.sparse import block_array, csc_array, csr_array, diags_array, eye_array, triu
from scipy.sparse.linalg import splu

DENSE = 200
"""Unknowns up to which the eigenvalues themselves are computed, by LAPACK."""
ZERO = 1e-13
"""Of the scaled stiffness, whose diagonal is one: an eigenvalue this small cannot be distinguished from zero."""
FLOOR = 1e-6
"""Of the largest stiffness: an unknown less stiff than this is scaled as if it had so much, so that the rounding of a
direction that is free is not scaled up to a stiffness."""
DEPENDENT = 1e-10
"""Of a constraint of unit length: what is left of one that follows from others."""
WIDEST = 100
"""Diagonals on a side of the band in which Cholesky's factorisation is tried first."""
SMALL = 300
"""Rows up to which the factorisation is dense, by Bunch and Kaufman."""
GROWTH = 16.0
"""What an elimination may add to entries that are at most one. Its rounding is 1e-16 of that: well below `ZERO`."""
MORE_GROWTH = 10.0
"""Times as much growth is admitted by each further factorisation: amid the spectrum there is no end of it."""
MOST_GROWTH = 1e7
"""The rounding is 1e-9 then; with more growth signs do not count."""
AT_ONCE = 60
"""Unknowns, of the most growth, that are put late for the next factorisation."""
WITHOUT = 1e-12
"""Of the largest entry in its row: with a smaller diagonal an unknown is no pivot before others are eliminated."""
NUDGES = 0.0, WITHOUT, 10 * WITHOUT, 100 * WITHOUT
"""Of the diagonal, which is about one: added where there are no pivots on it, to find which are too small."""
MOST_FACTORISATIONS = 30
MOST_LATE = 3000
"""Unknowns that may be left for the dense end of the factorisation: 72 MB."""


class Inertia(NamedTuple):
    """Numbers of eigenvalues of the constrained stiffness below zero, zero within rounding, and above zero."""

    negative: int
    zero: int
    positive: int


def inertia(K: Any, C: Any = None, units: np.ndarray | None = None, zero: float = ZERO) -> Inertia:
    """Return the inertia of K (n, n), symmetric, on the null space of C (m, n); both sparse or dense.

    Rows of C may depend on each other. ``inertia(K - shift * M, C)`` counts the eigenvalues of (K, M) below a shift.
    units (n,): how far a unit of each unknown moves a point, which makes all entries of K comparable (N/m); None: they
    are. K is scaled to a diagonal of about one, which changes no sign; zero: eigenvalues of the scaled K that are
    smaller count as zero.
    Raises ValueError where K is not finite or not symmetric to 1e-8 of its largest entry; ArithmeticError, see
    `negatives`.
    """
    K = csc_array(K, dtype=float)
    n = K.shape[0]
    _check(K)
    if _is_definite(K, np.ones(n) if units is None else np.asarray(units, dtype=float), zero):
        return Inertia(0, 0, n - (0 if C is None else _independent(csr_array(C, dtype=float)).shape[0]))
    K, C, _ = scaled((K + K.T) / 2, C, units)
    if n <= DENSE:
        return _by_eigenvalues(K.toarray(), C.toarray(), zero)
    shift = zero * eye_array(n, format="csc")
    below = negatives(K + shift, C)
    at = negatives(K - shift, C) - below
    return Inertia(below, at, n - C.shape[0] - below - at)


def _is_definite(K: csc_array, units: np.ndarray, zero: float) -> bool:
    """Return whether a factorisation shows that all eigenvalues of K, scaled as by `scaled`, are above this size.

    False, too, where its band is too wide for that to be quick. It is then so on the null space of any constraints.
    """
    n = K.shape[0]
    column = np.repeat(np.arange(n), np.diff(K.indptr))
    row, width = K.indices, int(np.abs(K.indices - column).max(initial=0))
    if not n or width > WIDEST or not np.diff(K.indptr).all():
        return False
    units = np.where(units > 0, units, 1.0)
    stiffness = np.maximum.reduceat(np.abs(K.data) / units[row], K.indptr[:-1]) / units
    scale = 1.0 / (units * np.sqrt(np.maximum(stiffness, FLOOR * stiffness.max())))
    above, values = np.abs(row - column), K.data * scale[row] * scale[column]
    at = (width - above) * n + np.maximum(row, column)
    band = np.bincount(at, np.where(above == 0, values - zero, values / 2), minlength=(width + 1) * n)
    try:
        cholesky_banded(band.reshape(width + 1, n), overwrite_ab=True, check_finite=False)
    except np.linalg.LinAlgError:
        return False
    return True


def scaled(K: csc_array, C: Any = None, units: np.ndarray | None = None) -> tuple[csc_array, csr_array, np.ndarray]:
    """Return D K D with a diagonal of about one, independent rows of C D of unit length, and D's diagonal (n,)."""
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
    """Return (n,): what unknowns are multiplied by, so that no row of K has an entry much above one."""
    units = np.where(units > 0, units, 1.0)
    per_unit = diags_array(1.0 / units)
    stiffness = abs(per_unit @ K @ per_unit).max(axis=1).toarray().ravel()
    largest = stiffness.max(initial=0.0) or 1.0
    return 1.0 / (units * np.sqrt(np.maximum(stiffness, FLOOR * largest)))


def _independent(C: csr_array) -> csr_array:
    """Return the rows of unit length that span what C does."""
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


def negatives(K: csc_array, C: csc_array | csr_array) -> int:
    """Return how many eigenvalues of K (n, n), sparse and symmetric, are negative on C x = 0; C (m, n), sparse, of rank
    m.

    The eigenvalues of [[K, C'], [C, 0]] are counted: m of them are negative, and m positive, of the constraints
    (Gould, Math. Program. 32 (1985) 90-99). Unknowns whose elimination would let entries grow are eliminated last, all
    together, by Bunch and Kaufman: the negative ones are those of the pivots before, and of what is left then
    (Haynsworth, Linear Algebra Appl. 1 (1968) 73-81). The count is that of a matrix which differs from K by rounding,
    seldom more than 1e-15 of it, at the worst 1e-9: amid the spectrum, not near its lower end.
    Raises ArithmeticError where so many would come last that memory and time do not allow it, or growth does not end.
    """
    n, m = K.shape[0], C.shape[0]
    whole = block_array([[K, C.T], [C, None]], format="csc") if m else K.tocsc()
    by = diags_array(equilibrating(whole))
    whole = (by @ whole @ by).tocsc()
    if n + m <= SMALL:
        return _negatives_of_blocks(whole.toarray()) - m
    is_late = np.abs(whole.diagonal()) < WITHOUT
    growth = GROWTH
    for _ in range(MOST_FACTORISATIONS):
        late, early = np.flatnonzero(is_late), np.flatnonzero(~is_late)
        if len(late) > MOST_LATE:
            break
        if not len(early):
            return _negatives_of_blocks(whole.toarray()) - m
        border = whole[early][:, late]
        pivots, rest, growing = _eliminated(whole[early][:, early].tocsc(), border.toarray(), growth)
        if not len(growing):
            left = whole[late][:, late].toarray() - border.T @ rest
            return int(np.count_nonzero(pivots < 0)) + _negatives_of_blocks(left) - m
        is_late[early[growing]] = True
        growth = min(growth * MORE_GROWTH, MOST_GROWTH)
    raise ArithmeticError("the pivots of the stiffness are too small for their signs to be known")


def equilibrating(K: csc_array) -> np.ndarray:
    """Return (n,): d such that the largest entry of each row of d_i K_ij d_j is about 1; K symmetric (Ruiz,
    RAL-TR-2001-034).
    """
    size, scale = abs(K).tocsc(), np.ones(K.shape[0])
    size.eliminate_zeros()
    column = np.repeat(np.arange(len(scale)), np.diff(size.indptr))
    filled = np.flatnonzero(np.diff(size.indptr))
    for _ in range(6):
        if not size.nnz:
            break
        step = np.ones(len(scale))
        step[filled] = 1 / np.sqrt(np.maximum.reduceat(size.data, size.indptr[filled]))
        size.data *= step[size.indices] * step[column]
        scale *= step
    return scale


def _eliminated(K: csc_array, border: np.ndarray, growth: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return pivots of K on its diagonal, K^-1 border (n, late), and unknowns that make entries grow more, the worst of
    them.

    K and border have entries of one at most. SuperLU factors without exchange of rows: K = L U with U = D L'. Pivot k
    adds U_kj² / |D_k| to the diagonal entry j of what is left. The pivots are sound where none grows.
    """
    n = K.shape[0]
    for nudge in NUDGES:  # where SuperLU takes no pivot that is zero or nearly so: a little above, it is seen to grow
        try:
            factor = splu(K + nudge * eye_array(n, format="csc") if nudge else K, permc_spec="MMD_AT_PLUS_A",
                          diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        except RuntimeError:
            continue
        if np.array_equal(factor.perm_r, factor.perm_c):
            break
    else:
        raise ArithmeticError("the stiffness has no pivots on its diagonal")
    order = np.argsort(factor.perm_c)
    upper, pivots = factor.U, factor.U.diagonal()
    rest = factor.solve(border) if border.shape[1] else border
    beside = abs(triu(upper, 1)).max(axis=1).toarray().ravel()
    if border.shape[1]:
        beside = np.maximum(beside, np.abs(upper @ rest[order]).max(axis=1))
    size = np.abs(pivots)
    added = beside**2 / np.maximum(size, np.finfo(float).tiny)
    growing = added > growth
    first = growing & (beside > growth * size)  # pivots that are small, not those that had grown before their turn
    found = np.flatnonzero(first if first.any() else growing)
    return pivots, rest, order[found[np.argsort(-added[found])[:AT_ONCE]]]


def _negatives_of_blocks(K: np.ndarray) -> int:
    """Return the negative eigenvalues of a dense matrix, by the pivots of Bunch and Kaufman of one and two rows."""
    if not len(K):
        return 0
    scale = 1 / np.sqrt(np.maximum(np.abs(K).max(axis=1), 1e-300))
    blocks = ldl(scale[:, None] * ((K + K.T) / 2) * scale)[1]
    count, k = 0, 0
    while k < len(blocks):
        if k + 1 < len(blocks) and blocks[k + 1, k] != 0:  # a block of two rows has one of each sign
            count, k = count + 1, k + 2
        else:
            count, k = count + (blocks[k, k] < 0), k + 1
    return int(count)
