"""How the points of a sweep lie in its file: one row a point, with its parameters, what is kept of it, and how it went.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..errors import SceneError
from ..results.netcdf import ROW_CHECKSUM, File, sealed
from ..results.netcdf_header import Entry
from ..results.quantities import Variable
from .parameters import SWEEP, Points
from .points import FAILED, Outcome
from .stored_points import TIME, Kept

POINT, ROW = "point", "row"
"""Dimensions: of the points; of output times where each point has its own."""
STATUS, MESSAGE, SECONDS = "status", "message", "seconds"
OF_POINT = ".of_point"
"""Behind the name of a coordinate that each point has as a variable."""
STATUS_BYTES, MESSAGE_BYTES = 16, 240
WORD = 8
"""Rows are checked in words of so many bytes."""


class Slot(NamedTuple):
    """What one variable of a point takes of a row: numbers, or a text of so many bytes."""

    dims: tuple[str, ...]
    shape: tuple[int, ...]
    units: str
    long_name: str
    text_bytes: int = 0


@dataclass(frozen=True)
class Layout:
    """What a row holds. parameters, variables: by name; coords: those of the variables' dimensions.

    times: the output times (time,) in s that all points share, or None.
    """

    parameters: Mapping[str, Slot]
    variables: Mapping[str, Slot]
    coords: Mapping[str, Variable]
    times: np.ndarray | None

    @classmethod
    def of(cls, points: Points, units: Mapping[str, str], sampled: Sequence[Kept], own_times: int | None) -> Layout:
        """Return the layout of a sweep from what is kept of some of its points.

        units: of the parameters; own_times: the largest number of output times where points have their own, else None.
        A coordinate that differs among the points, such as the arc-length of a cable's nodes where its length is swept,
        becomes a variable of each. Raises SceneError where names meet.
        """
        kept = _with_own_coords(sampled[0], _differing(sampled))
        parameters = {name: _parameter(values, units.get(name, "")) for name, values in points.columns.items()}
        _check_names(parameters, kept, own_times)
        variables = {name: Slot(_dims(each.dims, own_times), _shape(each, own_times), each.units, each.long_name)
                     for name, each in kept.variables.items()}
        if kept.time is not None and own_times is not None:
            variables = {TIME: Slot((ROW,), (own_times,), "s", "output time"), **variables}
        shared = None if own_times is not None else kept.time
        coords = dict(kept.coords)
        if shared is not None:
            coords[TIME] = Variable((TIME,), shared, "s", "time")
        return cls(parameters, variables, coords, shared)

    @property
    def row_bytes(self) -> int:
        """Return the bytes of a point, but for what the file aligns."""
        slots = [*self.parameters.values(), *self.variables.values()]
        return sum(each.text_bytes or 8 * math.prod(each.shape) for each in slots) + 16 + STATUS_BYTES + MESSAGE_BYTES

    def for_file(self) -> dict[str, Variable]:
        """Return the variables of the file, over points, without values."""
        own = {STATUS: Slot((), (), "1", "how the point's run ended, or failed", STATUS_BYTES),
               MESSAGE: Slot((), (), "1", "why the point failed, else what its run noted", MESSAGE_BYTES),
               SECONDS: Slot((), (), "s", "wall time of the point")}
        return {name: _over_points(each) for name, each in {**self.parameters, **self.variables, **own}.items()}

    def pack(self, dtype: np.dtype, values: Mapping[str, np.ndarray], outcomes: Sequence[Outcome]) -> np.ndarray:
        """Return sealed rows (n,) of the file's type; values: (n,) of each parameter."""
        rows = np.zeros(len(outcomes), dtype)
        for name, column in values.items():
            rows[name] = _characters(column, dtype[name].shape) if column.dtype.kind == "U" else column
        for k, outcome in enumerate(outcomes):
            status, message = outcome.status, outcome.message
            kept = None if outcome.kept is None else _with_own_coords(outcome.kept, self._own_coords)
            complaint = None if kept is None else self._complaint(kept)
            if complaint is not None:
                status, message, kept = FAILED, complaint, None
            for name, each in self.variables.items():
                rows[name][k] = np.nan if kept is None else self._fitted(name, each, kept)
            rows[STATUS][k], rows[MESSAGE][k] = _text(status, STATUS_BYTES), _text(message, MESSAGE_BYTES)
            rows[SECONDS][k] = outcome.seconds
        return sealed(rows)

    @staticmethod
    def failures(rows: np.ndarray) -> int:
        """Return how many of these rows (n,) are of points that failed."""
        return int(np.sum(np.all(rows[STATUS] == _text(FAILED, STATUS_BYTES), axis=1)))

    @classmethod
    def in_file(cls, file: File, parameters: Sequence[str]) -> Layout:
        """Return the layout of a sweep's file."""
        slots = {name: _slot(entry) for name, entry in file.entries.items() if entry.in_rows}
        coords = {name: file.variable(name, file.read(name)) for name in file.entries if name not in slots}
        times = coords[TIME].values if TIME in coords else None
        own = (STATUS, MESSAGE, SECONDS, ROW_CHECKSUM, *parameters)
        variables = {name: slot for name, slot in slots.items() if name not in own}
        return cls({name: slots[name] for name in parameters}, variables, coords, times)

    @property
    def _own_coords(self) -> list[str]:
        """Return the dimensions whose coordinates each point has as a variable."""
        return [name.removesuffix(OF_POINT) for name in self.variables if name.endswith(OF_POINT)]

    def _complaint(self, kept: Kept) -> str | None:
        """Return why a point does not fit in a row, None where it does."""
        for name, each in self.variables.items():
            if name != TIME and (complaint := self._complaint_of(name, each, kept)) is not None:
                return complaint
        for name in kept.variables:
            if name not in self.variables:
                return f'{SWEEP}: the point has "{name}", which the first points had not'
        for name, coordinate in self.coords.items():
            here = kept.coords.get(name)
            if name != TIME and (here is None or not np.array_equal(coordinate.values, here.values)):
                return f'{SWEEP}: the point has another "{name}" than the first points; sweep in parts'
        if self.times is not None and (kept.time is None or not np.array_equal(self.times, kept.time)):
            return f"{SWEEP}: the point has other output times than the first ones; give all the same"
        return None

    @staticmethod
    def _complaint_of(name: str, each: Slot, kept: Kept) -> str | None:
        """Return why a variable of a point does not fit in its place, None where it does."""
        if name not in kept.variables:
            return f'{SWEEP}: the point has no "{name}", which the first points had'
        shape, room = kept.variables[name].values.shape, each.shape
        over_rows = each.dims[:1] == (ROW,)
        if kept.variables[name].dims != tuple(TIME if dim == ROW else dim for dim in each.dims):
            return (f'{SWEEP}: "{name}" is over {", ".join(kept.variables[name].dims) or "nothing"} here, and over '
                    f'{", ".join(each.dims) or "nothing"} at the first points')
        if shape[over_rows:] != room[over_rows:] or len(shape) != len(room):
            return (f'{SWEEP}: "{name}" has the shape {shape} here, and {room} at the first points; keep what has one '
                    "shape, or sweep in parts")
        if over_rows and shape[0] > room[0]:
            return f"{SWEEP}: the point has {shape[0]} output times, and the first ones had at most {room[0]}"
        return None

    def _fitted(self, name: str, each: Slot, kept: Kept) -> np.ndarray:
        """Return the values of a point, with NaN behind its last output time where points have their own."""
        found = kept.time if name == TIME else kept.variables[name].values
        assert found is not None, "the points have output times"
        if each.dims[:1] != (ROW,):
            return found
        values = np.full(each.shape, np.nan)
        values[: len(found)] = found
        return values


