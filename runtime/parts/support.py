"""Supports and ties of the nodes of cables: pins, clamps, prescribed motions."""

import math
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from pydantic import model_validator

from .part import Part
from .quantity import Quantity, vector_of_time
from .schemas import AXIS, checked, some
from .signal import Constant, Signal, signal
from .validation import Name, Reference, Vector, direction, items, one_of, place_on, shown, vector


def _called(cable: Any) -> str:
    """Return the name in messages of a cable, given as part, name or neither."""
    name = getattr(cable, "name", cable)
    return f'"{name}"' if isinstance(name, str) else shown(name)


ON_CABLE = {"force": vector_of_time("N", "force on the cable"), "moment": vector_of_time("N m", "moment on the cable")}
"""Results of supports that hold a section of a cable."""


class Support(Part):
    """Base of the supports of a cable's node.

    cable: the cable
    s: arc-length of the node, m
    """

    results = ON_CABLE
    cable: Reference
    s: Annotated[float, place_on("cable")]

    @classmethod
    def title(cls, data: dict[str, Any]) -> str:
        """Return the name of the support in messages."""
        return f"{cls.kind} on {_called(data.get('cable'))}"

    @property
    def label(self) -> str:
        """Return its name in results, such as ``wire@0``."""
        return f"{self.cable}@{self.s + 0.0:.12g}"


class Pin(Support):
    """Holds the position of a cable's node at ``s`` (m); its slopes stay free."""

    kind = "pin"
    group = "pins"
    positional = ("cable",)
    results: ClassVar[dict[str, Quantity]] = {"force": ON_CABLE["force"]}


GIVEN_DIRECTION = direction()


class Clamp(Support):
    """Holds the position of a cable's node at ``s`` (m) and its section, or all of its nodal vectors.

    fix: "section": of cables the direction of the tangent, while its length stays free; of beams the axes of the
        section, r_y and r_z, while r_x stays free, so that shear and stretch are not hindered. "all": every nodal
        vector
    direction: of the tangent there, towards larger s, by default as drawn. The section turns to it the shortest way;
        drawn otherwise, the cable begins bent beside the clamp, and `equilibrium` finds its rest
    """

    kind = "clamp"
    group = "clamps"
    positional = ("cable",)
    fix: Annotated[str, one_of(("section", "all"))] = "section"
    direction: Annotated[Vector | None, GIVEN_DIRECTION] = None


class Rotation(Part):
    """A rotation about ``axis``, fixed in the ground, by the signal ``angle`` in rad."""

    axis: Annotated[Vector, direction(turns=AXIS)]
    angle: Signal

    def as_given(self) -> list[Any]:
        """Return its form in a scene file: [axis, angle]."""
        return [self.axis, self.angle]


FREE = "free"
"""A free direction of a motion."""
Displacement = tuple[Signal | None, Signal | None, Signal | None]
"""A signal for each direction, None for a free one."""


def _displacement(value: Any) -> Displacement | None:
    if value is None:
        return None
    if (given := items(value, 3, 3)) is None:
        raise ValueError(f"must be 3 signals or numbers, got {shown(value)}",
                         'give 0 for a direction without motion, "free" for one that is not prescribed')
    x, y, z = (None if each is None or each == FREE else _component(axis, each)
                 for axis, each in zip("xyz", given, strict=True))
    if x is y is z is None:
        raise ValueError("leaves all directions free", "leave it out, or give a signal or number for one of them")
    return x, y, z


def _component(axis: str, value: Any) -> Signal:
    try:
        return signal(value)
    except ValueError as error:
        raise _of(axis, error) from None


def _of(name: str, error: ValueError) -> ValueError:
    """Return an error of a component of a quantity, by the name of the component."""
    if hasattr(error, "errors"):
        first = error.errors(include_url=False)[0]
        cause = first.get("ctx", {}).get("error")
        inner, args = ".".join(map(str, first["loc"])), cause.args if cause else ("is missing",)
        return ValueError(f"{name}: {inner} {args[0]}".replace("  ", " "), *args[1:])
    return ValueError(f"{name} {error.args[0]}", *error.args[1:])


def _rotation(value: Any) -> Rotation | None:
    if value is None or isinstance(value, Rotation):
        return value
    if isinstance(value, dict) and set(value) == {"axis", "angle"}:
        value = value["axis"], value["angle"]
    if (given := items(value, 2, 2)) is None:
        raise ValueError(f"must be an axis and a signal, got {shown(value)}",
                         "such as ((0, 0, 1), Ramp(start=0, end=1))")
    try:
        axis = vector(given[0])
    except ValueError as error:
        raise _of("axis", error) from None
    norm = math.hypot(*axis)
    if not norm > 0:
        raise ValueError("axis must not be zero")
    if abs(norm - 1) > 1e-15:  # a unit vector to rounding keeps its digits
        axis = tuple(a / norm for a in axis)
    return Rotation(axis=axis, angle=_component("angle", given[1]))


class Motion(Support):
    """Moves a cable's node at ``s`` (m) as prescribed.

    displacement: three signals or numbers from the drawn position of the node, m; 0 holds a direction, None or "free"
        leaves it free. Without a displacement the position stays free
    rotation: an axis, and a signal of the rotation of the section from its drawn orientation, rad, of any number of
        turns. It moves r_x of cables, whose length is held, and r_y and r_z of beams. Without it the section stays free
    """

    kind = "motion"
    group = "motions"
    positional = ("cable",)
    displacement: Annotated[Displacement | None, checked(_displacement, some(3))] = None
    rotation: Annotated[Rotation | None, checked(_rotation, some(2))] = None

    @model_validator(mode="after")
    def _moves_something(self) -> "Motion":
        if self.displacement is None and self.rotation is None:
            raise ValueError("has neither displacement nor rotation", "give one of them, or both")
        return self

    def entries(self) -> dict[str, Any]:
        """Return its entries, with "free" for free directions."""
        entries = super().entries()
        if self.displacement is not None:
            entries["displacement"] = [FREE if each is None else each for each in self.displacement]
        return entries

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        if self.displacement is not None and self.displacement[2] not in (None, Constant(constant=0.0)):
            yield "displacement z"
        yield from super().off_plane()


class Tie(Part):
    """Joins the nodes of two cables, which share their position.

    cable: the first cable
    s: arc-length of its node, m
    to: the other cable
    at: arc-length of the node of the other cable, m
    rotation: "rigid" (a corner of a frame): the sections turn together at their drawn angle; cables in line, and all
        cables in space, share all slopes. In space a corner of beams, or of a beam and a cable, is then too soft; a
        `FunicularWarning` reports it, and a `Joint` of the kind "weld" is exact. "free" (a hinge): they turn freely
    """

    kind = "tie"
    group = "ties"
    positional = ("cable",)
    results = ON_CABLE
    name: Name | None = None
    cable: Reference
    s: Annotated[float, place_on("cable")]
    to: Reference
    at: Annotated[float, place_on("to")]
    rotation: Annotated[str, one_of(("rigid", "free"))] = "rigid"

    @classmethod
    def title(cls, data: dict[str, Any]) -> str:
        """Return the name of the tie in messages."""
        if data.get("name") is not None:
            return super().title(data)
        return f"tie of {_called(data.get('cable'))} and {_called(data.get('to'))}"
