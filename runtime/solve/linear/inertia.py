"""Inertia of a symmetric stiffness on the null space of constraints: how many eigenvalues lie below, at and above zero.

Signs are counted from a factorisation (Sylvester's law of inertia), not from a few computed eigenvalues: the count is
complete for any number and multiplicity of eigenvalues. `inertia` is for states of rest, where zeros count separately
and constraints may be redundant; `negatives` is for the spectrum, at a shift.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import cholesky_banded, eigvalsh, ldl, qr
from scipy.sparse import block_array, csc_array, csr_array, diags_array, eye_array, triu
from scipy.sparse.linalg import splu

from .matrices import MAX_DENSE_UNKNOWNS, all_finite, between, dense, row_maxima

ZERO_EIGENVALUE = 1e-13
"""Eigenvalues of the scaled stiffness, whose diagonal is one, below which they cannot be distinguished from zero."""
MIN_STIFFNESS_RATIO = 1e-6
"""Lower bound of the stiffness by which unknowns are scaled, as a fraction of the largest: else the rounding of a free
direction would be scaled up to a stiffness."""
DEPENDENCE_TOLERANCE = 1e-10
"""Independent part of a constraint of unit length below which it follows from others."""
MAX_CHOLESKY_UNKNOWNS = 500
"""Unknowns up to which Cholesky's factorisation of an array is tried, where the band is wide: it takes 2 ms."""
MAX_BANDWIDTH = 100
"""Diagonals on a side of the band up to which Cholesky's factorisation is tried first."""
MAX_DENSE_ROWS = 300
"""Rows up to which the factorisation is dense, by Bunch and Kaufman."""
GROWTH_LIMIT = 16.0
"""Growth by an elimination of entries of at most one. Its rounding is 1e-16 of it: well below `ZERO_EIGENVALUE`."""
GROWTH_LIMIT_RATIO = 10.0
"""Ratio of the growth limits of consecutive factorisations: in the middle of the spectrum growth does not end."""
MAX_GROWTH_LIMIT = 1e7
"""Growth limit up to which signs count: the rounding is 1e-9 then."""
MAX_DEFERRED_AT_ONCE = 60
"""Unknowns of the largest growth that are deferred for the next factorisation."""
MIN_PIVOT = 1e-12
"""Diagonal of an unknown over the largest entry in its row below which it is deferred."""
DIAGONAL_SHIFTS = 0.0, MIN_PIVOT, 10 * MIN_PIVOT, 100 * MIN_PIVOT
"""Shifts of the diagonal, which is about one, in turn, where it has no pivots, to find the small ones."""
MAX_FACTORISATIONS = 30
MAX_DEFERRED_UNKNOWNS = 3000
"""Unknowns that the dense end of the factorisation takes: 72 MB."""


class Inertia(NamedTuple):
    """Numbers of eigenvalues of the constrained stiffness below zero, zero within rounding, and above zero."""

    negative: int
    zero: int
    positive: int


def inertia(K: Any, C: Any = None, units: np.ndarray | None = None, zero: float = ZERO_EIGENVALUE) -> Inertia:
    """Return the inertia of K (n, n), symmetric, on the null space of C (m, n); both sparse or dense. For few unknowns
    the eigenvalues themselves are computed.

    Rows of C may depend on each other. ``inertia(K - shift * M, C)`` counts the eigenvalues of (K, M) below a shift.
    units (n,): displacement of a point by a unit of each unknown, which makes all entries of K comparable (N/m); None:
    they are. K is scaled to a diagonal of about one, which changes no sign; zero: smaller eigenvalues of the scaled K
    count as zero.
    Raises ValueError where K is not finite or not symmetric to 1e-8 of its largest entry; ArithmeticError, see
    `negatives`.
    """
    n = K.shape[0]
    is_small = n <= MAX_DENSE_UNKNOWNS
    K = dense(K) if is_small else csc_array(K, dtype=float)
    C = np.zeros((0, n)) if C is None else dense(C) if is_small else csr_array(C, dtype=float)
    _check(K)
    if not n:
        return Inertia(0, 0, 0)
    units = _positive(units, n)
    if (not is_small and _is_definite_band(K, units, zero)) or (
            n <= MAX_CHOLESKY_UNKNOWNS and _is_definite(dense(K), units, zero)):
        return Inertia(0, 0, n - _independent(C).shape[0])
    K, C, _ = scaled((K + K.T) / 2, C, units)
    if is_small:
        return _by_eigenvalues(K, C, zero)
    shift = zero * eye_array(n, format="csc")
    below = negatives(K + shift, C)
    at = negatives(K - shift, C) - below
    return Inertia(below, at, n - C.shape[0] - below - at)


