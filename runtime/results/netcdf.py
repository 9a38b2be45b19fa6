"""Files of results: netCDF, the classic format with 64-bit offsets, written row by row.

A row holds all variables at one time (of a sweep: at one point), and its checksum at the end. New rows are written
behind the counted ones before the header's count is raised, so that the file is valid at every instant. The header has
a checksum of its own. It excludes what changes while the file grows: the count of rows, and the report, each line of
which has a checksum. Other readers see ordinary variables and attributes. Format: NetCDF Classic Format Specification,
Unidata.

Libraries (netCDF4, h5netcdf, scipy.io) read these files. They do not write them: an HDF5 file that is being written is
unreadable after a crash, and none of them writes rows and checksums in this order.
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
    NO_CHECKSUM,
    Entry,
    header_checksum,
    header_of,
    parsed,
    report_line,
    size_of,
)
from .quantities import Variable

READ_BLOCK_BYTES = 1 << 22
MAX_HEADER_BYTES, MAX_ROW_BYTES = 1 << 28, 1 << 31
ROW_CHECKSUM = "row_checksum"


class File:
    """An open file of results. Rows are counted from 0; `write`, `count_rows` and `truncate` change their number.

    row_dtype: the type of a row in the file, its checksum included; first_row_at: where the rows begin, in bytes;
    left_out: the numbers of the damaged rows that `read` skips.
    """

    def __init__(self, path: str | os.PathLike[str], writable: bool = False, descriptor: int | None = None):
        """Open a file, or take over its descriptor.

        Raises OSError; ValueError for a file of another format, one cut short, or one with a damaged header.
        """
        self.path = os.fspath(path)
        if descriptor is None:
            descriptor = os.open(path, (os.O_RDWR if writable else os.O_RDONLY) | BYTES)
        self.descriptor = descriptor
        self.close = weakref.finalize(self, os.close, self.descriptor)
        try:
            self._read_header()
        except BaseException:
            self.close()
            raise

    def _read_header(self) -> None:
        size = os.fstat(self.descriptor).st_size
        self.rows, self.attributes, places, self.entries = self._parsed_header(size)
        self._report_at = places.get("report", (0, 0))
        records = {name: entry for name, entry in self.entries.items() if entry.in_rows}
        self.first_row_at = first = min((entry.begin for entry in records.values()), default=size)
        row_bytes = max((entry.begin + size_of(entry) - first for entry in records.values()), default=0)
        ends = [entry.begin + size_of(entry) for entry in self.entries.values() if not entry.in_rows]
        if row_bytes > MAX_ROW_BYTES or max([first + self.rows * row_bytes, *ends]) > size:
            raise ValueError("the file ends too early")
        self.row_dtype = np.dtype({
            "names": list(records),
            "formats": [(entry.dtype, entry.shape) for entry in records.values()],
            "offsets": [entry.begin - first for entry in records.values()]})
        self.left_out = np.zeros(0, int)
        self.has_checksums = ROW_CHECKSUM in records and HEADER_CHECKSUM in places
        if HEADER_CHECKSUM in places:
            head = read_at(self.descriptor, min(first, MAX_HEADER_BYTES), 0)
            if header_checksum(head, places) != self.attributes[HEADER_CHECKSUM]:
                raise ValueError("the header is damaged: it has another checksum")

    def _parsed_header(self, size: int) -> tuple[int, dict[str, Any], dict[str, tuple[int, int]], dict[str, Entry]]:
        length = READ_BLOCK_BYTES
        while True:
            try:
                return parsed(read_at(self.descriptor, length, 0))
            except (struct.error, IndexError, KeyError, OverflowError, UnicodeDecodeError) as error:
                if length >= min(size, MAX_HEADER_BYTES):
                    raise ValueError("the header is damaged") from error
            length *= 2

    @property
    def row_bytes(self) -> int:
        """Return the size of a row."""
        return self.row_dtype.itemsize

    def read(self, name: str) -> np.ndarray:
        """Return all values of a variable in native byte order, texts as str, without the rows `left_out`."""
        entry = self.entries[name]
        if not entry.in_rows:
            raw = read_at(self.descriptor, size_of(entry), entry.begin)
            values = np.frombuffer(raw, entry.dtype).reshape(entry.shape)
            return texts(values) if entry.dtype.kind == "S" else values.astype(entry.dtype.newbyteorder("="))
        values = np.empty((self.rows - len(self.left_out), *entry.shape), entry.dtype.newbyteorder("="))
        at = 0
        for block in self._valid_blocks():
            values[at : at + len(block)] = block[name]
            at += len(block)
        return values

    def damaged_rows(self, rows: int | None = None) -> np.ndarray:
        """Return the numbers of the rows with a wrong checksum, among the first `rows` or all. Raises OSError."""
        damaged = [np.zeros(0, int)]
        for start, block in self.blocks(self.rows if rows is None else rows):
            damaged.append(start + np.flatnonzero(block[ROW_CHECKSUM] != _checksums(block)))
        return np.concatenate(damaged)

    def blocks(self, rows: int) -> Iterator[tuple[int, np.ndarray]]:
        """Yield the first `rows` rows in blocks, each with the number of its first row."""
        if not rows:
            return
        block = np.empty(min(rows, max(1, READ_BLOCK_BYTES // max(1, self.row_bytes))), self.row_dtype)
        for start in range(0, rows, len(block)):
            part = block[: rows - start]
            at = self.first_row_at + start * self.row_bytes
            if read_into(self.descriptor, memoryview(part.view("u1").data), at) != part.nbytes:
                raise OSError(f"{self.path}: was cut short while it was read")
            yield start, part

    def _valid_blocks(self) -> Iterator[np.ndarray]:
        """Yield the rows that are not left out, in blocks."""
        for start, block in self.blocks(self.rows):
            omitted = self.left_out[(self.left_out >= start) & (self.left_out < start + len(block))] - start
            yield np.delete(block, omitted) if len(omitted) else block

    def described(self, over_time: bool) -> dict[str, Variable]:
        """Return the variables over time without their values, or the others with them."""
        return {name: self.variable(name, np.empty((0, *entry.shape)) if over_time else self.read(name))
                for name, entry in self.entries.items() if entry.in_rows == over_time and name != ROW_CHECKSUM}

    def variable(self, name: str, values: np.ndarray) -> Variable:
        """Return a variable with its labels."""
        entry = self.entries[name]
        units, long_name = (str(entry.attributes.get(label, "")) for label in ("units", "long_name"))
        return Variable(entry.dims[: values.ndim], values, units, long_name)

    def rename(self, path: str | os.PathLike[str]) -> None:
        """Move the file; it replaces a file of that name."""
        os.replace(self.path, path)
        self.path = os.fspath(path)

    def write(self, first: int, values: Mapping[str, np.ndarray]) -> None:
        """Write rows from row `first` on and drop the rows behind them. values: all variables, rows along axis 0."""
        (count,) = {len(array) for array in values.values()}
        self._check_follows(first)
        rows = np.empty(count, self.row_dtype)
        for name, array in values.items():
            rows[name] = array
        self.put_rows(first, sealed(rows))
        self.count_rows(first + count)

    def put_rows(self, first: int, rows: np.ndarray) -> None:
        """Write sealed rows (n,) of `row_dtype` at row `first`, which need not follow the last; the count stays."""
        self._put(rows.view("u1"), self.first_row_at + first * self.row_bytes)

    def count_rows(self, rows: int) -> None:
        """Set the number of rows in the header, which other readers see."""
        self._put(struct.pack(">i", rows), COUNT_AT)
        self.rows = rows

    def reserve(self, rows: int) -> None:
        """Extend the file to a number of rows; unwritten rows read as zeros, whose checksum is wrong."""
        os.ftruncate(self.descriptor, self.first_row_at + rows * self.row_bytes)

    def copy_rows(self, source: File) -> None:
        """Append the rows of a file with the same variables, except those that it leaves out."""
        for block in source._valid_blocks():
            self.write(self.rows, {name: block[name] for name in self.row_dtype.names or () if name != ROW_CHECKSUM})

    def truncate(self, rows: int) -> None:
        """Drop the rows of number `rows` and above."""
        self._check_follows(rows)
        self.count_rows(rows)

    def add_report(self, text: str) -> bool:
        """Replace the attribute `report` by a JSON object; return False if it does not fit.

        The last line that ends with a line feed is valid: the new line is complete before blanks replace the old one.
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
        remaining = memoryview(data)
        while len(remaining):
            done = write_at(self.descriptor, remaining, at)
            remaining, at = remaining[done:], at + done