def _differing(sampled: Sequence[Kept]) -> list[str]:
    """Return the dimensions whose coordinates are numbers, as many at all points, but not the same."""
    first = sampled[0].coords
    return [name for name, variable in first.items() if variable.values.dtype.kind == "f" and any(
        name in each.coords and each.coords[name].values.shape == variable.values.shape
        and not np.array_equal(each.coords[name].values, variable.values) for each in sampled)]


def _with_own_coords(kept: Kept, names: Sequence[str]) -> Kept:
    """Return what is kept of a point with coordinates of these dimensions as variables."""
    if not names:
        return kept
    own = {f"{name}{OF_POINT}": kept.coords[name] for name in names if name in kept.coords}
    others = {name: each for name, each in kept.coords.items() if name not in names}
    return Kept({**kept.variables, **own}, others, kept.time)


def _parameter(values: np.ndarray, unit: str) -> Slot:
    """Return a parameter of one point: a number, or as many bytes as its longest text has, in whole words."""
    longest = max(len(text.encode()) for text in values.tolist()) if values.dtype.kind == "U" else 0
    text_bytes = max(WORD, -(-longest // WORD) * WORD) if values.dtype.kind == "U" else 0
    return Slot((), (), unit, "parameter", text_bytes)


def _dims(dims: tuple[str, ...], own_times: int | None) -> tuple[str, ...]:
    return dims if own_times is None else tuple(ROW if dim == TIME else dim for dim in dims)


def _shape(variable: Variable, own_times: int | None) -> tuple[int, ...]:
    """Return the shape that a variable of a point has in a row."""
    shape = variable.values.shape
    return (own_times, *shape[1:]) if own_times is not None and variable.dims[:1] == (TIME,) else shape


def _over_points(slot: Slot) -> Variable:
    """Return a variable of the file for one of a point, without values."""
    values = np.empty((0, *slot.shape), f"S{slot.text_bytes}" if slot.text_bytes else float)
    return Variable((POINT, *slot.dims), values, slot.units or "1", slot.long_name)


def _check_names(parameters: Mapping[str, Any], kept: Kept, own_times: int | None) -> None:
    """Refuse names that the dataset would have twice. Raises SceneError."""
    own = {POINT, STATUS, MESSAGE, SECONDS, TIME, *((ROW,) if own_times is not None else ())}
    for name in (*parameters, *kept.variables):
        if name in own or name in kept.coords:
            raise SceneError(SWEEP, f'the name "{name}" is taken by the dataset of a sweep', "give another one")
    for name in parameters:
        if name in kept.variables:
            raise SceneError(SWEEP, f'"{name}" is a parameter, and kept as a result, too',
                             f'keep it by another name: keep={{"kept": "{name}", ...}}')


def _slot(entry: Entry) -> Slot:
    """Return the slot that a variable of a file is."""
    units, long_name = (str(entry.attributes.get(label, "")) for label in ("units", "long_name"))
    if entry.dtype.kind == "S":
        return Slot((), (), units, long_name, entry.shape[0])
    return Slot(entry.dims[1:], entry.shape, units, long_name)


def _text(text: str, size: int) -> np.ndarray:
    """Return a text as characters (size,); the end of a longer one is left out, and dots say so."""
    data = text.replace("\0", " ").encode()
    if len(data) > size:
        data = data[: size - 3].decode(errors="ignore").encode() + b"..."
    return np.frombuffer(data.ljust(size, b"\0"), "S1")


def _characters(texts: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Return texts (n,) as characters (n, size)."""
    return np.char.encode(texts, "utf-8").astype(f"S{shape[0]}").view("S1").reshape(len(texts), shape[0])
