"""When a run pauses, so that its rows can be taken and its state be kept."""

from __future__ import annotations

from typing import NamedTuple

PAUSES = 100
"""The least number of pauses of a run with so many output times."""
BUFFER = 8e6
"""Bytes of rows that are kept in memory."""


class Pauses(NamedTuple):
    """Output rows from one pause to the next, and rows that are kept in memory."""

    every: int
    capacity: int


def pauses(rows: int, row_bytes: int) -> Pauses:
    """Return when a run pauses: it must not depend on the clock, nor on whether results are saved."""
    most = max(1, int(BUFFER // row_bytes))
    every = min(most, -(-rows // PAUSES))
    return Pauses(every, min(rows, most // every * every) + 2)  # the start, and where a run is cut short
