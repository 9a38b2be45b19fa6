"""One HTML file that shows an animation in three dimensions, opens from disk and needs no network.

The file is ``page_source/template.html`` with the style, the viewer (``page_source/dist/viewer.min.js``, deflated), a
header in JSON, and the arrays that the header names by number (format: page_arrays.py). Positions are relative to
``origin``, so that float32 keeps its digits far from the origin.
"""

from __future__ import annotations

import base64
import html
import json
import os
import zlib
from collections.abc import Iterator, Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from ..base.written_files import write_text
from .animation import Animation, BodyShape, CableShape, Clip, Mark, Segment, arrays, period
from .decimation import decimated
from .page_arrays import FLOAT_BITS, Packer, power_of_two
from .surfaces import body_reach, surface

FORMAT = 1
POSITION_STEPS = 2**19  # steps of positions across the picture
TURN_STEPS = 2**11  # steps of components of unit vectors
VALUE_STEPS = 2**14  # steps of a quantity up to its largest value
KINDS = {CableShape: "cable", BodyShape: "body", Mark: "mark", Segment: "segment"}
"""Names of the parts of a clip in messages."""


def write_page(animation: Animation, path: str | os.PathLike[str]) -> Path:
    """Write the page of an animation to ``path`` and return that. Raises ResultFileError."""
    return write_text(path, page(animation), "the page")


