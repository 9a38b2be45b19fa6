"""Joints between bodies, points of cables and the ground."""

from collections.abc import Iterator
from typing import Annotated

import numpy as np
from pydantic import Field, model_validator

from .attachment import AnyAttachment
from .friction import AnyFriction
from .part import Part
from .quantity import all_of_engine
from .signal import AnySignal, Integral, Signal
from .validation import Name, Vector, direction, one_of, positive, show

POINT_KINDS, LINE_KINDS = ("spherical", "revolute", "universal", "weld"), ("prismatic", "cylindrical")
"""Kinds that hold two points together, and kinds that hold a point on a line."""
JOINT_KINDS = (*POINT_KINDS, *LINE_KINDS, "distance")

ROUGH_KINDS = ("revolute", "prismatic", "cylindrical")
"""Kinds that may have friction."""

DRIVEN = {"revolute": "angle", "cylindrical": "angle", "prismatic": "distance", "distance": "distance"}
"""The quantity that drives a joint, itself or by its rate."""
DRIVE_UNITS = {"angle": "rad", "distance": "m"}


class Joint(Part):
    """A joint between two attachments.

    Redundant equations, as of a door on two hinges, are left out, and the report names them.

    | kind | constrains | leaves free |
    |---|---|---|
    | spherical | the two points together | every rotation |
    | revolute | also the axis of both | the rotation about ``axis`` |
    | universal | the points; ``axis`` of a square to ``second_axis`` of b | the rotations about both |
    | prismatic | b's point to the line through a's along ``axis``, and the orientation | the displacement along it |
    | cylindrical | b's point to that line, and its direction | displacement along it and rotation about it |
    | weld | points and orientation | nothing |
    | distance | ``length`` between the points | all else |

    A joint is driven by one of the signals ``angle``, ``distance`` and ``velocity``.

    kind: see the table
    a, b: attachments: ("A", (x, y, z)), a point in body axes; "A", the origin of a body; ("wire", s), the place of a
        cable with its section, or its tangent where the elements have no sections; ("haul", s), a point of a rope's
        material, for spherical and distance joints, and revolute ones in the plane; or a point (x, y, z) of the
        ground, m
    axis, second_axis: directions of the ground, at the start
    up: where an element has no section axes, a direction fixed in the ground that completes the frame of its tangent,
        and against which the joint holds the rotation about the tangent
    angle: of b about the axis as seen from a, from the start on, rad; of revolute and cylindrical joints
    distance: of prismatic joints the displacement of b along the axis from the start on, of distance joints the
        distance, m
    velocity: rate of the angle or the distance, rad/s or m/s
    length: of a distance joint, m; by default the distance at the start
    friction: of a revolute, prismatic or cylindrical joint, not on ropes; with the model "stick", of the former two, it
        holds at rest. The joint's force across the axis presses, not its moment
    radius: of the pin, for friction of revolute and cylindrical joints, m
    normal_force: presses in the place of the joint's force, as in a brake, N
    """

    kind = "joint"
    group = "joints"
    positional = ("kind", "a", "b")
    results = all_of_engine(
        "joint",
        force="force on what carries the end b, at that end",
        moment="moment on what carries the end b, about that end",
        residual="largest of its equations, in m or of cosines",
    )
    joint_kind: Annotated[str, one_of(JOINT_KINDS)] = Field(alias="kind")
    name: Name | None = None
    a: AnyAttachment
    b: AnyAttachment
    axis: Annotated[Vector | None, direction()] = None
    second_axis: Annotated[Vector | None, direction()] = None
    up: Annotated[Vector | None, direction()] = None
    angle: AnySignal | None = None
    distance: AnySignal | None = None
    velocity: AnySignal | None = None
    length: Annotated[float, positive("m")] | None = None
    friction: AnyFriction | None = None
    radius: Annotated[float, positive("m")] | None = None
    normal_force: Annotated[float, positive("N")] | None = None

    @model_validator(mode="after")
    def _has_what_it_needs(self) -> "Joint":
        if self.a.on is None and self.b.on is None:
            raise ValueError("has both ends on the ground", "put one of them on a cable or a body")
        with_axis = {"axis": (*LINE_KINDS, "revolute", "universal"), "second_axis": ("universal",)}
        for name, kinds in with_axis.items():
            given, has_one = getattr(self, name) is not None, self.joint_kind in kinds
            if given and not has_one:
                raise ValueError(f"{name} is given, but a {self.joint_kind} joint has none", "leave it out")
            if has_one and not given and self.joint_kind != "revolute":  # in the plane it is z
                raise ValueError(f"{name} is missing: a {self.joint_kind} joint needs it")
        if self.length is not None and self.joint_kind != "distance":
            raise ValueError(f"length is given, but a {self.joint_kind} joint has none", "leave it out")
        return self

    @model_validator(mode="after")
    def _has_axes_square_to_each_other(self) -> "Joint":
        if self.joint_kind == "universal" and self.axis is not None and self.second_axis is not None:
            cosine = np.dot(self.axis, self.second_axis) / np.linalg.norm(self.axis) / np.linalg.norm(self.second_axis)
            if abs(cosine) > 1e-6:
                raise ValueError("axis and second_axis must be perpendicular, got "
                                 f"{np.degrees(np.arccos(np.clip(cosine, -1, 1))):.6g} degrees between them")
        return self

    @model_validator(mode="after")
    def _has_friction_that_it_can(self) -> "Joint":
        needs_radius = self.joint_kind in ("revolute", "cylindrical")
        if self.friction is None:
            for name in ("radius", "normal_force"):
                if getattr(self, name) is not None:
                    raise ValueError(f"{name} is given, but no friction", "give friction, or leave it out")
            return self
        if self.joint_kind not in ROUGH_KINDS:
            raise ValueError(f"friction is given, but a {self.joint_kind} joint has none",
                             f"leave it out, or take {' or '.join(ROUGH_KINDS)}")
        if self.is_driven:
            raise ValueError("friction is given, but a signal drives the joint", "leave one of the two out")
        if needs_radius != (self.radius is not None):
            raise ValueError(f"friction of a {self.joint_kind} joint needs the radius of its pin" if needs_radius else
                             "radius is given, but a prismatic joint has no pin", *() if needs_radius else
                             ("leave it out",))
        self.friction.check_of_joint()
        if self.friction.sticks and self.joint_kind == "cylindrical":
            raise ValueError('friction has model="stick", but a cylindrical joint is free in two motions, in which it '
                             "does not come to rest by itself", 'take model="regularised", or a revolute and a '
                             "prismatic joint in its place")
        return self

    @model_validator(mode="after")
    def _is_driven_once(self) -> "Joint":
        given = [name for name in ("angle", "distance", "velocity") if getattr(self, name) is not None]
        if len(given) > 1:
            raise ValueError(f"{' and '.join(given)} are given", "give one of them")
        possible = [DRIVEN[self.joint_kind], "velocity"] if self.joint_kind in DRIVEN else []
        if given and given[0] not in possible:
            raise ValueError(f"{given[0]} is given, but a {self.joint_kind} joint is driven by "
                             + (" or ".join(possible) or "nothing"), "leave it out")
        if self.distance is not None and self.length is not None:
            raise ValueError("distance and length are given", "give one of the two")
        return self

    @property
    def is_of_points(self) -> bool:
        """Return whether its equations depend on the two points alone, not on rotations."""
        return self.joint_kind in ("spherical", "distance")

    @property
    def is_driven(self) -> bool:
        """Return whether a signal drives it."""
        return any(signal is not None for signal in (self.angle, self.distance, self.velocity))

    @property
    def prescribed(self) -> Signal | None:
        """Return its driven angle (rad) or distance (m) over time, see `DRIVEN`, else None."""
        if self.velocity is not None:
            return Integral(rate=self.velocity, start=self.length or 0.0)
        return self.distance if self.angle is None else self.angle

    @property
    def axes(self) -> np.ndarray:
        """Return (3, 3): its axes at the start, as columns, along the ground's; z is ``axis``.

        x is ``second_axis`` where it is given. Else y is the ground's axis most nearly across z, the last of equals,
        in a plane z = 0 its normal. Without axis they are the ground's axes.
        """
        if self.axis is None:
            return np.eye(3)
        z = np.array(self.axis) / np.linalg.norm(self.axis)
        if self.second_axis is None:
            y = _across(np.eye(3)[max(range(3), key=lambda k: (-abs(z[k]), k))], z)
            return np.column_stack([np.cross(y, z), y, z])
        x = _across(np.array(self.second_axis), z)
        return np.column_stack([x, np.cross(z, x), z])

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        for name, end in (("a", self.a), ("b", self.b)):
            yield from (f"{name} {quantity}" for quantity in end.off_plane())
        if self.joint_kind == "universal":
            yield "a universal joint"
        elif self.joint_kind in LINE_KINDS:
            if self.axis is not None and self.axis[2]:
                yield f"axis {show(self.axis)}"
            if self.joint_kind == "cylindrical" and self.is_driven:
                yield "a turn about the axis"
        elif self.axis is not None and any(self.axis[:2]):
            yield f"axis {show(self.axis)}"


def _across(vector: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Return the unit vector along the part of ``vector`` across the unit vector ``axis``."""
    across = vector - np.dot(vector, axis) * axis
    return across / np.linalg.norm(across)
