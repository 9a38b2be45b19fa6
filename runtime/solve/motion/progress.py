"""The progress of a run on a terminal or in a notebook."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from ...base.notebook import in_notebook

OnProgress = Callable[[float], None]


def _nothing(_: float | str) -> None:
    """Show no progress at all."""


@dataclass(frozen=True)
class Meter:
    """Takes the time reached in s when it is called, and a text on the pace by ``tell``."""

    reached: OnProgress = _nothing
    tell: Callable[[str], None] = _nothing

    def __call__(self, time: float) -> None:
        """Show the time reached by the run, in s."""
        self.reached(time)


@contextmanager
def progress_bar(duration: float, progress: bool | OnProgress | None) -> Iterator[Meter]:
    """Yields the meter to call with each time reached (s); ``progress`` as in `Scene.run`."""
    if callable(progress):
        yield Meter(progress)
    elif progress is True or (progress is None and is_watched()):
        from rich.console import Console  # needed only for a visible progress bar
        from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

        reached = TextColumn("{task.completed:.4g} of {task.total:.4g} s")
        columns = reached, BarColumn(), TimeRemainingColumn(), TextColumn("{task.description}")
        with Progress(*columns, console=Console(stderr=not in_notebook()), transient=True) as bar:
            task = bar.add_task("", total=duration)
            yield Meter(lambda time: bar.update(task, completed=time), lambda text: bar.update(task, description=text))
    else:
        yield Meter()


def is_watched() -> bool:
    """Return whether output goes to a terminal, or to a notebook with ipywidgets, which a bar needs there."""
    return sys.stderr.isatty() or (in_notebook() and importlib.util.find_spec("ipywidgets") is not None)
