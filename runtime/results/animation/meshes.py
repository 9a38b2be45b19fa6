"""Meshes of what pictures draw: grids of points, in planes and bent, and several of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

Mesh = tuple[np.ndarray, np.ndarray]
"""Vertices (V, 3) in m and triangles (F, 3), numbers of vertices."""


def grid_mesh(points: np.ndarray) -> Mesh:
    """Return the vertices and triangles of a grid of points (n, m, 3), to be seen from both sides."""
    n, m = points.shape[:2]
    k = (np.arange(n - 1)[:, None] * m + np.arange(m - 1)).ravel()
    one = np.concatenate([np.stack([k, k + 1, k + m], axis=1), np.stack([k + 1, k + m + 1, k + m], axis=1)])
    return points.reshape(-1, 3), np.concatenate([one, one[:, ::-1]])


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """Return several meshes as one."""
    first = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    return (np.concatenate([vertices for vertices, _ in meshes]),
            np.concatenate([triangles + k for (_, triangles), k in zip(meshes, first, strict=False)]))


def square_to(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two unit vectors (3,) that are square to a third and to each other."""
    along = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    along /= np.linalg.norm(along)
    return along, np.cross(along, normal)
