"""The interface of a stream that takes the rows of a run as they come."""

from __future__ import annotations

from typing import Any, Protocol

from ...engine import Engine
from ...model.model import Model
from ..notes.row_notes import RowNotes
from .pauses import Pauses


class Sink(Protocol):
    """Takes the rows of a run as they come, so that the engine keeps the last ones only."""

    @property
    def elapsed(self) -> float:
        """Return the seconds that the run took before it was resumed."""

    @property
    def integrator(self) -> str | None:
        """Return the name of the integrator of a resumed run, None for a new one."""

    @property
    def free(self) -> int:
        """Return the free space in bytes."""

    @property
    def has_begun(self) -> bool:
        """Return whether the run can be resumed from the rows taken."""

    def start(self, model: Model, engine: Engine, pace: Pauses, events: list[dict[str, Any]], row_notes: RowNotes,
              on_trial: bool) -> None:
        """Take the first row, or bring the engine to the state of a resumed run; on_trial: the run may begin anew, with
        another call.
        """

    def settled(self) -> None:
        """Keep the rows of a trial as those of the run."""

    def pause(self) -> None:
        """Take the rows that the engine has at a pause, and write a checkpoint if it is time to."""

    def between(self) -> None:
        """Take the rows that the engine has between pauses, if it is time to."""
