"""What would leave the plane z = 0 of a scene of planar cables."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..errors import SceneError
from ..kernels.elements import built_in
from ..parts.joint import LINES, Joint
from ..parts.load import DistributedForce, Force, Moment
from ..parts.modal_body import ModalBody
from ..parts.rigid_body import RigidBody
from ..parts.signal import Constant
from ..parts.slide import Slide
from ..parts.spring import Spring
from ..parts.support import Motion
from ..parts.validation import Part, show

if TYPE_CHECKING:
    from ..scene import Scene

def check_plane(scene: Scene, part: Part | None = None) -> None:
    """Refuse a part, or all of the scene, where it leaves the plane. Raises SceneError."""
    planar = next((cable for cable in scene.cables.values() if cable.dim == 2), None)
    if planar is None:
        return
    spatial = ", ".join(f'"{name}"' for name, kind in built_in().items() if kind.dim == 3)
    remedy = f"let it stay in the plane, or take spatial elements: {spatial}"
    plane = f'leaves the plane z = 0 of the {planar.element} cable "{planar.name}"'
    if part is None and scene.gravity[2]:
        raise SceneError("scene", f"gravity {show(scene.gravity, 'm/s²')} {plane}", remedy)
    for each in scene.parts() if part is None else [part]:
        for what in _off(each):
            raise SceneError(each.where, f"{what} {plane}", remedy)


def _off(part: Part) -> Iterator[str]:
    """The quantities of a part that leave the plane."""
    match part:
        case ModalBody():
            position, orientation = part.frame
            yield from _across("position", position, "m")
            yield from _in_plane("orientation", orientation[1:], orientation)
            if part.shape.modes[..., 2].any():
                yield f"mode {1 + int(np.argmax(part.shape.modes[..., 2].any(axis=1)))}"
            yield from _across("velocity", part.velocity, "m/s")
            yield from _in_plane("angular_velocity", part.angular_velocity, part.angular_velocity, "rad/s")
        case RigidBody():
            yield from _across("position", part.position, "m")
            yield from _in_plane("orientation", part.orientation[1:], part.orientation)
            yield from _across("centre", part.centre, "m")
            yield from _across("velocity", part.velocity, "m/s")
            yield from _in_plane("angular_velocity", part.angular_velocity, part.angular_velocity, "rad/s")
        case Slide():
            yield from _across("at", part.at, "m")
        case Force():
            yield from _across("value", part.value, "N")
            yield from _across("at", part.at, "m")
        case DistributedForce():
            yield from _across("value", part.value, "N/m")
        case Moment():
            yield from _in_plane("value", part.value, part.value, "N m")
        case Motion():
            if part.displacement is not None and part.displacement[2] not in (None, Constant(constant=0.0)):
                yield "displacement z"
            if part.rotation is not None:
                yield from _in_plane("rotation about", part.rotation.axis, part.rotation.axis)
        case Spring():
            yield from _ends_across(part)
        case Joint():
            yield from _ends_across(part)
            if part.pair == "universal":
                yield "a universal joint"
            elif part.pair in LINES:
                yield from _across("axis", part.axis)
                if part.pair == "cylindrical" and part.is_driven:
                    yield "a turn about the axis"
            elif part.axis is not None:
                yield from _in_plane("axis", part.axis, part.axis)


def _ends_across(part: Spring | Joint) -> Iterator[str]:
    for name in ("a", "b"):
        yield from _across(name, getattr(part, name).at, "m")


def _across(name: str, value, unit: str = "") -> Iterator[str]:
    if value is not None and value[2]:
        yield f"{name} {show(value, unit)}"


def _in_plane(name: str, axis, value, unit: str = "") -> Iterator[str]:
    if np.any(axis[:2]):
        yield f"{name} {show(value, unit)}"
