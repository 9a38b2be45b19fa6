"""Shapes of surfaces for contact, and the distances of points from them.

`Box`, `Sphere` and `Cylinder` are also shapes of bodies in pictures. A further shape is one class, its entry in
`SURFACE_SHAPES`, and its case in `geometry`.
"""

from collections.abc import Callable, Iterator
from dataclasses import field, replace
from functools import lru_cache
from typing import Annotated, Any

import numpy as np
from pydantic import model_validator

from ..base.deferred import dataclass
from .height_bounds import height_bounds
from .part import Family, Part
from .plane import PLANE_ROUNDING, aligned
from .schemas import DIRECTION, HOLDER, checked, list_schema
from .solids import Box, Cylinder, Length, Sphere
from .validation import Vector, check_function, check_square, direction, items, list_of, show, shown, vector, xyz

HALF_WIDTH = 1e6
"""Of a height field without a table across, m."""


class SurfaceShape(Part):
    """Base of the shapes of surfaces that are no shapes of bodies."""

    tag = "kind"


class Plane(SurfaceShape):
    """A plane.

    point: a point of it, m
    normal: direction to the side where things may be
    """

    kind = "plane"
    positional = ("point", "normal")
    point: Annotated[Vector, xyz("m", DIRECTION, HOLDER)] = (0.0, 0.0, 0.0)
    normal: Annotated[Vector, direction(HOLDER)] = (0.0, 1.0, 0.0)

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        if self.normal[2]:
            yield f"normal {show(self.normal)}"


class Capsule(SurfaceShape):
    """A cylinder with half spheres at its ends.

    radius: m
    length: between the centres of the half spheres, m
    axis: direction
    at: its middle, m
    """

    kind = "capsule"
    positional = ("radius", "length", "axis")
    radius: Length
    length: Length
    axis: Annotated[Vector, direction(HOLDER)] = (0.0, 0.0, 1.0)
    at: Annotated[Vector, xyz("m", DIRECTION, HOLDER)] = (0.0, 0.0, 0.0)


def _heights(value: Any) -> tuple[Any, ...]:
    """Return a list of heights in m, or one for each place along of lists across."""
    if (given := items(value, 2)) is None:
        raise ValueError(f"must be a list of 2 heights or more, or of lists of them, got {shown(value)}")
    rows = [items(row, 0) for row in given]
    if not any(row is not None for row in rows):
        return vector(given, "m", len(given))
    sizes = {-1 if row is None else len(row) for row in rows}
    if sizes & {-1} or len(sizes) > 1:
        raise ValueError("must have lists of equal length, one for each place along")
    return tuple(vector(row, "m", *sizes) for row in rows)


class HeightField(SurfaceShape):
    """The ground by a table of heights, with a cubic spline between them; beyond its edges they stay.

    `HeightField.of` makes the table of a function.

    x: places along the direction ``along``, m
    heights: one for each place, or, with ``across``, a list for each of them, m
    across: places across, m, square to ``along`` and ``up``, on the side of the axis that it is nearest to. Without it
        heights do not change that way
    along, up: directions
    """

    kind = "height_field"
    positional = ("x", "heights")
    x: Annotated[tuple[float, ...], list_of("m", least=2)]
    heights: Annotated[tuple[Any, ...], checked(_heights, {"anyOf": [
        list_schema("m", 2, None), {"type": "array", "items": list_schema("m", 2, None), "minItems": 2}]})]
    across: Annotated[tuple[float, ...], list_of("m", least=2)] | None = None
    along: Annotated[Vector, direction(HOLDER)] = (1.0, 0.0, 0.0)
    up: Annotated[Vector, direction(HOLDER)] = (0.0, 1.0, 0.0)

    @classmethod
    def of(cls, function: Callable[..., Any], x: Any, across: Any = None, **directions: Any) -> "HeightField":
        """Return the height field of the values of function(x) or function(x, across), in m, at places in m."""
        table = [float(function(a)) if across is None else [float(function(a, b)) for b in across] for a in x]
        given = {} if across is None else {"across": [float(b) for b in across]}
        return cls(x=[float(a) for a in x], heights=table, **given, **directions)

    @model_validator(mode="after")
    def _is_a_table(self) -> "HeightField":
        check_function(self.x, "x", "m", self.heights, "heights")
        rows = isinstance(self.heights[0], tuple)
        if rows != (self.across is not None):
            raise ValueError("heights are a list of lists where across is given, and only there")
        if self.across is not None:
            check_function(self.across, "across", "m", self.heights[0], "the lists of heights")
        check_square("along", self.along, "up", self.up)
        return self

    @property
    def axes(self) -> np.ndarray:
        """Return (3, 3): unit vectors along, up and across, as columns."""
        along, up = (np.array(v) / np.linalg.norm(v) for v in (self.along, self.up))
        third = np.cross(along, up)
        return np.column_stack([along, up, third * np.sign(third[np.argmax(np.abs(third))])])

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        for name, axis in (("along", self.along), ("up", self.up)):
            if axis[2]:
                yield f"{name} {show(axis)}"
        if self.across is not None:
            yield "across"


