"""Hulls of cables' elements: points between which their axes lie, made of their nodal vectors."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from typing import Any

import numpy as np

DEGREES = range(3, 8)
"""Of the curves that elements are: those between which the points of an element's hull are sought."""
FITS = 1e-9
"""Of the largest share of a vector in the axis: what rounding leaves of it where the degree is enough."""


@dataclass(frozen=True)
class Hull:
    """Of the elements of a cable, or of its one element where they are equal.

    points: (elements, points, vectors of an element): what makes the points of the vectors; spread: (elements, vectors
    of an element): the largest share of each in a point, infinite where nodes do not begin with places.
    """

    points: np.ndarray
    spread: np.ndarray

    @property
    def share(self) -> np.ndarray | None:
        """Return (vectors of a node,): how much of each points move by at most as those of both nodes change.

        None where nodes do not begin with places.
        """
        if not np.isfinite(self.spread).all():
            return None
        half = self.points.shape[2] // 2
        share: np.ndarray = (np.abs(self.points[..., :half]) + np.abs(self.points[..., half:])).max(axis=(0, 1))
        return share


def hull_of(on_axis: Any, lengths: np.ndarray) -> Hull:
    """Return the hull of elements of these lengths, in m, by their kernel on_axis.

    Raises ValueError where their axes are no polynomials.
    """
    points = np.array([_hull(on_axis, length) for length in lengths])
    return Hull(points, np.array([_spread(each) for each in points]))


def _spread(hull: np.ndarray) -> np.ndarray:
    """Return (vectors,): the largest share of each in a hull point; infinite where nodes do not begin with places."""
    places = hull[:, 0] + hull[:, hull.shape[1] // 2]
    spread: np.ndarray = np.abs(hull).max(axis=0)
    return spread if np.abs(places - 1).max() < 1e-12 else np.full_like(spread, np.inf)


def _hull(on_axis: Any, length: float) -> np.ndarray:
    """Return (points, vectors): what makes Bézier points of an element's vectors, between which its axis lies."""
    for degree in DEGREES:
        at = np.linspace(0, 1, 2 * degree)
        order = np.arange(degree + 1)
        several = np.array([comb(degree, int(k)) for k in order])
        basis = several * at[:, None] ** order * (1 - at[:, None]) ** (degree - order)
        values = np.array([on_axis(length, length * t)[0] for t in at])
        points, *_ = np.linalg.lstsq(basis, values, rcond=None)
        # by column: the share of a vector grows with a power of the length
        if np.all(np.abs(basis @ points - values).max(axis=0) <= FITS * np.abs(values).max(axis=0)):
            return points
    raise ValueError(f"the axis of the element is no polynomial of degree {DEGREES[-1]} or less")
