"""Files of results: netCDF, the classic format with 64-bit offsets, written row by row.

A row holds all variables at one time. Rows are added behind those that count, then their number in the header is
raised, so that the file is whole at every instant. Format: NetCDF Classic Format Specification, Unidata.
"""

from __future__ import annotations

import os
import struct
import weakref
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

MAGIC = b"CDF\x02"
COUNT_AT = len(MAGIC)
"""Where the number of rows stands in the header, four bytes."""

_DIMENSION, _VARIABLE, _ATTRIBUTE = 10, 11, 12
_CHAR, _INT, _DOUBLE = 2, 4, 6
_TYPES = {1: ">i1", _CHAR: "S1", 3: ">i2", _INT: ">i4", 5: ">f4", _DOUBLE: ">f8"}
_BLOCK = 1 << 22
"""Bytes that are read at once."""


class Variable(NamedTuple):
    """An array with the names of its dimensions, its unit and what it is."""

    dims: tuple[str, ...]
    values: np.ndarray
    units: str
    long_name: str


class Entry(NamedTuple):
    """A variable as the header describes it; `begin` is where it starts, in bytes: in the file, or in a row."""

    dims: tuple[str, ...]
    shape: tuple[int, ...]
    attributes: dict[str, str | np.ndarray]
    dtype: np.dtype
    in_rows: bool
    begin: int


