"""Rigid bodies: mass, inertia, initial position and orientation."""

import math
from typing import Annotated, Any, ClassVar

import numpy as np

from ..base.rotations import rotate
from .part import Part
from .quantity import IN_BODY_AXES, Quantity, vector_of_time
from .schemas import ORIENTATION, POINT, TENSOR, Turning, checked, list_of_lists, list_schema
from .solids import AnySolid
from .validation import LENGTH_TOLERANCE, Matrix, Name, Vector, positive, show, symmetric, vector, xyz

Quaternion = tuple[float, float, float, float]


def _inertia(value: Any) -> Matrix:
    """Return a symmetric inertia from 3 principal moments or 3 rows, in kg m²."""
    return symmetric(value, "kg m²", _check_inertia)


def _check_inertia(matrix: np.ndarray) -> None:
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = matrix.tolist()
    small, middle, large = np.linalg.eigvalsh(matrix).tolist() if xy or xz or yz else sorted((xx, yy, zz))
    if not small > 0:
        raise ValueError(f"must be positive, got the principal moments {show((small, middle, large), 'kg m²')}")
    if large > (small + middle) * (1 + LENGTH_TOLERANCE):
        raise ValueError("is not that of a body: no principal moment exceeds the sum of the others, got "
                         f"{show((small, middle, large), 'kg m²')}")


def unit_quaternion(value: Any) -> Quaternion:
    """Return a quaternion of unit length to 1e-3, normalised. Raises ValueError."""
    w, x, y, z = vector(value, size=4)
    quaternion, norm = (w, x, y, z), math.hypot(w, x, y, z)
    if abs(norm - 1) > 1e-3:
        raise ValueError(f"must be a unit quaternion (w, x, y, z), got {show(quaternion)}, of length {norm:.6g}",
                         "divide it by its length")
    if abs(norm - 1) < 1e-15:  # a unit quaternion to rounding keeps its digits
        return quaternion
    return w / norm, x / norm, y / norm, z / norm


Orientation = Annotated[Quaternion, checked(unit_quaternion, list_schema("", 4, 4), Turning(ORIENTATION, "name"))]
"""The orientation of the body ``name``."""


def largest_moment(inertia: np.ndarray | Matrix) -> float:
    """Return the largest principal moment of inertia (3, 3), in kg m²."""
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = inertia
    return float(np.linalg.eigvalsh(inertia)[-1]) if xy or xz or yz else max(xx, yy, zz)


class RigidBody(Part):
    """A rigid body. Its points are given from its origin.

    mass: kg
    inertia: about the centre of mass, in body axes, 3 principal moments or 3x3, kg m²
    position: of the origin, m
    orientation: unit quaternion (w, x, y, z) from body axes to the ground's
    centre: of mass, a point in body axes, m; the origin by default
    velocity: of the origin, m/s
    angular_velocity: in body axes, rad/s
    shape: for pictures alone, a `Box`, `Sphere`, `Cylinder` or `MeshShape`; by default a box of the body's mass and
        inertia
    """

    kind = "rigid_body"
    group = "bodies"
    results: ClassVar[dict[str, Quantity]] = {
        "position": vector_of_time("m", "position of the body's origin", POINT),
        "orientation": Quantity(("time", "wxyz"), "1", "unit quaternion from body axes to the ground's",
                                ORIENTATION),
        "velocity": vector_of_time("m/s", "velocity of the body's origin"),
        "angular_velocity": vector_of_time("rad/s", "angular velocity in body axes", IN_BODY_AXES),
        "acceleration": vector_of_time("m/s2", "acceleration of the body's origin"),
        "angular_acceleration": vector_of_time("rad/s2", "angular acceleration in body axes", IN_BODY_AXES),
    }
    name: Name
    mass: Annotated[float, positive("kg")]
    inertia: Annotated[Matrix, checked(_inertia, {"anyOf": [list_schema("kg m²"), list_of_lists("kg m²")]},
                                        Turning(TENSOR, "name"))]
    position: Annotated[Vector, xyz("m")]
    orientation: Orientation = (1.0, 0.0, 0.0, 0.0)
    centre: Annotated[Vector, xyz("m", of="name")] = (0.0, 0.0, 0.0)
    velocity: Annotated[Vector, xyz("m/s")] = (0.0, 0.0, 0.0)
    angular_velocity: Annotated[Vector, xyz("rad/s", of="name")] = (0.0, 0.0, 0.0)
    shape: AnySolid | None = None

    @property
    def frame(self) -> tuple[np.ndarray, np.ndarray]:
        """Return its initial position (3,) in m and orientation (4,), a unit quaternion."""
        return np.array(self.position), np.array(self.orientation)

    @property
    def axes(self) -> np.ndarray:
        """Return (3, 3): its axes at the start, as columns."""
        return rotate(self.orientation, np.eye(3)).T

    def arm(self, at: Vector) -> tuple[float, float, float]:
        """Return the point ``at`` from the centre of mass, in body axes, in m."""
        (x, y, z), (x0, y0, z0) = at, self.centre
        return x - x0, y - y0, z - z0

    def point(self, at: Vector) -> np.ndarray:
        """Return (3,): the initial position of the point ``at`` (m, body axes), in m."""
        return np.array(self.position) + rotate(self.orientation, at)
