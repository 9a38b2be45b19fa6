"""Springs with dampers."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from funicular.validation import Name, Part, Vector, finite, not_negative, number, vector, xyz
from pydantic import PlainValidator, model_validator


class End(Part):
    """An end of a spring: ``s`` (m) of the cable ``on``, or the point ``at`` (m) of a body, or of the ground (on None).

    What it is on is found out when the spring is added to a scene; until then a name alone has neither s nor at.
    """

    on: str | None = None
    s: Annotated[float, finite("m")] | None = None
    at: Annotated[Vector, xyz("m")] | None = None

    def data(self) -> Any:
        """As a scene file has it: [x, y, z], "A", ["A", [x, y, z]] or ["wire", s]."""
        place = self.s if self.s is not None else self.at
        return place if self.on is None else self.on if place is None else [self.on, place]


def _end(value: Any) -> End:
    if isinstance(value, End):
        return value
    value = value.tolist() if hasattr(value, "tolist") else value
    on = getattr(value, "name", value)
    if isinstance(on, str):
        return End(on=on)
    remedy = 'give a point (x, y, z), a body, ("body", (x, y, z)) or ("cable", s)'
    if not isinstance(value, list | tuple) or len(value) not in (2, 3):
        raise ValueError(f"must be an end, got {value!r}", remedy)
    if len(value) == 3:
        return End(at=vector(value, "m"))
    on, place = getattr(value[0], "name", value[0]), value[1]
    if not isinstance(on, str):
        raise ValueError(f"must be an end, got {value!r}", remedy)
    if isinstance(place, list | tuple) or (hasattr(place, "tolist") and getattr(place, "ndim", 0)):
        return End(on=on, at=vector(place, "m"))
    return End(on=on, s=number(place, "m"))


AnyEnd = Annotated[End, PlainValidator(_end)]


class Spring(Part):
    """A linear spring with a damper between two points of cables, bodies or the ground.

    a, b: its ends: ("wire", s), ("A", (x, y, z) in body axes), "A" for its centre of mass, or a point (x, y, z) of the
    ground, in m; stiffness in N/m; damping in N s/m; length: where it is free of force, in m, that at the start if
    not given.
    """

    kind: ClassVar[str] = "spring"
    name: Name | None = None
    a: AnyEnd
    b: AnyEnd
    stiffness: Annotated[float, not_negative("N/m")]
    damping: Annotated[float, not_negative("N s/m")] = 0.0
    length: Annotated[float, not_negative("m")] | None = None

    @model_validator(mode="after")
    def _acts(self) -> Spring:
        if self.a.on is None and self.b.on is None:
            raise ValueError("has both ends on the ground", "let one of them hold a cable or a body")
        if self.stiffness == 0 and self.damping == 0:
            raise ValueError("has neither stiffness nor damping", "give one of them, or both")
        return self
