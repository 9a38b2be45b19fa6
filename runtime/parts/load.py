"""Loads: forces, distributed forces and moments, each a value times a signal of time."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Self

import numpy as np
from pydantic import model_validator

from .part import Part
from .schemas import Check, Place, checked, number_schema
from .signal import ONE, SIGNALS, AnySignal, Signal, check_switched, signal, switched
from .validation import Flag, Name, Reference, Vector, list_of, number, place_on, show, xyz


def moving_place_on(of: str) -> Check:
    """Return the check of an arc-length in m, or of a signal of it, along the cable that the attribute names."""
    def check(value: Any) -> float | Signal:
        return signal(value) if isinstance(value, Signal | Mapping) else number(value, "m")

    return checked(check, {"anyOf": [number_schema("m"), SIGNALS.schema]}, Place(of))


PlaceOrSignal = Annotated[float | Signal, moving_place_on("on")]
Offsets = Annotated[tuple[float, ...], list_of("m", least=1)]
Shares = Annotated[tuple[float, ...], list_of(least=1)]


class Load(Part):
    """Base of the loads: ``value`` (3,) times the signal ``scale``.

    scale: factor over time, a signal
    when: name of the event that it begins with, the first time it happens; ``scale`` counts its time from there
    until: name of the event that it ends with, the first time it happens
    """

    group = "loads"
    name: Name | None = None
    scale: AnySignal = ONE
    when: Name | None = None
    until: Name | None = None

    def factor(self, time: np.ndarray, happened: Mapping[str, float]) -> np.ndarray:
        """Return the factor at times in s; happened: the first times of events, s."""
        return switched(self.scale, self.when, self.until, happened).value(time)

    @model_validator(mode="after")
    def _can_be_switched(self) -> Self:
        check_switched(self.scale, self.when, self.until)
        return self


class Force(Load):
    """A force at a point of a cable, of a rope or of a body, or forces that move along a cable.

    On a rope it acts on a material point in a span, see `Rope`. Where ``s`` is a signal it moves: off the ends of the
    cable nothing acts, as of a train on a bridge; its work is that on the material under it.

    on: the cable, the rope or the body
    value: components of the force, N
    s: of a cable, a rope or a modal beam, the arc-length, m; of a cable also a signal of it
    offsets: of a moving force, distances of the axles of a train from ``s``, positive towards the end of the cable, m
    shares: factors of ``value`` at the axles, by default one each
    at: of a body, the point in body axes, m; by default its origin (a modal body's first node)
    follower: whether the components are along local axes, of a cable (tangent, height, width), of a body its own, of a
        modal body those of the section there; else along the ground's
    """

    kind = "force"
    positional = ("on",)
    on: Reference
    s: PlaceOrSignal | None = None
    offsets: Offsets = (0.0,)
    shares: Shares | None = None
    at: Annotated[Vector, xyz("m", of="on")] | None = None
    value: Annotated[Vector, xyz("N", of="along")]
    follower: Flag = False

    @property
    def along(self) -> str | None:
        """Return the part in whose axes its components are, None for the ground."""
        return self.on if self.follower else None

    @property
    def axles(self) -> list[tuple[float, float]]:
        """Return the offset in m and the share of each force."""
        return list(zip(self.offsets, self.shares or (1.0,) * len(self.offsets), strict=True))

    def axles_at(self, time: np.ndarray, length: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield of each force that moves along a cable of a length in m its arc-lengths (T,) at times in s, within the
        cable, and its shares (T,), zero off the cable.
        """
        assert isinstance(self.s, Signal), f"{self.where} does not move"
        for offset, share in self.axles:
            at = self.s.value(time) + offset
            yield np.clip(at, 0.0, length), share * ((at >= 0) & (at <= length))

    @model_validator(mode="after")
    def _moves_as_a_train(self) -> "Force":
        if not isinstance(self.s, Signal) and (self.offsets != (0.0,) or self.shares is not None):
            raise ValueError("offsets and shares are of a force that moves", "give s as a signal, or leave them out")
        if self.shares is not None and len(self.shares) != len(self.offsets):
            raise ValueError(f"offsets and shares must be of equal length, got {len(self.offsets)} and "
                             f"{len(self.shares)}")
        return self


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
