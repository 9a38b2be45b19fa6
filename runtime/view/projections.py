"""From where an animation is looked at: planes on which it is drawn, and how far it reaches."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from .animation import Animation, Clip

FLAT = 0.02
"""Of a scene's size: one that reaches no farther out of a vertical plane is drawn in that plane alone."""


class Projection(NamedTuple):
    """A plane that is looked at: unit vectors across and up (3,), and what they are called."""

    across: np.ndarray
    up: np.ndarray
    names: tuple[str, str]

    def of(self, points: np.ndarray) -> np.ndarray:
        """Return points (..., 3) as (..., 2) in the plane."""
        return points @ np.stack([self.across, self.up], axis=1)


class Directions(NamedTuple):
    """Three directions, right-handed: across the main view, into it, and up; and whether the scene is in that view."""

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
        """Return the view along the main view's horizontal."""
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
        """Return what the directions are called."""
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
    """Return (n, 3): the points of all clips; the origin where there are none."""
    found = [each.reshape(-1, 3) for clip in animation.clips for each in points(clip)]
    return np.concatenate(found) if found else np.zeros((1, 3))


def directions(animation: Animation) -> Directions:
    """Return how an animation is looked at: the horizontal along which it reaches farthest goes across.

    A scene in one vertical plane is seen square to it; of another one the ground's axes are taken where they are level.
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
    flat = bool(np.ptp(centred @ np.cross(up, across)) <= FLAT * size)
    axes = [axis for axis in np.eye(3) if abs(axis @ up) < 1e-9]
    if not flat and len(axes) == 2:
        across = max(axes, key=lambda axis: np.ptp(found @ axis))
    across = across * np.sign(across[np.argmax(np.abs(across))]) + 0.0  # no -0
    return Directions(across, np.cross(up, across), up, flat)
