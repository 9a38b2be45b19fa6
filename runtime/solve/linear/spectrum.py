"""The lowest eigenpairs of K x = λ M x on C x = 0, complete: counted by the signs of a factorisation's pivots."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import eigh, qr
from scipy.sparse import block_array, csc_array, diags_array
from scipy.sparse.linalg import splu

from .inertia import equilibrating, negatives

EXTRA_PAIRS = 4
"""Pairs computed beyond those asked for: the count needs a gap between eigenvalues."""

MAX_DENSE_DEGREES = 40
"""Degrees of freedom up to which all eigenvalues are computed."""

RESIDUAL_TOLERANCE = 1e-8
"""Relative residual of a pair of the inverse; the error of the eigenvalue is of the order of its square."""

MAX_STALLED_EXTENSIONS = 6
"""Extensions of the subspace without a smaller residual, after which rounding determines it."""

MAX_EXTENSIONS = 200
MAX_STARTS = 4
MAX_SUBSPACE_BLOCKS = 12
"""Blocks of the subspace beyond which it is restarted with the pairs found."""

SHIFT_RATIO = 16.0
"""Ratio of the shifts between which a search for an eigenvalue's size ends."""

MIN_EIGENVALUE_RATIO = 1e-30
"""Smallest eigenvalue that is sought, as a fraction of the largest: the square of the rounding of a shape."""

CLUSTER_RATIO = 1e-4
"""Eigenvalues below this fraction of the shift are not well separated by its inverse."""

ZERO_SEPARATION = 1e6
"""Lower bound of the ratio of non-zero eigenvalues to those that rounding makes of zeros."""

MAX_CLUSTER_SIZE = 2000
"""Eigenvalues too close to be separated, of which all are computed, up to this number."""

EIGENVALUE_ROUNDING = 1e-14
"""Rounding error of eigenvalues, as a fraction of the largest that is computed with them."""

NEGLIGIBLE_RATIO = 1e-6
"""Resolution of a cluster, as a fraction of the eigenvalue that follows."""

GAP_TOLERANCE = 1e-6
"""Relative distance of adjacent eigenvalues between which a count is certain."""

ROUNDING_RATIO = 4 * SHIFT_RATIO
"""Scale of a cluster over the rounding errors of its eigenvalues: none of them is below the shift of the inverse."""

STIFFNESS_ROUNDING = 4 * np.finfo(float).eps
"""Relative error of the entries of K and of their sums."""


class IncompleteError(Exception):
    """Eigenvalues that the factorisation counts were not found."""


