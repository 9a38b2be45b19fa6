"""Surfaces of the shapes of bodies, as triangles in body axes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

AROUND = 24
"""Corners of the circle that stands for one."""

Surface = tuple[np.ndarray, np.ndarray]
"""Vertices (V, 3) in m and triangles (F, 3), numbers of vertices, which turn left seen from outside."""


def _box() -> Surface:
    """Return the box of unit lengths about the origin."""
    vertices = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return vertices, np.array([part for a, b, c, d in faces for part in ((a, b, c), (a, c, d))])


BOX = _box()


def _turned_profile(radii: np.ndarray, heights: np.ndarray) -> Surface:
    """Return the surface that a profile makes which turns about z; its ends are on the axis."""
    angle = 2 * np.pi * np.arange(AROUND) / AROUND
    rings = [np.stack([r * np.cos(angle), r * np.sin(angle), np.full(AROUND, z)], axis=1)
             for r, z in zip(radii[1:-1], heights[1:-1], strict=True)]
    vertices = np.concatenate([[[0, 0, heights[0]]], *rings, [[0, 0, heights[-1]]]])
    here = np.arange(AROUND)
    on = np.roll(here, -1)
    last = len(vertices) - 1
    triangles = [np.stack([np.zeros(AROUND, int), 1 + on, 1 + here], axis=1)]
    for ring in range(len(rings) - 1):
        low, high = 1 + ring * AROUND, 1 + (ring + 1) * AROUND
        triangles += [np.stack([low + here, low + on, high + on], axis=1),
                      np.stack([low + here, high + on, high + here], axis=1)]
    top = 1 + (len(rings) - 1) * AROUND
    triangles.append(np.stack([top + here, top + on, np.full(AROUND, last)], axis=1))
    return vertices, np.concatenate(triangles)


def _along(axis: np.ndarray) -> np.ndarray:
    """Return a rotation (3, 3) that takes z to a unit vector."""
    other = np.eye(3)[np.argmin(np.abs(axis))]
    x = np.cross(other, axis)
    x = x / np.linalg.norm(x)
    return np.column_stack([x, np.cross(axis, x), axis])


def surface(shape: Mapping[str, Any]) -> Surface:
    """Return the surface of the shape of a `BodyShape`, in body axes. Raises ValueError for an unknown kind."""
    match shape["kind"]:
        case "box":
            vertices, triangles = BOX[0] * shape["size"], BOX[1]
        case "sphere":
            polar = np.linspace(np.pi, 0, AROUND // 2 + 1)
            vertices, triangles = _turned_profile(shape["radius"] * np.sin(polar), shape["radius"] * np.cos(polar))
        case "cylinder":
            radius, half = shape["radius"], shape["length"] / 2
            profile = np.array([0, radius, radius, 0]), np.array([-half, -half, half, half])
            vertices, triangles = _turned_profile(*profile)
            axis = np.asarray(shape["axis"], dtype=float)
            vertices = vertices @ _along(axis / np.linalg.norm(axis)).T
        case "mesh":
            vertices, triangles = np.asarray(shape["vertices"], dtype=float), np.asarray(shape["triangles"])
        case unknown:
            raise ValueError(f"a body has a shape of the unknown kind {unknown!r}")
    return vertices + np.asarray(shape["offset"], dtype=float), triangles
