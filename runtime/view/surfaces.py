"""Surfaces of bodies as triangles, in body axes and at a frame, and their outlines in a picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..base.linear_waves import elevation
from ..base.rotations import rotate
from .animation import BodyShape

CIRCLE_POINTS = 24
"""Corners of the polygon that approximates a circle."""
WHEEL_POINTS = 72
"""Corners of the rim of a wheel, on which a rope lies."""
SPOKES = 5
RIM, HUB, SPOKE, WIDE_SPOKE = 0.14, 0.16, 0.07, 0.2
"""Depth of the rim of a wheel, radius of its hub, widths of its spokes, over its radius."""

Surface = tuple[np.ndarray, np.ndarray]
"""Vertices (V, 3) in m and triangles (F, 3), numbers of vertices, counterclockwise seen from outside."""


def _box() -> Surface:
    """Return the box of unit lengths about the origin."""
    vertices = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return vertices, np.array([part for a, b, c, d in faces for part in ((a, b, c), (a, c, d))])


BOX = _box()


def _turned_profile(radii: np.ndarray, heights: np.ndarray) -> Surface:
    """Return the surface of revolution of a profile about z; the ends of the profile are on the axis."""
    angle = 2 * np.pi * np.arange(CIRCLE_POINTS) / CIRCLE_POINTS
    rings = [np.stack([r * np.cos(angle), r * np.sin(angle), np.full(CIRCLE_POINTS, z)], axis=1)
             for r, z in zip(radii[1:-1], heights[1:-1], strict=True)]
    vertices = np.concatenate([[[0, 0, heights[0]]], *rings, [[0, 0, heights[-1]]]])
    here = np.arange(CIRCLE_POINTS)
    on = np.roll(here, -1)
    last = len(vertices) - 1
    triangles = [np.stack([np.zeros(CIRCLE_POINTS, int), 1 + on, 1 + here], axis=1)]
    for ring in range(len(rings) - 1):
        low, high = 1 + ring * CIRCLE_POINTS, 1 + (ring + 1) * CIRCLE_POINTS
        triangles += [np.stack([low + here, low + on, high + on], axis=1),
                      np.stack([low + here, high + on, high + here], axis=1)]
    top = 1 + (len(rings) - 1) * CIRCLE_POINTS
    triangles.append(np.stack([top + here, top + on, np.full(CIRCLE_POINTS, last)], axis=1))
    return vertices, np.concatenate(triangles)


def _ring(inner: float, outer: float, width: float, corners: int) -> Surface:
    """Return a ring of rectangular section about z."""
    angle = 2 * np.pi * np.arange(corners) / corners
    profile = [(inner, -width / 2), (outer, -width / 2), (outer, width / 2), (inner, width / 2)]
    vertices = np.stack([np.stack([r * np.cos(angle), r * np.sin(angle), np.full(corners, z)], axis=1)
                         for r, z in profile])
    here = np.arange(corners)
    on = np.roll(here, -1)
    triangles = []
    for k in range(4):
        low, high = k * corners, (k + 1) % 4 * corners
        triangles += [np.stack([low + here, low + on, high + on], axis=1),
                      np.stack([low + here, high + on, high + here], axis=1)]
    return vertices.reshape(-1, 3), np.concatenate(triangles)


def wheel(radius: float, width: float) -> Surface:
    """Return a wheel about z: rim, hub and spokes, of which the one along x is wide and shows the angle."""
    hub, inner = HUB * radius, (1 - RIM) * radius
    parts = [_ring(inner, radius, width, WHEEL_POINTS), _ring(0.4 * hub, hub, width, CIRCLE_POINTS)]
    for k in range(SPOKES):
        across = (SPOKE if k else WIDE_SPOKE) * radius
        length = inner - 0.8 * hub + 0.3 * RIM * radius
        bar = BOX[0] * [length, across, 0.6 * width] + [0.8 * hub + length / 2, 0, 0]
        turn = 2 * np.pi * k / SPOKES
        x, y = np.array([np.cos(turn), np.sin(turn), 0]), np.array([-np.sin(turn), np.cos(turn), 0])
        parts.append((bar @ np.stack([x, y, [0, 0, 1]]), BOX[1]))
    return joined(parts)


def square_to(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two unit vectors (3,) orthogonal to a unit vector and to each other."""
    along = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    along /= np.linalg.norm(along)
    return along, np.cross(along, normal)


