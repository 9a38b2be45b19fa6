"""Loads: forces, distributed forces and moments, each a value times a signal of time."""

from typing import Annotated

from pydantic import model_validator

from .part import Part
from .signal import ONE, AnySignal
from .validation import Flag, Name, Reference, Vector, place_on, show, xyz


class Load(Part):
    """Base of the loads: ``value`` (3,) times the signal ``scale``.

    scale: factor over time, a signal
    """

    group = "loads"
    name: Name | None = None
    scale: AnySignal = ONE


class Force(Load):
    """A force at a point of a cable, of a rope or of a body.

    On a rope it acts on a material point in a span, see `Rope`.

    on: the cable, the rope or the body
    value: components of the force, N
    s: of a cable, a rope or a modal beam, the arc-length, m
    at: of a body, the point in body axes, m; by default its origin (a modal body's first node)
    follower: whether the components are along local axes, of a cable (tangent, height, width), of a body its own, of a
        modal body those of the section there; else along the ground's
    """

    kind = "force"
    positional = ("on",)
    on: Reference
    s: Annotated[float, place_on("on")] | None = None
    at: Annotated[Vector, xyz("m", of="on")] | None = None
    value: Annotated[Vector, xyz("N", of="along")]
    follower: Flag = False

    @property
    def along(self) -> str | None:
        """Return the part in whose axes its components are, None for the ground."""
        return self.on if self.follower else None


class DistributedForce(Load):
    """A force along a cable or the spans of a rope, by the undeformed length.

    On a rope it moves with the material. Nothing acts on what lies on sheaves and drums.

    cable: the cable or the rope
    value: components of the force, N/m
    start, stop: arc-lengths between which it acts, m; by default all of it
    follower: as of a `Force`
    """

    kind = "distributed_force"
    positional = ("cable",)
    cable: Reference
    value: Annotated[Vector, xyz("N/m", of="along")]
    start: Annotated[float, place_on("cable")] | None = None
    stop: Annotated[float, place_on("cable")] | None = None
    follower: Flag = False

    @property
    def along(self) -> str | None:
        """Return the cable in whose axes its components are, None for the ground."""
        return self.cable if self.follower else None

    @model_validator(mode="after")
    def _has_a_length(self) -> "DistributedForce":
        if self.start is not None and self.stop is not None and not self.start < self.stop:
            raise ValueError(f"stop must be beyond start {show(self.start, 'm')}, got {show(self.stop, 'm')}")
        return self


class Moment(Load):
    """A moment on a section of a cable or on a body.

    on: the cable or the body
    value: components along the ground's axes, N m
    s: of a cable or a modal beam, the arc-length, m; by default its start
    """

    kind = "moment"
    positional = ("on",)
    on: Reference
    s: Annotated[float, place_on("on")] | None = None
    value: Annotated[Vector, xyz("N m")]
