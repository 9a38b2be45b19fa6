"""Quantities of parts that a signal prescribes."""

from dataclasses import dataclass

from .signal import Signal, at_start, extremes

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
