"""Hollow surfaces in a picture: staves and hoops of round shapes, the edges of a box, with the interior visible."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...parts.surface_shapes import Geometry
from ...view.surfaces import grid_mesh, joined, square_to

STAVES = 12
"""Staves around an axis."""
COVERAGE = 0.3
"""Part of the circumference under staves, and width of a hoop over the radius."""
EDGE_WIDTH = 0.1
"""Width of the edges of a box over its smallest half size."""
ARC_SEGMENTS = 12
"""Segments of a half circle."""


def hollow_mesh(shape: Geometry) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices (V, 3), in m from the origin of the shape, and triangles (F, 3) of a hollow."""
    patches = _edges(shape) if shape.word == "box" else _staves(shape)
    return joined([grid_mesh(patch @ shape.axes.T) for patch in patches])


def _edges(shape: Geometry) -> Iterator[np.ndarray]:
    """Yield the strips along the edges of each face of a box, (2, 2, 3)."""
    half, width = shape.half_size, EDGE_WIDTH * shape.half_size.min()
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
    """Yield strips (n, m, 3) along the axis of a round shape, and hoops about it."""
    axis = shape.direction if shape.direction.any() else np.array([0.0, 0.0, 1.0])
    first, second = square_to(axis)
    if shape.word == "round" and shape.direction.any():
        radii, heights = np.full(2, shape.radius), shape.half_length * np.array([-1.0, 1.0])
        ends = heights
    else:
        half = ARC_SEGMENTS // 2
        angle = np.concatenate([np.linspace(-np.pi / 2, 0, half + 1), np.linspace(0, np.pi / 2, half + 1)])
        radii = shape.radius * np.cos(angle)
        heights = shape.radius * np.sin(angle) + shape.half_length * np.where(np.arange(len(angle)) <= half, -1, 1)
        ends = np.zeros(1)

    def turned(r: np.ndarray, z: np.ndarray, about: np.ndarray) -> np.ndarray:
        around = np.cos(about)[:, None] * first + np.sin(about)[:, None] * second
        return np.asarray(r[:, None, None] * around + z[:, None, None] * axis)

    for k in range(STAVES):
        yield turned(radii, heights, 2 * np.pi / STAVES * (k + COVERAGE * np.array([-0.5, 0.5])))
    for end in ends:
        near = end + COVERAGE * shape.radius * np.array([-0.5, 0.5])
        near = np.clip(near, heights.min(), heights.max())
        yield turned(np.full(2, shape.radius), near, np.linspace(0, 2 * np.pi, 4 * ARC_SEGMENTS + 1))
