"""Batches of points: long enough that the overhead of a task is small, short enough that all workers stay busy."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from typing import NamedTuple

import numpy as np

from ..errors import FunicularError
from .abandonment import Watch
from .layout import Layout
from .parameters import Points
from .subject import Subject

BATCH_SECONDS = 0.5
"""Time of a batch: a task of Dask costs some ms in the scheduler, the worker and this process together."""
MAX_BATCH_BYTES = 1 << 22
"""Bytes of the rows of a batch."""
MIN_BATCHES_PER_WORKER = 4
"""Batches that each worker gets at least, so that all end at about the same time."""


class Batch(NamedTuple):
    """Points that one task computes: their numbers, which rise, and their values (n,) by parameter."""

    numbers: np.ndarray
    values: Mapping[str, np.ndarray]


class Done(NamedTuple):
    """The result of a batch: sealed rows, wall seconds of all, the number of failed points."""

    rows: np.ndarray
    seconds: float
    failed: int


@dataclass(frozen=True)
class Task:
    """The work of a worker on a batch, sent with each; programs: versions that the worker must have."""

    subject: Subject
    layout: Layout
    dtype: np.dtype
    programs: str

    def __call__(self, batch: Batch, watch: Watch | None = None) -> Done:
        """Return the rows of a batch; watch: of runs in threads. Raises FunicularError where the worker has other
        programs.
        """
        if (here := versions()) != self.programs:
            raise FunicularError(f"sweep: a worker has {here}, and the sweep was started with {self.programs}; install "
                                 "the same everywhere")
        columns = {name: column.tolist() for name, column in batch.values.items()}
        points = [dict(zip(columns, each, strict=True)) for each in zip(*columns.values(), strict=True)]
        outcomes = self.subject.compute(points, watch)
        rows = self.layout.pack(self.dtype, batch.values, outcomes)
        return Done(rows, sum(outcome.seconds for outcome in outcomes), self.layout.failures(rows))


@cache
def versions() -> str:
    """Return the versions of the programs that compute a point, in words."""
    return ", ".join(f"{name} {version(name)}" for name in ("funicular", "numpy", "scipy"))


class Batches:
    """Hands out the remaining points in batches, whose length follows the time of a point."""

    def __init__(self, points: Points, numbers: np.ndarray, row_bytes: int, workers: int, seconds: float,
                 length: int | None = None):
        """numbers: of the remaining points; seconds: of a point, from a sample; length: of a batch, None to adapt."""
        self._points, self._left, self._at = points, numbers, 0
        self._length = length
        share = -(-len(numbers) // (MIN_BATCHES_PER_WORKER * max(workers, 1)))
        self._most = max(1, min(MAX_BATCH_BYTES // row_bytes, share))
        self._seconds, self._counted = seconds, 1.0
        self._again: list[Batch] = []

    def __iter__(self) -> Iterator[Batch]:
        """Yield batches until none are left, returned ones first."""
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
        """Update the mean time of a point, over about the last thousand points."""
        weight = min(self._counted, 1e3)
        self._seconds = (self._seconds * weight + seconds) / (weight + count)
        self._counted = weight + count
