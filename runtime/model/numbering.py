"""The order of the unknowns: a band, in chains of elements, and a border that couples the chains."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..base.deferred import dataclass


@dataclass(eq=False, repr=False)
class Numbering:
    """number[unknown]: first the band, in which unknowns of one element are at most `width` apart, then the border.

    chains: first rows of the parts of the band that only the border couples; and the end.
    """

    number: np.ndarray
    n_band: int
    width: int
    chains: np.ndarray


@dataclass(eq=False, repr=False)
class Incidence:
    """Incidence of elements and unknowns: an element and an unknown per entry."""

    element: np.ndarray
    unknown: np.ndarray
    n_elements: int


def ranges(first: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """Return the numbers of ranges, one range after the other; each has its first number and its count."""
    return np.repeat(first - np.cumsum(counts) + counts, counts) + np.arange(counts.sum())


def as_drawn(elements: np.ndarray, unknown_of_dof: np.ndarray) -> Numbering:
    """Return the numbering of unknowns in the order of their dofs.

    elements (n, 2): first dof and number of dofs of each; unknown_of_dof: increasing numbers of unknowns, or -1. Scenes
    of one topology share it.
    """
    return numbered_once(*(np.asarray(each, int).tobytes() for each in (elements, unknown_of_dof)))


@lru_cache(maxsize=32)
def numbered_once(*given: bytes) -> Numbering:
    """Return `as_drawn` of arrays of these bytes."""
    flat, unknown_of_dof = (np.frombuffer(each, int) for each in given)
    elements = flat.reshape(-1, 2)
    before = np.append(0, np.cumsum(unknown_of_dof >= 0))  # unknowns before a dof
    n = int(before[-1])
    return _numbering(before[elements[:, 0]], before[elements[:, 0] + elements[:, 1]] - 1, np.arange(n), n)


def numbered(incidence: Incidence, number: np.ndarray, n_band: int) -> Numbering:
    """Return the numbering with these numbers of the unknowns; the first n_band are the band."""
    return _numbering(*extents(incidence, number, n_band), number, n_band)


def extents(incidence: Incidence, number: np.ndarray, n_band: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the first and the last row of the band of each element; n_band and -1 without any."""
    at = number[incidence.unknown]
    inside = at < n_band
    low, high = np.full(incidence.n_elements, n_band), np.full(incidence.n_elements, -1)
    np.minimum.at(low, incidence.element[inside], at[inside])
    np.maximum.at(high, incidence.element[inside], at[inside])
    return low, high


def _numbering(low: np.ndarray, high: np.ndarray, number: np.ndarray, n_band: int) -> Numbering:
    """Return a numbering with its band; low, high: `extents` of the elements."""
    banded = low <= high
    low, high = low[banded], high[banded]
    ties = np.bincount(low + 1, minlength=n_band + 1) - np.bincount(high + 1, minlength=n_band + 1)
    # the first row of a chain: no element couples it to the row before
    chains = np.append(np.flatnonzero(np.cumsum(ties[:n_band]) == 0), n_band)
    return Numbering(number, n_band, int(np.max(high - low, initial=0)), chains)