class File:
    """An open file of results; rows are counted from 0, and only `write` and `truncate` change their number."""

    def __init__(self, path: str | os.PathLike, writable: bool = False):
        """Open a file. Raises OSError, ValueError where it is no such file or was cut short."""
        self.path = os.fspath(path)
        self.descriptor = os.open(path, os.O_RDWR if writable else os.O_RDONLY)
        weakref.finalize(self, os.close, self.descriptor)
        size = os.fstat(self.descriptor).st_size
        self.rows, self.attributes, self._report_at, self.entries = self._head(size)
        records = {name: entry for name, entry in self.entries.items() if entry.in_rows}
        self._first = first = min((entry.begin for entry in records.values()), default=size)
        self._row = np.dtype({
            "names": list(records),
            "formats": [(entry.dtype, entry.shape) for entry in records.values()],
            "offsets": [entry.begin - first for entry in records.values()]})
        fixed = [entry.begin + _bytes(entry) for entry in self.entries.values() if not entry.in_rows]
        if max([first + self.rows * self._row.itemsize, *fixed]) > size:
            raise ValueError("the file ends too early")

    def _head(self, size: int) -> tuple[int, dict, tuple[int, int], dict[str, Entry]]:
        length = _BLOCK
        while True:
            try:
                return _parse(os.pread(self.descriptor, length, 0))
            except (struct.error, IndexError, KeyError, OverflowError, UnicodeDecodeError) as error:
                if length >= size:
                    raise ValueError("the header is damaged") from error
            length *= 2

    @property
    def row_bytes(self) -> int:
        """Size of a row."""
        return self._row.itemsize

    def read(self, name: str) -> np.ndarray:
        """All values of a variable, in this machine's order of bytes; texts as str."""
        entry = self.entries[name]
        if not entry.in_rows:
            raw = os.pread(self.descriptor, _bytes(entry), entry.begin)
            values = np.frombuffer(raw, entry.dtype).reshape(entry.shape)
            return _texts(values) if entry.dtype.kind == "S" else values.astype(entry.dtype.newbyteorder("="))
        values = np.empty((self.rows, *entry.shape), entry.dtype.newbyteorder("="))
        for start, block in self._blocks():
            values[start : start + len(block)] = block[name]
        return values

    def _blocks(self) -> Iterator[tuple[int, np.ndarray]]:
        block = np.empty(max(1, _BLOCK // max(1, self.row_bytes)), self._row)
        for start in range(0, self.rows, len(block)):
            part = block[: self.rows - start]
            if os.preadv(self.descriptor, [part.view("u1")], self._first + start * self.row_bytes) != part.nbytes:
                raise OSError(f"{self.path}: was cut short while it was read")
            yield start, part

    def described(self, over_time: bool) -> dict[str, Variable]:
        """The variables over time without their values, or the other ones."""
        return {name: self.variable(name, np.empty((0, *entry.shape)) if over_time else self.read(name))
                for name, entry in self.entries.items() if entry.in_rows == over_time}

    def variable(self, name: str, values: np.ndarray) -> Variable:
        """A variable with its labels."""
        entry = self.entries[name]
        return Variable(entry.dims[: values.ndim], values, entry.attributes["units"], entry.attributes["long_name"])

    def rename(self, path: str | os.PathLike) -> None:
        """Move the file, in the place of another one."""
        os.replace(self.path, path)
        self.path = os.fspath(path)

    def write(self, first: int, values: Mapping[str, np.ndarray]) -> None:
        """Put rows from row `first` on; those behind them go. values: all variables, first axis the rows."""
        (count,) = {len(array) for array in values.values()}
        self._check_follows(first)
        rows = np.empty(count, self._row)
        for name, array in values.items():
            rows[name] = array
        self._put(rows.view("u1"), self._first + first * self.row_bytes)
        self._set_rows(first + count)

    def copy_rows(self, source: File) -> None:
        """Add all rows of a file with the same variables."""
        for start, block in source._blocks():
            self._put(block.view("u1"), self._first + start * self.row_bytes)
        self._set_rows(source.rows)

    def truncate(self, rows: int) -> None:
        """Drop the rows from `rows` on."""
        self._check_follows(rows)
        self._set_rows(rows)

    def add_report(self, text: str) -> bool:
        """Put a new text into the attribute `report`; False where there is no room for it.

        The last line that has an end of line counts: the new one is whole before blanks go over the old one.
        """
        begin, size = self._report_at
        old = self.attributes["report"]
        used = len(old[: old.rfind("\n") + 1].encode())
        line = f"{text}\n".encode()
        if used + len(line) > size:
            return False
        self._put(line + b" " * (size - used - len(line)), begin + used)
        self._put(b" " * used, begin)
        self.attributes["report"] = os.pread(self.descriptor, size, begin).decode()
        return True

    def _check_follows(self, first: int) -> None:
        if not 0 <= first <= self.rows:
            raise ValueError(f"{self.path}: has {self.rows} rows, {first} cannot be the next")

    def _set_rows(self, rows: int) -> None:
        self._put(struct.pack(">i", rows), COUNT_AT)
        self.rows = rows

    def _put(self, data, at: int) -> None:
        left = memoryview(data)
        while len(left):
            done = os.pwrite(self.descriptor, left, at)
            left, at = left[done:], at + done


def last_report(text: str) -> str:
    """The last whole line of the attribute `report`, or all of it where it is not in lines."""
    lines = text.split("\n")
    return (lines[:-1] or lines)[-1]


class Stored(Mapping[str, Variable]):
    """Variables of a file, read when they are asked for and kept then."""

    def __init__(self, file: File, names: list[str]):
        """names: of those variables."""
        self.file, self._names, self._read = file, dict.fromkeys(names), {}

    def __getitem__(self, name: str) -> Variable:
        """A variable with its values."""
        if name not in self._names:
            raise KeyError(name)
        if name not in self._read:
            self._read[name] = self.file.variable(name, self.file.read(name))
        return self._read[name]

    def __contains__(self, name: object) -> bool:
        """Whether there is such a variable."""
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        """Their names."""
        return iter(self._names)

    def __len__(self) -> int:
        """Their number."""
        return len(self._names)


def create(path: str | os.PathLike, coords: Mapping[str, Variable], variables: Mapping[str, Variable],
           attributes: Mapping[str, str | int], report: str, room: int = 0) -> File:
    """A new file, without rows yet; of the variables over time only shapes count.

    attributes: but for the report, for which there is room to grow by so many bytes.
    """
    line = f"{report}\n".encode()
    header = _header(coords | variables, {**attributes, "report": line + b" " * room})
    with open(path, "wb") as file:
        file.write(header)
    return File(path, writable=True)


def _header(variables: dict[str, Variable], attributes: dict) -> bytes:
    """The header, and behind it the variables that are not over time."""
    sizes, entries, fixed = {"time": 0}, {}, {}
    for name, variable in variables.items():
        values, dims = variable.values, variable.dims
        labels = {"units": variable.units, "long_name": variable.long_name}
        if values.dtype.kind == "U":  # characters along one more dimension, as xarray writes them, too
            texts = np.char.encode(values, "utf-8")
            values = texts.view("S1").reshape(*texts.shape, texts.itemsize)
            dims = (*dims, f"string{texts.itemsize}")
            labels["_Encoding"] = "utf-8"
        sizes |= {dim: size for dim, size in zip(dims, values.shape, strict=True) if dim != "time"}
        entries[name] = (dims, labels, _CHAR if values.dtype.kind == "S" else _DOUBLE)
        if dims[:1] != ("time",):
            fixed[name] = _padded(values.astype(_TYPES[entries[name][2]]).tobytes())
    number = {dim: k for k, dim in enumerate(sizes)}
    size = {name: np.dtype(_TYPES[kind]).itemsize * int(np.prod([sizes[d] for d in dims if d != "time"], dtype=int))
            for name, (dims, _, kind) in entries.items()}

    def head(begins: dict[str, int]) -> bytes:
        written = [_text(name) + struct.pack(">i", len(dims)) + b"".join(struct.pack(">i", number[d]) for d in dims)
                   + _attributes(labels)
                   + struct.pack(">iIq", kind, min(-(-size[name] // 4) * 4, 2**32 - 4), begins.get(name, 0))
                   for name, (dims, labels, kind) in entries.items()]
        dimensions = [_text(dim) + struct.pack(">i", length) for dim, length in sizes.items()]
        return (MAGIC + struct.pack(">i", 0) + _list(_DIMENSION, dimensions) + _attributes(attributes)
                + _list(_VARIABLE, written))

    at, begins = len(head({})), {}
    for name in [*fixed, *(name for name in entries if name not in fixed)]:
        begins[name] = at
        at += -(-size[name] // 4) * 4
    return head(begins) + b"".join(fixed.values())


def _padded(data: bytes) -> bytes:
    return data + bytes(-len(data) % 4)


def _text(text: str) -> bytes:
    data = text.encode()
    return struct.pack(">i", len(data)) + _padded(data)


def _list(tag: int, items: list[bytes]) -> bytes:
    return struct.pack(">ii", tag if items else 0, len(items)) + b"".join(items)


def _attributes(attributes: Mapping[str, str | bytes | int]) -> bytes:
    items = []
    for name, value in attributes.items():
        if isinstance(value, int):
            items.append(_text(name) + struct.pack(">iii", _INT, 1, value))
        else:
            data = value if isinstance(value, bytes) else value.encode()
            items.append(_text(name) + struct.pack(">ii", _CHAR, len(data)) + _padded(data))
    return _list(_ATTRIBUTE, items)


def _parse(header: bytes) -> tuple[int, dict, tuple[int, int], dict[str, Entry]]:
    """Number of rows, attributes, place and size of the report, variables. Raises what struct and dicts raise."""
    at = len(MAGIC)
    if header[:at] != MAGIC:
        raise ValueError("it does not begin as the classic format with 64-bit offsets does")

    def ints(count: int = 1) -> tuple[int, ...]:
        nonlocal at
        found = struct.unpack_from(f">{count}i", header, at)
        at += 4 * count
        return found

    def data(size: int) -> bytes:
        nonlocal at
        found = header[at : at + size]
        if size < 0 or len(found) < size:
            raise IndexError
        at += -(-size // 4) * 4
        return found

    def attributes() -> tuple[dict, dict]:
        found, places = {}, {}
        for _ in range(ints(2)[1]):
            name = data(*ints()).decode()
            kind, count = ints(2)
            dtype = np.dtype(_TYPES[kind])
            places[name] = at, count
            value = data(dtype.itemsize * count)
            found[name] = value.decode() if kind == _CHAR else np.frombuffer(value, dtype)
        return found, places

    (rows,) = ints()
    dims = [(data(*ints()).decode(), *ints()) for _ in range(ints(2)[1])]
    general, places = attributes()
    entries = {}
    for _ in range(ints(2)[1]):
        name = data(*ints()).decode()
        along = [dims[k] for k in ints(*ints())]
        labels, _ = attributes()
        kind, _ = ints(2)
        (begin,) = struct.unpack_from(">q", header, at)
        at += 8
        in_rows = bool(along) and along[0][1] == 0
        shape = tuple(size for _, size in along[in_rows:])
        entries[name] = Entry(tuple(dim for dim, _ in along), shape, labels, np.dtype(_TYPES[kind]), in_rows, begin)
    return rows, general, places.get("report", (0, 0)), entries


def _bytes(entry: Entry) -> int:
    return entry.dtype.itemsize * int(np.prod(entry.shape, dtype=int))


def _texts(characters: np.ndarray) -> np.ndarray:
    """(..., n) characters -> (...) str."""
    joined = np.ascontiguousarray(characters).view(f"S{characters.shape[-1]}")[..., 0]
    return np.char.decode(joined, "utf-8")
