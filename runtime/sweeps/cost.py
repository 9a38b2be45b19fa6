"""The cost of a sweep, estimated from a sample of its points, which are computed first.

Why it stays: the sample is needed in any case, since the layout of the file follows from the results of some points,
and the length of batches from their time. The estimate is a mean over it. It tells a user before hours of work how long
the sweep takes and how large its file is; without it, the first sign of a sweep of days is its progress bar.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from .parameters import Points
from .subject import Outcome, Subject

SAMPLE_SECONDS = 1.0
"""Time after which a sample ends."""
SAMPLE_PLACES = (0.0, 1.0, 0.5, 0.25, 0.75, 0.375, 0.625, 0.125)
"""Places of the sampled points among all, in their order."""


@dataclass(frozen=True)
class SweepCost:
    """The estimated cost of a sweep.

    points: still to compute; sampled: points that were computed for the estimate; point_seconds: least, mean and
    largest wall time of a point; workers: processes or threads that compute; point_bytes: in the file.
    """

    points: int
    sampled: int
    point_seconds: tuple[float, float, float]
    workers: int
    point_bytes: int

    @property
    def seconds(self) -> float:
        """Return the remaining wall time, in s."""
        return self.points * self.point_seconds[1] / max(self.workers, 1)

    @property
    def bytes(self) -> int:
        """Return the size of the remaining results."""
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
    """Return outcomes of points sampled among the missing ones, in the order of their numbers.

    At least two are computed unless they take very long: the first one includes the import of modules.
    """
    begin, found = time.monotonic(), dict[int, Outcome]()
    places = [round(place * (len(missing) - 1)) for place in SAMPLE_PLACES] if len(missing) else []
    for number in dict.fromkeys(missing[places].tolist()):
        (found[number],) = subject.compute([points.point(number)])
        allowed = SAMPLE_SECONDS * (1 if len(found) > 1 else 3)
        if any(outcome.stored for outcome in found.values()) and time.monotonic() - begin > allowed:
            break
    return dict(sorted(found.items()))


def seconds_of(outcomes: dict[int, Outcome]) -> tuple[float, float, float]:
    """Return the least, mean and largest wall time of a sample, without a longest first point, which imported modules.
    """
    seconds = [outcome.seconds for outcome in outcomes.values()]
    if len(seconds) > 1 and seconds[0] == max(seconds):
        seconds = seconds[1:]
    return (min(seconds), sum(seconds) / len(seconds), max(seconds)) if seconds else (0.0, 0.0, 0.0)
