"""Slides: joints between a cable or a rope and a point on its centreline."""

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from pydantic import Field, model_validator

from ..engine import OUTPUTS
from .attachment import Attachment
from .end_stops import CableEnd, Stop
from .friction import AnyFriction
from .part import Part
from .quantity import Quantity, of_engine, of_time
from .schemas import GivenAs, attachment_schema
from .signal import AnySignal, Integral, Signal
from .validation import Name, Reference, Vector, direction, items, one_of, place_on, xyz


class Slide(Part):
    """A sliding joint: a point of a body, of another cable or of the ground rides the centreline of a cable or a rope.

    Along a rope s is stress-free and material, from the first end as drawn: a rider with constant s moves with it. The
    slide runs within one span, past ends of elements. Its ends are those of the span, at a sheave, a drum or an anchor:
    "error" ends the run with a RopeLeftError, "leave" lets the rider go, and a `HardStop` or a `Buffer` may stand at an
    anchor. Friction and ``traction`` are those on the material. The frame is "point" or "tangent". The rope is rounded
    under a rider: its path is off in proportion to the length of elements, and without friction it may rest beside the
    lowest place.

    body: the rider: a body; ("link", s), the point of another cable or rope; or a point (x, y, z) of the ground, an
        eyelet through which the cable slides
    body_s: of a cable or rope that rides, the arc-length of its point, m, which body=("link", 0.5) gives, too
    along: the cable or the rope
    s: initial arc-length, m; by default that of ``drive``, else the point of the drawn cable nearest to the rider
    at: the rider's point in body axes, m
    frame: "point": the rider rotates freely. "tangent": it keeps its initial angle to the tangent, so that the floor of
        a trolley stays along the cable. "section": it keeps its initial orientation to the section of the cable, which
        transmits torsion and needs an element with section axes
    roll: with the frame "tangent", the rotation about the tangent: "free", or "fixed" against the direction ``up``
    up: a direction fixed in the ground, by default the one against gravity, else the cable's own
    drive: s over time as a signal, m, prescribed for any force
    velocity: rate of s as a signal, m/s, in the place of ``drive``
    friction: a coefficient, or a `Friction`
    at_start, at_end: at the ends of the cable, or of the span: "error", "leave" (the cable), a `HardStop` or a `Buffer`
    """

    kind = "slide"
    group = "slides"
    positional = ("body",)
    results: ClassVar[dict[str, Quantity]] = {
        "s": of_time("m", "undeformed arc-length of the rider's place"),
        "s_rate": of_engine("slide", "s_rate", "rate of s"),
        "s_acceleration": of_engine("slide", "s_acceleration", "second rate of s"),
        "force": of_engine("slide", "force", "force on the rider"),
        "multiplier": of_engine("slide", "multiplier", "multipliers of the two constraints across the cable", "normal"),
        "traction": of_engine("slide", "traction",
                              "force on the rider along the cable; of a driven slide its drive's power over s_rate"),
        "moment": of_engine("joint", "moment",
                            "moment on the rider, of a slide that ties its axes to the cable's frame"),
        "residual": of_time(OUTPUTS["slide"]["residual"].units, "distance of the rider's point to the cable"),
    }
    body: Annotated[Reference | None, GivenAs(attachment_schema("or the point [x, y, z] of the ground"))]
    body_s: Annotated[float, place_on("body")] | None = None
    along: Reference
    s: Annotated[float, place_on("along", moves=True)] | None = None
    at: Annotated[Vector, xyz("m", of="body")] = (0.0, 0.0, 0.0)
    name: Name = Field(default_factory=lambda data: f"{data['body'] or 'ground'}_on_{data['along']}")
    frame: Annotated[str, one_of(("point", "tangent", "section"))] = "point"
    roll: Annotated[str, one_of(("free", "fixed"))] = "free"
    up: Annotated[Vector | None, direction(lies=False)] = None
    drive: AnySignal | None = None
    velocity: AnySignal | None = None
    friction: AnyFriction | None = None
    at_start: CableEnd = "error"
    at_end: CableEnd = "error"

    @model_validator(mode="before")
    @classmethod
    def _splits_what_rides(cls, data: Any) -> Any:
        if not isinstance(data, dict) or "body" not in data:
            return data
        body = data["body"]
        if (given := items(body, 2, 2)) is not None:
            return data | {"body": given[0], "body_s": given[1]}
        if items(body, 3, 3) is not None:
            if any(data.get("at") or ()):
                raise ValueError("body is a point of the ground and takes no at", "leave at out")
            return data | {"body": None, "at": body}
        if body is None:
            raise ValueError("body is missing", "give a body, (cable, s), or a point (x, y, z) of the ground")
        return data

    @model_validator(mode="after")
    def _is_of_one_mind(self) -> "Slide":
        if self.body_s is not None and any(self.at):
            raise ValueError("at is a point in body axes, but body_s one on a cable", "give one of the two")
        if self.roll == "fixed" and self.frame != "tangent":
            raise ValueError(f'roll "fixed" is for frame "tangent", got frame "{self.frame}"',
                             "section axes fix the roll already" if self.frame == "section" else
                             'leave it out, or take frame="tangent"')
        if self.up is not None and self.roll != "fixed":
            raise ValueError("up is given, but roll is free", 'leave it out, or take roll="fixed"')
        if self.drive is not None and self.velocity is not None:
            raise ValueError("drive and velocity are given", "give one of the two")
        for name in ("at_start", "at_end"):
            if self.is_driven and isinstance(getattr(self, name), Stop):
                raise ValueError(f"is driven, and a stop {name} would act against that", "leave one of them out")
        return self

    def entries(self) -> dict[str, Any]:
        """Return its entries; the body of an eyelet is its point."""
        entries = super().entries()
        return entries if self.body is not None else {"body": self.at} | {k: v for k, v in entries.items() if k != "at"}

    def entries_with(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """Return the entries with changes; another rider has its own point."""
        other = changes.get("body")
        point = ("at", "body_s") if other is not None and other != self.entries()["body"] else ()
        return super().entries_with(dict.fromkeys(point) | {**changes})

    @property
    def rider(self) -> Attachment:
        """Return the attachment that rides."""
        if self.body_s is None:  # both of checked entries, in a third of the time of another check
            return Attachment.model_construct(on=self.body, at=self.at)
        return Attachment.model_construct(on=self.body, s=self.body_s)

    @property
    def arc_length(self) -> float:
        """Return s in m, of a complete slide."""
        assert self.s is not None, f"{self.where} is not complete"
        return self.s

    @property
    def is_driven(self) -> bool:
        """Return whether s follows a signal."""
        return self.drive is not None or self.velocity is not None

    @property
    def prescribed(self) -> Signal | None:
        """Return the driven s over time in m, else None."""
        return self.drive if self.velocity is None else Integral(rate=self.velocity, start=self.arc_length)
