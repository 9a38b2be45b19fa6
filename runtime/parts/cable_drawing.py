"""How a cable may be drawn: its elements follow the curve, its height has a direction, planar ones lie in the plane."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from . import cable_laws
from .curves import Line, Spline, has_height, shape_through
from .validation import Vector, show

FOLLOWS = 0.5
"""An element's slope along the curve that it stands for must be this part of the curve's everywhere."""


def check_plane(element: str, through: dict[str, Sequence[float]], velocity: Vector, angular_velocity: Vector,
                up: Vector) -> None:
    """Raise ValueError(cause, remedy) where a cable of planar elements leaves the plane z = 0, or has such a motion.

    through: the points that it is drawn through, by what messages call them.
    """
    for name, point in through.items():
        if point[2] != 0:
            raise ValueError(f"{element} is planar, but {name} leaves the plane z = 0: {show(tuple(point), 'm')}",
                             "draw it with z = 0, or take " + cable_laws.others(3))
    if velocity[2] != 0 or any(angular_velocity[:2]):
        raise ValueError(f"{element} is planar, but it starts with velocity {show(velocity, 'm/s')} and "
                         f"angular_velocity {show(angular_velocity, 'rad/s')}",
                         "let it move in the plane z = 0 and turn about z, or take " + cable_laws.others(3))
    if up[2] != 0:
        raise ValueError(f"{element} is planar, but up leaves the plane z = 0: {show(up)}",
                         "leave it out: the height lies in the plane")


def check_height(points: tuple[tuple[float, ...], ...], up: Vector, is_round: bool) -> None:
    """Raise ValueError(cause, remedy) where up gives no direction of the height; a round section needs none.

    points: that the cable is drawn through.
    """
    if not has_height(points, up) and not (is_round and any(up)):
        tangent = shape_through(points).tangent(0.0)
        raise ValueError(f"up must not be zero or parallel to the axis {show(tangent)}, got {show(up)}",
                         "give the direction of the section's height")


def check_elements(shape: Line | Spline, nodes: np.ndarray) -> None:
    """Raise ValueError(cause, remedy) where elements are too coarse to be drawn: the slope of one loses the direction
    of the curve.

    nodes: (n,) their arc-lengths as drawn, in m.
    """
    if shape.straight:
        return
    xi, length = np.linspace(0, 1, 17)[:, None, None], np.diff(nodes)[:, None]
    r, t = shape.point(nodes), shape.tangent(nodes)
    slope = (6 * xi * (1 - xi) * np.diff(r, axis=0) / length
             + (1 - 4 * xi + 3 * xi**2) * t[:-1] + (3 * xi**2 - 2 * xi) * t[1:])
    onward = np.sum(slope * shape.tangent(nodes[:-1] + length[:, 0] * xi[..., 0]), axis=-1).min(axis=0)
    worst = int(np.argmin(onward))
    if onward[worst] < FOLLOWS:
        raise ValueError(f"element {worst + 1} of {len(length)} cannot follow the curve from "
                         f"{show(r[worst])} to {show(r[worst + 1], 'm')}: it bends too much there",
                         "take more elements")
