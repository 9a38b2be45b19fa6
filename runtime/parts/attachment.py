"""Attachments: points of cables, bodies and the ground."""

from collections.abc import Iterator
from typing import Annotated, Any

import numpy as np

from .part import Part
from .schemas import attachment_schema, checked
from .validation import NAMES_A_PART, Vector, items, number, place_on, show, shown, vector3, xyz


class Attachment(Part):
    """A point: ``s`` (m) of the cable or rope ``on``, or ``at`` (m) of the body ``on`` or of the ground (on None).

    Before its part is added to a scene, the name of a cable or body alone has neither s nor at.
    """

    on: Annotated[str, NAMES_A_PART] | None = None
    s: Annotated[float, place_on("on")] | None = None
    at: Annotated[Vector, xyz("m", of="on")] | None = None

    @property
    def arc_length(self) -> float:
        """Return s in m of a complete attachment to a cable."""
        assert self.s is not None, f"{self!r} is not complete"
        return self.s

    @property
    def point(self) -> Vector:
        """Return the point in m of a complete attachment to a body or to the ground."""
        assert self.at is not None, f"{self!r} is not complete"
        return self.at

    def as_given(self) -> Any:
        """Return its form in a scene file: [x, y, z], "A", ["A", [x, y, z]] or ["wire", s]."""
        place = self.s if self.s is not None else self.at
        return place if self.on is None else self.on if place is None else [self.on, place]

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        if self.at is not None and self.at[2]:
            yield show(self.at, "m")


def _attachment(value: Any) -> Attachment:
    """Return the attachment that a value describes. Raises ValueError."""
    if isinstance(value, Attachment):
        return value
    if isinstance(on := getattr(value, "name", value), str):
        return Attachment(on=on)
    if (given := items(value, 3, 3)) is not None:
        return Attachment(at=vector3(given, "m"))
    on, place = items(value, 2, 2) or (None, None)
    if not isinstance(on := getattr(on, "name", on), str):
        raise ValueError(f"must be an end, got {shown(value)}",
                         'give a point (x, y, z), a body, ("body", (x, y, z)) or ("cable", s)')
    if isinstance(place, list | tuple) or (isinstance(place, np.ndarray) and place.ndim):
        return Attachment(on=on, at=vector3(place, "m"))
    return Attachment(on=on, s=number(place, "m"))


AnyAttachment = Annotated[Attachment, checked(_attachment, attachment_schema('["A", [x, y, z]] or [x, y, z]'))]
"""An attachment, or its form of `Attachment.as_given`, with parts in place of their names."""
