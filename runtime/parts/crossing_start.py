"""Closest points of the lines of a crossing as drawn, and the side of each line."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ..base.deferred import dataclass
from ..base.rotations import rotate
from .attachment import Attachment
from .cable import Cable
from .crossing import Crossing, radius_of
from .locations import point_of
from .scene_data import SceneData

SAMPLES = 4
"""Of an element, from which the search for the closest points starts."""
BAR_SAMPLES = 9
MAX_ITERATIONS = 50
"""Of the Gauss-Newton method for the closest points."""


@dataclass
class Start:
    """Closest points as drawn: arc-lengths s (2,) in m, vector d (3,) from b to a in m, slopes (2, 3) of both lines,
    unit normal (3,) across both lines, of either sign, and sine of the angle between them.

    In a plane the second slope is the normal of the plane, and the sine is 1.
    """

    s: np.ndarray
    d: np.ndarray
    slopes: np.ndarray
    normal: np.ndarray
    sine: float


@dataclass
class _Line:
    """A cable or bar: arc-lengths of samples in m, its point (3,), points (n, 3) and slope (3,) by arc-length."""

    samples: np.ndarray
    length: float
    point: Callable[[float], np.ndarray]
    points_at: Callable[[np.ndarray], np.ndarray]
    slope: Callable[[float], np.ndarray]


def _cable(cable: Cable) -> _Line:
    """Return the line of a cable as drawn."""
    return _Line(cable.samples(SAMPLES), cable.length, cable.point, cable.points_at, cable.slope)


def _bar(scene: SceneData, part: Crossing) -> _Line:
    """Return the line of a bar on a body or the ground, by arc-length from its middle; a point where it has no axis."""
    middle, axis, half = point_of(scene, Attachment(on=part.b, at=part.at)), np.zeros(3), part.length or 0.0
    if part.axis is not None:
        axis = np.array(part.axis) / np.linalg.norm(part.axis)
        axis = axis if part.b is None else rotate(scene.bodies[part.b].orientation, axis)
    return _Line(np.linspace(-half, half, BAR_SAMPLES if half else 1), 2 * half, lambda s: middle + s * axis,
                 lambda s: middle + s[:, None] * axis, lambda s: axis)


def start_of(scene: SceneData, part: Crossing) -> Start:
    """Return the closest points of a complete crossing, also beyond ends, on straight continuations."""
    cable = scene.cables[part.a]
    a, b = _cable(cable), _cable(scene.cables[part.b]) if part.b in scene.cables else _bar(scene, part)
    ends = [np.array([line.samples[end] for line in (a, b)]) for end in (0, -1)]
    s = _nearest(a, b)
    for _ in range(MAX_ITERATIONS):
        d = a.point(s[0]) - b.point(s[1])
        slopes = np.array([a.slope(s[0]), -b.slope(s[1])])
        step = np.linalg.lstsq(slopes.T, -d, rcond=1e-12)[0]
        limit = np.array([a.length, b.length or 1.0]) / 8
        step *= min(1.0, float(np.min(limit / np.maximum(np.abs(step), 1e-300))))
        s = np.clip(s + step, *ends)
        if np.all(np.abs(step) <= 1e-12 * limit):
            break
    d, t = a.point(s[0]) - b.point(s[1]), a.slope(s[0])
    other = cable.normal if cable.dim == 2 else b.slope(s[1])
    normal = np.cross(t, other)
    sizes = float(np.linalg.norm(t) * np.linalg.norm(other))
    sine = float(np.linalg.norm(normal)) / sizes
    return Start(s, d, np.array([t, other]), normal / sizes / sine if sine else normal, sine)


def _nearest(a: _Line, b: _Line) -> np.ndarray:
    """Return (2,): the arc-lengths of the two closest samples, m."""
    first, second = a.points_at(a.samples), b.points_at(b.samples)
    apart = [float(np.min(np.sum((second - point) ** 2, axis=1))) for point in first]
    k = int(np.argmin(apart))
    return np.array([a.samples[k], b.samples[int(np.argmin(np.sum((second - first[k]) ** 2, axis=1)))]])


def radii(scene: SceneData, part: Crossing) -> float:
    """Return the distance of the axes of lines in contact, m. Raises ValueError."""
    if part.radius is not None:
        return part.radius
    return sum(radius_of(scene.cables[name]) for name in (part.a, part.b) if name in scene.cables)


def sign_of(part: Crossing, normal: np.ndarray, d: np.ndarray) -> float:
    """Return the sign of a normal from b to a, by the given side or by the vector d (3,) as drawn."""
    return math.copysign(1.0, float(np.dot(d if part.side is None else part.side, normal)))
