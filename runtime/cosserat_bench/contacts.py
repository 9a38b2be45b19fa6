"""Contact in cosseratbench's scenarios: of rods with fixed obstacles and with each other, and contact left out.

The stiffness of contact lets rods under their own weight sink by a thousandth of their radius. Where a state of rest is
the result, damping prevents bouncing.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial import cKDTree

from ..base.rotations import cross as cross_product
from ..parts.cable import Cable
from ..parts.solids import Cylinder
from ..parts.surface_shapes import Plane
from ..scene.scene import Scene

if TYPE_CHECKING:
    from cosseratbench.scenario import Rod, Scenario

PENETRATION = 1e-3
"""Penetration of a rod under its own weight, over its radius."""

REST_DAMPING = 10.0
"""Damping of contact times the speed of a fall from a radius' height, where a state of rest is the result."""

EARTH_GRAVITY = 9.81
"""m/s²: assumed where a scenario has no gravity."""

CLOSE_START = 0.1
"""Distance below which contact of rods is expected, over the length of the shorter one."""

DEEP_PENETRATION = 0.25
"""Part of the distance of two axes in contact above which a penetration means that rods passed into each other."""

MIN_CROSSING_SINE = 0.1
"""Smallest sine of the angle of two rods that cross."""

POINT_SPACING = 0.5
"""Distance of the points on rods between which distances are computed, in radii."""

MIN_SELF_CONTACT_TURN = 0.9 * np.pi
"""rad: smallest turn along a rod with which it can have contact with itself."""


def tangents_of(positions: np.ndarray) -> np.ndarray:
    """Return (..., elements, 3): unit vectors along the chords between nodes (..., nodes, 3)."""
    chords = np.diff(positions, axis=-2)
    return np.asarray(chords / np.linalg.norm(chords, axis=-1, keepdims=True))


def is_plane(obstacle: Any) -> bool:
    """Return whether an obstacle is a plane; others are cylinders."""
    return bool(obstacle.kind == "plane")


def stand(scene: Scene, scenario: Scenario, rods: list[Rod], cables: list[Cable]) -> None:
    """Add the obstacles of a scenario to a scene, and their contact with every rod."""
    obstacle: Any
    for k, obstacle in enumerate(scenario.obstacles):
        name = f"obstacle{k}"
        if is_plane(obstacle):
            scene.surface(name, Plane(point=obstacle.point, normal=tuple(obstacle.unit_normal.tolist())))
        else:
            scene.surface(name, Cylinder(radius=obstacle.radius, length=obstacle.length,
                                         axis=tuple(obstacle.unit_axis.tolist())), at=obstacle.center)
        for rod, cable in zip(rods, cables, strict=True):
            scene.contact(cable, name, stiffness=_weight(rod, scenario) / (PENETRATION * rod.radius),
                          damping=_damping(rod, scenario), friction=max(obstacle.friction, rod.friction))


def cross(scene: Scene, scenario: Scenario, first: tuple[Rod, Cable], second: tuple[Rod, Cable]) -> None:
    """Add frictionless contact of two rods at their closest points."""
    lighter = min(first[0], second[0], key=lambda rod: _weight(rod, scenario) * rod.length)
    scene.crossing(first[1], second[1], damping=_damping(lighter, scenario),
                   stiffness=_weight(lighter, scenario) * lighter.length / (PENETRATION * lighter.radius))


def near(scenario: Scenario) -> set[tuple[int, int]]:
    """Return the pairs of rods whose contact is expected: those that start close to each other."""
    rods = scenario.rods
    return {(i, j) for i, j in combinations(range(len(rods)), 2)
            if _gaps(rods[i], rods[j], *_starts(rods[i], rods[j])).min()
            < CLOSE_START * min(rods[i].length, rods[j].length)}


def side_by_side(first: Rod, second: Rod) -> bool:
    """Return whether two rods start in parallel where they are closest, so that their contact would not be a point."""
    points = [_points(nodes[0], rod)[0] for nodes, rod in zip(_starts(first, second), (first, second), strict=True)]
    tangents = [np.gradient(line, axis=0)[k] for line, k in zip(points, _closest(*points), strict=True)]
    sine = np.linalg.norm(cross_product(*tangents)) / np.prod(np.linalg.norm(tangents, axis=1))
    return bool(sine < MIN_CROSSING_SINE)


def line_of(vectors: np.ndarray, names: tuple[str, ...], rod: Rod) -> np.ndarray:
    """Return points (frames, points, 3) in m on the axis of a rod, by the shape functions of its elements.

    vectors: (frames, nodes, vectors, 3), with these names; the points are about `POINT_SPACING` radii apart.
    """
    at, slope = vectors[:, :, names.index("r")], vectors[:, :, names.index("r_x")]
    length = rod.length / (at.shape[1] - 1)
    intervals = 1 + int(length / (POINT_SPACING * rod.radius))
    x = (np.arange(intervals) / intervals)[:, None]
    inside = ((1 - 3 * x**2 + 2 * x**3) * at[:, :-1, None] + (3 * x**2 - 2 * x**3) * at[:, 1:, None]
              + length * ((x - 2 * x**2 + x**3) * slope[:, :-1, None] + (x**3 - x**2) * slope[:, 1:, None]))
    return np.concatenate([inside.reshape(len(at), -1, 3), at[:, -1:]], axis=1)


def may_meet(scenario: Scenario, lines: list[np.ndarray]) -> set[tuple[int, int]]:
    """Return the pairs of rods with possible contact in a frame or between two; lines: (frames, points, 3), m."""
    rods = scenario.rods
    travels = [_travel(line) for line in lines]
    return {(i, j) for i, j in combinations(range(len(rods)), 2)
            if np.any(_within_reach(_gaps(rods[i], rods[j], lines[i], lines[j]), travels[i] + travels[j]))}


