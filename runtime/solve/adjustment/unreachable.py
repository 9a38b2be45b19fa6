"""A step of parameters towards targets by a linear model within limits, and the cause of targets out of reach."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .parameters import Parameters

RANK_TOLERANCE = 1e-8
"""Singular values of the scaled derivatives, which are differences, below this fraction of the largest count as
zero."""
MIN_PARTICIPATION = 0.1
"""Messages name the targets with at least this part in a combination."""


@dataclass
class Linear:
    """The linear model of the misfits, and its step.

    A (targets, n): derivatives of the values over their scales, by the parameters over their sizes; misfit (targets,)
    over the scales; step (n,): of the parameters, the smallest over their sizes with the smallest misfit; free (n,):
    which of them are within their limits after it; gains: decrease of the norm of the misfits.
    """

    A: np.ndarray
    misfit: np.ndarray
    step: np.ndarray
    free: np.ndarray
    gains: float

    @classmethod
    def of(cls, parameters: Parameters[Any], p: np.ndarray, G: np.ndarray, scales: np.ndarray, misfit: np.ndarray,
           sizes: np.ndarray) -> Linear:
        """Return the model at the values p (n,); G (targets, n): derivatives. A parameter stops at its limit, and the
        others reduce the remaining misfit.
        """
        A = G * sizes / scales[:, None]
        low, high = (parameters.low - p) / sizes, (parameters.high - p) / sizes
        free, y = np.ones(len(p), dtype=bool), np.zeros(len(p))
        while free.any():
            y[free] = np.linalg.pinv(A[:, free], rcond=RANK_TOLERANCE) @ (misfit - A[:, ~free] @ y[~free])
            beyond = free & ((y < low) | (y > high))
            if not beyond.any():
                break
            y[beyond] = np.clip(y, low, high)[beyond]
            free &= ~beyond
        left = float(np.linalg.norm(misfit - A @ y))
        gains = float(np.linalg.norm(misfit)) - left
        return cls(A, misfit, sizes * y, free, gains if gains > RANK_TOLERANCE * np.linalg.norm(misfit) else 0.0)

    def out_of_reach(self, columns: np.ndarray) -> np.ndarray:
        """Return (targets, k): an orthonormal basis of the combinations of targets that parameters do not change."""
        if not columns.any():
            return np.eye(len(self.misfit))
        U, values, _ = np.linalg.svd(self.A[:, columns])
        return U[:, int(np.sum(values > RANK_TOLERANCE * values[0])):] if values[0] > 0 else U


def why_unreachable(linear: Linear, g: np.ndarray, to: Mapping[str, float], cause: str) -> str:
    """Return a message with the targets that are not reached, the values g there, and the cause."""
    names = list(to)
    missed = np.abs(linear.misfit) > MIN_PARTICIPATION * np.max(np.abs(linear.misfit))
    values = " and ".join(f'"{names[k]}" is {g[k]:.9g}, not {to[names[k]]:.9g}' for k in np.flatnonzero(missed))
    return f"the targets are not reached: {values}; {cause}; the state there is kept in .state"


def cause_of(parameters: Parameters[Any], linear: Linear, names: list[str], reason: str) -> str:
    """Return the cause of the end of a search, in words; names: of the targets; reason: why no step was taken."""
    silent = ~np.any(np.abs(linear.A) > RANK_TOLERANCE * max(np.max(np.abs(linear.A)), 1e-300), axis=1)
    if silent.any():
        which = _quoted([names[k] for k in np.flatnonzero(silent)])
        return f"no parameter changes {which} there: adjust something that does, or begin where it does (a part that " \
               "is slack changes nothing)"
    everything = np.ones(len(parameters.names), dtype=bool)
    if (depends := _in_conflict(linear, everything, names)) is not None:
        return f"the parameters change {depends} only together, so that these values contradict each other"
    if not linear.free.all():
        limits = " and ".join(_at_limit(parameters, linear, k) for k in np.flatnonzero(~linear.free).tolist())
        return f"{limits}; give wider limits, more parameters or other targets"
    return reason


def _in_conflict(linear: Linear, columns: np.ndarray, names: list[str]) -> str | None:
    """Return the targets with misfits that change only together, quoted; None where there are none."""
    basis = linear.out_of_reach(columns)
    left = basis.T @ linear.misfit
    if not np.any(np.abs(left) > MIN_PARTICIPATION * np.linalg.norm(linear.misfit)):
        return None
    share = np.linalg.norm(basis * (np.abs(left) > 0), axis=1)
    return _quoted([names[k] for k in np.flatnonzero(share > MIN_PARTICIPATION)])


def _at_limit(parameters: Parameters[Any], linear: Linear, k: int) -> str:
    """Return a text on the limit of a parameter."""
    down = linear.step[k] < 0 or not np.isfinite(parameters.high[k])
    name = f'"{parameters.names[k]}"'
    if down and parameters.natural[k]:
        return f"{name} would have to be zero or below"
    return f"{name} is at its limit {parameters.low[k] if down else parameters.high[k]:.9g}"


def _quoted(names: list[str]) -> str:
    """Return names in quotes, in words."""
    quoted = [f'"{name}"' for name in names]
    return " and ".join(filter(None, [", ".join(quoted[:-1]), quoted[-1]]))
