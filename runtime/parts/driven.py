"""Quantities of parts that a signal prescribes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .signal import Signal, at_start, extremes

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # for type checkers alone

GROWTH = "growth"
"""The factor of the stress-free length of a cable."""


@dataclass(frozen=True)
class Driven:
    """A quantity that a signal f prescribes: base + linear f; without a signal the constant base."""

    signal: Signal | None
    base: float
    linear: float = 0.0

    @property
    def start(self) -> float:
        """Return its value at t = 0."""
        return self.base if self.signal is None else self.base + self.linear * at_start(self.signal)

    @property
    def least(self) -> float:
        """Return a lower bound of it over all times."""
        if self.signal is None:
            return self.base
        return min(self.base + self.linear * value for value in extremes(self.signal))

    @property
    def greatest(self) -> float:
        """Return an upper bound of it over all times."""
        if self.signal is None:
            return self.base
        return max(self.base + self.linear * value for value in extremes(self.signal))

    def at(self, time: ArrayLike) -> np.ndarray:
        """Return its values at times of any shape, in s."""
        found = np.zeros(np.shape(time)) if self.signal is None else self.signal.value(time)
        return np.asarray(self.base + self.linear * found)
