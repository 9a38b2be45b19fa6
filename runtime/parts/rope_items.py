"""The items of a rope's route: anchors and drums, where it ends, and sheaves, which it runs over."""

from collections.abc import Iterator
from numbers import Integral as WholeNumber
from typing import Annotated, Any, Self

from pydantic import model_validator

from .attachment import AnyAttachment, Attachment
from .friction import AnyFriction, Friction
from .part import Family, Part
from .quantity import all_of_engine
from .schemas import AXIS, checked
from .signal import AnySignal, Integral, Signal
from .validation import (
    NAMES_A_PART,
    Flag,
    Name,
    Vector,
    direction,
    not_negative,
    one_of,
    place_on,
    positive,
    show,
    shown,
    xyz,
)

MAX_TURNS = 1000
MAX_ZONES = 16
"""Zones of a wrap for which the engine has room."""
MAX_FLEET_ANGLE = 0.07
"""Fleet angle in rad, 4 degrees, that rules for cranes allow."""
GROOVE_WIDTH = 0.2
"""Width of a groove over the radius: twice the diameter of a rope that runs on a sheave of 20 of these."""
MAX_FALLS = 100
"""Falls of a tackle, at most."""
AT_END = ("error", "stop", "leave")
"""What a drum does that has run empty."""
SIDES = {"left": 1, "right": -1}
"""The senses in which the rope runs around a sheave on a side of it: 1 counter-clockwise."""


class RouteItem(Part):
    """Base of the items of a route."""

    tag = "kind"

    @property
    def end(self) -> Attachment:
        """Return the point that holds it; of a sheave its centre."""
        raise NotImplementedError

    def held_at(self, end: Attachment) -> "RouteItem":
        """Return the item at a complete attachment."""
        raise NotImplementedError

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        yield from self.end.off_plane()


def _body(value: Any) -> str | None:
    name = getattr(value, "name", value)
    if name is not None and not isinstance(name, str):
        raise ValueError(f"must be a body, a cable or the name of one, got {shown(value)}",
                         "give a point of the ground as at=(x, y, z)")
    return name


class Anchor(RouteItem):
    """An end of a rope, held at a point of a body, of a cable or of the ground; the direction of the rope is free.

    on: the body or the cable; by default the ground
    at: point in the body's axes, by default its origin, or of the ground, m
    s: arc-length of the cable, m
    """

    kind = "anchor"
    positional = ("on", "at")
    on: Annotated[str | None, checked(_body, {"type": "string"}), NAMES_A_PART] = None
    at: Annotated[Vector, xyz("m", of="on")] | None = None
    s: Annotated[float, place_on("on")] | None = None

    @model_validator(mode="after")
    def _is_somewhere(self) -> "Anchor":
        if self.on is None and self.at is None:
            raise ValueError("has neither on nor at", "name a body, or give a point at=(x, y, z) of the ground")
        if self.on is None and self.s is not None:
            raise ValueError("has s, but not the cable on which it is", "give on, the name of the cable")
        return self

    @property
    def end(self) -> Attachment:
        """Return the point that holds it."""
        return Attachment.model_construct(on=self.on, at=self.at, s=self.s)

    def held_at(self, end: Attachment) -> "Anchor":
        """Return the anchor at a complete attachment."""
        return self.model_copy(update={"at": end.at, "s": end.s})


def _whole_number_between(least: int, most: int) -> Any:
    """Return the check of a whole number from least to most."""
    def check(value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, WholeNumber) or not least <= int(value) <= most:
            raise ValueError(f"must be a whole number from {least} to {most}, got {shown(value)}")
        return int(value)

    return checked(check, {"type": "integer", "minimum": least, "maximum": most})


class Wheel(RouteItem):
    """Base of the items that a rope runs on: at, radius, side, inertia, torque, angle, velocity, damping, axis and
    max_fleet_angle.
    """

    positional = ("name", "at")
    name: Name
    at: AnyAttachment
    radius: Annotated[float, positive("m")]
    side: Annotated[str | None, one_of(SIDES, optional=True)] = None
    inertia: Annotated[float, not_negative("kg m²")] = 0.0
    torque: AnySignal | None = None
    angle: AnySignal | None = None
    velocity: AnySignal | None = None
    damping: Annotated[float, not_negative("N m s")] = 0.0
    axis: Annotated[Vector, direction(turns=AXIS)] = (0.0, 0.0, 1.0)
    max_fleet_angle: Annotated[float, positive("rad")] = MAX_FLEET_ANGLE

    @property
    def turns_round(self) -> bool:
        """Return whether it rotates."""
        return self.inertia > 0 or self.prescribed is not None

    @property
    def turns_freely(self) -> bool:
        """Return whether its inertia and the moments on it decide on its rotation."""
        return self.turns_round and self.prescribed is None

    @property
    def prescribed(self) -> Signal | None:
        """Return its prescribed angle over time, rad; None where it turns freely."""
        return self.angle if self.velocity is None else Integral(rate=self.velocity)

    @property
    def end(self) -> Attachment:
        """Return the point that holds its centre."""
        return self.at

    def held_at(self, end: Attachment) -> Self:
        """Return it at a complete attachment."""
        return self.model_copy(update={"at": end})

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        yield from super().off_plane()
        if any(self.axis[:2]) or self.axis[2] < 0:
            yield f"axis {show(self.axis)}"

    @model_validator(mode="after")
    def _is_driven_once(self) -> Self:
        drives = [name for name in ("torque", "angle", "velocity") if getattr(self, name) is not None]
        if len(drives) > 1:
            raise ValueError(f"has two drives, {drives[0]} and {drives[1]}", "give one of them")
        if (drives or self.damping) and not self.turns_round:
            raise ValueError(f"has {drives[0] if drives else 'damping'}, but no inertia", "give its inertia in kg m²")
        return self


