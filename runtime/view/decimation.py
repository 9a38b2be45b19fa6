"""Reduction of an animation to the resolution of a screen: frames, stations, rows of curves; with notes on the loss."""

from __future__ import annotations

import heapq
from dataclasses import replace
from typing import Any

import numpy as np

from .animation import CableShape, Clip, Curve, section_sides, taken

MAX_FRAMES = 1000
MAX_STATIONS = 3000  # of one cable
MAX_ROWS = 2000  # of a curve
PIXELS = 2000  # across a large screen
CHORD_ERROR = 0.25  # pixels, in a picture of the whole motion
ZOOM = 5  # resolution of cables much thinner than a pixel, per pixel
COLOUR_STEPS = 128
MIN_COLOUR_RANGE = 1e-3  # over the largest value; main.js has the same
SECTION_TURN = 0.02  # rad between a section's direction and the interpolated one
SAMPLED_FRAMES = 48
BLOCK_FRAMES = 64  # computed together, to limit memory


def decimated(clip: Clip, size: float) -> tuple[Clip, list[str]]:
    """Return the clip at screen resolution, and notes on the loss. ``size``: of the picture in m."""
    clip, notes = _with_fewer_frames(clip)
    cables = []
    for cable in clip.cables:
        fewer, excess = _with_fewer_stations(cable, size)
        cables.append(fewer)
        if excess > 1:
            notes.append(f'Cable "{cable.name}" is drawn at {len(fewer.s)} of its {len(cable.s)} stations; between '
                         f"them the error of the picture is up to {excess:.1f} times that of other cables.")
    drawn, given = (sum(len(cable.s) for cable in group) for group in (cables, clip.cables))
    if drawn < given:
        notes.append(f"Cables are drawn at {drawn} of {given} stations: the others lie within {CHORD_ERROR:g} pixels "
                     f"and 1/{COLOUR_STEPS} of the colour range of the drawn line.")
    curves = tuple(_with_fewer_rows(curve) for curve in clip.curves)
    if any(len(few.time) < len(all_.time) for few, all_ in zip(curves, clip.curves, strict=True)):
        notes.append(f"Long curves have at most {MAX_ROWS} rows; their extremes are kept.")
    return replace(clip, cables=tuple(cables), curves=curves), notes


def even_frames(time: np.ndarray, count: int) -> np.ndarray:
    """Return the numbers of at most ``count`` frames, evenly over time, with the first and the last."""
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
    parts: dict[str, Any] = {kind: tuple(taken(part, "T", frames, given) for part in getattr(clip, kind))
                             for kind in ("cables", "bodies", "marks", "segments")}
    fewer = replace(clip, time=clip.time[frames], **parts)
    return fewer, [f"The picture shows {len(frames)} of {given} frames, evenly over time, and no motion between them."]


def _with_fewer_stations(cable: CableShape, size: float) -> tuple[CableShape, float]:
    """Return the cable at the stations that a screen resolves, and the largest error over the tolerance."""
    pixel = max(size, 1e-300) / PIXELS
    chord = CHORD_ERROR * min(pixel, max(min(section_sides(cable.section)), pixel / ZOOM))
    columns = [cable.position / chord]
    columns += [] if cable.section_y is None else [cable.section_y / SECTION_TURN]
    columns += [] if cable.material_s is None else [cable.material_s[..., None] / chord]
    for quantity in cable.quantities:
        finite = quantity.values[np.isfinite(quantity.values)]
        span = np.ptp(finite) if len(finite) else 0.0
        if span > MIN_COLOUR_RANGE * np.abs(finite).max(initial=0):
            columns.append(np.nan_to_num(quantity.values)[..., None] / (span / COLOUR_STEPS))
    kept, excess = needed_stations(cable.s, columns)
    return taken(cable, "P", kept, len(cable.s)), excess


def needed_stations(s: np.ndarray, columns: list[np.ndarray]) -> tuple[np.ndarray, float]:
    """Return the stations between which all columns are linear in s to within 1, and the largest remaining error.

    s: (P,). columns: arrays (T or 1, P, K) over their tolerances. The station with the largest error is added until no
    error exceeds 1 (Ramer, Douglas and Peucker), first at some frames, then at those with larger errors. No more than
    ``MAX_STATIONS`` are taken.
    """
    n_frames = max(len(column) for column in columns)
    frames = np.unique(np.linspace(0, n_frames - 1, min(SAMPLED_FRAMES, n_frames)).astype(int))
    while True:
        kept = _subdivided(s, [column[frames] if len(column) > 1 else column for column in columns])
        errors = np.zeros(n_frames)
        for column in columns:
            errors = np.maximum(errors, _errors(s, kept, column))
        worst = float(errors.max())
        late = np.setdiff1d(np.flatnonzero(errors > 1), frames)
        if worst <= 1 or len(late) == 0 or len(kept) >= MAX_STATIONS:
            return kept, worst
        frames = np.concatenate([frames, late[np.argsort(errors[late])[-SAMPLED_FRAMES:]]])


def _errors(s: np.ndarray, kept: np.ndarray, column: np.ndarray) -> np.ndarray:
    """Return the largest distance (T,) of a column from its interpolation between the kept stations, by frame."""
    if len(kept) < 2:
        return np.zeros(len(column))
    stations = np.arange(len(s))
    left = np.clip(np.searchsorted(kept, stations, side="right") - 1, 0, len(kept) - 2)
    errors = [_distances(s, column[start: start + BLOCK_FRAMES], kept[left], kept[left + 1], stations).max(axis=1)
              for start in range(0, len(column), BLOCK_FRAMES)]
    return np.concatenate(errors)


def _distances(s: np.ndarray, column: np.ndarray, left: np.ndarray, right: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the distances (T, n) of a column at stations (n,) from the lines between others, (n,) or one pair."""
    length = s[right] - s[left]
    weight = np.where(length > 0, (s[at] - s[left]) / np.where(length > 0, length, 1), 0.0)[:, None]
    line = column[:, left] * (1 - weight) + column[:, right] * weight
    return np.asarray(np.linalg.norm(column[:, at] - line, axis=-1))


def _subdivided(s: np.ndarray, columns: list[np.ndarray]) -> np.ndarray:
    """Return the sorted numbers of the stations that are needed at the given frames."""
    def worst(left: int, right: int) -> tuple[float, int, int, int]:
        inner = np.arange(left + 1, right)
        if len(inner) == 0:
            return (0.0, left, right, left)
        ends = np.array([left]), np.array([right])
        error = np.max([_distances(s, column, *ends, inner).max(axis=0) for column in columns], axis=0)
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
    """Return a curve of at most ``MAX_ROWS`` rows: the extremes in equal groups of rows."""
    rows, values = len(curve.time), curve.values.reshape(len(curve.time), -1)
    if rows <= MAX_ROWS:
        return curve
    groups = max(1, (MAX_ROWS - 2) // (2 * values.shape[1]))
    kept = {0, rows - 1}
    for group in np.array_split(np.arange(rows), groups):
        part = values[group]
        kept.update(group[np.argmin(np.nan_to_num(part, nan=np.inf), axis=0)])
        kept.update(group[np.argmax(np.nan_to_num(part, nan=-np.inf), axis=0)])
    chosen = np.array(sorted(kept))
    return replace(curve, time=curve.time[chosen], values=curve.values[chosen])
