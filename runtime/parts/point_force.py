"""Forces between two points: what springs and the like have in common."""

from __future__ import annotations

from typing import ClassVar, Self

from pydantic import model_validator

from .attachment import AnyAttachment
from .quantity import Quantity, of_time, vector_of_time
from .validation import Name, Part


class PointForce(Part):
    """Base of forces along the gap between the points of two attachments, a and b.

    ``kind`` is also the name of the engine's type of coupling (engine/couplings/list.c), whose law takes `parameters`,
    and the role of its kernels. A further force is a class of this kind and an entry in kinds.py.
    """

    group: ClassVar[str] = "point_forces"
    positional: ClassVar[tuple[str, ...]] = ("a", "b")
    quantities: ClassVar[dict[str, Quantity]] = {
        "force": vector_of_time("N", "force on the first end"),
        "tension": of_time("N", "force with which the ends are drawn together"),
        "length": of_time("m", "distance of the ends"),
    }
    name: Name | None = None
    a: AnyAttachment
    b: AnyAttachment

    @property
    def parameters(self) -> tuple[float, ...]:
        """Parameters of the law, in the order of the engine, in SI units."""
        raise NotImplementedError

    def kernel(self, dim: int) -> str:
        """Return the name of the kernels of its law in a scene of that dimension; "" if the law is written in C."""
        return ""

    @property
    def is_damped(self) -> bool:
        """Whether the force depends on velocities."""
        return False

    def at_distance(self, distance: float) -> Self:
        """Return the part complete; distance: of its points at the start, m."""
        return self

    @model_validator(mode="after")
    def _acts_on_something(self) -> Self:
        if self.a.on is None and self.b.on is None:
            raise ValueError("has both ends on the ground", "put one of them on a cable or a body")
        return self
