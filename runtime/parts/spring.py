"""Springs with dampers between two attachments."""

from __future__ import annotations

from typing import Annotated, ClassVar, Self

from pydantic import model_validator

from .point_force import PointForce
from .validation import not_negative


class Spring(PointForce):
    """A linear spring with a damper between two points of cables, bodies or the ground.

    a, b: its ends: ("wire", s), ("A", (x, y, z) in body axes), "A" for its origin, or a point (x, y, z) of the
    ground, in m; stiffness in N/m; damping in N s/m; length: where it is free of force, in m, that at the start if
    not given.
    """

    kind: ClassVar[str] = "spring"
    stiffness: Annotated[float, not_negative("N/m")]
    damping: Annotated[float, not_negative("N s/m")] = 0.0
    length: Annotated[float, not_negative("m")] | None = None

    @property
    def law(self) -> str:
        """Return the name of its law, that of a file in derive/couplings/point_laws."""
        return "spring" if self.length else "zero_length_spring"

    @property
    def loses_direction(self) -> bool:
        """Return whether its force has no direction where its points meet: not if it is free of force there."""
        return self.length != 0.0

    def at_distance(self, distance: float) -> Self:
        """Return the spring with its length, the distance of its points at the start if not given."""
        return self.completed({"length": distance}) if self.length is None else self

    @model_validator(mode="after")
    def _has_a_law(self) -> Self:
        if self.stiffness == 0 and self.damping == 0:
            raise ValueError("has neither stiffness nor damping", "give one of them, or both")
        return self
