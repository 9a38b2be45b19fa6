"""Where the lines of a crossing are closest as drawn, and which side of the other each is on."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..base.rotations import rotate
from .attachment import Attachment
from .cable import Cable
from .crossing import Crossing, radius_of
from .locations import point_of
from .scene_data import SceneData

SAMPLES = 4
"""Of an element, between which the closest points are looked for."""

ITERATIONS = 50
"""Of Gauss and Newton's method to the closest points."""


@dataclass
class Start:
    """Closest points as drawn: arc-lengths s (2,) in m, the way d (3,) from b to a in m, slopes (2, 3) of both lines,
    the unit normal (3,) across both lines, of no particular sign, and the sine of the angle between the lines, 1 in
    the plane. In the plane the second slope is the normal of the plane.
    """

    s: np.ndarray
    d: np.ndarray
    slopes: np.ndarray
    normal: np.ndarray
    sine: float


class _Bar:
    """A bar through a point of a body or the ground; square to the plane where it has no axis."""

    def __init__(self, scene: SceneData, part: Crossing):
        self.middle = point_of(scene, Attachment(on=part.b, at=part.at))
        axis = np.zeros(3)
        if part.axis is not None:
            axis = np.array(part.axis) / np.linalg.norm(part.axis)
            axis = axis if part.b is None else rotate(scene.bodies[part.b].orientation, axis)
        self.axis, self.length = axis, 2 * (part.length or 0.0)

    def samples(self) -> np.ndarray:
        """Return arc-lengths from the middle, m."""
        return np.linspace(-self.length / 2, self.length / 2, 9 if self.length else 1)

    def point(self, s: float) -> np.ndarray:
        """Return (3,): a point, m."""
        return self.middle + s * self.axis

    def points_at(self, s: np.ndarray) -> np.ndarray:
        """Return (n, 3): points, m."""
        return self.middle + s[:, None] * self.axis

    def slope(self, s: float) -> np.ndarray:
        """Return (3,): the direction, zero in the plane."""
        return self.axis


class _Line:
    """A cable as drawn."""

    def __init__(self, cable: Cable):
        self.cable, self.length = cable, cable.length
        self.point, self.points_at, self.slope = cable.point, cable.points_at, cable.slope

    def samples(self) -> np.ndarray:
        """Return arc-lengths of nodes and points between them, m; evenly apart where it has no elements yet."""
        return self.cable.samples(SAMPLES)


def start_of(scene: SceneData, part: Crossing) -> Start:
    """Return the closest points of a crossing that is complete. Both may be beyond ends, on straight continuations."""
    cable = scene.cables[part.a]
    a = _Line(cable)
    b = _Line(scene.cables[part.b]) if part.b in scene.cables else _Bar(scene, part)
    samples = a.samples(), b.samples()
    ends = [np.array([each[end] for each in samples]) for end in (0, -1)]
    s = _nearest(a, b, *samples)
    for _ in range(ITERATIONS):
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


def _nearest(a: _Line, b: _Line | _Bar, of_a: np.ndarray, of_b: np.ndarray) -> np.ndarray:
    """Return (2,): those of the arc-lengths of samples, m, whose points are the two closest."""
    first, second = a.points_at(of_a), b.points_at(of_b)
    apart = [float(np.min(np.sum((second - point) ** 2, axis=1))) for point in first]
    k = int(np.argmin(apart))
    return np.array([of_a[k], of_b[int(np.argmin(np.sum((second - first[k]) ** 2, axis=1)))]])


def radii(scene: SceneData, part: Crossing) -> float:
    """Return the distance of the axes of both lines at which they touch, m. Raises ValueError."""
    if part.radius is not None:
        return part.radius
    return sum(radius_of(scene.cables[name]) for name in (part.a, part.b) if name in scene.cables)


def sign_of(part: Crossing, normal: np.ndarray, d: np.ndarray) -> float:
    """Return the sign with which a normal leads from b to a: by the side that is given, or by the way d as drawn."""
    return math.copysign(1.0, float(np.dot(d if part.side is None else part.side, normal)))
