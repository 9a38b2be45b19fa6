"""Degrees of freedom of quantities that a signal prescribes and that belong to no node or body.

They stand between the dofs of ropes and those of bodies. Growth factors of cables, lengths and stiffnesses of springs
change with them as positions do with those of a prescribed motion: the force on such a dof is the derivative of the
energy, and its work is that of a support. A growth factor other than 1 has one where it is constant, too.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..parts.cable import Cable
from ..parts.driven import GROWTH, Driven
from ..parts.point_force import PointForce
from ..parts.scene_data import SceneData
from .constants import series
from .model import CableModel, MotionModel
from .signals import Signals

BENDING = 1
"""Place of EI among the constants of the laws of cables."""


@dataclass(eq=False, repr=False)
class DrivenDofs:
    """The driven quantities of a scene, by part (`Part.where`) and quantity, whose dofs begin at `first`."""

    first: int
    driven: dict[tuple[str, str], Driven]

    @classmethod
    def of(cls, scene: SceneData, first: int) -> DrivenDofs:
        """Return those of a scene."""
        parts: list[Cable | PointForce] = [*scene.cables.values(), *scene.point_forces.values()]
        return cls(first, {(part.where, what): driven for part in parts for what, driven in part.driven().items()})

    def let_grow(self, cables: Iterable[CableModel], scene: SceneData) -> int:
        """Give the cables of a scene the dofs of their growth factors; return `stop`."""
        for cable, part in zip(cables, scene.cables.values(), strict=True):
            if (part.where, GROWTH) not in self.driven:
                continue
            dofs = [self.dofs[part.where, name] for name in part.names_of_growth]
            cable.growth = dofs[0]
            cable.pieces = tuple(piece._replace(growth=dof) for piece, dof in zip(cable.pieces, dofs, strict=True))
            if part.grows and part.kind_of_element.is_cable:
                cable.growth_constants = cable.A.copy()
                cable.growth_constants[:, BENDING] *= -1
            elif part.grows:
                cable.growth_series = series(part)
        return self.stop

    @property
    def dofs(self) -> dict[tuple[str, str], int]:
        """Return the dof of each."""
        return {key: self.first + k for k, key in enumerate(self.driven)}

    @property
    def stop(self) -> int:
        """Return the dof behind the last one."""
        return self.first + len(self.driven)

    def motions(self, signals: Signals) -> list[MotionModel]:
        """Return how they follow their signals, which are stored."""
        return [MotionModel(dof, signals.add(each.signal), each.base, each.linear, 0.0, 0.0)
                for dof, each in enumerate(self.driven.values(), self.first) if each.signal is not None]

    @property
    def still(self) -> np.ndarray:
        """Return (n,): zeros, for what they do not have."""
        return np.zeros(len(self.driven))

    @property
    def start(self) -> np.ndarray:
        """Return (n,): the values at t = 0."""
        return np.array([each.start for each in self.driven.values()])
