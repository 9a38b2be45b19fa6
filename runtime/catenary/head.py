"""A collector head that tilts, with contact strips on springs, on the collector of a pantograph."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import model_validator

from ..errors import SceneError
from ..parts.part import Part
from ..parts.solids import Box
from ..parts.validation import list_of, not_negative, positive
from ..scene.scene import Scene

RADIUS = 0.05
"""m: from the wire's axis to the middle of a strip in contact; more than any penetration."""

REACH = 0.8
"""m: of a strip to each side of the track's middle."""

STRIP_LENGTH = 0.06
"""m: of a strip along the track, as drawn."""

LEVER = 0.25
"""m: of springs that hold a head level, from its pivot."""

SPRING_LENGTH = 1.0
"""m: of springs of heads and strips, free of force: more than any motion in the search for rest, so that none folds."""


class Head(Part):
    """A head that tilts on the first mass of a chain, or on the collector of a jointed pantograph, with contact strips.

    It turns about its middle: pitch about the axis across the track, and in a line with staggers also roll about the
    axis along it. mass in kg, without strips; inertia in kg m², of pitch and of roll; strips: their places along the
    track from the middle, in m, each with a contact force of its own. strip_mass in kg, of each; strip_stiffness in N/m
    and strip_damping in N s/m: of the spring and the damper below each strip, which moves up and down on the head;
    without a stiffness strips are rigid parts of the head, without mass of their own. tilt_stiffness in N m/rad and
    tilt_damping in N m s/rad hold the head level on what carries it. Forces against the weights are added.
    """

    mass: Annotated[float, positive("kg")]
    inertia: Annotated[float, positive("kg m²")]
    strips: Annotated[tuple[float, ...], list_of("m", least=1)] = (-0.25, 0.25)
    strip_mass: Annotated[float, positive("kg")] = 1.0
    strip_stiffness: Annotated[float, positive("N/m")] | None = None
    strip_damping: Annotated[float, not_negative("N s/m")] = 0.0
    tilt_stiffness: Annotated[float, not_negative("N m/rad")] = 0.0
    tilt_damping: Annotated[float, not_negative("N m s/rad")] = 0.0

    @model_validator(mode="after")
    def _is_held(self) -> Head:
        if len({*self.strips}) < len(self.strips):
            raise ValueError("has two strips at one place", "give each a place of its own along the track")
        if not self.tilt_stiffness and not min(self.strips) < 0 < max(self.strips):
            raise ValueError("tips over: all its strips are on one side of its middle",
                             "give strips before and behind it, or tilt_stiffness")
        if self.strip_stiffness is None and ({"strip_mass", "strip_damping"} & self.model_fields_set):
            raise ValueError("has strip_mass or strip_damping, but no spring below its strips", "give strip_stiffness")
        return self


def add_head(scene: Scene, head: Head, name: str, place: tuple[float, float], speed: float, planar: bool
             ) -> list[tuple[str, tuple[float, float, float]]]:
    """Add a head on the body name_1 of a pantograph, at (x, y) in m, with a speed (m/s) along x.

    Returns the body that carries each strip, and the middle of the strip on it. Raises SceneError.
    """
    if not planar and not head.tilt_stiffness:
        raise SceneError("head", "rolls over under a wire beside the middle of the track", "give tilt_stiffness")
    carrier, body = f"{name}_1", f"{name}_tilting_head"
    size = max(map(abs, head.strips)) * 2 + STRIP_LENGTH
    _add_body(scene, body, head.mass, head.inertia, place, speed, Box(size=(size, RADIUS / 2, REACH)))
    how: dict[str, Any] = ({"kind": "revolute", "axis": (0, 0, 1)} if planar else
                           {"kind": "universal", "axis": (1, 0, 0), "second_axis": (0, 0, 1)})
    scene.joint(how.pop("kind"), carrier, body, name=f"{name}_tilt", **how)
    if head.tilt_stiffness or head.tilt_damping:
        _hold_level(scene, head, carrier, body, name, planar)
    return [_add_strip(scene, head, k, body, place, speed, name) for k in range(len(head.strips))]


def _hold_level(scene: Scene, head: Head, carrier: str, body: str, name: str, planar: bool) -> None:
    """Add springs that hold a head level, before and behind its pivot, and to both sides of it if it rolls."""
    levers = [(side * LEVER, 0.0) for side in (-1, 1)] + [(0.0, side * LEVER) for side in (-1, 1) if not planar]
    for k, (x, z) in enumerate(levers):
        scene.spring((carrier, (x, -SPRING_LENGTH, z)), (body, (x, 0.0, z)), length=SPRING_LENGTH,
                     name=f"{name}_level_{k + 1}", stiffness=head.tilt_stiffness / (2 * LEVER**2),
                     damping=head.tilt_damping / (2 * LEVER**2))


def _add_strip(scene: Scene, head: Head, k: int, body: str, place: tuple[float, float], speed: float, name: str
               ) -> tuple[str, tuple[float, float, float]]:
    """Add a strip of a head, counted from 0; return its body and its middle on that."""
    x = head.strips[k]
    if head.strip_stiffness is None:
        return body, (x, 0.0, 0.0)
    strip = f"{name}_strip_{k + 1}"
    _add_body(scene, strip, head.strip_mass, head.strip_mass * REACH**2 / 3, (place[0] + x, place[1]), speed,
              Box(size=(STRIP_LENGTH, 2 * RADIUS, 2 * REACH)))
    scene.joint("prismatic", (body, (x, 0.0, 0.0)), strip, axis=(0, 1, 0), name=f"{strip}_guide")
    scene.spring((body, (x, -SPRING_LENGTH, 0.0)), strip, stiffness=head.strip_stiffness, damping=head.strip_damping,
                 length=SPRING_LENGTH, name=f"{strip}_spring")
    return strip, (0.0, 0.0, 0.0)


def _add_body(scene: Scene, name: str, mass: float, inertia: float, place: tuple[float, float], speed: float,
              shape: Box) -> None:
    """Add a body at (x, y) in m with a force against its weight."""
    scene.rigid_body(name, mass=mass, inertia=(inertia,) * 3, position=(*place, 0.0), velocity=(speed, 0, 0),
                     shape=shape)
    scene.force(name, value=(0, -mass * scene.gravity[1], 0), name=f"{name}_lift")
