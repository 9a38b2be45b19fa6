"""The progress of a run on a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

OnProgress = Callable[[float], None]


@contextmanager
def progress_bar(duration: float, progress: bool | OnProgress | None) -> Iterator[OnProgress]:
    """Yields the function to call with each time reached (s); ``progress`` as in `Scene.run`."""
    if callable(progress):
        yield progress
    elif progress is True or (progress is None and sys.stderr.isatty()):
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

        reached = TextColumn("{task.completed:.4g} of {task.total:.4g} s")
        with Progress(reached, BarColumn(), TimeRemainingColumn(), console=Console(stderr=True), transient=True) as bar:
            task = bar.add_task("run", total=duration)
            yield lambda time: bar.update(task, completed=time)
    else:
        yield lambda time: None
