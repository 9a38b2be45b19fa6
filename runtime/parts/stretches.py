"""Parts of a cable between two nodes: the elements on which forces act, by pieces."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from .piece import UniformPiece
from .section import Section

if TYPE_CHECKING:
    from .cable import Cable
    from .rope import Rope


def stretches(line: Cable | Rope, start: float | None, stop: float | None,
              sizes: Callable[[Section], Any]) -> list[UniformPiece]:
    """Return the elements of a cable or a rope between the nodes at start and stop, m, by pieces with equal sizes.

    start, stop: of a cable; None: its ends. sizes: returns what counts of a section. Pass its errors on.
    """
    first, end = 0, line.n_elements
    if start is not None or stop is not None:
        assert not hasattr(line, "route"), f"{line.where} has no nodes at arc-lengths"
        first, end = (line.boundary(s) if s is not None else other for s, other in ((start, first), (stop, end)))
    found: list[UniformPiece] = []
    before: Any = None
    for piece in line.uniform_pieces:
        begin, last = max(piece.first, first), min(piece.end, end)
        if begin >= last:
            continue
        own = sizes(piece.section)
        if found and own == before:
            found[-1] = found[-1]._replace(end=last)
        else:
            found.append(piece._replace(first=begin, end=last))
        before = own
    return found


def overlap(one: tuple[float | None, float | None], other: tuple[float | None, float | None]) -> bool:
    """Return whether two parts of a cable overlap, from start to stop, m; None: its ends."""
    ends = [(0.0 if start is None else start, np.inf if stop is None else stop) for start, stop in (one, other)]
    return max(start for start, _ in ends) < min(stop for _, stop in ends)
