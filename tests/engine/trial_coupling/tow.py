"""Tows: springs of no length to points that move."""

from __future__ import annotations

from typing import Annotated, ClassVar

from .attachment import AnyAttachment
from .part import Part
from .quantity import Quantity, all_of_engine
from .validation import Name, Vector, positive, xyz


class Tow(Part):
    """A spring of no length from a point of a cable to a point that moves; it breaks at a force.

    a: end on a cable
    start: place of the moving point at the start, m
    velocity: of the moving point, m/s
    stiffness: N/m
    strength: force at which it breaks, N
    """

    kind: ClassVar[str] = "tow"
    group: ClassVar[str] = "tows"
    positional: ClassVar[tuple[str, ...]] = ("a",)
    results: ClassVar[dict[str, Quantity]] = all_of_engine(
        "tow", force="force on the end", position="place of the moving point", stretch="distance of both")
    name: Name | None = None
    a: AnyAttachment
    start: Annotated[Vector, xyz("m")]
    velocity: Annotated[Vector, xyz("m/s")]
    stiffness: Annotated[float, positive("N/m")]
    strength: Annotated[float, positive("N")]