def page(animation: Animation) -> str:
    """Return the text of a self-contained HTML file that shows ``animation``.

    Raises ValueError if the animation has no clip, or if an array does not fit the others.
    """
    header, packed = described(animation)
    source = files(__package__) / "page_source"
    viewer = (source / "dist" / "viewer.min.js").read_bytes()
    text = (source / "template.html").read_text(encoding="utf-8")
    fields = {
        "title": html.escape(animation.title),
        "licence": (source / "dist" / "three-LICENSE.txt").read_text(encoding="utf-8").replace("--", "- -"),
        "style": (source / "style.css").read_text(encoding="utf-8"),
        "header": json.dumps(header, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"),
        "arrays": packed,
        "viewer": base64.b64encode(zlib.compress(viewer, 9)).decode("ascii"),
    }
    parts = text.split("@@")  # text, name of a field, text, ...
    return "".join(fields[part] if k % 2 else part for k, part in enumerate(parts))


def described(animation: Animation) -> tuple[dict[str, Any], str]:
    """Return the header of a page and the text of its arrays."""
    if not animation.clips:
        raise ValueError("an animation without a clip has nothing to show")
    for clip in animation.clips:
        check(clip)
    low, high = bounds(animation)
    size = float(np.linalg.norm(high - low))
    clips: list[Clip] = []
    notes: list[str] = []
    for clip in animation.clips:
        fewer, said = decimated(clip, size)
        clips.append(fewer)
        notes += [note for note in said if note not in notes]
    packer = _ScenePacker(origin=(low + high) / 2, size=size)
    step = power_of_two(size / POSITION_STEPS)
    header = {
        "format": FORMAT, "title": animation.title, "up": [float(x) for x in animation.up],
        "planar": bool(animation.planar), "arrangement": animation.arrangement, "time_label": animation.time_label,
        "time_unit": animation.time_unit, "origin": packer.origin.tolist(), "low": (low - packer.origin).tolist(),
        "high": (high - packer.origin).tolist(), "clips": [packer.clip(clip) for clip in clips],
        "notes": list(animation.notes),
        "about": [*notes, f"Positions are rounded to {step:.2g} m, quantities along cables to {1 / VALUE_STEPS:.1g} of "
                          f"their largest value, and curves to {FLOAT_BITS} bits, five digits."],
    }
    return {**header, "arrays": packer.descriptions}, packer.text()


def bounds(animation: Animation) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest and the highest coordinates (3,) of the picture in m; of a single point with room around it."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for points in _positions(animation):
        finite = points[np.isfinite(points).all(axis=-1)]
        if len(finite):
            low, high = np.minimum(low, finite.min(axis=0)), np.maximum(high, finite.max(axis=0))
    if not np.isfinite(low).all():
        low, high = np.zeros(3), np.zeros(3)
    return (low, high) if (high > low).any() else (low - 0.5, high + 0.5)  # a single point


def _positions(animation: Animation) -> Iterator[np.ndarray]:
    for clip in animation.clips:
        yield from (cable.position.reshape(-1, 3) for cable in clip.cables)
        yield from (mark.position for mark in clip.marks)
        for segment in clip.segments:
            yield from (segment.start, segment.end)
        for body in clip.bodies:
            reach = body_reach(body)
            yield from (body.position - reach, body.position + reach)


def check(clip: Clip) -> None:
    """Raise ValueError if the shape of an array of a clip does not fit its other arrays."""
    frames = len(clip.time)
    if frames == 0 or not (np.diff(clip.time) >= 0).all():
        raise ValueError(f'clip "{clip.label}": its times must rise, and there must be one at least')
    for part in clip.parts:
        sizes = {"T": frames, "P": len(part.s) if isinstance(part, CableShape) else 0}
        for name, dims, array in arrays(part):
            shape = tuple(sizes[dim] if isinstance(dim, str) else dim for dim in dims)
            stands_still = name == "reference" and array.ndim == len(dims) - 1
            if ((1, *array.shape) if stands_still else array.shape) not in (shape, (1, *shape[1:])):
                raise ValueError(f'clip "{clip.label}": {KINDS[type(part)]} "{part.name}": {name} has the shape '
                                 f"{array.shape}, {shape} is needed")


class _ScenePacker(Packer):
    """Writes the parts of an animation as JSON that names arrays by number."""

    def __init__(self, origin: np.ndarray, size: float) -> None:
        super().__init__()
        self.origin = origin
        self.step = size / POSITION_STEPS

    def clip(self, clip: Clip) -> dict[str, Any]:
        """Return a clip with its arrays replaced by their numbers."""
        frames = len(clip.time)
        return {
            "label": clip.label, "time": self.fine(clip.time), "period": period(clip),
            "exaggerable": is_exaggerable(clip),
            "details": {str(key): str(value) for key, value in clip.details.items()},
            "cables": [self._cable(cable) for cable in clip.cables],
            "bodies": [self._body(body, frames) for body in clip.bodies],
            "marks": [self._mark(mark, clip) for mark in clip.marks],
            "segments": [self._segment(segment, clip) for segment in clip.segments],
            "curves": [{"key": c.key, "label": c.label, "unit": c.unit, "columns": list(c.columns),
                        "time": self.fine(c.time), "values": self.floats(c.values)} for c in clip.curves],
            "events": [{"time": float(e.time), "label": e.label} for e in clip.events],
        }

    def fine(self, values: np.ndarray) -> int:
        """Add times or arc-lengths in steps of 2^-30 of the largest, which keep close values distinct."""
        return self.fixed(values, max(float(np.abs(values).max(initial=0)), 1e-300) * 2.0**-30)

    def points(self, points: np.ndarray) -> int:
        """Add positions in m."""
        return self.fixed(np.asarray(points) - self.origin, self.step)

    def values(self, values: np.ndarray) -> int:
        """Add values in steps of a fraction of the largest."""
        finite = np.abs(values[np.isfinite(values)])
        return self.fixed(values, max(float(finite.max(initial=0)), 1e-30) / VALUE_STEPS)

    def _cable(self, cable: CableShape) -> dict[str, Any]:
        return {
            "name": cable.name, "s": self.fine(cable.s), "section": _plain(cable.section),
            "position": self.points(cable.position), "reference": self.points(cable.reference),
            "section_y": None if cable.section_y is None else self.fixed(cable.section_y, 1 / TURN_STEPS),
            "material_s": None if cable.material_s is None else self.fixed(cable.material_s, self.step),
            "spacing": cable.spacing, "make": cable.make,
            "quantities": [{"key": q.key, "label": q.label, "unit": q.unit, "values": self.values(q.values)}
                           for q in cable.quantities],
        }

    def _body(self, body: BodyShape, frames: int) -> dict[str, Any]:
        shape: dict[str, Any] = dict(body.shape)
        if shape["kind"] == "wheel":
            vertices, triangles = surface(shape)
            shape = {"kind": "mesh", "vertices": vertices, "triangles": triangles, "offset": (0.0, 0.0, 0.0)}
        if shape["kind"] == "mesh":
            shape["vertices"] = self.floats(shape["vertices"])
            shape["triangles"] = self.integers(shape["triangles"])
        return {
            "name": body.name, "shape": _plain(shape), "position": self.points(body.position),
            "orientation": self.floats(body.orientation),
            "reference": self.points(np.reshape(body.reference, (-1, 3))),
            "quantities": [{"label": label, "unit": unit, "values": self.floats(values)}
                           for label, (unit, values) in body.quantities.items()],
        }

    def _mark(self, mark: Mark, clip: Clip) -> dict[str, Any]:
        reference = mark.reference if mark.reference is not None else _start(mark.position, clip)
        return {"name": mark.name, "kind": mark.kind, "detail": mark.detail, "position": self.points(mark.position),
                "reference": self.points(np.reshape(reference, (-1, 3)))}

    def _segment(self, segment: Segment, clip: Clip) -> dict[str, Any]:
        if segment.reference is None:
            references = [_start(segment.start, clip), _start(segment.end, clip)]
        else:
            both = np.reshape(segment.reference, (-1, 2, 3))
            references = [both[:, 0], both[:, 1]]
        return {"name": segment.name, "kind": segment.kind, "start": self.points(segment.start),
                "end": self.points(segment.end), "references": [self.points(r.reshape(-1, 3)) for r in references]}


def _start(position: np.ndarray, clip: Clip) -> np.ndarray:
    return position.mean(axis=0, keepdims=True) if clip.periodic else position[:1]


def is_exaggerable(clip: Clip) -> bool:
    """Return whether a picture with exaggerated displacements is consistent.

    A slide would leave its cable if its motion along it were exaggerated, too: it needs a reference that slides. A rope
    that runs would leave its sheaves.
    """
    sliding = (mark for mark in clip.marks if mark.kind == "slide"
               and (len(clip.time) == 1 or np.ptp(mark.position, axis=0).any()))
    runs = any(cable.material_s is not None for cable in clip.cables)
    return clip.periodic or (not runs and all(mark.reference is not None and mark.reference.ndim == 2
                                              for mark in sliding))


def _plain(mapping: Mapping[str, Any]) -> dict[str, Any]:
    """Return a description with plain numbers and lists, for JSON."""
    def plain(value: Any) -> Any:
        if isinstance(value, np.ndarray | np.generic):
            return value.tolist()
        return [plain(v) for v in value] if isinstance(value, tuple | list) else value

    return {str(key): plain(value) for key, value in mapping.items()}
