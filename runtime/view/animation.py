"""The content of pictures as plain data, from which pages, plots, films and exports are made.

Lengths in m, times in s. T is the number of frames, P the number of stations along a cable. The annotation of an array
has its dimensions. An array with one frame (first dimension 1) stands still.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Annotated, Any, Literal, TypeVar, get_origin, get_type_hints

import numpy as np

MARK_ROUNDING = 1e-9
"""Of the place of a mark over the spacing: a mark at the end of a cable is drawn."""


@dataclass(frozen=True)
class Quantity:
    """A number along a cable, by which it can be coloured."""

    key: str  # "tension"
    label: str  # "tension"
    unit: str  # "N"
    values: Annotated[np.ndarray, "T", "P"]


@dataclass(frozen=True)
class CableShape:
    """A cable: the centre line at P stations, with its section.

    section: ``{"shape": "circle", "diameter": d}``, ``{"shape": "tube", "diameter": d, "thickness": t}``,
    ``{"shape": "rectangle", "height": h, "width": w}``, or ``{"shape": "unknown", "size": d}``, the diameter of a
    circle of plausible size. material_s: the arc-length of the undeformed cable at the stations where its material runs
    through them, as of a rope over sheaves; it rises along the stations, and s is that of the scene as drawn.
    spacing: of marks on the material, by which one sees it run, in m of that arc-length. make: number of the section
    and material of a piece among those of its cable.
    """

    name: str
    s: Annotated[np.ndarray, "P"]  # arc-length of the undeformed cable
    position: Annotated[np.ndarray, "T", "P", 3]
    section_y: Annotated[np.ndarray | None, "T", "P", 3]  # unit vector of the section's height; None: no direction
    section: Mapping[str, object]
    reference: Annotated[np.ndarray, "T", "P", 3]  # (P, 3) origin of exaggerated displacements
    quantities: tuple[Quantity, ...] = ()
    material_s: Annotated[np.ndarray | None, "T", "P"] = None  # None: s of all frames
    spacing: float = 0.0
    make: int | None = None  # None: a cable of one piece


@dataclass(frozen=True)
class BodyShape:
    """A body: its frame over time, and the shape in it.

    shape: ``{"kind": "box", "size": [x, y, z]}``, ``{"kind": "sphere", "radius": r}``, ``{"kind": "cylinder",
    "radius": r, "length": l, "axis": [x, y, z]}``, ``{"kind": "wheel", "radius": r, "width": w}`` about z, with one
    wide spoke along x, or ``{"kind": "mesh", "vertices": (V, 3) array, "triangles": (F, 3) array}``, each with
    ``"offset": [x, y, z]``, its centre in axes of the body; ``"sheet": "water"`` or
    ``"ground"``: the surface of a fluid, or a part of an unbounded surface, without thickness. The first is ``{"kind":
    "water", "size": s, "along": [x, y, z], "across": [x, y, z], "up": [x, y, z], "cells": [n, m], "waves": (W, 6)
    array}``, a square to the distance s from its middle along two level sides, in so many cells, with waves over time
    as in `funicular.base.linear_waves`, without an offset.
    """

    name: str
    position: Annotated[np.ndarray, "T", 3]
    orientation: Annotated[np.ndarray, "T", 4]  # unit quaternion, scalar first, from axes of the body to those of space
    shape: Mapping[str, object]
    reference: Annotated[np.ndarray, "T", 3]  # (3,), or (T, 3) if it slides: origin of exaggerated displacements
    quantities: Mapping[str, tuple[str, np.ndarray]] = field(default_factory=dict)  # label: (unit, (T,) values)


@dataclass(frozen=True)
class Mark:
    """A point with a meaning.

    reference: origin of exaggerated displacements; None: the mean of a periodic clip, else the start.
    """

    name: str
    kind: Literal["pin", "clamp", "tie", "joint", "slide", "ground", "point"]
    position: Annotated[np.ndarray, "T", 3]
    detail: str = ""  # shown under the pointer
    reference: Annotated[np.ndarray | None, "T", 3] = None  # (3,), or (T, 3) if it slides


@dataclass(frozen=True)
class Segment:
    """A straight connection of two points; reference: as of a mark, of start and end."""

    name: str
    kind: Literal["spring", "hanger", "lever", "joint", "load"]  # hanger: a spring that only pulls
    start: Annotated[np.ndarray, "T", 3]
    end: Annotated[np.ndarray, "T", 3]
    reference: Annotated[np.ndarray | None, "T", 2, 3] = None  # (2, 3), or (T, 2, 3) if it slides


@dataclass(frozen=True)
class Curve:
    """A result over time, for the charts beside the picture."""

    key: str  # "trolley.force"
    label: str
    unit: str
    columns: tuple[str, ...]  # ("x", "y", "z"), or () for a scalar
    time: np.ndarray  # (N,): a curve may have more rows than the picture has frames
    values: np.ndarray  # (N,) or (N, columns)


@dataclass(frozen=True)
class EventMark:
    """An event on the time line."""

    time: float
    label: str


@dataclass(frozen=True)
class Clip:
    """One motion: a run, a mode over one period, a load path, or a single frame (T = 1)."""

    label: str
    time: np.ndarray  # (T,)
    cables: tuple[CableShape, ...] = ()
    bodies: tuple[BodyShape, ...] = ()
    marks: tuple[Mark, ...] = ()
    segments: tuple[Segment, ...] = ()
    curves: tuple[Curve, ...] = ()
    events: tuple[EventMark, ...] = ()
    periodic: bool = False  # a mode: played in a loop, the last frame joins the first
    details: Mapping[str, str] = field(default_factory=dict)  # "frequency": "1.25 Hz"

    @property
    def parts(self) -> Iterator[Part]:
        """Yield cables, bodies, marks and segments."""
        return chain(self.cables, self.bodies, self.marks, self.segments)


@dataclass(frozen=True)
class Animation:
    """The content of a page.

    arrangement: ``"overlay"`` draws all clips at once, each in its own shade (two runs); ``"menu"`` one at a time,
    selected by its label (modes).
    """

    title: str
    clips: tuple[Clip, ...]
    up: tuple[float, float, float]  # against gravity
    planar: bool
    arrangement: Literal["overlay", "menu"] = "overlay"
    time_label: str = "time"  # "load factor" for a load path
    time_unit: str = "s"
    notes: tuple[str, ...] = ()  # shown on the page: decimation, warnings of the run


Part = CableShape | BodyShape | Mark | Segment
AnyPart = TypeVar("AnyPart", CableShape, BodyShape, Mark, Segment)
DIMENSIONS: dict[type[Any], dict[str, tuple[str | int, ...]]] = {
    kind: {name: hint.__metadata__ for name, hint in get_type_hints(kind, include_extras=True).items()
           if get_origin(hint) is Annotated} for kind in (CableShape, BodyShape, Mark, Segment)}
"""Dimensions of the arrays of each kind of part, from their annotations."""


def arrays(part: Part) -> Iterator[tuple[str, tuple[str | int, ...], np.ndarray]]:
    """Yield the arrays of a part with their names and dimensions, those of its quantities included."""
    for name, dims in DIMENSIONS[type(part)].items():
        if (value := getattr(part, name)) is not None:
            yield name, dims, value
    if isinstance(part, CableShape):
        yield from ((quantity.key, ("T", "P"), quantity.values) for quantity in part.quantities)
    elif isinstance(part, BodyShape):
        yield from ((label, ("T",), values) for label, (_, values) in part.quantities.items())


def taken(part: AnyPart, dim: str, numbers: np.ndarray, count: int) -> AnyPart:
    """Return a part at some of its ``count`` frames (dim "T") or stations ("P"); arrays that stand still stay."""
    def at(array: np.ndarray, dims: tuple[str | int, ...]) -> np.ndarray:
        axis = dims.index(dim) - (len(dims) - array.ndim) if dim in dims else -1
        return array.take(numbers, axis) if axis >= 0 and array.shape[axis] == count else array

    changed: dict[str, Any] = {name: at(getattr(part, name), dims) for name, dims in DIMENSIONS[type(part)].items()
                               if getattr(part, name) is not None}
    if isinstance(part, CableShape):
        changed["quantities"] = tuple(replace(each, values=at(each.values, ("T", "P"))) for each in part.quantities)
    elif isinstance(part, BodyShape):
        changed["quantities"] = {label: (unit, at(values, ("T",)))
                                 for label, (unit, values) in part.quantities.items()}
    return replace(part, **changed)


def section_sides(section: Mapping[str, Any]) -> tuple[float, float]:
    """Return height and width of a section, or its diameter twice, in m."""
    if section["shape"] == "rectangle":
        return float(section["height"]), float(section["width"])
    diameter = float(section["size" if section["shape"] == "unknown" else "diameter"])
    return diameter, diameter


def material_marks(cable: CableShape, frame: int) -> np.ndarray:
    """Return the marks (n, 3) on the material of a cable at a frame, n = 0 for a cable without."""
    if cable.material_s is None or not cable.spacing > 0:
        return np.zeros((0, 3))
    s = at_frame(cable.material_s, frame)
    first, last = s[[0, -1]] / cable.spacing
    at = cable.spacing * np.arange(np.ceil(first - MARK_ROUNDING), np.floor(last + MARK_ROUNDING) + 1)
    return np.stack([np.interp(at, s, x) for x in at_frame(cable.position, frame).T], axis=1)


def at_frame(values: np.ndarray, frame: int) -> np.ndarray:
    """Return the values at a frame, also of an array that stands still."""
    return np.asarray(values[frame if len(values) > 1 else 0])


def period(clip: Clip) -> float | None:
    """Return the period of a repeated clip; its last frame is the first one again, or the one before it."""
    if not clip.periodic or len(clip.time) < 2:
        return None
    moving = [*(cable.position for cable in clip.cables), *(body.position for body in clip.bodies)]
    moved = max((np.abs(cable.position - cable.position[0]).max() for cable in clip.cables), default=0.0)
    closed = bool(moving) and all(np.abs(each[-1] - each[0]).max() <= 1e-6 * max(moved, 1e-300) for each in moving)
    return float(clip.time[-1] - clip.time[0] + (0 if closed else clip.time[-1] - clip.time[-2]))
