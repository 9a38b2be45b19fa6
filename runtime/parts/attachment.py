"""Attachments: what springs, joints and flexible riders are attached to."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

import numpy as np

from .part import Part
from .schemas import attachment_schema, checked
from .validation import NAMES_A_PART, Vector, number, place_on, show, shown, vector3, xyz


class Attachment(Part):
    """A place: ``s`` (m) of the cable ``on``, or the point ``at`` (m) of the body ``on``, or of the ground (on None).

    What it is on is found out when its part is added to a scene; until then a name alone has neither s nor at.
    """

    on: Annotated[str, NAMES_A_PART] | None = None
    s: Annotated[float, place_on("on")] | None = None
    at: Annotated[Vector, xyz("m", of="on")] | None = None

    @property
    def arc_length(self) -> float:
        """Return s in m, of a complete attachment to a cable."""
        assert self.s is not None, f"{self!r} is not complete"
        return self.s

    @property
    def point(self) -> Vector:
        """Return the point in m, of a complete attachment to a body or to the ground."""
        assert self.at is not None, f"{self!r} is not complete"
        return self.at

    def as_given(self) -> Any:
        """Return it as a scene file has it: [x, y, z], "A", ["A", [x, y, z]] or ["wire", s]."""
        place = self.s if self.s is not None else self.at
        return place if self.on is None else self.on if place is None else [self.on, place]

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        if self.at is not None and self.at[2]:
            yield show(self.at, "m")


def _attachment(value: Any) -> Attachment:
    if isinstance(value, Attachment):
        return value
    value = value.tolist() if hasattr(value, "tolist") else value
    on = getattr(value, "name", value)
    if isinstance(on, str):
        return Attachment(on=on)
    remedy = 'give a point (x, y, z), a body, ("body", (x, y, z)) or ("cable", s)'
    if not isinstance(value, list | tuple) or len(value) not in (2, 3):
        raise ValueError(f"must be an end, got {shown(value)}", remedy)
    if len(value) == 3:
        return Attachment(at=vector3(value, "m"))
    on, place = getattr(value[0], "name", value[0]), value[1]
    if not isinstance(on, str):
        raise ValueError(f"must be an end, got {shown(value)}", remedy)
    if isinstance(place, list | tuple) or (isinstance(place, np.ndarray) and place.ndim):
        return Attachment(on=on, at=vector3(place, "m"))
    return Attachment(on=on, s=number(place, "m"))


AnyAttachment = Annotated[Attachment, checked(_attachment, attachment_schema('["A", [x, y, z]] or [x, y, z]'))]
"""An attachment, or what `Attachment.as_given` gives, with a part of the scene for its name where that is at hand."""