class Sheave(Wheel):
    """A sheave that a rope runs over, with friction or without.

    at: its centre, a point of the ground, a body, a point in the axes of a body, or ("cable", s). In space the groove
        turns with the cable; on one without sections its axis stays across the tangent
    radius: from its centre to the axis of the rope, that of the groove plus that of the rope, m
    side: "left" or "right": where it lies, looking along the route with the axis up. A rope with the sheave on its
        left runs counter-clockwise around it. By default the side to which the line through the centres of the route
        turns here
    inertia: about its axis, kg m²; it rotates where this is above 0 or its motion is prescribed, else it is held
    torque: of a motor or a brake between it and what holds it, over time, N m; it turns about its axis,
        counter-clockwise
    angle, velocity: of its rotation over time, prescribed, rad or rad/s, relative to the body that it is on
    damping: of its bearing, N m s
    axis: its direction as drawn, of a rope in space, which turns with the body or cable that it is on; by default z
    friction: between rope and groove, a coefficient or a `Friction`, by default "regularised"; without it none
    zones: number of parts of the wrap between which friction acts, and over each of which the tension is constant
    turns: whole turns of the rope around it, in addition to the wrap angle between both spans
    contact: whether the rope lies on it at the start. It may leave the sheave and touch it again; the sheave then turns
        on
    max_fleet_angle: between the plane of the groove and the rope as drawn, in space, rad; a larger one is reported. A
        rope that leaves with a larger kink along the axis ends the run with a RopeLeftError
    groove_width: between the edges of the groove, m, by default 0.2 of the radius. In space a rope that returns farther
        than half of it beside the plane of the groove ends the run with a RopeLeftError
    """

    kind = "sheave"
    results = all_of_engine(
        "sheave",
        tension_on="tension of the rope where it runs on, in the rope's order",
        tension_off="tension where it runs off",
        wrap_angle="angle of the arc on the sheave",
        force="force of the rope on what holds the sheave",
        material_speed="stress-free length that passes in the rope's order, a second",
        slip="largest speed of the rope on the sheave, in the rope's order",
        slip_angle="part of the wrap angle over which the rope slides, with friction at its limit",
        normal_force="least normal force of the groove on an angle of the wrap",
        torque="of the rope on the sheave, by friction",
        angle="by which the sheave has turned, relative to the body that it is on",
        residual="largest distance of the rope from its tangent points",
        fleet_angle_on="from the plane of the groove to the rope where it runs on, towards its axis",
        fleet_angle_off="from the plane of the groove to the rope where it runs off, towards its axis",
        gap="of a rope that has left the sheave to the groove",
    )
    friction: AnyFriction | None = None
    zones: Annotated[int, _whole_number_between(1, MAX_ZONES)] = 8
    turns: Annotated[int, _whole_number_between(0, MAX_TURNS)] = 0
    contact: Flag = True
    groove_width: Annotated[float, positive("m")] | None = None

    @property
    def mouth(self) -> float:
        """Return half the width of its groove, m."""
        return (GROOVE_WIDTH * self.radius if self.groove_width is None else self.groove_width) / 2

    @property
    def coefficient(self) -> float:
        """Return the coefficient of friction of the rope on it."""
        return 0.0 if self.friction is None else self.friction.coefficient

    @property
    def sticks(self) -> bool:
        """Return whether its friction sticks, by its model."""
        return self.coefficient > 0 and self.friction is not None and self.friction.sticks

    @property
    def slip_velocity(self) -> float:
        """Return the speed at which friction is 0.7 of its limit, m/s."""
        return Friction().velocity if self.friction is None else self.friction.velocity

    @property
    def n_zones(self) -> int:
        """Return the number of zones of its wrap: without friction the tension is the same all over it."""
        return self.zones if self.coefficient > 0 else 1

    @property
    def has_most_zones(self) -> bool:
        """Return whether twice its zones are more than the engine has room for."""
        return 2 * self.zones > MAX_ZONES

    @model_validator(mode="after")
    def _has_modelled_friction(self) -> "Sheave":
        if self.friction is not None:
            self.friction.check_coulomb()
        drive = next((name for name in ("torque", "angle", "velocity") if getattr(self, name) is not None), None)
        if drive is not None and not self.coefficient:
            raise ValueError(f"has {drive}, but no friction with the rope, which it then never moves",
                             f"give its friction, or leave {drive} out")
        if self.inertia > 0 and not self.coefficient:
            raise ValueError("has inertia, but no friction with the rope, which then never turns it",
                             "give its friction, or leave the inertia out")
        return self

    @model_validator(mode="after")
    def _may_be_without_contact(self) -> "Sheave":
        if self.contact:
            return self
        if self.turns:
            raise ValueError("has turns and contact=False", "give one of them")
        if self.side is None:
            raise ValueError("has contact=False, but no side", 'give side="left" or "right": where it lies, looking '
                             "along the route")
        return self

    def refined(self) -> "Sheave":
        """Return the sheave with twice the zones, or with half of them where twice exceeds `MAX_ZONES`."""
        return self.model_copy(update={"zones": self.zones // 2 if self.has_most_zones else 2 * self.zones})


class Drum(Wheel):
    """A drum at an end of a rope, which winds the rope and pays it out.

    The rope sticks to the drum where it runs on, and keeps there the stretch with which it was wound. What is wound has
    the radius of the drum, turns with it, and adds to its inertia and weight.

    at: its centre, a point of the ground, a body, a point in the axes of a body, or ("cable", s)
    radius: from its centre to the axis of the rope, m
    side: "left" or "right": where it lies, looking along the route, from the first to the last item, with the axis up.
        A rope with the drum on its left runs counter-clockwise around it
    length_in_store: stress-free length of the rope that is wound at the start, m
    inertia: about its axis, without the wound rope, kg m²; a drum with neither inertia nor prescribed motion is held
    torque: of a motor or a brake between it and what holds it, over time, N m; it turns about its axis,
        counter-clockwise
    angle, velocity: of its rotation over time, prescribed, rad or rad/s, relative to the body that it is on
    damping: of its bearing, N m s
    axis: its direction as drawn, of a rope in space, which turns with the body or cable that it is on; by default z.
        There the rope lies in the plane across it through ``at``
    max_fleet_angle: between this plane and the rope as drawn, in space, rad; a larger one is reported
    at_end: where it has run empty, "error" ends the run with a RopeLeftError, "stop" as an event does, "leave" frees
        the end of the rope, not of one without mass
    """

    kind = "drum"
    results = all_of_engine(
        "drum",
        tension="tension of the rope where it leaves the drum",
        force="force of the rope on what holds the drum",
        torque="of the motor or the brake on the drum, or of what holds it",
        power="of the motor or the brake",
        length_in_store="stress-free length of the wound rope",
        material_speed="stress-free length that passes in the rope's order, a second",
        normal_force="of the drum on an angle, where the rope leaves it",
        angle="by which the drum has turned, relative to the body that it is on",
        residual="largest distance of the rope from its tangent point",
        fleet_angle="from the plane of the groove to the rope, towards its axis",
    )
    side: Annotated[str, one_of(SIDES)]
    length_in_store: Annotated[float, positive("m")]
    at_end: Annotated[str, one_of(AT_END)] = "error"


class Block(RouteItem):
    """The sheaves of a tackle: falls of rope side by side between a lower and an upper axle.

    A route has in its place the sheaves in the order in which the rope passes them, first one on the lower axle,
    "hook_1" of a block "hook", then "hook_2" on the upper one. After an even number of falls the rope leaves upwards,
    after an odd one downwards, so that its end is at the lower axle.

    at: lower axle, a body, or a point in the axes of a body
    upper: upper axle, a point of the ground, a body, or a point in the axes of a body
    falls: number of parts of the rope that hold the lower axle; there is one sheave less
    radius, side, inertia, friction, zones, axis, max_fleet_angle: of each sheave, see `Sheave`
    """

    kind = "block"
    positional = ("name",)
    name: Name
    at: AnyAttachment
    upper: AnyAttachment
    falls: Annotated[int, _whole_number_between(2, MAX_FALLS)]
    radius: Annotated[float, positive("m")]
    side: Annotated[str, one_of(SIDES)] = "left"
    inertia: Annotated[float, not_negative("kg m²")] = 0.0
    friction: AnyFriction | None = None
    zones: Annotated[int, _whole_number_between(1, MAX_ZONES)] = 8
    axis: Annotated[Vector, direction(turns=AXIS)] = (0.0, 0.0, 1.0)
    max_fleet_angle: Annotated[float, positive("rad")] = MAX_FLEET_ANGLE

    @property
    def end(self) -> Attachment:
        """Return its lower axle."""
        return self.at

    @property
    def sheaves(self) -> tuple[Sheave, ...]:
        """Return its sheaves in the rope's order."""
        shared = {name: getattr(self, name) for name in (
            "radius", "side", "inertia", "friction", "zones", "axis", "max_fleet_angle")}
        return tuple(Sheave(name=f"{self.name}_{k + 1}", at=self.upper if k % 2 else self.at, **shared)
                     for k in range(self.falls - 1))


ROUTE_ITEMS = Family("route_item", 'an item such as Anchor("A") or Sheave("top", at=(0, 9, 0), radius=0.3)',
                     (Anchor, Sheave, Drum, Block))
