"""What a picture shows, as plain data: the pages, plots and exports are made of this and of nothing else.

Lengths in m, times in s. T is the number of frames, P the number of stations along a cable. Arrays that hold one frame
(first dimension 1) stand still.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np


@dataclass(frozen=True)
class Quantity:
    """A number along a cable that may colour it: values (T, P) in a unit."""

    key: str  # "tension"
    label: str  # "tension"
    unit: str  # "N"
    values: np.ndarray


@dataclass(frozen=True)
class CableShape:
    """A cable: the centre line at P stations, with its section.

    section: ``{"shape": "circle", "diameter": d}``, ``{"shape": "tube", "diameter": d, "thickness": t}``,
    ``{"shape": "rectangle", "height": h, "width": w}``, or ``{"shape": "unknown", "size": d}``, the diameter of a
    circle of plausible size.
    """

    name: str
    s: np.ndarray  # (P,) arc-length of the undeformed cable in m
    position: np.ndarray  # (T, P, 3)
    section_y: np.ndarray | None  # (T, P, 3) unit vector of the section's height; None: the section has no direction
    section: Mapping[str, object]
    reference: np.ndarray  # (P, 3) what an exaggerated displacement is measured from
    quantities: tuple[Quantity, ...] = ()


@dataclass(frozen=True)
class BodyShape:
    """A body: its frame over time, and what is drawn in it.

    shape: ``{"kind": "box", "size": [x, y, z]}``, ``{"kind": "sphere", "radius": r}``, ``{"kind": "cylinder",
    "radius": r, "length": l, "axis": [x, y, z]}``, or ``{"kind": "mesh", "vertices": (V, 3) array, "triangles": (F, 3)
    array}``, each with ``"offset": [x, y, z]``, its centre in axes of the body.
    """

    name: str
    position: np.ndarray  # (T, 3)
    orientation: np.ndarray  # (T, 4) unit quaternion, scalar first, from axes of the body to those of space
    shape: Mapping[str, object]
    reference: np.ndarray  # (3,), or (T, 3) for what slides: what an exaggerated displacement is measured from
    quantities: Mapping[str, tuple[str, np.ndarray]] = field(default_factory=dict)  # label: (unit, (T,) values)


@dataclass(frozen=True)
class Mark:
    """A point that means something.

    reference: what an exaggerated displacement is measured from; None: the mean of a periodic clip, else the start.
    """

    name: str
    kind: Literal["pin", "clamp", "tie", "joint", "slide", "ground", "point"]
    position: np.ndarray  # (T or 1, 3)
    detail: str = ""  # said when the pointer is on it
    reference: np.ndarray | None = None  # (3,), or (T, 3) for what slides


@dataclass(frozen=True)
class Segment:
    """A straight connection of two points; ``reference`` is like that of a mark, start and end."""

    name: str
    kind: Literal["spring", "hanger", "lever", "joint", "load"]  # hanger: a spring that only pulls
    start: np.ndarray  # (T or 1, 3)
    end: np.ndarray  # (T or 1, 3)
    reference: np.ndarray | None = None  # (2, 3), or (T, 2, 3)


@dataclass(frozen=True)
class Curve:
    """A result over time, for the diagrams beside the picture."""

    key: str  # "trolley.force"
    label: str
    unit: str
    columns: tuple[str, ...]  # ("x", "y", "z"), or () for a scalar
    time: np.ndarray  # (N,): a curve may have more rows than the picture has frames
    values: np.ndarray  # (N,) or (N, columns)


@dataclass(frozen=True)
class EventMark:
    """Something that happened, on the line of time."""

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


@dataclass(frozen=True)
class Animation:
    """What a page shows.

    arrangement: ``"overlay"`` draws all clips at once, each in its own shade (two runs); ``"menu"`` one at a time,
    chosen by its label (modes).
    """

    title: str
    clips: tuple[Clip, ...]
    up: tuple[float, float, float]  # against gravity
    planar: bool
    arrangement: Literal["overlay", "menu"] = "overlay"
    time_label: str = "time"  # "load factor" for a load path
    time_unit: str = "s"
    notes: tuple[str, ...] = ()  # said on the page: what was decimated, warnings of the run
