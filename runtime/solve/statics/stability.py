"""Stability of a state of rest: the number of independent directions that lower its energy, and the lowest of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import eigh, null_space
from scipy.sparse.linalg import ArpackNoConvergence, eigsh

from ..linear.inertia import ZERO_EIGENVALUE, inertia, scaled
from ..linear.matrices import all_finite, dense
from .static_problem import StaticProblem

ASYMMETRY_ROUNDING = 1e-9
"""Asymmetry of the stiffness due to rounding, relative; follower loads cause more."""
MAX_UNSYMMETRIC_UNKNOWNS = 1500
"""Unknowns up to which all eigenvalues of an unsymmetric stiffness are computed."""
MAX_LAPACK_UNKNOWNS = 600
"""Unknowns up to which LAPACK finds the lowest direction."""
PUSH_SIZE = 1e-3
"""Size of the push off an unstable branch, as a fraction of the scene's size."""


@dataclass(frozen=True)
class Stability:
    """unstable: independent directions that lower the energy; neutral: those that leave it as it is, within rounding.

    follower: the stiffness is not symmetric, since loads turn with what they act on. There is no energy then: unstable
    counts negative real eigenvalues, which are directions of divergence; flutter is not looked for. bound: unstable is
    the count of the symmetric part (of more than 1500 unknowns), which is not less than that of divergence. known:
    False where no factorisation of the stiffness was accurate enough to count; the numbers are zero then.
    """

    unstable: int
    neutral: int
    follower: bool = False
    bound: bool = False
    known: bool = True

    def __str__(self) -> str:
        """Return what is known of the stability, as messages state it."""
        if not self.known:
            return "of unknown stability: no factorisation of its stiffness is accurate enough to count"
        if not self.unstable:
            return "stable"
        if self.bound:
            return f"unstable in up to {self.unstable} independent directions"
        one = self.unstable == 1
        directions = f"{self.unstable} independent direction{'' if one else 's'}"
        return (f"unstable: it diverges in {directions}" if self.follower
                else f"unstable: {directions} {'lowers' if one else 'lower'} its energy")


def stability(problem: StaticProblem) -> Stability:
    """Return the stability of the static state under the present load."""
    K, C, units = problem.stiffness()
    if not K.shape[0]:
        return Stability(0, 0)
    return count(K, C, units)


def count(K: Any, C: Any, units: np.ndarray) -> Stability:
    """Return the stability for a stiffness K on constraints C; units: displacement in m by a unit of each coordinate.
    """
    try:
        return _counted(K, C, units)
    except ArithmeticError:
        return Stability(0, 0, known=False)


def _counted(K: Any, C: Any, units: np.ndarray) -> Stability:
    if not all_finite(K):
        raise ArithmeticError("the stiffness is not finite")
    if abs(K - K.T).max() <= ASYMMETRY_ROUNDING * (abs(K).max() or 1.0):
        found = inertia(K, C, units)
        return Stability(found.negative, found.zero)
    found = inertia((K + K.T) / 2, C, units)  # real eigenvalues are not below those of the symmetric part
    if K.shape[0] > MAX_UNSYMMETRIC_UNKNOWNS or not (found.negative or found.zero):
        return Stability(found.negative, found.zero, follower=True, bound=found.negative > 0)
    K, C, _ = scaled(K, C, units)
    free = _free(C, K.shape[0])
    values = np.linalg.eigvals(free.T @ (K @ free))
    real = values.real[np.abs(values.imag) <= ZERO_EIGENVALUE]
    zero = np.abs(values) <= ZERO_EIGENVALUE
    return Stability(int(np.count_nonzero(real < -ZERO_EIGENVALUE)), int(np.count_nonzero(zero)), follower=True)


def lowest_direction(problem: StaticProblem) -> np.ndarray:
    """Return (unknowns,): the direction of the least curvature of the symmetric part of the scaled stiffness, 1 m long.
    It points along the loads, or has a positive largest entry where it is orthogonal to them.
    """
    K, C, units = problem.stiffness()
    n = K.shape[0]
    K, C, scale = scaled((K + K.T) / 2, C, units)
    if n <= MAX_LAPACK_UNKNOWNS:
        free = _free(C, n)
        found = free @ eigh(free.T @ (K @ free), subset_by_index=(0, 0))[1][:, 0]
    else:
        start = np.random.default_rng(0).standard_normal(n)
        try:  # constraints as stiff springs: a direction near the null space will do
            found = eigsh(K + 10 * C.T @ C, 1, which="SA", v0=start, tol=1e-3)[1][:, 0]
        except ArpackNoConvergence:
            found = start
    direction = np.zeros(len(problem.weight))
    direction[problem.coordinates] = scale * found
    along = direction @ problem.load_vector()
    largest = direction[np.argmax(np.abs(problem.weight * direction))]
    return np.asarray(direction * (np.sign(along) if abs(along) > 1e-9 * np.linalg.norm(direction) * np.linalg.norm(
        problem.load_vector()) else np.sign(largest)) / problem.length(direction))


def push_off(problem: StaticProblem) -> None:
    """Move the static state off an unstable branch, along its lowest direction."""
    problem.move(PUSH_SIZE * problem.size * lowest_direction(problem))


def _free(C: Any, n: int) -> np.ndarray:
    return null_space(dense(C)) if C.shape[0] else np.eye(n)
