"""Files of results: netCDF, the classic format with 64-bit offsets, written row by row.

A row holds all variables at one time (of a sweep: at one point), and last its checksum. Rows are added behind those
that count, then their number in the header is raised, so that the file is whole at every instant. The header has a
checksum, too, which leaves out what changes while the file grows: the number of rows and the report, whose lines have
their own. All are ordinary variables and attributes for other readers. Format: NetCDF Classic Format Specification,
Unidata.
"""

from __future__ import annotations

import os
import struct
import weakref
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..base.operating_system import BYTES, read_at, read_into, write_at
from .checksums import row_checksums
from .locks import created
from .netcdf_header import (
    COUNT_AT,
    HEADER_CHECKSUM,
    NOT_YET,
    Entry,
    header_checksum,
    header_of,
    parsed,
    report_line,
    size_of,
)
from .quantities import Variable

_BLOCK = 1 << 22
"""Bytes that are read at once."""
MOST_HEADER, MOST_ROW = 1 << 28, 1 << 31
"""Bytes that a header and a row may have."""

ROW_CHECKSUM = "row_checksum"
class File:
    """An open file of results; rows are counted from 0, and only `write` and `truncate` change their number."""

    def __init__(self, path: str | os.PathLike, writable: bool = False, descriptor: int | None = None):
        """Open a file, or take over its descriptor.

        Raises OSError, ValueError where it is no such file, was cut short or has a damaged header.
        """
        self.path = os.fspath(path)
        if descriptor is None:
            descriptor = os.open(path, (os.O_RDWR if writable else os.O_RDONLY) | BYTES)
        self.descriptor = descriptor
        self.close = weakref.finalize(self, os.close, self.descriptor)
        try:
            self._look()
        except BaseException:
            self.close()
            raise

    def _look(self) -> None:
        """Read the header and what follows from it. Raises OSError, ValueError."""
        size = os.fstat(self.descriptor).st_size
        self.rows, self.attributes, places, self.entries = self._head(size)
        self._report_at = places.get("report", (0, 0))
        records = {name: entry for name, entry in self.entries.items() if entry.in_rows}
        self._first = first = min((entry.begin for entry in records.values()), default=size)
        row_bytes = max((entry.begin + size_of(entry) - first for entry in records.values()), default=0)
        ends = [entry.begin + size_of(entry) for entry in self.entries.values() if not entry.in_rows]
        if row_bytes > MOST_ROW or max([first + self.rows * row_bytes, *ends]) > size:
            raise ValueError("the file ends too early")
        self._row = np.dtype({
            "names": list(records),
            "formats": [(entry.dtype, entry.shape) for entry in records.values()],
            "offsets": [entry.begin - first for entry in records.values()]})
        self.left_out = np.zeros(0, int)
        self.has_checksums = ROW_CHECKSUM in records and HEADER_CHECKSUM in places
        if HEADER_CHECKSUM in places:
            head = read_at(self.descriptor, min(first, MOST_HEADER), 0)
            if header_checksum(head, places) != self.attributes[HEADER_CHECKSUM]:
                raise ValueError("the header is damaged: it has another checksum")

    def _head(self, size: int) -> tuple[int, dict, dict[str, tuple[int, int]], dict[str, Entry]]:
        length = _BLOCK
        while True:
            try:
                return parsed(read_at(self.descriptor, length, 0))
            except (struct.error, IndexError, KeyError, OverflowError, UnicodeDecodeError) as error:
                if length >= min(size, MOST_HEADER):
                    raise ValueError("the header is damaged") from error
            length *= 2

    @property
    def row_bytes(self) -> int:
        """Return the size of a row."""
        return self._row.itemsize

    @property
    def row_dtype(self) -> np.dtype:
        """Return the type of a row as it stands in the file, its checksum with it."""
        return self._row

    @property
    def first_row_at(self) -> int:
        """Return where the rows begin, in bytes."""
        return self._first

    def read(self, name: str) -> np.ndarray:
        """Return all values of a variable, in this machine's order of bytes, texts as str; without rows that are left
        out.
        """
        entry = self.entries[name]
        if not entry.in_rows:
            raw = read_at(self.descriptor, size_of(entry), entry.begin)
            values = np.frombuffer(raw, entry.dtype).reshape(entry.shape)
            return _texts(values) if entry.dtype.kind == "S" else values.astype(entry.dtype.newbyteorder("="))
        values = np.empty((self.rows - len(self.left_out), *entry.shape), entry.dtype.newbyteorder("="))
        at = 0
        for block in self._kept_blocks():
            values[at : at + len(block)] = block[name]
            at += len(block)
        return values

    def damaged_rows(self, rows: int | None = None) -> np.ndarray:
        """Return the numbers of the rows, of all or of so many, whose checksum is not theirs. Raises OSError."""
        damaged = [np.zeros(0, int)]
        for start, block in self.blocks(self.rows if rows is None else rows):
            damaged.append(start + np.flatnonzero(block[ROW_CHECKSUM] != _checksums(block)))
        return np.concatenate(damaged)

    def blocks(self, rows: int) -> Iterator[tuple[int, np.ndarray]]:
        """Yield the first rows, as many as are asked for, in blocks, each with the number of its first row."""
        if not rows:
            return
        block = np.empty(min(rows, max(1, _BLOCK // max(1, self.row_bytes))), self._row)
        for start in range(0, rows, len(block)):
            part = block[: rows - start]
            at = self._first + start * self.row_bytes
            if read_into(self.descriptor, memoryview(part.view("u1").data), at) != part.nbytes:
                raise OSError(f"{self.path}: was cut short while it was read")
            yield start, part

    def _kept_blocks(self) -> Iterator[np.ndarray]:
        """Yield blocks of rows that are not left out."""
        for start, block in self.blocks(self.rows):
            gone = self.left_out[(self.left_out >= start) & (self.left_out < start + len(block))] - start
            yield np.delete(block, gone) if len(gone) else block

    def described(self, over_time: bool) -> dict[str, Variable]:
        """Return the variables over time without their values, or the other ones."""
        return {name: self.variable(name, np.empty((0, *entry.shape)) if over_time else self.read(name))
                for name, entry in self.entries.items() if entry.in_rows == over_time and name != ROW_CHECKSUM}

    def variable(self, name: str, values: np.ndarray) -> Variable:
        """Return a variable with its labels."""
        entry = self.entries[name]
        units, long_name = (str(entry.attributes.get(label, "")) for label in ("units", "long_name"))
        return Variable(entry.dims[: values.ndim], values, units, long_name)

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
        self.put_rows(first, sealed(rows))
        self.count_rows(first + count)

    def put_rows(self, first: int, rows: np.ndarray) -> None:
        """Put sealed rows (n,) of `row_dtype` at row `first`, in any order; the number of rows stays."""
        self._put(rows.view("u1"), self._first + first * self.row_bytes)

    def count_rows(self, rows: int) -> None:
        """Let the first `rows` rows count, which other readers see."""
        self._put(struct.pack(">i", rows), COUNT_AT)
        self.rows = rows

    def reserve(self, rows: int) -> None:
        """Make the file as long as so many rows need; those not written read as zeros, which are no sealed rows."""
        os.ftruncate(self.descriptor, self._first + rows * self.row_bytes)

    def copy_rows(self, source: File) -> None:
        """Add all rows of a file with the same variables, but for those that it leaves out."""
        for block in source._kept_blocks():
            self.write(self.rows, {name: block[name] for name in self._row.names or () if name != ROW_CHECKSUM})

    def truncate(self, rows: int) -> None:
        """Drop the rows of number `rows` and above."""
        self._check_follows(rows)
        self.count_rows(rows)

    def add_report(self, text: str) -> bool:
        """Put a new text, of a JSON object, into the attribute `report`; False where it does not fit.

        The last line that has an end of line counts: the new one is whole before blanks go over the old one.
        """
        begin, size = self._report_at
        old = self.attributes["report"]
        used = len(old[: old.rfind("\n") + 1].encode())
        line = report_line(text)
        if used + len(line) > size:
            return False
        self._put(line + b" " * (size - used - len(line)), begin + used)
        self._put(b" " * used, begin)
        self.attributes["report"] = read_at(self.descriptor, size, begin).decode()
        return True

    def _check_follows(self, first: int) -> None:
        if not 0 <= first <= self.rows:
            raise ValueError(f"{self.path}: has {self.rows} rows, {first} cannot be the next")

    def _put(self, data: Any, at: int) -> None:
        left = memoryview(data)
        while len(left):
            done = write_at(self.descriptor, left, at)
            left, at = left[done:], at + done


class Stored(Mapping[str, Variable]):
    """Variables of a file, read when they are asked for and kept then."""

    def __init__(self, file: File, names: list[str]):
        """names: of those variables."""
        self.file, self._names = file, dict.fromkeys(names)
        self._read: dict[str, Variable] = {}

    def __getitem__(self, name: str) -> Variable:
        """Return a variable with its values."""
        if name not in self._names:
            raise KeyError(name)
        if name not in self._read:
            self._read[name] = self.file.variable(name, self.file.read(name))
        return self._read[name]

    def __contains__(self, name: object) -> bool:
        """Return whether there is such a variable."""
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the variables."""
        return iter(self._names)

    def __len__(self) -> int:
        """Return the number of variables."""
        return len(self._names)


def create(path: str | os.PathLike, coords: Mapping[str, Variable], variables: Mapping[str, Variable],
           attributes: Mapping[str, str | int], report: str, spare: int = 0, descriptor: int | None = None,
           along: str = "time") -> File:
    """Return a new file, without rows yet; of the variables over time only shapes count.

    attributes: but for the report, a JSON object, which can grow by `spare` bytes; descriptor: of a
    file of that path which is open already, and becomes this one, or is closed where that fails; along: the dimension
    of the rows.
    """
    checksum = Variable((along,), np.zeros(0), "1", "checksum of the row")
    header = header_of({**coords, **variables, ROW_CHECKSUM: checksum},
                       {**attributes, HEADER_CHECKSUM: NOT_YET, "report": report_line(report) + b" " * spare}, along)
    places = parsed(header)[2]
    at, size = places[HEADER_CHECKSUM]
    header = header[:at] + header_checksum(header, places).encode() + header[at + size :]
    descriptor = created(path) if descriptor is None else descriptor
    try:
        os.ftruncate(descriptor, 0)
        with open(descriptor, "wb", closefd=False) as file:
            file.write(header)
    except BaseException:
        os.close(descriptor)
        raise
    return File(path, descriptor=descriptor)


def sealed(rows: np.ndarray) -> np.ndarray:
    """Return rows (n,) as they stand in a file, with their checksums filled in, in place."""
    rows[ROW_CHECKSUM] = _checksums(rows)
    return rows


def _checksums(rows: np.ndarray) -> np.ndarray:
    """Return (rows,): of whole rows as they are in the file."""
    words = rows.view("<u8").reshape(len(rows), rows.dtype.itemsize // 8)
    return row_checksums(words[:, :-1])


def _texts(characters: np.ndarray) -> np.ndarray:
    """Return characters (..., n) as texts (...)."""
    joined = np.ascontiguousarray(characters).view(f"S{characters.shape[-1]}")[..., 0]
    return np.char.decode(joined, "utf-8")