def overlapping(scenario: Scenario, lines: list[np.ndarray]) -> dict[tuple[int, int], int]:
    """Return the pairs of rods that pass into or through each other, with the first frame of that.

    lines: (frames, points, 3) of each, in m.
    """
    rods, found = scenario.rods, {}
    for i, j in combinations(range(len(rods)), 2):
        gaps = _gaps(rods[i], rods[j], lines[i], lines[j])
        inside = gaps < -DEEP_PENETRATION * (rods[i].radius + rods[j].radius)
        for k in np.flatnonzero(_within_reach(gaps, _travel(lines[i]) + _travel(lines[j]))).tolist():
            before, after = (_between(rods[i], rods[j], lines[i][each], lines[j][each]) for each in (k, k + 1))
            inside[k + 1] |= before @ after < 0  # they changed sides
        if inside.any():
            found[i, j] = int(np.argmax(inside))
    return found


def passes_into_itself(rod: Rod, line: np.ndarray) -> int | None:
    """Return the first frame in which a rod along a line (frames, points, 3) passes into itself, or None."""
    tangents = tangents_of(line)
    turns = np.arccos(np.clip(np.sum(tangents[:, :-1] * tangents[:, 1:], axis=-1), -1, 1)).sum(axis=1)
    for frame in np.flatnonzero(turns > MIN_SELF_CONTACT_TURN).tolist():
        points, along = _points(line[frame], rod)
        pairs = cKDTree(points).query_pairs(2 * (1 - DEEP_PENETRATION) * rod.radius, output_type="ndarray")
        if np.any(along[pairs[:, 1]] - along[pairs[:, 0]] > np.pi * rod.radius):
            return frame
    return None


def beyond_a_cylinder(scenario: Scenario, positions: list[np.ndarray]) -> bool:
    """Return whether a rod has contact with the extension of a cylinder: those of scenes are endless."""
    obstacle: Any
    for obstacle in scenario.obstacles:
        if is_plane(obstacle):
            continue
        for rod, nodes in zip(scenario.rods, positions, strict=True):
            offset = nodes - np.asarray(obstacle.center)
            along = offset @ obstacle.unit_axis
            across = np.linalg.norm(offset - along[..., None] * obstacle.unit_axis, axis=-1)
            if np.any((np.abs(along) > obstacle.length / 2) & (across < obstacle.radius + rod.radius)):
                return True
    return False


def _weight(rod: Rod, scenario: Scenario) -> float:
    """Return the weight of a rod in N/m."""
    return float(rod.material.density * rod.area * _gravity(scenario))


def _damping(rod: Rod, scenario: Scenario) -> float:
    """Return the damping of contact in s/m."""
    return float(REST_DAMPING / np.sqrt(_gravity(scenario) * rod.radius)) if scenario.quasi_static else 0.0


def _gravity(scenario: Scenario) -> float:
    """Return the size of gravity for the stiffness of contact, in m/s²."""
    return float(np.linalg.norm(scenario.gravity)) or EARTH_GRAVITY


def _starts(first: Rod, second: Rod) -> tuple[np.ndarray, np.ndarray]:
    """Return the lines of two rods as they start, as the only frame (1, points, 3) of each, in m."""
    return np.asarray([first.centerline], dtype=float), np.asarray([second.centerline], dtype=float)


def _gaps(first: Rod, second: Rod, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the distances (frames,) in m of the surfaces of two rods along lines (frames, points, 3).

    Rods that pass into each other have negative distances. Rods with separate bounding boxes have those of the boxes.
    """
    between = np.maximum(one.min(axis=1) - other.max(axis=1), other.min(axis=1) - one.max(axis=1))
    gaps = np.linalg.norm(np.maximum(0, between), axis=-1) - first.radius - second.radius
    for k in np.flatnonzero(gaps < 0).tolist():
        tree = cKDTree(_points(one[k], first)[0])
        gaps[k] = tree.query(_points(other[k], second)[0])[0].min() - first.radius - second.radius
    return np.asarray(gaps)


def _travel(line: np.ndarray) -> np.ndarray:
    """Return the largest displacement of a line (frames, points, 3) from frame to frame, (frames - 1,) in m."""
    return np.asarray(np.linalg.norm(np.diff(line, axis=0), axis=-1).max(axis=1))


def _within_reach(gaps: np.ndarray, travels: np.ndarray) -> np.ndarray:
    """Return whether a gap in a frame or the next one is below the displacement of both rods, (frames - 1,)."""
    return np.asarray(np.minimum(gaps[:-1], gaps[1:]) < travels)


def _between(first: Rod, second: Rod, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the vector (3,) between the points of two lines (points, 3) that are closest, in m."""
    points, others = _points(one, first)[0], _points(other, second)[0]
    at, there = _closest(points, others)
    return np.asarray(points[at] - others[there])


def _closest(points: np.ndarray, others: np.ndarray) -> tuple[int, int]:
    """Return the numbers of the point (n, 3) and of the other one (m, 3) that are closest to each other."""
    distance, nearest = cKDTree(others).query(points)
    at = int(np.argmin(distance))
    return at, int(nearest[at])


def _points(line: np.ndarray, rod: Rod) -> tuple[np.ndarray, np.ndarray]:
    """Return points on a line (points, 3), `POINT_SPACING` radii apart, and their arc-lengths, in m."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    at = np.linspace(0, along[-1], 1 + int(np.ceil(along[-1] / (POINT_SPACING * rod.radius))))
    return np.stack([np.interp(at, along, line[:, d]) for d in range(3)], axis=1), at
