"""How results lie in the axes of a scene's plane, and in the ground's: what turns them there and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..base.rotations import conjugate, product, quaternion, rotate
from .plane import Plane, flattened
from .quantity import IN_BODY_AXES, NODAL_VECTORS, ORIENTATION, POINT, UNCHANGED
from .turning import TURNING


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

        Nodal vectors are (..., vectors, 3), of which the first one is a point. Raises KeyError for a quantity that is
        none of results, see `turning`.
        """
        turns = TURNING[quantity]
        if turns == UNCHANGED:
            return values
        if turns == ORIENTATION:
            back = conjugate(self.bodies.get(part, UNTURNED))
            return product(product(self.attitude, values), back)
        if turns == IN_BODY_AXES:
            return rotate(self.bodies[part], values) if part in self.bodies else values
        if turns == POINT and not moves:
            return self.plane.points_out(values)
        made = self.plane.out(values)
        if turns == NODAL_VECTORS and not moves:
            made[..., 0, :] += self.plane.origin
        return made

    def into(self, part: str, quantity: str, values: np.ndarray) -> np.ndarray:
        """Return a result of a part along the plane's axes: `out` undone, without what rounding leaves across it."""
        turns = TURNING[quantity]
        if turns == UNCHANGED:
            return values
        if turns == ORIENTATION:
            turned = product(product(conjugate(self.attitude), values), self.bodies.get(part, UNTURNED))
            return np.where(np.abs(turned) <= ROUNDED, 0.0, turned)
        if turns == IN_BODY_AXES:
            turned = rotate(conjugate(self.bodies[part]), values) if part in self.bodies else np.asarray(values)
            return np.where(np.abs(turned) <= ROUNDED * np.abs(turned).max(initial=0.0), 0.0, turned)
        if turns == POINT:
            return flattened(self.plane.points_into(values), self.size)
        values = np.array(values)
        if turns == NODAL_VECTORS:
            values[..., 0, :] -= self.plane.origin
        return flattened(self.plane.into(values), self.size if turns == NODAL_VECTORS else 0.0)


UNTURNED = np.array([1.0, 0.0, 0.0, 0.0])

ROUNDED = 1e-12
"""Of its size: what rounding may leave of a component that is zero."""
