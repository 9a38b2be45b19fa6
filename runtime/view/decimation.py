"""What a screen shows of an animation: at most so many frames, stations and rows, with what was left out in words."""

from __future__ import annotations

import heapq
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from .animation import BodyShape, CableShape, Clip, Curve, Mark, Segment

MAX_FRAMES = 1000
MAX_STATIONS = 3000  # of one cable
MAX_ROWS = 2000  # of a curve
PIXELS = 2000  # across a large screen
CHORD_ERROR = 0.25  # pixels, where the picture shows the whole motion
ZOOM = 5  # cables much thinner than a pixel are followed so much closer
COLOUR_STEPS = 128
LEAST_RANGE = 1e-3  # of colours, in parts of the largest value: main.js has the same
SECTION_TURN = 0.02  # rad between a section's direction and the one interpolated
SAMPLED_FRAMES = 48


def decimated(clip: Clip, size: float) -> tuple[Clip, list[str]]:
    """Return the clip as a screen shows it, and sentences that say what was left out. ``size``: of the picture in m."""
    clip, notes = _with_fewer_frames(clip)
    cables = []
    for cable in clip.cables:
        fewer, excess = _with_fewer_stations(cable, size)
        cables.append(fewer)
        if excess > 1:
            notes.append(f'Cable "{cable.name}" is drawn at {len(fewer.s)} of its {len(cable.s)} stations; between '
                         f"them the picture is up to {excess:.1f} times as far off as elsewhere.")
    drawn, given = (sum(len(cable.s) for cable in group) for group in (cables, clip.cables))
    if drawn < given:
        notes.append(f"Cables are drawn at {drawn} of {given} stations: the others lie within {CHORD_ERROR:g} pixels "
                     f"and 1/{COLOUR_STEPS} of the colour range of what is drawn.")
    curves = tuple(_with_fewer_rows(curve) for curve in clip.curves)
    if any(len(few.time) < len(all_.time) for few, all_ in zip(curves, clip.curves, strict=True)):
        notes.append(f"Long curves have at most {MAX_ROWS} rows; their extremes are kept.")
    return replace(clip, cables=tuple(cables), curves=curves), notes


def even_frames(time: np.ndarray, count: int) -> np.ndarray:
    """Return the numbers of at most ``count`` frames, evenly over time; the first and the last are among them."""
    if len(time) <= count:
        return np.arange(len(time))
    wanted = np.linspace(time[0], time[-1], count)
    after = np.clip(np.searchsorted(time, wanted), 1, len(time) - 1)
    nearest = after - (wanted - time[after - 1] <= time[after] - wanted)
    return np.unique(np.concatenate([[0], nearest, [len(time) - 1]]))


def _with_fewer_frames(clip: Clip) -> tuple[Clip, list[str]]:
    frames = even_frames(clip.time, MAX_FRAMES)
    given = len(clip.time)
    if len(frames) == given:
        return clip, []

    def at(array: np.ndarray) -> np.ndarray:
        return array[frames] if len(array) == given else array

    def moving(reference: np.ndarray, dimensions: int) -> np.ndarray:
        return at(reference) if np.ndim(reference) == dimensions else reference

    def cable(c: CableShape) -> CableShape:
        return replace(c, position=at(c.position), section_y=None if c.section_y is None else at(c.section_y),
                       quantities=tuple(replace(q, values=at(q.values)) for q in c.quantities))

    def body(b: BodyShape) -> BodyShape:
        return replace(b, position=at(b.position), orientation=at(b.orientation), reference=moving(b.reference, 2),
                       quantities={key: (unit, at(values)) for key, (unit, values) in b.quantities.items()})

    def mark(m: Mark) -> Mark:
        return replace(m, position=at(m.position), reference=None if m.reference is None else moving(m.reference, 2))

    def segment(s: Segment) -> Segment:
        return replace(s, start=at(s.start), end=at(s.end),
                       reference=None if s.reference is None else moving(s.reference, 3))

    fewer = replace(clip, time=clip.time[frames], cables=tuple(map(cable, clip.cables)),
                    bodies=tuple(map(body, clip.bodies)), marks=tuple(map(mark, clip.marks)),
                    segments=tuple(map(segment, clip.segments)))
    return fewer, [f"The picture shows {len(frames)} of {given} frames, evenly over time; motion between them is not "
                   "seen."]


def section_size(section: Mapping[str, Any]) -> float:
    """Return the smaller side or the diameter of a cable's section in m."""
    if section["shape"] == "rectangle":
        return float(min(section["height"], section["width"]))
    return float(section["diameter"] if "diameter" in section else section["size"])


