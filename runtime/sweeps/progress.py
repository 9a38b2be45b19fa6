"""The progress of a sweep on a terminal or in a notebook: points done, their rate, what is left."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ..base.notebook import in_notebook
from ..solve.motion.progress import is_watched

OnPoints = Callable[[int, int], None]
"""Takes how many points are done, and how many of them failed."""


@contextmanager
def point_bar(total: int, before: int, progress: bool | OnPoints | None) -> Iterator[OnPoints]:
    """Yield the meter to call with the points done and failed.

    before: points that were done before; progress: a bar (True), none (False), a bar if a terminal watches (None), or a
    function.
    """
    if callable(progress):
        yield progress
        return
    if not (progress is True or (progress is None and is_watched())):
        yield lambda done, failed: None
        return
    from rich.console import Console  # for sweeps that a person watches
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = MofNCompleteColumn(), BarColumn(), TimeRemainingColumn(), TextColumn("{task.description}")
    begin = time.monotonic()
    with Progress(*columns, console=Console(stderr=not in_notebook()), transient=True) as bar:
        task = bar.add_task("", total=total, completed=before)

        def show(done: int, failed: int) -> None:
            rate = (done - before) / max(time.monotonic() - begin, 1e-3)
            words = f"{rate:.3g} points/s" + (f", {failed} failed" if failed else "")
            bar.update(task, completed=done, description=words)

        yield show
