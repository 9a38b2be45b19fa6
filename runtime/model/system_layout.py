"""The integers of a system of equations of the engine that depend on the topology of a scene alone."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ..base.deferred import dataclass

OF_FRONTS = ("start", "first", "pivots", "neighbours", "unknown", "in_parent", "parent", "child", "sibling", "front",
             "place")
"""Arrays of an elimination that the engine reads."""


class Fronts(Protocol):
    """The elimination of m unknowns, which has the arrays `OF_FRONTS` and the strips of `elimination.Elimination`."""

    m: int
    strips: np.ndarray


@dataclass(eq=False, repr=False)
class SystemLayout:
    """numbers: all arrays, one behind the other; first: the place of each by its name in engine/linear.

    n_strips: of the border's coupling with chains; rows, rows_of_x: the sums of their lengths, without and with what
    the engine adds to each.
    """

    numbers: np.ndarray
    first: dict[str, int]
    n_strips: int
    rows: int
    rows_of_x: int

    @classmethod
    def of(cls, elimination: Fronts, chains: np.ndarray, beyond: int) -> SystemLayout:
        """Return the layout; chains: as in `Numbering`; beyond: rows that the engine adds to each strip of X."""
        k, chain, moves = elimination.strips.T
        lengths = np.diff(chains)[chain]
        ends, ends_of_x = np.cumsum(lengths), np.cumsum(lengths + beyond)
        middles = (chains[:-1] + chains[1:]) // 2
        arrays = {name: getattr(elimination, name) for name in OF_FRONTS} | {
            "strips": np.stack([k, chain, ends - lengths - chains[chain],
                                ends_of_x - lengths - beyond - chains[chain], moves * lengths], axis=1).ravel(),
            "first_strip": np.searchsorted(k, np.arange(elimination.m + 1)),
            "chains": chains,
            "half": np.searchsorted(np.sort([*chains[:-1], *middles]), np.arange(chains[-1]), "right") - 1,
        }
        places = np.cumsum([0, *map(len, arrays.values())])[:-1].tolist()
        return cls(np.concatenate([each.astype(np.intc) for each in arrays.values()]),
                   dict(zip(arrays, places, strict=True)), len(k), int(ends[-1]) if len(k) else 0,
                   int(ends_of_x[-1]) if len(k) else 0)