SURFACE_SHAPES = Family("surface_shape", "a shape such as Plane(point=(0, 0, 0), normal=(0, 1, 0))",
                        (Plane, HeightField, Sphere, Cylinder, Capsule, Box))
AnySurfaceShape = Annotated[Part, SURFACE_SHAPES.checked()]


@dataclass
class Geometry:
    """A surface of the engine (couplings/common/surfaces.h), from an origin (3,) along axes (3, 3) by columns.

    word: the kind of shape; direction (3,): a normal or an axis; radius, half_length in m; half_size (3,): of a box
    along its axes, in m; first, second: breakpoints of a height field; cells (first, second, 4, 4): its coefficients,
    (first, 4) without second; highest, steepest, bend: bounds of its height in m, its slope, and its second derivatives
    in 1/m; inside: whether it is a hollow.
    """

    word: str
    origin: np.ndarray
    axes: np.ndarray
    direction: np.ndarray
    radius: float = 0.0
    half_length: float = 0.0
    half_size: np.ndarray = field(default_factory=lambda: np.zeros(3))
    first: np.ndarray | None = None
    second: np.ndarray | None = None
    cells: np.ndarray | None = None
    highest: float = 0.0
    steepest: float = 0.0
    bend: float = 0.0
    inside: bool = False

    def moved(self, by: Any) -> "Geometry":
        """Return it translated by (3,), in m."""
        return replace(self, origin=self.origin + np.array(by))

    def in_plane(self, normal: np.ndarray) -> "Geometry":
        """Return it for planes across a unit vector (3,), along which a box has no end."""
        across = np.abs(normal @ self.axes) > 1 - PLANE_ROUNDING
        return replace(self, half_size=np.where(across, np.inf, self.half_size))

    def into(self, points: np.ndarray) -> np.ndarray:
        """Return points (..., 3), in m, in its axes."""
        return (points - self.origin) @ self.axes

    @property
    def inner_radius(self) -> float:
        """Return the radius in m of the largest sphere inside; infinite for shapes without an inside."""
        if self.word == "box":
            return float(self.half_size.min())
        return self.radius if self.word in ("round", "capsule") else np.inf

    @property
    def largest_length(self) -> float:
        """Return the largest length in m in the formulas of its distance."""
        lengths = [*self.origin, self.radius, self.half_length, *self.half_size, self.highest]
        return float(max(abs(length) for length in lengths if np.isfinite(length)))

    def walls(self, dim: int) -> "list[Geometry]":
        """Return the inner planes of a hollow box in a scene of dim dimensions, or itself for other surfaces."""
        if not (self.inside and self.word == "box"):
            return [self]
        sides = [sign * axis for axis in np.eye(3)[:dim] for sign in (1.0, -1.0)]  # the last axis is across a plane
        return [Geometry("flat", self.origin + self.axes @ (side * self.half_size), self.axes, -side) for side in sides]

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Return the distances (...) of points (..., 3), in m: positive outside, of a hollow positive inside."""
        distance = self._outside(self.into(points))
        return -distance if self.inside else distance

    def _outside(self, y: np.ndarray) -> np.ndarray:
        if self.word == "terrain":
            height, slope, slope_across = self.heights(y[..., 0], y[..., 2])
            return (y[..., 1] - height) / np.sqrt(1 + slope**2 + slope_across**2)
        if self.word == "box":
            beyond = np.abs(y) - self.half_size
            return np.linalg.norm(np.maximum(beyond, 0.0), axis=-1) + np.minimum(beyond.max(axis=-1), 0.0)
        along = y @ self.direction
        if self.word == "flat":
            return along
        if self.word == "capsule":
            along = np.clip(along, -self.half_length, self.half_length)
        return np.linalg.norm(y - along[..., None] * self.direction, axis=-1) - self.radius

    def heights(self, x: np.ndarray, across: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return the heights (...) of a height field at places (...), in m, and its slopes along and across."""
        assert self.first is not None and self.cells is not None, "only of height fields"
        x, across = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(across, dtype=float))
        i, a, da = _powers(self.first, x)
        if self.second is None:
            c = self.cells[i]
            return np.sum(c * a, axis=-1), np.sum(c * da, axis=-1), np.zeros(x.shape)
        j, b, db = _powers(self.second, across)
        c = self.cells[i, j]
        return tuple(np.einsum("...mk,...m,...k->...", c, m, k) for m, k in ((a, b), (da, b), (a, db)))


