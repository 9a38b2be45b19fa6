"""Forces between two points, such as springs."""

from typing import ClassVar, Self

from pydantic import model_validator

from .attachment import AnyAttachment
from .driven import Driven
from .part import Part
from .quantity import Quantity, of_engine, of_time
from .validation import Name


class PointForce(Part):
    """Base of forces along the line between the points of two attachments, a and b.

    The parameters of its law are fields of the same names. A further force is a class of this kind, a line in
    listed.py, and its law in derive/couplings/point_laws.
    """

    group = "point_forces"
    positional = ("a", "b")
    results: ClassVar[dict[str, Quantity]] = {
        "force": of_engine("point_force", "force", "force on the first end"),
        "tension": of_time("N", "force that draws the ends together"),
        "length": of_time("m", "distance of the ends"),
    }
    name: Name | None = None
    a: AnyAttachment
    b: AnyAttachment

    @property
    def law(self) -> str:
        """Return the name of its law, a file in derive/couplings/point_laws."""
        return self.kind

    @property
    def loses_direction(self) -> bool:
        """Return whether it has a force, and so no direction, where its points meet."""
        return True

    @property
    def only_pulls(self) -> bool:
        """Return whether it has tension only, as ropes and droppers."""
        return False

    def driven(self) -> dict[str, Driven]:
        """Return the quantities of its law that signals prescribe, by the name of the engine's dof for each."""
        return {}

    @property
    def largest(self) -> Self:
        """Return the part with numbers in the place of its signals, to which `driven` refers."""
        return self

    def at_distance(self, distance: float) -> Self:
        """Return the part complete; distance: initial distance of its points, m."""
        return self

    @model_validator(mode="after")
    def _acts_on_something(self) -> Self:
        if self.a.on is None and self.b.on is None:
            raise ValueError("has both ends on the ground", "put one of them on a cable or a body")
        return self
