"""Slides: sliding joints."""

from __future__ import annotations

from typing import Annotated, ClassVar

from funicular.validation import Name, Part, Reference, Vector, finite, xyz
from pydantic import Field


class Slide(Part):
    """A body's point that rides the centreline of a cable.

    body, along: the rigid body and the cable; s: the arc-length where it starts, in m; at: the point in body
    axes, in m.
    """

    kind: ClassVar[str] = "slide"
    body: Reference
    along: Reference
    s: Annotated[float, finite("m")]
    at: Annotated[Vector, xyz("m")] = (0.0, 0.0, 0.0)
    name: Name = Field(default_factory=lambda data: f"{data['body']}_on_{data['along']}")
