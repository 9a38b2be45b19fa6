"""The progress of a run on a terminal or in a notebook."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ...base.deferred import dataclass
from ...base.notebook import in_notebook

OnProgress = Callable[[float], None]


def _nothing(_: float | str) -> None:
    """Show no progress at all."""


@dataclass(frozen=True)
class ProgressDisplay:
    """Displays the time reached in s, given by a call, and a text on the rate, given to ``describe``."""

    reached: OnProgress = _nothing
    describe: Callable[[str], None] = _nothing

    @property
    def is_shown(self) -> bool:
        """Return whether a call does anything."""
        return self.reached is not _nothing

    def __call__(self, time: float) -> None:
        """Show the time reached by the run, in s."""
        self.reached(time)


@contextmanager
def progress_bar(duration: float, progress: bool | OnProgress | None) -> Iterator[ProgressDisplay]:
    """Yields the display to call with each time reached (s); ``progress`` as in `Scene.run`."""
    if callable(progress):
        yield ProgressDisplay(progress)
    elif progress is True or (progress is None and is_watched()):
        from rich.console import Console  # needed only for a visible progress bar
        from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

        reached = TextColumn("{task.completed:.4g} of {task.total:.4g} s")
        columns = reached, BarColumn(), TimeRemainingColumn(), TextColumn("{task.description}")
        with Progress(*columns, console=Console(stderr=not in_notebook()), transient=True) as bar:
            task = bar.add_task("", total=duration)
            yield ProgressDisplay(lambda time: bar.update(task, completed=time),
                                  lambda text: bar.update(task, description=text))
    else:
        yield ProgressDisplay()


def is_watched() -> bool:
    """Return whether output goes to a terminal, or to a notebook with ipywidgets, which a bar needs there."""
    return sys.stderr.isatty() or (in_notebook() and importlib.util.find_spec("ipywidgets") is not None)
