"""Views of an animation: the planes of projection, and the extents of its points."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from .animation import Animation, Clip

MAX_FLAT_DEPTH = 0.02
"""Largest extent out of a vertical plane, over the size of a scene, of a scene drawn in this plane alone."""


class Projection(NamedTuple):
    """A plane of projection: unit vectors across and up (3,), and their names."""

    across: np.ndarray
    up: np.ndarray
    names: tuple[str, str]

    def of(self, points: np.ndarray) -> np.ndarray:
        """Return points (..., 3) as (..., 2) in the plane."""
        projected: np.ndarray = points @ np.stack([self.across, self.up], axis=1)
        return projected

    def foreshortened(self, direction: np.ndarray) -> float:
        """Return the length of a unit vector (3,) in the plane: 1 of one in it, 0 of one along the view."""
        return float(np.linalg.norm(self.of(np.asarray(direction))))


class Directions(NamedTuple):
    """Right-handed directions: across the main view, into it, and up; flat: whether the scene lies in this view."""

    across: np.ndarray
    depth: np.ndarray
    up: np.ndarray
    flat: bool

    @property
    def front(self) -> Projection:
        """Return the main view."""
        return _projection(self.across, self.up)

    @property
    def side(self) -> Projection:
        """Return the view along the horizontal of the main view."""
        return _projection(self.depth, self.up)

    @property
    def top(self) -> Projection:
        """Return the view from above."""
        return _projection(self.across, self.depth)

    @property
    def matrix(self) -> np.ndarray:
        """Return (3, 3): the directions as columns."""
        return np.column_stack([self.across, self.depth, self.up])

    @property
    def names(self) -> tuple[str, str, str]:
        """Return the names of the directions."""
        return axis_name(self.across), axis_name(self.depth), axis_name(self.up)


def _projection(across: np.ndarray, up: np.ndarray) -> Projection:
    return Projection(across, up, (axis_name(across), axis_name(up)))


def axis_name(direction: np.ndarray) -> str:
    """Return the name of an axis, or the components of another direction."""
    for name, axis in zip("xyz", np.eye(3), strict=True):
        for sign, called in ((1, name), (-1, f"−{name}")):
            if np.allclose(direction, sign * axis, atol=1e-6):
                return called
    return "({:.3g}, {:.3g}, {:.3g})".format(*direction)


def points(clip: Clip) -> Iterator[np.ndarray]:
    """Yield the points (..., 3) of cables, bodies and marks of a clip over all its frames."""
    for cable in clip.cables:
        yield cable.position
    for body in clip.bodies:
        yield body.position
    for mark in clip.marks:
        yield mark.position


def all_points(animation: Animation) -> np.ndarray:
    """Return the points (n, 3) of all clips; the origin without any."""
    found = [each.reshape(-1, 3) for clip in animation.clips for each in points(clip)]
    return np.concatenate(found) if found else np.zeros((1, 3))


def directions(animation: Animation) -> Directions:
    """Return the directions of an animation: across is the horizontal of its largest extent.

    A scene in one vertical plane is seen perpendicular to it; another one along the ground's axes if they are level.
    """
    up = np.array(animation.up)
    found = all_points(animation)
    centred = found - found.mean(axis=0)
    level = centred - np.multiply.outer(centred @ up, up)
    size = float(np.linalg.norm(np.ptp(found, axis=0)))
    values, vectors = np.linalg.eigh(level.T @ level)
    across = vectors[:, 2]
    if values[2] <= (1e-9 * size) ** 2 * len(found):  # a vertical line, or a point
        across = np.eye(3)[np.argmin(np.abs(up))]
        across = across - (across @ up) * up
    across = across / np.linalg.norm(across)
    flat = bool(np.ptp(centred @ np.cross(up, across)) <= MAX_FLAT_DEPTH * size)
    axes = [axis for axis in np.eye(3) if abs(axis @ up) < 1e-9]
    if not flat and len(axes) == 2:
        across = max(axes, key=lambda axis: np.ptp(found @ axis))
    across = across * np.sign(across[np.argmax(np.abs(across))]) + 0.0  # no -0
    return Directions(across, np.cross(up, across), up, flat)