class Stored(Mapping[str, Variable]):
    """Variables of a file, each read at its first use and then kept."""

    def __init__(self, file: File, names: list[str]):
        self.file = file
        self._variables: dict[str, Variable | None] = dict.fromkeys(names)

    def __getitem__(self, name: str) -> Variable:
        """Return a variable with its values."""
        found = self._variables[name]
        if found is None:
            found = self._variables[name] = self.file.variable(name, self.file.read(name))
        return found

    def __contains__(self, name: object) -> bool:
        """Return whether there is such a variable; the values are not read."""
        return name in self._variables

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the variables."""
        return iter(self._variables)

    def __len__(self) -> int:
        """Return the number of variables."""
        return len(self._variables)


def create(path: str | os.PathLike[str], coords: Mapping[str, Variable], variables: Mapping[str, Variable],
           attributes: Mapping[str, str | int], report: str, spare: int = 0, descriptor: int | None = None,
           along: str = "time") -> File:
    """Return a new file without rows; of the variables over time only the shapes are used.

    attributes: all except the report, a JSON object that can grow by `spare` bytes; descriptor: of the file if it is
    open already, closed on failure; along: the dimension of the rows.
    """
    checksum = Variable((along,), np.zeros(0), "1", "checksum of the row")
    header = header_of({**coords, **variables, ROW_CHECKSUM: checksum},
                       {**attributes, HEADER_CHECKSUM: NO_CHECKSUM, "report": report_line(report) + b" " * spare},
                       along)
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
    """Fill in the checksums of rows (n,) and return the rows."""
    rows[ROW_CHECKSUM] = _checksums(rows)
    return rows


def _checksums(rows: np.ndarray) -> np.ndarray:
    """Return the checksums (rows,) of whole rows as they are in the file."""
    words = rows.view("<u8").reshape(len(rows), rows.dtype.itemsize // 8)
    return row_checksums(words[:, :-1])


def texts(characters: np.ndarray) -> np.ndarray:
    """Return characters (..., n) as texts (...)."""
    joined = np.ascontiguousarray(characters).view(f"S{characters.shape[-1]}")[..., 0]
    return np.char.decode(joined, "utf-8")
