"""Shapes of rigid bodies in pictures; some are also shapes of surfaces.

A further shape is one class and one entry in `SOLIDS`.
"""

import os
from pathlib import PurePath
from typing import Annotated, Any

import numpy as np
from pydantic import model_validator

from .part import Family, Part
from .plane import aligned
from .schemas import DIRECTION, HOLDER, LENGTHS, FileEntry, Turning, checked, list_schema
from .validation import Vector, check_square, direction, positive, shown, vector, xyz

Length = Annotated[float, positive("m")]
MESH_FILES = (".stl", ".glb", ".gltf")


def _lengths(value: Any) -> Vector:
    """Return three positive lengths in m."""
    x, y, z = vector(value, "m")
    if not min(x, y, z) > 0:
        raise ValueError(f"must be three positive lengths, got {shown(value)}")
    return x, y, z


def _mesh_file(value: Any) -> str:
    """Return the path of a mesh file, which is read when it is drawn."""
    if not isinstance(value, str | os.PathLike):
        raise ValueError(f"must be a file, got {shown(value)}")
    if PurePath(value).suffix.lower() not in MESH_FILES:
        raise ValueError(f"must end in {', '.join(MESH_FILES[:-1])} or {MESH_FILES[-1]}, got {shown(os.fspath(value))}")
    return os.fspath(value)


class Solid(Part):
    """Base of the shapes of bodies in pictures.

    at: middle of the shape, in body axes, m
    """

    tag = "kind"
    at: Annotated[Vector, xyz("m", DIRECTION, HOLDER)] = (0.0, 0.0, 0.0)


class Box(Solid):
    """A box.

    size: its three lengths along ``along``, along ``up``, and across both, m
    along, up: directions; by default the body's axes
    """

    kind = "box"
    positional = ("size",)
    size: Annotated[Vector, checked(_lengths, list_schema("m"), Turning(LENGTHS))]
    along: Annotated[Vector, direction(HOLDER)] = (1.0, 0.0, 0.0)
    up: Annotated[Vector, direction(HOLDER)] = (0.0, 1.0, 0.0)

    @model_validator(mode="after")
    def _has_square_axes(self) -> "Box":
        check_square("along", self.along, "up", self.up)
        return self

    @property
    def axes(self) -> np.ndarray:
        """Return (3, 3): unit vectors along the three lengths, as columns, a right-handed system."""
        along, up = (aligned(np.array(v) / np.linalg.norm(v)) for v in (self.along, self.up))
        return np.column_stack([along, up, aligned(np.cross(along, up))])


class Sphere(Solid):
    """A sphere.

    radius: m
    """

    kind = "sphere"
    positional = ("radius",)
    radius: Length


class Cylinder(Solid):
    """A cylinder.

    radius: m
    length: m
    axis: direction in body axes
    """

    kind = "cylinder"
    positional = ("radius", "length", "axis")
    radius: Length
    length: Length
    axis: Annotated[Vector, direction(HOLDER)] = (0.0, 0.0, 1.0)


class MeshShape(Solid):
    """The surface in a file, its coordinates along the body's axes.

    The file is read when a picture is made, which needs trimesh: pip install 'funicular[meshes]'.

    file: STL (binary or text) or glTF (.gltf, .glb)
    scale: metres a unit of the file, 0.001 for one in millimetres
    at: origin of the file, in body axes, m
    """

    kind = "mesh"
    positional = ("file",)
    file: Annotated[str, checked(_mesh_file, {"type": "string"}, FileEntry())]
    scale: Annotated[float, positive()] = 1.0


SOLIDS = Family("solid", "a shape such as Box(size=(1, 2, 3))", (Box, Sphere, Cylinder, MeshShape))
AnySolid = Annotated[Solid, SOLIDS.checked()]
