"""Threads of this process as workers: they start at once, and the C engine runs without Python's lock."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

from .abandonment import Abandonment
from .batches import Batch, Batches, Done, Task
from .workers import Workers


class ThreadWorkers(Workers):
    """A number of threads."""

    def __init__(self, number: int):
        self._number = number

    @property
    def number(self) -> int:
        """Return the number of threads."""
        return self._number

    def compute(self, task: Task, batches: Batches, lost: Callable[[Batch, str], Done]) -> Iterator[tuple[Batch, Done]]:
        """Yield batches with their results in order of completion; a batch that is under way when the iteration ends,
        also after Ctrl-C, is abandoned.
        """
        abandonment, pending = Abandonment(), dict[Future[Done], Batch]()
        with ThreadPoolExecutor(self._number, "funicular") as pool:
            try:
                while True:
                    while len(pending) < self._number and (batch := batches.take()) is not None:
                        pending[pool.submit(task, batch, abandonment.watch)] = batch
                    if not pending:
                        return
                    for future in wait(pending, return_when=FIRST_COMPLETED).done:
                        yield pending.pop(future), future.result()
            finally:
                abandonment.begin()
                pool.shutdown(wait=False, cancel_futures=True)
