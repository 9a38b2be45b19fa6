"""Blocks of rows of a run between its pauses, and the interface of a stream that receives them."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, Protocol

from ...engine import Engine
from ...model.model import Model
from ...parts.settings import RunSettings
from ..notes.row_notes import RowNotes

MIN_BLOCKS = 100
"""Smallest number of blocks of a run with at least as many output times."""
MAX_BUFFERED_BYTES = 8e6
"""Bytes of rows in memory."""


class RowBlocks(NamedTuple):
    """Output rows between two pauses of a run, and capacity of the buffer in rows."""

    every: int
    capacity: int


def row_blocks(settings: RunSettings, row_bytes: int) -> RowBlocks:
    """Return the blocks of a run, which depend neither on the clock nor on whether results are saved."""
    rows = math.ceil(settings.duration / settings.output_step) + 1
    most = max(1, int(MAX_BUFFERED_BYTES // row_bytes))
    every = min(most, -(-rows // MIN_BLOCKS))
    return RowBlocks(every, min(rows, most // every * every) + 2)  # the start, and where a run is cut short


class RowStream(Protocol):
    """Receives the rows of a run block by block, so that the engine holds the last ones only."""

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
        """Return whether the run can be resumed from the rows received."""

    def start(self, model: Model, engine: Engine, blocks: RowBlocks, events: list[dict[str, Any]], row_notes: RowNotes,
              on_trial: bool) -> None:
        """Receive the first row, or restore the state of a resumed run; on_trial: another call may restart the run."""

    def settled(self) -> None:
        """Keep the rows of a trial as those of the run."""

    def pause(self) -> None:
        """Receive rows at a pause, and write a checkpoint if due."""

    def between(self) -> None:
        """Receive rows between pauses, if due."""
