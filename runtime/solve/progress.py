"""The progress of a run on a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

OnProgress = Callable[[float], None]


def _nothing(_: float | str) -> None:
    """Show no progress at all."""


@dataclass(frozen=True)
class Meter:
    """Takes the time reached, s, when it is called, and by ``tell`` what is to be said of the pace, in words."""

    reached: OnProgress = _nothing
    tell: Callable[[str], None] = _nothing

    def __call__(self, time: float) -> None:
        """Show that the run has come to this time, s."""
        self.reached(time)


@contextmanager
def progress_bar(duration: float, progress: bool | OnProgress | None) -> Iterator[Meter]:
    """Yields the meter to call with each time reached (s); ``progress`` as in `Scene.run`."""
    if callable(progress):
        yield Meter(progress)
    elif progress is True or (progress is None and sys.stderr.isatty()):
        from rich.console import Console  # for runs that a person watches
        from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

        reached = TextColumn("{task.completed:.4g} of {task.total:.4g} s")
        columns = reached, BarColumn(), TimeRemainingColumn(), TextColumn("{task.description}")
        with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
            task = bar.add_task("", total=duration)
            yield Meter(lambda time: bar.update(task, completed=time), lambda text: bar.update(task, description=text))
    else:
        yield Meter()
