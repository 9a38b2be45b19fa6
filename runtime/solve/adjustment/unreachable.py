"""A step of parameters towards targets, by a linear model within limits, and why targets cannot be reached."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .parameters import Parameters

RANK_TOLERANCE = 1e-8
"""Of the largest singular value of the scaled derivatives: what is below is none, as they are differences."""
MIN_PARTICIPATION = 0.1
"""Of a combination of targets: what takes part in it less is not named."""


@dataclass
class Linear:
    """The linear model of the misfits, and the step that it advises.

    A (targets, n): derivatives of the values over their scales, by the parameters over their sizes; misfit (targets,)
    over the scales; step (n,): of the parameters, the least over their sizes that leaves the least misfit; free (n,):
    which of them are not at a limit after it; gains: by how much the norm of the misfits falls.
    """

    A: np.ndarray
    misfit: np.ndarray
    step: np.ndarray
    free: np.ndarray
    gains: float

    @classmethod
    def of(cls, parameters: Parameters, p: np.ndarray, G: np.ndarray, scales: np.ndarray, misfit: np.ndarray,
           sizes: np.ndarray) -> Linear:
        """Return the model at the values p (n,); G (targets, n): derivatives. Where the step leads beyond a limit, the
        parameter stops there, and the others do what they can.
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
        """Return (targets, k): an orthonormal basis of the combinations of targets that these parameters do not change.
        """
        if not columns.any():
            return np.eye(len(self.misfit))
        U, values, _ = np.linalg.svd(self.A[:, columns])
        return U[:, int(np.sum(values > RANK_TOLERANCE * values[0])):] if values[0] > 0 else U


def why_unreachable(linear: Linear, g: np.ndarray, to: Mapping[str, float], cause: str) -> str:
    """Return which targets are not reached, how far from them the search ended, and why, as a message; g: values there.
    """
    names = list(to)
    missed = np.abs(linear.misfit) > MIN_PARTICIPATION * np.max(np.abs(linear.misfit))
    values = " and ".join(f'"{names[k]}" is {g[k]:.9g}, not {to[names[k]]:.9g}' for k in np.flatnonzero(missed))
    return f"the targets are not reached: {values}; {cause}; the state there is kept in .state"


def cause_of(parameters: Parameters, linear: Linear, names: list[str], reason: str) -> str:
    """Return why the search ended where it did, in words; names: of the targets; reason: why no step was taken."""
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
    """Return the targets that cannot be changed one without the other, quoted, where they have misfits; else None."""
    basis = linear.out_of_reach(columns)
    left = basis.T @ linear.misfit
    if not np.any(np.abs(left) > MIN_PARTICIPATION * np.linalg.norm(linear.misfit)):
        return None
    share = np.linalg.norm(basis * (np.abs(left) > 0), axis=1)
    return _quoted([names[k] for k in np.flatnonzero(share > MIN_PARTICIPATION)])


def _at_limit(parameters: Parameters, linear: Linear, k: int) -> str:
    """Return that a parameter is at its limit, in words."""
    down = linear.step[k] < 0 or not np.isfinite(parameters.high[k])
    name = f'"{parameters.names[k]}"'
    if down and parameters.natural[k]:
        return f"{name} would have to be zero or below"
    return f"{name} is at its limit {parameters.low[k] if down else parameters.high[k]:.9g}"


def _quoted(names: list[str]) -> str:
    """Return names in quotes, in words."""
    quoted = [f'"{name}"' for name in names]
    return " and ".join(filter(None, [", ".join(quoted[:-1]), quoted[-1]]))
