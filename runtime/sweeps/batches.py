"""Points in batches: long enough that handing one out costs little, short enough that all workers stay busy."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from typing import Any, NamedTuple

import numpy as np

from ..errors import FunicularError
from .layout import Layout
from .parameters import Points
from .subject import Subject

BATCH_SECONDS = 0.5
"""What a batch should take: a task of Dask's costs some ms of the scheduler, the worker and this process together."""
MOST_BYTES = 1 << 22
"""Of the rows of a batch."""
LEAST_BATCHES = 4
"""That each worker should get of a sweep, so that all end at about the same time."""


class Batch(NamedTuple):
    """Points that one task computes: their numbers, which rise, and their values (n,) by parameter."""

    numbers: np.ndarray
    values: Mapping[str, np.ndarray]


class Done(NamedTuple):
    """What a batch came to: sealed rows, wall seconds of all, how many points failed."""

    rows: np.ndarray
    seconds: float
    failed: int


@dataclass(frozen=True)
class Task:
    """What a worker does with a batch; it is sent there with each, and knows the programs that it was made with."""

    subject: Subject
    layout: Layout
    dtype: np.dtype
    programs: str

    def __call__(self, batch: Batch) -> Done:
        """Return the rows of a batch. Raises FunicularError where the worker has other programs."""
        if (here := versions()) != self.programs:
            raise FunicularError(f"sweep: a worker has {here}, and the sweep was started with {self.programs}; install "
                                 "the same everywhere")
        outcomes = self.subject.compute(listed(batch.values))
        rows = self.layout.pack(self.dtype, batch.values, outcomes)
        return Done(rows, sum(outcome.seconds for outcome in outcomes), self.layout.failures(rows))


@cache
def versions() -> str:
    """Return the versions of what computes a point, in words."""
    return ", ".join(f"{name} {version(name)}" for name in ("funicular", "numpy", "scipy"))


def listed(values: Mapping[str, np.ndarray]) -> list[dict[str, Any]]:
    """Return the points of values (n,) by parameter, as plain int, float, bool or str."""
    columns = {name: column.tolist() for name, column in values.items()}
    return [dict(zip(columns, each, strict=True)) for each in zip(*columns.values(), strict=True)]


class Batches:
    """Hands out the points that are left, in batches of a length that follows what they take."""

    def __init__(self, points: Points, numbers: np.ndarray, row_bytes: int, workers: int, seconds: float,
                 length: int | None = None):
        """numbers: of the points that are left; seconds: what a point takes, of a sample; length: fixed, or None."""
        self._points, self._left, self._at = points, numbers, 0
        self._length = length
        self._most = max(1, min(MOST_BYTES // row_bytes, -(-len(numbers) // (LEAST_BATCHES * max(workers, 1)))))
        self._seconds, self._counted = seconds, 1.0
        self._again: list[Batch] = []

    def __iter__(self) -> Iterator[Batch]:
        """Yield batches until none are left, those given back first."""
        while (batch := self.take()) is not None:
            yield batch

    @property
    def length(self) -> int:
        """Return the length of the next batch."""
        return self._length or max(1, min(self._most, round(BATCH_SECONDS / max(self._seconds, 1e-9))))

    def take(self) -> Batch | None:
        """Return the next batch, None where none is left."""
        if self._again:
            return self._again.pop()
        numbers = self._left[self._at : self._at + self.length]
        self._at += len(numbers)
        return Batch(numbers, self._points.at(numbers)) if len(numbers) else None

    def give_back(self, batches: Sequence[Batch]) -> None:
        """Take batches back that were not computed."""
        self._again += batches

    def learn(self, count: int, seconds: float) -> None:
        """Take note of what points took: the mean forgets what is older than some hundred batches."""
        weight = min(self._counted, 1e3)
        self._seconds = (self._seconds * weight + seconds) / (weight + count)
        self._counted = weight + count