def _is_definite(K: np.ndarray, units: np.ndarray, zero: float) -> bool:
    """Return whether a factorisation shows that all eigenvalues of K, scaled as by `scaled`, exceed ``zero``; they do
    so on the null space of any constraints, too.
    """
    scale = _scale(K, units)
    try:
        np.linalg.cholesky(between(scale, (K + K.T) / 2, scale) - zero * np.eye(len(K)))
    except np.linalg.LinAlgError:
        return False
    return True


def _is_definite_band(K: csc_array, units: np.ndarray, zero: float) -> bool:
    """Return the same of a sparse matrix; False also where the band is too wide for a quick factorisation."""
    n = K.shape[0]
    column = np.repeat(np.arange(n), np.diff(K.indptr))
    row, width = K.indices, int(np.abs(K.indices - column).max(initial=0))
    if not n or width > MAX_BANDWIDTH or not np.diff(K.indptr).all():
        return False
    stiffness = np.maximum.reduceat(np.abs(K.data) / units[row], K.indptr[:-1]) / units
    scale = 1.0 / (units * np.sqrt(np.maximum(stiffness, MIN_STIFFNESS_RATIO * stiffness.max())))
    above, values = np.abs(row - column), K.data * scale[row] * scale[column]
    at = (width - above) * n + np.maximum(row, column)
    band = np.bincount(at, np.where(above == 0, values - zero, values / 2), minlength=(width + 1) * n)
    try:
        cholesky_banded(band.reshape(width + 1, n), overwrite_ab=True, check_finite=False)
    except np.linalg.LinAlgError:
        return False
    return True


def scaled(K: Any, C: Any, units: np.ndarray | None = None) -> tuple[Any, Any, np.ndarray]:
    """Return D K D with a diagonal of about one, independent rows of C D of unit length, and D's diagonal (n,); K and C
    are both arrays or both sparse.
    """
    scale = _scale(K, _positive(units, K.shape[0]))
    whole = between(scale, K, scale)
    return whole if isinstance(K, np.ndarray) else whole.tocsc(), _independent(C, scale), scale


def _positive(units: np.ndarray | None, n: int) -> np.ndarray:
    """Return (n,): displacements of a point by a unit of each unknown, one where they are not known."""
    given = np.ones(n) if units is None else np.asarray(units, dtype=float)
    return np.where(given > 0, given, 1.0)


def _check(K: Any) -> None:
    if not all_finite(K):
        raise ValueError("the stiffness is not finite")
    if row_maxima(K - K.T).max(initial=0.0) > 1e-8 * row_maxima(K).max(initial=0.0):
        raise ValueError("the stiffness is not symmetric")


def _scale(K: Any, units: np.ndarray) -> np.ndarray:
    """Return (n,): factors of the unknowns with which no row of K has an entry much above one."""
    stiffness = row_maxima(between(1.0 / units, K, 1.0 / units))
    largest = stiffness.max(initial=0.0) or 1.0
    return np.asarray(1.0 / (units * np.sqrt(np.maximum(stiffness, MIN_STIFFNESS_RATIO * largest))))


def _independent(C: Any, scale: np.ndarray | None = None) -> Any:
    """Return rows of unit length with the span of C, its columns times a scale."""
    if not C.shape[0]:
        return C
    C = C if scale is None else between(np.ones(C.shape[0]), C, scale)
    length = np.sqrt(np.asarray((C * C).sum(axis=1)).ravel())
    C = between(1.0 / np.where(length > 0, length, 1.0), C, np.ones(C.shape[1]))[length > 0]
    if not C.shape[0]:
        return C
    occurring = np.flatnonzero(abs(C).sum(axis=0))
    r, order = qr(dense(C[:, occurring]).T, mode="r", pivoting=True)
    diagonal = np.abs(np.diag(r))
    return C[np.sort(order[: np.count_nonzero(diagonal > DEPENDENCE_TOLERANCE)])]


