"""Threads of a run, and the single thread of linear algebra on small matrices."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterable
from functools import cache
from typing import TYPE_CHECKING

from ...base.lapack import WHEN_LOADED

if TYPE_CHECKING:
    from threadpoolctl import LibController

    from ...engine import Engine


def available() -> int:
    """Return the processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def share_elements(engine: Engine, asked: int) -> list[str]:
    """Let threads share the work of a run, at most one per processor; return a message where there are fewer than
    asked.
    """
    if asked == 1:
        return []
    threads, why = asked, ""
    if asked > available():
        threads, why = available(), f"there are {available()} processors for this process"
    started = engine.use_threads(threads)
    if started < threads:
        threads, why = started, "the system gave no more threads"
    return [f"threads = {asked} came to {threads}: {why}"] if why else []


class _OneBlasThread:
    """Context that holds the BLAS of NumPy and SciPy at one thread in the whole process.

    OpenBLAS starts its threads from blocks of a few dozen rows on, where distributing the work takes longer than the
    work. The limits of before return when the last context ends.
    """

    def __init__(self) -> None:
        self._reset()
        os.register_at_fork(after_in_child=self._reset)  # what other threads were inside of is not in the child
        WHEN_LOADED.append(self._hold_scipy)

    def _reset(self) -> None:
        self._lock, self._inside = threading.Lock(), 0
        self._held: list[tuple[LibController, int]] = []

    def __enter__(self) -> None:
        with self._lock:
            if self._inside == 0:
                self._limit()
            self._inside += 1

    def __exit__(self, *exception: object) -> None:
        with self._lock:
            self._inside -= 1
            if self._inside == 0:
                self._release()

    def _hold_scipy(self) -> None:
        """Hold SciPy's BLAS, too, which is loaded within a run."""
        with self._lock:
            _blas.cache_clear()
            if self._inside:
                self._release()
                self._limit()

    def _limit(self) -> None:
        threads = [(library, library.num_threads) for library in _blas()]
        self._held = [each for each in threads if each[1] != 1]
        self._set((library, 1) for library, _ in self._held)

    def _release(self) -> None:
        if self._held:
            self._set(self._held)
            _let_this_thread_set_limits()  # and who had set limits before
            self._held = []

    def _set(self, threads: Iterable[tuple[LibController, int]]) -> None:
        """Set the threads of libraries."""
        if self._held:
            _let_this_thread_set_limits()
            for library, number in threads:
                library.set_num_threads(number)


one_blas_thread = _OneBlasThread()
"""For ``with``."""


def _let_this_thread_set_limits() -> None:
    """Let this thread set OpenBLAS's limits: from 3.8 on threadpoolctl ignores all threads but one without a message.
    """
    import threadpoolctl  # for runs alone, not for `import funicular`

    controller = getattr(threadpoolctl, "OpenBLASController", None)
    if controller is not None and hasattr(controller, "clear_controlling_thread"):
        controller.clear_controlling_thread(force=True)


@cache
def _blas() -> list[LibController]:
    from threadpoolctl import ThreadpoolController  # for runs alone

    return list(ThreadpoolController().select(user_api="blas").lib_controllers)
