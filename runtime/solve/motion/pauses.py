"""Pauses of a run, at which its rows are taken and its state is kept."""

from __future__ import annotations

from typing import NamedTuple

MIN_PAUSES = 100
"""Smallest number of pauses of a run with at least as many output times."""
MAX_BUFFERED_BYTES = 8e6
"""Bytes of rows that are kept in memory."""


class Pauses(NamedTuple):
    """Output rows between two pauses, and rows that are kept in memory."""

    every: int
    capacity: int


def pauses(rows: int, row_bytes: int) -> Pauses:
    """Return the pauses of a run, which depend neither on the clock nor on whether results are saved."""
    most = max(1, int(MAX_BUFFERED_BYTES // row_bytes))
    every = min(most, -(-rows // MIN_PAUSES))
    return Pauses(every, min(rows, most // every * every) + 2)  # the start, and where a run is cut short
