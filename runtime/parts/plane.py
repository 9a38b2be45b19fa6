"""Planes in space with axes of their own, for scenes of planar elements."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..base.deferred import dataclass
from ..base.rotations import cross
from .validation import show

PLANE_ROUNDING = 1e-12
"""Rounding of points and directions off a plane, relative to their size."""
MIN_SINE = 1e-6
"""Of the angle between two directions that define a plane."""


@dataclass(frozen=True, eq=False)
class Plane:
    """A plane in space with axes of its own: x and y in it, z along its normal.

    axes (3, 3): unit vectors along the ground's axes, as columns; origin (3,): its point nearest to the ground's
    origin, in m.
    """

    axes: np.ndarray
    origin: np.ndarray

    @classmethod
    def across(cls, normal: np.ndarray, point: np.ndarray) -> Plane:
        """Return the plane through a point (3,) across a unit normal (3,).

        Its x axis lies along the ground's axis most nearly in the plane, the first one of equals.
        """
        x = np.eye(3)[int(np.argmin(np.abs(normal)))]
        x = x - np.dot(x, normal) * normal
        x /= np.linalg.norm(x)
        axes = np.column_stack([x, cross(normal, x), normal])
        return cls(axes + 0.0, np.dot(point, normal) * normal + 0.0)  # no -0

    @property
    def normal(self) -> np.ndarray:
        """Return (3,): its unit normal."""
        return self.axes[:, 2]

    def into(self, directions: np.ndarray) -> np.ndarray:
        """Return directions (..., 3) along its axes."""
        return _combined(np.asarray(directions), self.axes)

    def points_into(self, points: np.ndarray) -> np.ndarray:
        """Return points (..., 3), in m, in its axes."""
        return _combined(np.asarray(points) - self.origin, self.axes)

    def out(self, directions: np.ndarray) -> np.ndarray:
        """Return directions (..., 2 or 3) along its axes along the ground's."""
        return _combined(directions, self.axes.T)

    def points_out(self, points: np.ndarray) -> np.ndarray:
        """Return points (..., 2 or 3) in its axes, in m, in the ground's."""
        return self.out(points) + self.origin

    def contains(self, points: np.ndarray) -> bool:
        """Return whether points (n, 3), in m, lie in it to rounding."""
        off = np.abs(self.points_into(points)[:, 2])
        return bool(np.all(off <= PLANE_ROUNDING * np.abs(points).max(initial=0.0)))

    def is_same(self, other: Plane) -> bool:
        """Return whether another plane, also a parallel one, has the same normal to rounding."""
        return float(np.linalg.norm(self.normal - other.normal)) <= 1e-9

    def has_same_axes(self, other: Plane) -> bool:
        """Return whether another plane has the same axes and origin to rounding."""
        off = np.linalg.norm(self.origin - other.origin)
        return bool(np.abs(self.axes - other.axes).max() <= 1e-9 and off <= 1e-9 * np.linalg.norm(other.origin))


def _combined(factors: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Return (..., 3): the sums of factors (..., 2 or 3) times vectors (3, 3), as rows.

    The rounding of a matrix product depends on the number of rows; that of sums does not, so that files of results have
    the same bits in blocks of any size.
    """
    made = factors[..., :1] * vectors[0]
    for k in range(1, factors.shape[-1]):
        made = made + factors[..., k : k + 1] * vectors[k]
    return made


def normal_of(groups: Iterable[np.ndarray]) -> np.ndarray | None:
    """Return the unit vector (3,) across the first two directions of groups of vectors (n, 3), None of fewer.

    The first direction is the longest vector of a group, the second one has the largest angle with it.
    """
    first = None
    for vectors in groups:
        sizes = np.linalg.norm(vectors, axis=1)
        directions = vectors[sizes > 0] / sizes[sizes > 0, None]
        if not len(directions):
            continue
        if first is None:
            first = vectors[np.argmax(sizes)] / sizes.max()
        across = np.cross(first, directions)
        sines = np.linalg.norm(across, axis=1)
        if sines.max() > MIN_SINE:
            return across[np.argmax(sines)] / sines.max()
    return None


def called(plane: Plane | None) -> str:
    """Return the name of a plane in messages; None is z = 0."""
    if plane is None:
        return "the plane z = 0"
    axis = int(np.argmax(np.abs(plane.normal)))
    if abs(plane.normal[axis]) == 1.0:
        return f"the plane {'xyz'[axis]} = {plane.origin[axis]:.9g}"
    return f"the plane through {show(plane.origin, 'm')} across {show(plane.normal)}"


def flattened(vectors: np.ndarray, size: float = 0.0) -> np.ndarray:
    """Return vectors (..., 3) without z components that are rounding of the largest one or of a size."""
    made = np.array(vectors, dtype=float)
    least = PLANE_ROUNDING * max(size, float(np.abs(made).max(initial=0.0)))
    made[..., 2] = np.where(np.abs(made[..., 2]) <= least, 0.0, made[..., 2])
    return made


def aligned(vector: np.ndarray) -> np.ndarray:
    """Return a vector (3,) without components that are rounding of its size."""
    made = np.array(vector, dtype=float)
    made[np.abs(made) <= PLANE_ROUNDING * np.abs(made).max(initial=0.0)] = 0.0
    return made
