"""Convex hulls of the axes of elements: Bézier points, linear in the nodal vectors."""

from __future__ import annotations

from math import comb
from typing import Any

import numpy as np

from ..base.deferred import dataclass

DEGREES = range(3, 8)
"""Degrees of the axis that are tried."""
FIT_TOLERANCE = 1e-9
"""Residual of a Bézier curve of sufficient degree, as a fraction of the largest share of a vector in the axis."""


@dataclass(frozen=True)
class Hull:
    """Hulls of the elements of a cable, one where they are equal.

    points: (elements, points, vectors of an element): coefficients of the hull points; spread: (elements, vectors of an
    element): the largest coefficient of each vector, infinite where the first vector of a node is no position.
    """

    points: np.ndarray
    spread: np.ndarray

    @property
    def share(self) -> np.ndarray | None:
        """Return (vectors of a node,): largest displacement of points by unit changes of the vectors at both nodes.

        None where the first vector of a node is no position.
        """
        if not np.isfinite(self.spread).all():
            return None
        half = self.points.shape[2] // 2
        share: np.ndarray = (np.abs(self.points[..., :half]) + np.abs(self.points[..., half:])).max(axis=(0, 1))
        return share


def hull_of(on_axis: Any, lengths: np.ndarray) -> Hull:
    """Return the hull of elements of these lengths, in m, by their kernel on_axis.

    Raises ValueError for axes that are no polynomials.
    """
    points = np.array([_hull(on_axis, length) for length in lengths])
    return Hull(points, np.array([_spread(each) for each in points]))


def _spread(hull: np.ndarray) -> np.ndarray:
    places = hull[:, 0] + hull[:, hull.shape[1] // 2]
    spread: np.ndarray = np.abs(hull).max(axis=0)
    return spread if np.abs(places - 1).max() < 1e-12 else np.full_like(spread, np.inf)


def _hull(on_axis: Any, length: float) -> np.ndarray:
    """Return (points, vectors): the coefficients of the Bézier points of the axis."""
    for degree in DEGREES:
        at = np.linspace(0, 1, 2 * degree)
        order = np.arange(degree + 1)
        binomials = np.array([comb(degree, int(k)) for k in order])
        basis = binomials * at[:, None] ** order * (1 - at[:, None]) ** (degree - order)
        values = np.array([on_axis(length, length * t)[0] for t in at])
        points: np.ndarray
        points, *_ = np.linalg.lstsq(basis, values, rcond=None)
        # by column: the share of a vector is proportional to a power of the length
        if np.all(np.abs(basis @ points - values).max(axis=0) <= FIT_TOLERANCE * np.abs(values).max(axis=0)):
            return points
    raise ValueError(f"the axis of the element is no polynomial of degree {DEGREES[-1]} or less")
