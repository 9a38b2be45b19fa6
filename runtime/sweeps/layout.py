"""The layout of a sweep's file: one row a point, with its parameters, the stored results, and its status."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..errors import SceneError
from ..results.netcdf import ROW_CHECKSUM, File, sealed
from ..results.quantities import Variable
from .parameters import SWEEP, Points
from .stored_points import OF_POINT, TIME, StoredPoint
from .subject import FAILED, Outcome

POINT, ROW = "point", "row"
"""Dimensions: of the points; of output times where each point has its own."""
STATUS, MESSAGE, SECONDS = "status", "message", "seconds"
STATUS_BYTES, MESSAGE_BYTES = 16, 240
WORD_BYTES = 8
"""Rows are checked in words."""


class Slot(NamedTuple):
    """The place of a variable of a point in a row: numbers, or a text of at most `text_bytes` bytes."""

    dims: tuple[str, ...]
    shape: tuple[int, ...]
    units: str
    long_name: str
    text_bytes: int = 0

    @property
    def in_file(self) -> Variable:
        """Return the variable of the file, over points, without values."""
        values = np.empty((0, *self.shape), f"S{self.text_bytes}" if self.text_bytes else float)
        return Variable((POINT, *self.dims), values, self.units or "1", self.long_name)


OF_STATUS = {STATUS: Slot((), (), "1", "how the point's run ended, or failed", STATUS_BYTES),
             MESSAGE: Slot((), (), "1", "error of the point, else notes of its run", MESSAGE_BYTES),
             SECONDS: Slot((), (), "s", "wall time of the point")}
"""Variables of every sweep."""


@dataclass(frozen=True)
class Layout:
    """The contents of a row. parameters, variables: by name; coords: those of the variables' dimensions.

    times: the output times (time,) in s that all points share, or None.
    """

    parameters: Mapping[str, Slot]
    variables: Mapping[str, Slot]
    coords: Mapping[str, Variable]
    times: np.ndarray | None

    @classmethod
    def of(cls, points: Points, units: Mapping[str, str], sampled: Sequence[StoredPoint],
           own_times: int | None) -> Layout:
        """Return the layout of a sweep from the stored results of some points.

        units: of the parameters; own_times: the largest number of output times where points have their own, else None.
        A coordinate that differs among the points, such as the arc-length of a cable's nodes where its length is swept,
        becomes a variable of each. Raises SceneError for a name that is taken.
        """
        stored = sampled[0].with_own_coords(_differing(sampled))
        parameters = {name: _parameter(values, units.get(name, "")) for name, values in points.columns.items()}
        variables = {}
        if stored.time is not None and own_times is not None:
            variables[TIME] = Slot((ROW,), (own_times,), "s", "output time")
        for name, each in stored.variables.items():
            dims, shape = each.dims, each.values.shape
            if own_times is not None and dims[:1] == (TIME,):
                dims, shape = (ROW, *dims[1:]), (own_times, *shape[1:])
            variables[name] = Slot(dims, shape, each.units, each.long_name)
        taken = {POINT, TIME, *OF_STATUS, *((ROW,) if own_times is not None else ()), *stored.coords}
        for name in (*parameters, *stored.variables):
            if name in taken:
                raise SceneError(SWEEP, f'the name "{name}" is taken by the dataset of a sweep', "give another one")
            if name in parameters and name in stored.variables:
                raise SceneError(SWEEP, f'"{name}" is a parameter, and kept as a result, too',
                                 f'keep it by another name: keep={{"kept": "{name}", ...}}')
        shared = None if own_times is not None else stored.time
        coords = stored.coords if shared is None else stored.coords | {TIME: Variable((TIME,), shared, "s", "time")}
        return cls(parameters, variables, coords, shared)

    @classmethod
    def in_file(cls, file: File, parameters: Sequence[str]) -> Layout:
        """Return the layout of a sweep's file."""
        slots = {}
        for name, entry in file.entries.items():
            if entry.in_rows:
                units, long_name = (str(entry.attributes.get(label, "")) for label in ("units", "long_name"))
                text = entry.dtype.kind == "S"
                slots[name] = Slot(() if text else entry.dims[1:], () if text else entry.shape, units, long_name,
                                   entry.shape[0] if text else 0)
        coords = {name: file.variable(name, file.read(name)) for name in file.entries if name not in slots}
        times = coords[TIME].values if TIME in coords else None
        own = (*OF_STATUS, ROW_CHECKSUM, *parameters)
        variables = {name: slot for name, slot in slots.items() if name not in own}
        return cls({name: slots[name] for name in parameters}, variables, coords, times)

    @property
    def row_bytes(self) -> int:
        """Return the bytes of a point, without those that align it in the file."""
        slots = [*self.parameters.values(), *self.variables.values()]
        return sum(each.text_bytes or 8 * math.prod(each.shape) for each in slots) + 16 + STATUS_BYTES + MESSAGE_BYTES

    def for_file(self) -> dict[str, Variable]:
        """Return the variables of the file, over points, without values."""
        return {name: each.in_file for name, each in {**self.parameters, **self.variables, **OF_STATUS}.items()}

    def pack(self, dtype: np.dtype, values: Mapping[str, np.ndarray], outcomes: Sequence[Outcome]) -> np.ndarray:
        """Return sealed rows (n,) of the file's type; values: (n,) of each parameter."""
        rows = np.zeros(len(outcomes), dtype)
        for name, column in values.items():
            if column.dtype.kind == "U":
                size = dtype[name].shape[0]
                column = np.char.encode(column, "utf-8").astype(f"S{size}").view("S1").reshape(len(column), size)
            rows[name] = column
        own_coords = [name.removesuffix(OF_POINT) for name in self.variables if name.endswith(OF_POINT)]
        for k, outcome in enumerate(outcomes):
            status, message = outcome.status, outcome.message
            stored = None if outcome.stored is None else outcome.stored.with_own_coords(own_coords)
            complaint = None if stored is None else self._complaint(stored)
            if complaint is not None:
                status, message, stored = FAILED, complaint, None
            for name, each in self.variables.items():
                found = np.nan if stored is None else stored.time if name == TIME else stored.variables[name].values
                if each.dims[:1] == (ROW,):
                    rows[name][k] = np.nan  # behind the last output time of the point
                    if stored is not None:
                        rows[name][k][: len(np.asarray(found))] = found
                else:
                    rows[name][k] = found
            rows[STATUS][k], rows[MESSAGE][k] = _text(status, STATUS_BYTES), _text(message, MESSAGE_BYTES)
            rows[SECONDS][k] = outcome.seconds
        return sealed(rows)

    @staticmethod
    def failures(rows: np.ndarray) -> int:
        """Return the number of these rows (n,) whose points failed."""
        return int(np.sum(np.all(rows[STATUS] == _text(FAILED, STATUS_BYTES), axis=1)))

    def _complaint(self, stored: StoredPoint) -> str | None:
        """Return why a point does not fit in a row, None where it does."""
        for name, each in self.variables.items():
            if name != TIME and (complaint := _misfit(name, each, stored)) is not None:
                return f"{SWEEP}: {complaint}"
        for name in stored.variables:
            if name not in self.variables:
                return f'{SWEEP}: the point has "{name}", which the first points had not'
        for name, coordinate in self.coords.items():
            here = stored.coords.get(name)
            if name != TIME and (here is None or not np.array_equal(coordinate.values, here.values)):
                return f'{SWEEP}: the point has another "{name}" than the first points; sweep in parts'
        if self.times is not None and (stored.time is None or not np.array_equal(self.times, stored.time)):
            return f"{SWEEP}: the point has other output times than the first ones; give all the same"
        return None


