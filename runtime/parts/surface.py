"""Surfaces of the ground or of a body for contact with cables and bodies."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Any

import numpy as np
from pydantic import model_validator

from ..base.rotations import conjugate, rotate
from .part import Part
from .plane import PLANE_ROUNDING
from .solids import Box, Cylinder, Sphere
from .surface_shapes import AnySurfaceShape, Capsule, Geometry, geometry
from .validation import Flag, Name, Reference, Vector, show, xyz


class Surface(Part):
    """A surface of the ground or of a rigid body; a `Contact` names the part in contact with it.

    Contact with a cylinder continues beyond its length, which pictures draw; a message reports it.

    shape: a `Plane`, `HeightField`, `Sphere`, `Cylinder`, `Capsule` or `Box`
    on: the body, in whose axes the shape is given; by default the ground
    at: origin of the shape's own places, m
    inside: whether the shape is a hollow, a duct, a tube or a container, with contact on its inside
    """

    kind = "surface"
    group = "surfaces"
    positional = ("name", "shape")
    name: Name
    shape: AnySurfaceShape
    on: Reference | None = None
    at: Annotated[Vector, xyz("m", of="on")] = (0.0, 0.0, 0.0)
    inside: Flag = False

    @model_validator(mode="after")
    def _has_an_inside(self) -> "Surface":
        if self.inside and not np.isfinite(geometry(self.shape).inner_radius):
            raise ValueError(f"a {self.shape.kind} has no inside",
                             "leave inside out; things are on the side of its normal, or of up")
        return self

    @property
    def geometry(self) -> Geometry:
        """Return its geometry in the axes of its body or of the ground."""
        return replace(geometry(self.shape).moved(self.at), inside=self.inside)

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        lies = isinstance(self.shape, Sphere)
        if isinstance(self.shape, Cylinder | Capsule):
            axis = np.abs(np.array(self.shape.axis)) / np.linalg.norm(self.shape.axis)
            lies = bool(axis[2] <= PLANE_ROUNDING)
            if not lies and max(axis[:2]) > PLANE_ROUNDING:
                yield f"axis {show(self.shape.axis)}"
        if isinstance(self.shape, Box):
            box = self.geometry
            lies = abs(box.origin[2]) > box.half_size[2]
            if np.abs(box.axes[:2, 2]).max() > PLANE_ROUNDING:
                yield f"along {show(self.shape.along)}, up {show(self.shape.up)}"
        if lies:  # a shape across the plane, or without end that way, reaches the plane from anywhere
            for name, at in (("at", self.at), ("shape.at", getattr(self.shape, "at", None))):
                if at is not None and at[2]:
                    yield f"{name} {show(at, 'm')}"
        yield from self.shape.off_plane()

    def in_axes(self, body: Any, points: np.ndarray) -> np.ndarray:
        """Return points (..., 3) of the ground in the axes of its body as drawn; None: on the ground."""
        if body is None:
            return points
        position, orientation = body.frame
        return rotate(conjugate(orientation), points - position)

    def distance(self, body: Any, points: np.ndarray, normal: np.ndarray | None = None) -> np.ndarray:
        """Return the distances (...) of points (..., 3) of the ground from it as drawn, negative inside, in m.

        normal: a unit vector (3,) across the plane of a planar scene, along which distances do not count.
        """
        shape = self.geometry
        if normal is not None:
            shape = shape.in_plane(normal if body is None else rotate(conjugate(body.frame[1]), normal))
        return shape.distance(self.in_axes(body, points))
