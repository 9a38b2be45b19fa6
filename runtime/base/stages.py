"""Work in stages, with which several works of a kind can go in step: one stage of all of them after the other.

Right after the time loop of a run, Python and NumPy take twice as long as after work like their own, whose code and
data the caches of the processor still hold. For runs of a few milliseconds that is an eighth of all their time.
"""

from __future__ import annotations

import time
from collections.abc import Generator
from typing import TypeAlias, TypeVar

T = TypeVar("T")

Stages: TypeAlias = Generator[int, None, T]
"""Yields between two stages the bytes of results that the work holds or will hold; returns its result."""


def at_once(work: Stages[T]) -> T:
    """Do all stages of a work; return its result."""
    while True:
        try:
            next(work)
        except StopIteration as end:
            found: T = end.value
            return found


class StageClock:
    """Wall and CPU time of a work in s, without the times between its stages."""

    def __init__(self, of_thread: bool):
        """of_thread: whether CPU time is that of this thread alone, else of the process."""
        self._cpu = time.thread_time if of_thread else time.process_time
        self._wall_between = self._cpu_between = 0.0

    @property
    def wall(self) -> float:
        """Return the wall time, from any time on."""
        return time.perf_counter() - self._wall_between

    @property
    def cpu(self) -> float:
        """Return the CPU time, from any time on."""
        return self._cpu() - self._cpu_between

    def pause(self, size: int) -> Stages[None]:
        """End a stage; size: see `Stages`."""
        wall, cpu = self.wall, self.cpu
        yield size
        self._wall_between += self.wall - wall
        self._cpu_between += self.cpu - cpu
