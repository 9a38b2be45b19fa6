"""Transformation of results between the axes of the plane of a scene and those of the ground."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from functools import cached_property

import numpy as np

from ..base.deferred import dataclass
from ..base.rotations import conjugate, product, quaternion, rotate
from .kinds import TURNING
from .part import Part
from .plane import Plane, flattened
from .quantity import IN_BODY_AXES, NODAL_VECTORS, UNCHANGED
from .rigid_body import RigidBody
from .schemas import ORIENTATION, POINT

UNTURNED = np.array([1.0, 0.0, 0.0, 0.0])

ROUNDING_TOLERANCE = 1e-12
"""Rounding of a zero component over the largest one."""


@dataclass(frozen=True, eq=False)
class PlaneAxes:
    """The axes of the plane of a scene, in which the engine computes.

    A rigid body has other axes there: it starts unturned.

    plane: of the scene; bodies: those of the scene as drawn; size: of the scene, in m.
    """

    plane: Plane
    bodies: Mapping[str, Part]
    size: float
    _turns: dict[str, np.ndarray | None] = field(default_factory=dict)

    @cached_property
    def attitude(self) -> np.ndarray:
        """Return the unit quaternion (4,) from the axes of the plane to those of the ground."""
        return quaternion(self.plane.axes)

    def turn_of(self, name: str) -> np.ndarray | None:
        """Return the unit quaternion (4,) from the axes of a rigid body in the plane to its own, else None."""
        if name not in self._turns:
            body = self.bodies.get(name)
            self._turns[name] = (product(conjugate(body.orientation), self.attitude) if isinstance(body, RigidBody)
                                 else None)
        return self._turns[name]

    def out(self, part: str, quantity: str, values: np.ndarray, moves: bool = False) -> np.ndarray:
        """Return a result of a part, (..., 3) or (..., 4), along the ground's axes; moves: it is a displacement.

        Nodal vectors are (..., vectors, 3), of which the first one is a point. Raises KeyError for a quantity that is
        no result of a part, see `kinds.TURNING`.
        """
        turns, turn = TURNING[quantity], self.turn_of(part)
        if turns == UNCHANGED:
            return values
        if turns == ORIENTATION:
            return product(product(self.attitude, values), UNTURNED if turn is None else conjugate(turn))
        if turns == IN_BODY_AXES:
            return values if turn is None else rotate(turn, values)
        if turns == POINT and not moves:
            return self.plane.points_out(values)
        made = self.plane.out(values)
        if turns == NODAL_VECTORS and not moves:
            made[..., 0, :] += self.plane.origin
        return made

    def into(self, part: str, quantity: str, values: np.ndarray) -> np.ndarray:
        """Return a result of a part along the axes of the plane, the inverse of `out`, without rounding across it."""
        turns, turn = TURNING[quantity], self.turn_of(part)
        if turns == UNCHANGED:
            return values
        if turns == ORIENTATION:
            turned = product(product(conjugate(self.attitude), values), UNTURNED if turn is None else turn)
            return np.where(np.abs(turned) <= ROUNDING_TOLERANCE, 0.0, turned)
        if turns == IN_BODY_AXES:
            turned = np.asarray(values) if turn is None else rotate(conjugate(turn), values)
            return np.where(np.abs(turned) <= ROUNDING_TOLERANCE * np.abs(turned).max(initial=0.0), 0.0, turned)
        if turns == POINT:
            return flattened(self.plane.points_into(values), self.size)
        values = np.array(values)
        if turns == NODAL_VECTORS:
            values[..., 0, :] -= self.plane.origin
        return flattened(self.plane.into(values), self.size if turns == NODAL_VECTORS else 0.0)