class Pencil:
    """K x = λ M x on C x = 0, scaled to coordinates of unit inertia.

    K: (n, n) sparse symmetric; M: (n, n) sparse, symmetric, positive definite on C x = 0; C: (m, n) sparse of rank m.
    A coordinate without inertia is one that the constraints determine.
    """

    def __init__(self, K: csc_array, M: csc_array, C: csc_array):
        self.unit = float(abs(K).max()) if K.nnz else 0.0  # of stiffness and eigenvalues
        self.unit = self.unit or 1.0
        K = K / self.unit
        inertia = M.diagonal()
        heavy = inertia > 0
        scale = np.ones(len(inertia))
        scale[heavy] = 1 / np.sqrt(inertia[heavy])
        if C.shape[0]:
            size = abs(C) @ diags_array(scale)
            rows = np.asarray(size.tocsc()[:, heavy].max(axis=1).todense()).ravel()
            for at in np.flatnonzero(~heavy):  # as large in the constraints as the coordinates with inertia
                column = size.tocsc()[:, [at]].toarray().ravel()
                if rows[column > 0].any():  # or no coordinate with inertia is in them
                    scale[at] = rows[column > 0].max() / column.max()
        by = diags_array(scale)
        self.scale = scale
        self.K = _symmetric((by @ K @ by).tocsc())
        self.M = _symmetric((by @ M @ by).tocsc())
        C = (C @ by).tocsr()
        if C.shape[0]:
            C = (diags_array(1 / np.asarray(abs(C).max(axis=1).todense()).ravel()) @ C).tocsr()
        self.C = C
        self.degrees = K.shape[0] - C.shape[0]
        self.largest = float(np.max(np.asarray(abs(self.K).sum(axis=1)).ravel()[heavy], initial=0.0)) or 1.0
        self.floor = MIN_EIGENVALUE_RATIO * self.largest
        self.random = np.random.default_rng(0)

    def below(self, shift: float) -> int:
        """Return the number of eigenvalues below a shift. Raises ArithmeticError where it cannot be counted."""
        for nudge in (0.0, 1e-7, -1e-7, 1e-5):  # beside a shift at which a part of the matrix is singular
            try:
                return negatives((self.K - shift * (1 + nudge) * self.M).tocsc(), self.C)
            except ArithmeticError:
                continue
        raise ArithmeticError("the pivots of the stiffness are too small for their signs to be known")

    def inverse(self, shift: float) -> Callable[[np.ndarray], np.ndarray]:
        """Return the solver of (K - shift M) x = M y on C x = 0 for y (n, k)."""
        n, m = self.K.shape[0], self.C.shape[0]
        whole = (self.K - shift * self.M).tocsc()
        if m:
            whole = block_array([[whole, self.C.T], [self.C, None]], format="csc")
        by = equilibrating(whole)
        factor = splu((diags_array(by) @ whole @ diags_array(by)).tocsc())

        def solve(y: np.ndarray) -> np.ndarray:
            right = np.zeros((n + m, y.shape[1]))
            right[:n] = self.M @ y
            return np.asarray(by[:n, None] * factor.solve(by[:, None] * right)[:n])

        return solve

    def lowest(self, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
        """Return at least the n smallest eigenvalues (n,), their vectors (coordinates, n) with x'Mx = 1, the rounding
        errors of the eigenvalues (n,), and the next eigenvalue, infinite if there is none.

        Raises IncompleteError, ArithmeticError, RuntimeError.
        """
        all_at_once = n + EXTRA_PAIRS >= self.degrees or self.degrees <= MAX_DENSE_DEGREES
        values, x, after, top = self._by_lapack() if all_at_once else self._by_inverse(n)
        values, x, error = self._taken_apart(values, x, after, top)
        return self.unit * values, self.scale[:, None] * x, self.unit * error, self.unit * after

    def refined(self, values: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return pairs that LAPACK found, of all at once, without the rounding of the largest eigenvalue, and the
        rounding errors of the eigenvalues; none of the values (n,), rising, is zero.

        One iteration by the inverse, and the pairs of the space of its vectors, x (coordinates, n) as of `lowest`.
        """
        x = self.inverse(-np.abs(values).max() / self.unit / SHIFT_RATIO)(x / self.scale[:, None])
        x = x / np.sqrt(np.sum(x * (self.M @ x), axis=0))
        values, turn = eigh(x.T @ (self.K @ x), x.T @ (self.M @ x))
        x = x @ turn
        error = np.maximum(self.uncertainty(x), EIGENVALUE_ROUNDING * np.abs(values).max())
        return self.unit * values, self.scale[:, None] * x, self.unit * error

    def _by_lapack(self) -> tuple[np.ndarray, np.ndarray, float, float]:
        """Return all pairs of the scaled matrices, infinity for the next eigenvalue, and the size of the largest."""
        free = basis(self.C)
        k, m = free.T @ (self.K @ free), free.T @ (self.M @ free)
        values, x = eigh((k + k.T) / 2, (m + m.T) / 2)
        return values, free @ x, np.inf, np.abs(values).max(initial=0.0)

    def _by_inverse(self, n: int) -> tuple[np.ndarray, np.ndarray, float, float]:
        """Return at least the n lowest pairs, the next eigenvalue, and the scale at which they were found."""
        while n + EXTRA_PAIRS < self.degrees:
            top = self.reaching(n + EXTRA_PAIRS)
            try:
                return *self._from_below(n, top), top
            except IncompleteError:  # n of a large cluster, most often at zero: take all of it, and some above
                n = max(2 * n, self.below(ZERO_SEPARATION * top))
                if n > MAX_CLUSTER_SIZE:
                    raise
        return self._by_lapack()

    def _from_below(self, n: int, top: float) -> tuple[np.ndarray, np.ndarray, float]:
        """Return the lowest pairs and the next eigenvalue by the inverse at a shift below them, at two shifts where
        some are negative.
        """
        middle = -top / SHIFT_RATIO
        negative = self.below(middle)
        values, x, after = np.zeros(0), np.zeros((self.K.shape[0], 0)), 0.0
        if negative:
            bottom = middle
            while self.below(bottom) and -bottom < 1e3 * self.largest:
                bottom *= SHIFT_RATIO
            values, x, after = self._above(bottom, min(n, negative), values, x)
        if len(values) < n:
            values, x, after = self._above(middle, n, values, x)
        return values, x, after

    def _taken_apart(self, values: np.ndarray, x: np.ndarray, after: float, top: float
                     ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return pairs found at the scale of ``top``, with much smaller ones, a cluster at that scale, resolved at
        their own scale, and the rounding errors of the eigenvalues; after: the next eigenvalue.
        """
        error = np.maximum(self.uncertainty(x), max(EIGENVALUE_ROUNDING * top, self.floor))
        small = int(np.count_nonzero(values < CLUSTER_RATIO * top))
        if not small or values[0] < -CLUSTER_RATIO * top or small == self.degrees:
            return values, x, error
        after = values[small] if small < len(values) else after
        bound, rounding = np.sqrt(NEGLIGIBLE_RATIO) * after, self.uncertainty(x[:, :small]).max()
        scale = max(self.reaching(small), NEGLIGIBLE_RATIO * after, ROUNDING_RATIO * rounding)
        if not scale < CLUSTER_RATIO * top or self.below(bound) != small:
            return values, x, error
        while scale < CLUSTER_RATIO * top:
            found, own = self._sorted(self._nearest(self.inverse(-scale / SHIFT_RATIO), x[:, :small], x[:, :0], small))
            if len(found) == small and found[-1] < bound:  # as many as are counted below it: these are all of them
                values[:small], x[:, :small], error[:small] = self._taken_apart(found, own, after, scale)
                break
            scale *= SHIFT_RATIO  # one was below the shift, where its inverse is negative
        return values, x, error

    def uncertainty(self, x: np.ndarray) -> np.ndarray:
        """Return the error of x'Kx / x'Mx by the rounding of K's entries, for each column of x."""
        change = STIFFNESS_ROUNDING * np.sum(np.abs(x) * (abs(self.K) @ np.abs(x)), axis=0)
        return np.asarray(change / np.sum(x * (self.M @ x), axis=0))

    def reaching(self, n: int) -> float:
        """Return a positive shift, about the smallest, with at least n eigenvalues below it."""
        low, high = self.floor, self.largest
        while self.below(high) < n:
            high *= SHIFT_RATIO
            if high > ZERO_SEPARATION * self.largest:
                raise IncompleteError("there are fewer eigenvalues than degrees of freedom")
        while high / low > SHIFT_RATIO:
            shift = np.sqrt(low * high)
            low, high = (low, shift) if self.below(shift) >= n else (shift, high)
        return high

    def _above(self, shift: float, n: int, values: np.ndarray, x: np.ndarray
               ) -> tuple[np.ndarray, np.ndarray, float]:
        """Return at least the n lowest pairs, and the next eigenvalue; those below the shift are known."""
        known, more, solve = len(values), EXTRA_PAIRS, self.inverse(shift)
        start = np.zeros((self.K.shape[0], 0))
        for _ in range(MAX_STARTS):
            wanted = min(n - known + more, self.degrees - known)
            random = solve(self.random.standard_normal((self.K.shape[0], wanted)))
            found, start = self._sorted(self._nearest(solve, np.hstack([start, random]), x, wanted))
            at = self._gap(found, start, n - known, known)
            if at is None:
                more *= 2
            elif at == len(found) or self.below(0.5 * (found[at - 1] + found[at])) == known + at:
                return (np.append(values, found[:at]), np.hstack([x, start[:, :at]]),
                        found[at] if at < len(found) else np.inf)
        raise IncompleteError("not all that are counted were found")

    def _gap(self, values: np.ndarray, x: np.ndarray, n: int, known: int) -> int | None:
        """Return the first pair, after n of them, with a gap before it; the number of pairs if these are all."""
        rounding = self.uncertainty(x)
        for at in range(n, len(values)):
            size = max(abs(values[at]), abs(values[at - 1]))
            if values[at] - values[at - 1] > GAP_TOLERANCE * size + rounding[at] + rounding[at - 1]:
                return at
        return len(values) if len(values) == self.degrees - known else None

    def _sorted(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return Rayleigh's quotients of the columns of x, in rising order, and the columns with x'Mx = 1."""
        x = x / np.sqrt(np.sum(x * (self.M @ x), axis=0))
        values = np.sum(x * (self.K @ x), axis=0)
        order = np.argsort(values)
        return values[order], x[:, order]

    def _nearest(self, solve: Callable[[np.ndarray], np.ndarray], start: np.ndarray, known: np.ndarray,
                 wanted: int) -> np.ndarray:
        """Return (n, wanted): vectors of the next eigenvalues above the shift of ``solve``, without the known ones.

        A block method: the subspace grows from many vectors at once by the residuals of the inverse (Davidson, J.
        Comput. Phys. 17 (1975) 87-94, there with one vector), so that repeated eigenvalues are found, too.
        """
        known = self._orthonormal(known)
        V = self._orthonormal(start, known)
        MV, W = self.M @ V, solve(V)
        T = MV.T @ W
        least, stalled = np.inf, 0
        for _ in range(MAX_EXTENSIONS):
            theta, Y = np.linalg.eigh((T + T.T) / 2)
            theta, Y = theta[::-1], Y[:, ::-1]
            y, of = Y[:, :wanted], theta[:wanted]
            R = W @ y - (V @ y) * of
            error = np.sqrt(np.abs(np.sum(R * (self.M @ R), axis=0))) / np.abs(of)
            stalled = 0 if error.max() < 0.5 * least else stalled + 1
            least = min(least, error.max())
            if least <= RESIDUAL_TOLERANCE or stalled > MAX_STALLED_EXTENSIONS:
                break
            if V.shape[1] > MAX_SUBSPACE_BLOCKS * wanted:
                kept = Y[:, : 2 * wanted]
                V, MV, W, T = V @ kept, MV @ kept, W @ kept, np.diag(theta[: 2 * wanted])
            new = self._orthonormal(R[:, error > RESIDUAL_TOLERANCE], known, V)
            if not new.shape[1]:
                break
            image = solve(new)
            across = MV.T @ image
            T = np.block([[T, across], [across.T, new.T @ (self.M @ image)]])
            V, MV, W = np.hstack([V, new]), np.hstack([MV, self.M @ new]), np.hstack([W, image])
        return np.asarray(W @ y / of)  # the inverse once more removes the rounding of the highest eigenvalues

    def _orthonormal(self, x: np.ndarray, *against: np.ndarray) -> np.ndarray:
        """Return a basis of the columns of x, x'Mx = 1, orthogonal to others; dependent columns are left out."""
        for _ in range(2):
            for others in against:
                x = x - others @ (others.T @ (self.M @ x))
            size = np.sqrt(np.maximum(np.sum(x * (self.M @ x), axis=0), 0.0))
            x = x[:, size > 0] / size[size > 0]
            values, turn = np.linalg.eigh(x.T @ (self.M @ x))
            kept = values > 1e-12
            x = x @ (turn[:, kept] / np.sqrt(values[kept]))
        return x


def basis(C: csc_array) -> np.ndarray:
    """Return (n, n - m): orthonormal vectors with C x = 0; C (m, n) of rank m."""
    m, n = C.shape
    return qr(C.toarray().T)[0][:, m:] if m else np.eye(n)


def _symmetric(K: csc_array) -> csc_array:
    return ((K + K.T) / 2).tocsc()
