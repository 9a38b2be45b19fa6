"""The work of a sweep: scenes are run, and what is kept of each, or why there is nothing, comes back."""

from __future__ import annotations

import time
import warnings
from collections.abc import Sequence
from typing import NamedTuple

from ..base.interruptions import interruptible, uninterrupted
from ..errors import FunicularError
from ..results.run import Run
from ..scene.scene import Scene
from ..solve.linear.threads import one_blas_thread
from .stored_points import Keep, Kept

FAILED = "failed"
RETURNED = "returned"
"""The status of a point whose function returned numbers."""


class Outcome(NamedTuple):
    """What a point came to.

    kept: None where it failed; status: that of its run, "returned" where a function gave numbers, or "failed"; message:
    why it failed, else what its run noted; seconds: wall time.
    """

    kept: Kept | None
    status: str
    message: str
    seconds: float


def run_points(scenes: Sequence[Scene], keep: Keep) -> list[Outcome]:
    """Run scenes with their own settings; return what is kept of each, or the error, in their order.

    An error of one does not stop the rest; Ctrl-C does, as KeyboardInterrupt.
    """
    with uninterrupted(), one_blas_thread, interruptible():  # for all at once: each would set and reset it
        return [_run_point(scene, keep) for scene in scenes]


def _run_point(scene: Scene, keep: Keep) -> Outcome:
    begin = time.perf_counter()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # they stand in the report
            run = scene.run(progress=False)
        return outcome_of(run, keep, begin)
    except Exception as error:  # whatever it is, the other points go on
        return failure(error, begin)


def outcome_of(run: Run, keep: Keep, begin: float) -> Outcome:
    """Return what is kept of a run; begin: when the point was begun, by time.perf_counter.

    Raises what `Keep.take` does.
    """
    if run.status == "interrupted":
        raise KeyboardInterrupt
    return Outcome(keep.take(run), run.status, "; ".join(run.report["messages"]), time.perf_counter() - begin)


def failure(error: BaseException, begin: float) -> Outcome:
    """Return the outcome of a point that an error ended."""
    text = str(error) or type(error).__name__
    if not isinstance(error, FunicularError):
        text = f"{type(error).__name__}: {text}"
    return Outcome(None, FAILED, text, time.perf_counter() - begin)
