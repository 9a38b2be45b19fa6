"""Dofs that are constant linear combinations of unknowns."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate

import numpy as np

from ..base.deferred import dataclass
from .numbering import ranges


@dataclass(frozen=True)
class Combinations:
    """Rows of unknowns and coefficients, in compressed form, as the engine reads them.

    start (k + 1,): first entry of each of the k rows, and their number; unknown, value: number of the unknown and
    coefficient of each entry, by increasing number in a row.
    """

    start: np.ndarray
    unknown: np.ndarray
    value: np.ndarray

    @classmethod
    def of(cls, rows: Sequence[dict[int, float]]) -> Combinations:
        """Return the combinations with these coefficients by unknown, at least one in each row."""
        ordered = [sorted(row.items()) for row in rows]
        entries = [entry for row in ordered for entry in row]
        return cls(np.array([*accumulate(map(len, ordered), initial=0)]),
                   np.array([of for of, _ in entries], dtype=int),
                   np.array([factor for _, factor in entries], dtype=float))

    def times(self, unknowns: np.ndarray) -> np.ndarray:
        """Return the dofs (k,) at these unknowns (n,)."""
        return np.add.reduceat(self.value * unknowns[self.unknown], self.start[:-1])

    def entries(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the entries of some rows: place in `rows`, unknown, coefficient."""
        first, counts = self.start[rows], self.start[rows + 1] - self.start[rows]
        at = ranges(first, counts)
        return np.repeat(np.arange(len(rows)), counts), self.unknown[at], self.value[at]