def _misfit(name: str, each: Slot, stored: StoredPoint) -> str | None:
    """Return why a variable of a point does not fit in its place, None where it does."""
    if name not in stored.variables:
        return f'the point has no "{name}", which the first points had'
    dims, shape, room = stored.variables[name].dims, stored.variables[name].values.shape, each.shape
    over_rows = each.dims[:1] == (ROW,)
    if dims != tuple(TIME if dim == ROW else dim for dim in each.dims):
        return (f'"{name}" is over {", ".join(dims) or "nothing"} here, and over {", ".join(each.dims) or "nothing"} '
                "at the first points")
    if shape[over_rows:] != room[over_rows:] or len(shape) != len(room):
        return f'"{name}" has the shape {shape} here, and {room} at the first points; keep results of one shape, or ' \
               "sweep in parts"
    if over_rows and shape[0] > room[0]:
        return f"the point has {shape[0]} output times, and the first ones had at most {room[0]}"
    return None


def _differing(sampled: Sequence[StoredPoint]) -> list[str]:
    """Return the dimensions whose coordinates are equally many numbers at all points, but not the same."""
    first = sampled[0].coords
    return [name for name, variable in first.items() if variable.values.dtype.kind == "f" and any(
        name in each.coords and each.coords[name].values.shape == variable.values.shape
        and not np.array_equal(each.coords[name].values, variable.values) for each in sampled)]


def _parameter(values: np.ndarray, unit: str) -> Slot:
    """Return a parameter of one point: a number, or the bytes of its longest text, in whole words."""
    if values.dtype.kind != "U":
        return Slot((), (), unit, "parameter")
    longest = max(len(text.encode()) for text in values.tolist())
    return Slot((), (), unit, "parameter", max(WORD_BYTES, -(-longest // WORD_BYTES) * WORD_BYTES))


def _text(text: str, size: int) -> np.ndarray:
    """Return a text as characters (size,); a longer one ends with dots."""
    data = text.replace("\0", " ").encode()
    if len(data) > size:
        data = data[: size - 3].decode(errors="ignore").encode() + b"..."
    return np.frombuffer(data.ljust(size, b"\0"), "S1")