def _with_fewer_stations(cable: CableShape, size: float) -> tuple[CableShape, float]:
    """Return the cable at the stations that a screen needs, and the largest error in units of what is allowed."""
    pixel = max(size, 1e-300) / PIXELS
    chord = CHORD_ERROR * min(pixel, max(section_size(cable.section), pixel / ZOOM))
    columns = [cable.position / chord]
    columns += [] if cable.section_y is None else [cable.section_y / SECTION_TURN]
    for quantity in cable.quantities:
        finite = quantity.values[np.isfinite(quantity.values)]
        span = np.ptp(finite) if len(finite) else 0.0
        if span > LEAST_RANGE * np.abs(finite).max(initial=0):
            columns.append(np.nan_to_num(quantity.values)[..., None] / (span / COLOUR_STEPS))
    kept, excess = needed_stations(cable.s, columns)

    def at(array: np.ndarray) -> np.ndarray:
        return array[:, kept]

    return replace(
        cable, s=cable.s[kept], position=at(cable.position),
        section_y=None if cable.section_y is None else at(cable.section_y), reference=cable.reference[kept],
        quantities=tuple(replace(q, values=at(q.values)) for q in cable.quantities)), excess


def needed_stations(s: np.ndarray, columns: list[np.ndarray]) -> tuple[np.ndarray, float]:
    """Return the stations between which everything is linear in s to within 1, and the largest error that remains.

    s: (P,). columns: arrays (T or 1, P, K), in units of what is allowed. The station that is farthest off is added
    until none is off (Ramer, Douglas and Peucker), first at some frames, then at those where others are off. No more
    than ``MAX_STATIONS`` are taken.
    """
    most = max(len(column) for column in columns)
    frames = np.unique(np.linspace(0, most - 1, min(SAMPLED_FRAMES, most)).astype(int))
    while True:
        sampled = [column[frames] if len(column) > 1 else column for column in columns]
        kept = _subdivided(s, sampled)
        errors = np.zeros(most)
        for column in columns:
            errors = np.maximum(errors, _errors(s, kept, column))
        worst = float(errors.max())
        late = np.setdiff1d(np.flatnonzero(errors > 1), frames)
        if worst <= 1 or len(late) == 0 or len(kept) >= MAX_STATIONS:
            return kept, worst
        frames = np.concatenate([frames, late[np.argsort(errors[late])[-SAMPLED_FRAMES:]]])


def _errors(s: np.ndarray, kept: np.ndarray, column: np.ndarray) -> np.ndarray:
    """Return (T,): how far a column is from its interpolation between the kept stations, at most, in each frame."""
    if len(kept) < 2:
        return np.zeros(len(column))
    left = np.clip(np.searchsorted(kept, np.arange(len(s)), side="right") - 1, 0, len(kept) - 2)
    weight = _weights(s, kept[left], kept[left + 1], np.arange(len(s)))[:, None]
    worst = np.zeros(len(column))
    for start in range(0, len(column), 64):  # blocks: all frames at once would take too much memory
        part = column[start: start + 64]
        line = part[:, kept[left]] * (1 - weight) + part[:, kept[left + 1]] * weight
        worst[start: start + 64] = np.linalg.norm(part - line, axis=-1).max(axis=1)
    return worst


def _weights(s: np.ndarray, left: np.ndarray | int, right: np.ndarray | int, at: np.ndarray) -> np.ndarray:
    length = s[right] - s[left]
    return np.where(length > 0, (s[at] - s[left]) / np.where(length > 0, length, 1), 0.0)


def _subdivided(s: np.ndarray, columns: list[np.ndarray]) -> np.ndarray:
    """Return the sorted numbers of the stations that are needed at the given frames."""
    def worst(left: int, right: int) -> tuple[float, int, int, int]:
        inner = np.arange(left + 1, right)
        if len(inner) == 0:
            return (0.0, left, right, left)
        weight = _weights(s, left, right, inner)[:, None]
        error = np.zeros(len(inner))
        for column in columns:
            line = column[:, left, None] * (1 - weight) + column[:, right, None] * weight
            error = np.maximum(error, np.linalg.norm(column[:, inner] - line, axis=-1).max(axis=0))
        farthest = int(error.argmax())
        return (-float(error[farthest]), left, right, int(inner[farthest]))

    if len(s) < 2:
        return np.arange(len(s))
    kept = {0, len(s) - 1}
    queue = [worst(0, len(s) - 1)]
    while queue and queue[0][0] < -1 and len(kept) < MAX_STATIONS:
        _, left, right, middle = heapq.heappop(queue)
        kept.add(middle)
        heapq.heappush(queue, worst(left, middle))
        heapq.heappush(queue, worst(middle, right))
    return np.array(sorted(kept))


def _with_fewer_rows(curve: Curve) -> Curve:
    """Return the curve with its extremes in equal stretches of rows, if it has more than ``MAX_ROWS``."""
    rows, values = len(curve.time), curve.values.reshape(len(curve.time), -1)
    if rows <= MAX_ROWS:
        return curve
    stretches = max(1, (MAX_ROWS - 2) // (2 * values.shape[1]))
    kept = {0, rows - 1}
    for stretch in np.array_split(np.arange(rows), stretches):
        part = values[stretch]
        kept.update(stretch[np.argmin(np.nan_to_num(part, nan=np.inf), axis=0)])
        kept.update(stretch[np.argmax(np.nan_to_num(part, nan=-np.inf), axis=0)])
    chosen = np.array(sorted(kept))
    return replace(curve, time=curve.time[chosen], values=curve.values[chosen])