def _by_eigenvalues(K: np.ndarray, C: np.ndarray, zero: float) -> Inertia:
    if C.shape[0]:
        free = qr(C.T)[0][:, C.shape[0]:]  # rows of C are independent
        K = free.T @ K @ free
    values = eigvalsh(K) if K.shape[0] else np.zeros(0)
    below, above = int(np.count_nonzero(values < -zero)), int(np.count_nonzero(values > zero))
    return Inertia(below, len(values) - below - above, above)


def negatives(K: csc_array, C: csc_array | csr_array) -> int:
    """Return the number of negative eigenvalues of K (n, n), sparse and symmetric, on C x = 0; C (m, n), sparse, of
    rank m.

    The eigenvalues of [[K, C'], [C, 0]] are counted: m of them are negative, and m positive, of the constraints
    (Gould, Math. Program. 32 (1985) 90-99). Unknowns whose elimination would let entries grow are deferred, and
    eliminated together by Bunch and Kaufman: negative eigenvalues are those of the pivots before, and of the Schur
    complement (Haynsworth, Linear Algebra Appl. 1 (1968) 73-81). The count is that of a matrix which differs from K by
    rounding, seldom by more than 1e-15 of it, and by 1e-9 at most, in the middle of the spectrum.
    Raises ArithmeticError where too many unknowns are deferred for memory and time, or where growth does not end.
    """
    n, m = K.shape[0], C.shape[0]
    whole = block_array([[K, C.T], [C, None]], format="csc") if m else K.tocsc()
    by = diags_array(equilibrating(whole))
    whole = (by @ whole @ by).tocsc()
    if n + m <= MAX_DENSE_ROWS:
        return int(_negatives_of_blocks(whole.toarray()) - m)
    is_late = np.abs(whole.diagonal()) < MIN_PIVOT
    growth = GROWTH_LIMIT
    for _ in range(MAX_FACTORISATIONS):
        late, early = np.flatnonzero(is_late), np.flatnonzero(~is_late)
        if len(late) > MAX_DEFERRED_UNKNOWNS:
            break
        if not len(early):
            return int(_negatives_of_blocks(whole.toarray()) - m)
        border = whole[early][:, late]
        pivots, rest, growing = _eliminated(whole[early][:, early].tocsc(), border.toarray(), growth)
        if not len(growing):
            left = whole[late][:, late].toarray() - border.T @ rest
            return int(np.count_nonzero(pivots < 0) + _negatives_of_blocks(left) - m)
        is_late[early[growing]] = True
        growth = min(growth * GROWTH_LIMIT_RATIO, MAX_GROWTH_LIMIT)
    raise ArithmeticError("the pivots of the stiffness are too small for their signs to be known")


def equilibrating(K: csc_array) -> np.ndarray:
    """Return d (n,) such that the largest entry of each row of d_i K_ij d_j is about 1; K symmetric (Ruiz,
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
    """Return pivots of K on its diagonal, K^-1 border (n, late), and the unknowns with the largest growth beyond the
    limit.

    K and border have entries of one at most. SuperLU factors without exchange of rows: K = L U with U = D L'. Pivot k
    adds U_kj² / |D_k| to the remaining diagonal entry j. The pivots are sound where none exceeds the limit.
    """
    n = K.shape[0]
    for shift in DIAGONAL_SHIFTS:  # SuperLU takes no zero pivot; with a small one the growth is seen
        try:
            factor = splu(K + shift * eye_array(n, format="csc") if shift else K, permc_spec="MMD_AT_PLUS_A",
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
    first = growing & (beside > growth * size)  # small pivots, not those that grew before their turn
    found = np.flatnonzero(first if first.any() else growing)
    return pivots, rest, order[found[np.argsort(-added[found])[:MAX_DEFERRED_AT_ONCE]]]


def _negatives_of_blocks(K: np.ndarray) -> int:
    """Return the number of negative eigenvalues of a dense matrix, by the pivots of Bunch and Kaufman."""
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
