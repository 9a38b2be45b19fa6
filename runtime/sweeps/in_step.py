"""Works in step: the like stages of several runs one after the other, see `base.stages`."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from typing import Generic, NamedTuple, TypeVar

from ..base.interruptions import uninterrupted
from ..base.stages import Stages

T = TypeVar("T")

MAX_GROUP = 16
"""Works in step; more of them gain nothing."""
MAX_GROUP_SECONDS, MAX_GROUP_BYTES = 0.02, 1 << 24
"""Time of the first stages of a group, in s, and bytes of its results, beyond which no further work joins it: long
stages gain nothing, and memory would grow.
"""


class Ended(NamedTuple, Generic[T]):
    """The end of a work: its result or its error, and its wall time in s."""

    result: T | Exception
    seconds: float


class _Work(Generic[T]):
    """A work under way; size: bytes of its results; result: None until it ends."""

    def __init__(self, begin: Callable[[], Stages[T]]):
        self._begin = begin
        self._stages: Stages[T] | None = None
        self.size, self.seconds = 0, 0.0
        self.result: T | Exception | None = None

    def go_on(self) -> None:
        """Do its next stage."""
        if self.result is not None:
            return
        begun = time.perf_counter()
        try:
            stages = self._stages = self._stages or self._begin()
            with uninterrupted():
                self.size = next(stages)
        except StopIteration as end:
            self.result = end.value
        except Exception as error:  # of any kind: the other works go on
            self.result = error
        self.seconds += time.perf_counter() - begun


def in_step(works: Iterable[Callable[[], Stages[T]]]) -> Iterator[Ended[T]]:
    """Yield the ends of works, in their order; works: functions that return their stages.

    An error of one does not stop the others, but KeyboardInterrupt does.
    """
    waiting = iter(works)
    while group := _group(waiting):
        while any(work.result is None for work in group):
            for work in group:
                work.go_on()
        for work in group:
            assert work.result is not None, "all works of a group have ended"
            yield Ended(work.result, work.seconds)


def _group(waiting: Iterator[Callable[[], Stages[T]]]) -> list[_Work[T]]:
    """Return the next works, each after its first stage."""
    group: list[_Work[T]] = []
    for begin in waiting:
        group.append(_Work(begin))
        group[-1].go_on()
        if (len(group) == MAX_GROUP or sum(work.seconds for work in group) > MAX_GROUP_SECONDS
                or sum(work.size for work in group) > MAX_GROUP_BYTES):
            break
    return group
