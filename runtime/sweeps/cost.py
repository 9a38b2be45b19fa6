"""What a sweep will cost, told from a sample of its points, which are computed first."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from .parameters import Points
from .points import Outcome
from .subject import Subject

SAMPLE_SECONDS, MOST_SAMPLED = 1.0, 8
"""A sample ends after so much time, or so many points."""


@dataclass(frozen=True)
class SweepCost:
    """What a sweep costs. points: that are left to compute; point_seconds: least, mean and largest wall time of one.

    sampled: points that were computed to know it; workers: processes that compute; point_bytes: in the file.
    """

    points: int
    sampled: int
    point_seconds: tuple[float, float, float]
    workers: int
    point_bytes: int

    @property
    def seconds(self) -> float:
        """Return the wall time that is left, in s."""
        return self.points * self.point_seconds[1] / max(self.workers, 1)

    @property
    def bytes(self) -> int:
        """Return the size of the results that are left."""
        return self.points * self.point_bytes

    def __str__(self) -> str:
        """Return the cost in words."""
        least, mean, largest = self.point_seconds
        return (f"{self.points} points of {mean:.3g} s each ({least:.3g} to {largest:.3g} s in a sample of "
                f"{self.sampled}): about {in_words(self.seconds)} on {self.workers} "
                f"worker{'s' * (self.workers != 1)}; {self.point_bytes} bytes a point, {self.bytes / 1e6:.3g} MB")


def in_words(seconds: float) -> str:
    """Return a time in seconds, minutes, hours or days."""
    for size, unit in ((86400.0, "days"), (3600.0, "h"), (60.0, "min")):
        if seconds >= 2 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds:.3g} s"


def sample(subject: Subject, points: Points, missing: np.ndarray) -> dict[int, Outcome]:
    """Return the outcomes of some of the points of these numbers, spread over them, in the order of their numbers.

    The least are two, but of very long ones: the first one brings modules that others need not bring.
    """
    begin, found = time.monotonic(), {}
    for number in dict.fromkeys(missing[_spread(len(missing))].tolist()):
        (found[number],) = subject.compute([points.point(number)])
        took = time.monotonic() - begin
        if any(outcome.kept for outcome in found.values()) and took > SAMPLE_SECONDS * (1 if len(found) > 1 else 3):
            break
    return dict(sorted(found.items()))


def _spread(number: int) -> list[int]:
    """Return places of a sample among so many points: first, last, middle, and between them."""
    parts = (0.0, 1.0, 0.5, 0.25, 0.75, 0.375, 0.625, 0.125)[:MOST_SAMPLED]
    return [round(part * (number - 1)) for part in parts] if number else []


def seconds_of(outcomes: dict[int, Outcome]) -> tuple[float, float, float]:
    """Return the least, mean and largest wall time of a sample; of several the longest one is left out where it is the
    first, which brought modules.
    """
    seconds = [outcome.seconds for outcome in outcomes.values()]
    if len(seconds) > 1 and seconds[0] == max(seconds):
        seconds = seconds[1:]
    return (min(seconds), sum(seconds) / len(seconds), max(seconds)) if seconds else (0.0, 0.0, 0.0)
