"""Tows: wheels on circular rails, drawn by springs to points that move."""

from __future__ import annotations

from typing import Annotated, ClassVar

from .attachment import AnyAttachment
from .part import Part
from .quantity import Quantity, all_of_engine
from .validation import Name, Vector, positive, xyz


class Tow(Part):
    """A wheel at a point of a cable on a circular rail, drawn by a spring of no length to a point that moves.

    The spring breaks at a force.

    a: wheel on a cable
    start: place of the moving point at the start, m
    velocity: of the moving point, m/s
    centre: of the rail, m
    radius: of the rail, m
    stiffness: of the spring, N/m
    strength: force at which the spring breaks, N
    """

    kind: ClassVar[str] = "tow"
    group: ClassVar[str] = "tows"
    positional: ClassVar[tuple[str, ...]] = ("a",)
    results: ClassVar[dict[str, Quantity]] = all_of_engine(
        "tow", force="force on the wheel", reaction="its part of the rail",
        position="place of the moving point", stretch="distance of both")
    name: Name | None = None
    a: AnyAttachment
    start: Annotated[Vector, xyz("m")]
    velocity: Annotated[Vector, xyz("m/s")]
    centre: Annotated[Vector, xyz("m")]
    radius: Annotated[float, positive("m")]
    stiffness: Annotated[float, positive("N/m")]
    strength: Annotated[float, positive("N")]
