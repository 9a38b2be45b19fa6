"""Abandoned runs: threads whose results are no longer needed end their runs."""

from __future__ import annotations

from collections.abc import Callable
from threading import Event

Watch = Callable[[float], None]
"""Takes the time that a run has reached, in s; raises Abandoned."""


class Abandoned(BaseException):
    """Ends a run whose results are no longer needed."""


class Abandonment:
    """Ends the runs that `watch` watches, in other threads."""

    def __init__(self) -> None:
        self._begun = Event()

    def begin(self) -> None:
        """End the runs, each at its next report of progress."""
        self._begun.set()

    def watch(self, reached: float) -> None:
        """Raise Abandoned where the runs are to end."""
        if self._begun.is_set():
            raise Abandoned
