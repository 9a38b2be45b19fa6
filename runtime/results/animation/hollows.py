"""Hollows in a picture: staves and hoops of what is round, the edges of a box; one sees between them what is inside."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...parts.surface_shapes import Geometry
from .meshes import grid_mesh, joined, square_to

STAVES = 12
"""Around an axis."""
COVERED = 0.3
"""Of the way around: what staves cover, and of the radius the width of a hoop."""
EDGE = 0.1
"""Of the least half size of a box: the width of its edges."""
ARC = 12
"""Pieces of a half circle."""


def hollow_mesh(shape: Geometry) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices (V, 3), in m from the origin of the shape, and triangles (F, 3) of a hollow."""
    patches = _edges(shape) if shape.word == "box" else _staves(shape)
    return joined([grid_mesh(patch @ shape.axes.T) for patch in patches])


def _edges(shape: Geometry) -> Iterator[np.ndarray]:
    """Yield the strips along the edges of each face of a box, (2, 2, 3)."""
    half, width = shape.half_size, EDGE * shape.half_size.min()
    for face in range(3):
        for along, across in ((face - 2, face - 1), (face - 1, face - 2)):
            for side in (-1, 1):
                for end in (-1, 1):
                    patch = np.zeros((2, 2, 3))
                    patch[..., face] = side * half[face]
                    patch[..., along] = (np.array([-1, 1]) * half[along])[:, None]
                    patch[..., across] = end * np.array([half[across], half[across] - width])
                    yield patch


def _staves(shape: Geometry) -> Iterator[np.ndarray]:
    """Yield strips (n, m, 3) along the axis of what is round, and hoops about it."""
    axis = shape.direction if shape.direction.any() else np.array([0.0, 0.0, 1.0])
    first, second = square_to(axis)
    if shape.word == "round" and shape.direction.any():
        radii, heights = np.full(2, shape.radius), shape.half_length * np.array([-1.0, 1.0])
        ends = heights
    else:
        angle = np.concatenate([np.linspace(-np.pi / 2, 0, ARC // 2 + 1), np.linspace(0, np.pi / 2, ARC // 2 + 1)])
        radii = shape.radius * np.cos(angle)
        heights = shape.radius * np.sin(angle) + shape.half_length * np.where(np.arange(len(angle)) <= ARC // 2, -1, 1)
        ends = np.zeros(1)

    def turned(r: np.ndarray, z: np.ndarray, about: np.ndarray) -> np.ndarray:
        around = np.cos(about)[:, None] * first + np.sin(about)[:, None] * second
        return r[:, None, None] * around + z[:, None, None] * axis

    for k in range(STAVES):
        yield turned(radii, heights, 2 * np.pi / STAVES * (k + COVERED * np.array([-0.5, 0.5])))
    for end in ends:
        near = end + COVERED * shape.radius * np.array([-0.5, 0.5])
        near = np.clip(near, heights.min(), heights.max())
        yield turned(np.full(2, shape.radius), near, np.linspace(0, 2 * np.pi, 4 * ARC + 1))
