"""Checks of drawn cables: elements follow the curve, the height has a direction, planar elements lie in a plane."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..base.rotations import cross
from . import cable_laws
from .curves import Line, Spline, has_height, shape_through
from .plane import Plane, aligned, called, normal_of
from .validation import Points, Vector, show

MIN_SLOPE = 0.5
"""Of an element along the curve that it approximates, over the slope of the curve."""
UP_TOLERANCE = 1e-9
"""Angle in rad of ``up`` from the plane of a curve."""


@lru_cache(maxsize=128)
def plane_of(points: Points, up: Vector) -> Plane | None:
    """Return the plane of a planar cable through its line and ``up``, normal along tangent x up; None for z = 0.

    points: of the drawn cable. Raises ValueError(cause, remedy) where there is no such plane.
    """
    if not up[2] and not any(point[2] for point in points):
        return None
    shape = shape_through(points)
    tangent = shape.tangent(0.0)
    if not has_height(points, up):
        raise ValueError(f"up must not be zero or parallel to the axis {show(tangent)}, got {show(up)}",
                         "give up, a direction in the plane of the cable")
    by_up = cross(tangent, up) / np.linalg.norm(cross(tangent, up))
    vertices = np.array(points)
    normal = normal_of([vertices - vertices[0]])  # the points of a curve give it more exactly
    normal = by_up if normal is None else -normal if np.dot(normal, by_up) < 0 else normal
    plane = Plane.across(aligned(normal), vertices[0])
    remedy = "draw it in one plane, give up in that, or take " + cable_laws.others(3)
    if plane.contains(vertices) and not plane.contains(shape.point(np.linspace(0, shape.length, 8 * len(points)))):
        raise ValueError(f"its curve leaves {called(plane)} between points in it", "give more points, or take "
                         + cable_laws.others(3))
    if np.linalg.norm(normal - by_up) > UP_TOLERANCE:
        raise ValueError(f"up {show(up)} leaves {called(plane)}, in which it is drawn", remedy)
    if not plane.contains(vertices):
        off = int(np.argmax(np.abs(plane.points_into(vertices)[:, 2])))
        raise ValueError(f"point {off + 1}, {show(points[off], 'm')}, leaves {called(plane)}", remedy)
    return plane


def check_plane(element: str, points: Points, velocity: Vector, angular_velocity: Vector,
                up: Vector) -> None:
    """Raise ValueError(cause, remedy) where a cable of planar elements lies in no plane, or starts to leave it."""
    try:
        plane = plane_of(points, up)
    except ValueError as error:
        cause, remedy = error.args
        raise ValueError(f"{element} is planar, but {cause}", remedy) from None
    moves, turns = np.array(velocity), np.array(angular_velocity)
    if plane is not None:
        moves, turns = aligned(plane.into(moves)), aligned(plane.into(turns))
    if moves[2] != 0 or any(turns[:2]):
        raise ValueError(f"{element} is planar, but it starts with velocity {show(velocity, 'm/s')} and "
                         f"angular_velocity {show(angular_velocity, 'rad/s')}",
                         f"let it move in {called(plane)} and turn about "
                         f"{'z' if plane is None else 'its normal'}, or take {cable_laws.others(3)}")


def check_height(points: Points, up: Vector, is_round: bool) -> None:
    """Raise ValueError(cause, remedy) where ``up`` gives no direction of the height; a round section needs none."""
    if not has_height(points, up) and not (is_round and any(up)):
        tangent = shape_through(points).tangent(0.0)
        raise ValueError(f"up must not be zero or parallel to the axis {show(tangent)}, got {show(up)}",
                         "give the direction of the section's height")


def check_elements(shape: Line | Spline, nodes: np.ndarray) -> None:
    """Raise ValueError(cause, remedy) where an element is too long to follow the direction of the curve.

    nodes: (n,) drawn arc-lengths in m, rising; twice where pieces of unlike stiffness join.
    """
    if shape.straight:
        return
    nodes = np.unique(nodes)
    xi, length = np.linspace(0, 1, 17)[:, None, None], np.diff(nodes)[:, None]
    r, t = shape.point(nodes), shape.tangent(nodes)
    slope = (6 * xi * (1 - xi) * np.diff(r, axis=0) / length
             + (1 - 4 * xi + 3 * xi**2) * t[:-1] + (3 * xi**2 - 2 * xi) * t[1:])
    onward = np.sum(slope * shape.tangent(nodes[:-1] + length[:, 0] * xi[..., 0]), axis=-1).min(axis=0)
    worst = int(np.argmin(onward))
    if onward[worst] < MIN_SLOPE:
        raise ValueError(f"element {worst + 1} of {len(length)} cannot follow the curve from "
                         f"{show(r[worst])} to {show(r[worst + 1], 'm')}: it bends too much there",
                         "take more elements")