def _powers(knots: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the cells of places, and powers of their distances from the breakpoints below, with derivatives."""
    inside = np.clip(x, knots[0], knots[-1])
    cell = np.clip(np.searchsorted(knots, inside, "right") - 1, 0, len(knots) - 2)
    u = (inside - knots[cell])[..., None]
    order = np.arange(4)
    slopes = order * np.where(order > 0, u ** np.maximum(order - 1, 0), 0.0)
    return cell, u**order, np.where(((x >= knots[0]) & (x <= knots[-1]))[..., None], slopes, 0.0)


def geometry(shape: Part) -> Geometry:
    """Return the geometry of a shape, in the axes that its vectors are given in."""
    if isinstance(shape, HeightField):
        return replace(_fitted(shape.x, shape.heights, shape.across), axes=shape.axes)
    if isinstance(shape, Plane):
        return Geometry("flat", np.array(shape.point), np.eye(3), _unit(shape.normal))
    if isinstance(shape, Box):
        order = np.roll(np.arange(3), 2 - int(np.argmax(np.abs(shape.axes[2]))))  # the axis nearest to z is the last
        return Geometry("box", np.array(shape.at), shape.axes[:, order], np.zeros(3),
                        half_size=np.array(shape.size)[order] / 2)
    assert isinstance(shape, Sphere | Cylinder | Capsule), f"{shape!r} is no shape of a surface"
    axis = np.zeros(3) if isinstance(shape, Sphere) else _unit(shape.axis)
    half = 0.0 if isinstance(shape, Sphere) else shape.length / 2
    word = "capsule" if half and isinstance(shape, Capsule) else "round"
    return Geometry(word, np.array(shape.at), np.eye(3), axis, shape.radius, half)


def _unit(v: Vector) -> np.ndarray:
    return aligned(np.array(v) / np.linalg.norm(v))


@lru_cache(maxsize=8)  # contacts, checks and pictures need it
def _fitted(x: tuple[float, ...], heights: tuple[Any, ...], across: tuple[float, ...] | None) -> Geometry:
    """Return the geometry of the cubic splines through a table of heights, along the ground's axes.

    Its arrays are shared and read-only.
    """
    from scipy.interpolate import CubicSpline  # 30 ms, for those alone

    first = np.array(x)
    along = CubicSpline(first, np.array(heights, dtype=float), bc_type="natural").c[::-1]  # (4, cells[, across])
    made = Geometry("terrain", np.zeros(3), np.eye(3), np.array([0.0, 1.0, 0.0]), first=first)
    if across is None:
        made.cells = along.T.copy()
    else:
        made.second = np.array(across)
        both = CubicSpline(made.second, along, axis=2, bc_type="natural").c[::-1]  # (4, cells across, 4, cells along)
        made.cells = both.transpose(3, 1, 2, 0).copy()
        made.second.flags.writeable = False
    for array in (made.origin, made.axes, made.direction, first, made.cells):
        array.flags.writeable = False
    made.highest, made.steepest, made.bend = height_bounds(first, made.second, made.cells)
    return made

