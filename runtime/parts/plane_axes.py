"""How results lie in the axes of a scene's plane, and in the ground's: what turns them there and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..rotations import conjugate, product, quaternion, rotate
from .plane import Plane, flattened

POINTS = ("position", "nodes")
DIRECTIONS = ("nodal_vectors", "nodal_velocity", "velocity", "acceleration", "displacement", "force", "friction_force",
              "moment")
IN_BODY_AXES = ("angular_velocity", "angular_acceleration", "rotation")
"""Quantities of results by how they turn; all others, but for orientations, are the same in all axes."""


@dataclass(frozen=True, eq=False)
class PlaneAxes:
    """A scene of planar elements in the axes of its plane, where that is z = 0: what the engine takes.

    The axes of a rigid body are turned, too: in the plane's axes it starts unturned.

    plane: that it lies in; bodies: of each rigid body the unit quaternion (4,) that takes its axes in the plane to its
    own; size: of the scene, in m.
    """

    plane: Plane
    bodies: Mapping[str, np.ndarray]
    size: float

    @property
    def attitude(self) -> np.ndarray:
        """Return the unit quaternion (4,) that takes the plane's axes to the ground's."""
        return quaternion(self.plane.axes)

    def out(self, part: str, quantity: str, values: np.ndarray, moves: bool = False) -> np.ndarray:
        """Return a result of a part, (..., 3) or (..., 4), along the ground's axes; moves: it is a displacement.

        Nodal vectors are (..., vectors, 3), of which the first one is a point.
        """
        if quantity == "orientation":
            back = conjugate(self.bodies.get(part, UNTURNED))
            return product(product(self.attitude, values), back)
        if quantity in IN_BODY_AXES:
            return rotate(self.bodies[part], values) if part in self.bodies else values
        if quantity in POINTS and not moves:
            return self.plane.points_out(values)
        if quantity not in (*POINTS, *DIRECTIONS):
            return values
        made = self.plane.out(values)
        if quantity == "nodal_vectors" and not moves:
            made[..., 0, :] += self.plane.origin
        return made

    def into(self, part: str, quantity: str, values: np.ndarray) -> np.ndarray:
        """Return a result of a part along the plane's axes: `out` undone, without what rounding leaves across it."""
        if quantity == "orientation":
            turned = product(product(conjugate(self.attitude), values), self.bodies.get(part, UNTURNED))
            return np.where(np.abs(turned) <= ROUNDED, 0.0, turned)
        if quantity in IN_BODY_AXES:
            turned = rotate(conjugate(self.bodies[part]), values) if part in self.bodies else np.asarray(values)
            return np.where(np.abs(turned) <= ROUNDED * np.abs(turned).max(initial=0.0), 0.0, turned)
        if quantity in POINTS:
            return flattened(self.plane.points_into(values), self.size)
        if quantity not in DIRECTIONS:
            return values
        values = np.array(values)
        if quantity == "nodal_vectors":
            values[..., 0, :] -= self.plane.origin
        return flattened(self.plane.into(values), self.size if quantity == "nodal_vectors" else 0.0)


UNTURNED = np.array([1.0, 0.0, 0.0, 0.0])

ROUNDED = 1e-12
"""Of its size: what rounding may leave of a component that is zero."""