def grid_mesh(points: np.ndarray) -> Surface:
    """Return the vertices and triangles of a grid of points (n, m, 3), visible from both sides."""
    n, m = points.shape[:2]
    k = (np.arange(n - 1)[:, None] * m + np.arange(m - 1)).ravel()
    one = np.concatenate([np.stack([k, k + 1, k + m], axis=1), np.stack([k + 1, k + m + 1, k + m], axis=1)])
    return points.reshape(-1, 3), np.concatenate([one, one[:, ::-1]])


def joined(meshes: Sequence[Surface]) -> Surface:
    """Return several meshes as one."""
    first = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    return (np.concatenate([vertices for vertices, _ in meshes]),
            np.concatenate([triangles + k for (_, triangles), k in zip(meshes, first, strict=False)]))


def _level(shape: Mapping[str, Any]) -> Surface:
    """Return the level surface of a fluid."""
    u, v = (np.linspace(-shape["size"], shape["size"], cells + 1)[:, None] for cells in shape["cells"])
    return grid_mesh(u[:, None] * shape["along"] + v * shape["across"])


def surface(shape: Mapping[str, Any]) -> Surface:
    """Return the surface of the shape of a `BodyShape`, in body axes. Raises ValueError for an unknown kind."""
    match shape["kind"]:
        case "box":
            vertices, triangles = BOX[0] * shape["size"], BOX[1]
        case "sphere":
            polar = np.linspace(np.pi, 0, CIRCLE_POINTS // 2 + 1)
            vertices, triangles = _turned_profile(shape["radius"] * np.sin(polar), shape["radius"] * np.cos(polar))
        case "cylinder":
            radius, half = shape["radius"], shape["length"] / 2
            profile = np.array([0, radius, radius, 0]), np.array([-half, -half, half, half])
            vertices, triangles = _turned_profile(*profile)
            axis = np.asarray(shape["axis"], dtype=float)
            axis = axis / np.linalg.norm(axis)
            vertices = vertices @ np.stack([*square_to(axis)[::-1], axis])
        case "wheel":
            vertices, triangles = wheel(shape["radius"], shape["width"])
        case "mesh":
            vertices, triangles = np.asarray(shape["vertices"], dtype=float), np.asarray(shape["triangles"])
        case "water":
            vertices, triangles = _level(shape)
        case unknown:
            raise ValueError(f'a body has no shape "{unknown}": box, sphere, cylinder, wheel, mesh and water are known')
    return vertices + np.asarray(shape.get("offset", (0, 0, 0)), dtype=float), triangles


def body_reach(body: BodyShape) -> float:
    """Return the largest distance of the surface of a body from its origin, m."""
    return float(np.linalg.norm(surface(body.shape)[0], axis=1).max())


def placed_surface(body: BodyShape, frame: int, time: float) -> Surface:
    """Return the surface of a body at a frame and its time: vertices (V, 3) in m, the ground's axes, and triangles."""
    vertices, triangles = surface(body.shape)
    if body.shape["kind"] == "water":
        vertices = with_waves(body.shape, vertices, time)
    return body.position[frame] + rotate(body.orientation[frame], vertices), triangles


def with_waves(shape: Mapping[str, Any], points: np.ndarray, time: float) -> np.ndarray:
    """Return points (n, 3) of the level surface of a fluid, in m from its origin, at their elevations at a time."""
    return np.asarray(points + np.multiply.outer(elevation(shape["waves"], np.asarray(time), points), shape["up"]))


def wave_lines(body: BodyShape, frame: int, time: float, count: int) -> list[np.ndarray]:
    """Return lines (n, 3) on the surface of a fluid at a frame and its time, so many along each side, in m."""
    shape: Mapping[str, Any] = body.shape
    size, sides, found = shape["size"], (shape["along"], shape["across"]), []
    for side, other, cells in zip(sides, sides[::-1], shape["cells"], strict=True):
        for at in np.linspace(-size, size, count) if count > 1 else (0.0,):
            line = np.multiply.outer(np.linspace(-size, size, cells + 1), side) + at * np.asarray(other)
            found.append(body.position[frame] + with_waves(shape, line, time))
    return found


def spoke(body: BodyShape, frame: int) -> np.ndarray:
    """Return the ends (2, 3) in m of the wide spoke of a wheel at a frame."""
    ends = np.multiply.outer([0.0, float(body.shape["radius"])], [1.0, 0.0, 0.0])  # type: ignore[arg-type]
    return np.asarray(body.position[frame] + rotate(body.orientation[frame], ends))


def outline(points: np.ndarray) -> np.ndarray:
    """Return the corners (n, 2) of the convex hull of points (N, 2) in order; collinear points unchanged."""
    from scipy.spatial import ConvexHull, QhullError  # for pictures alone

    try:
        hull: np.ndarray = points[ConvexHull(points).vertices]
    except QhullError:
        return points
    return hull
