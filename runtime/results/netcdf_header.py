"""The header of a file of results: written, read and checked. Format: NetCDF Classic Format Specification, Unidata."""

from __future__ import annotations

import json
import math
import struct
import zlib
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from .quantities import Variable

MAGIC = b"CDF\x02"
COUNT_AT = len(MAGIC)
"""Position of the number of rows in the header, four bytes."""

_DIMENSION, _VARIABLE, _ATTRIBUTE = 10, 11, 12
_CHAR, _INT, _DOUBLE = 2, 4, 6
_TYPES = {1: ">i1", _CHAR: "S1", 3: ">i2", _INT: ">i4", 5: ">f4", _DOUBLE: ">f8"}
HEADER_CHECKSUM = "header_checksum"
NO_CHECKSUM = "00000000"
"""Placeholder of a checksum while that is computed."""
_REPORT_CHECKSUM = '{"checksum": "'
"""Start of a report line that has a checksum."""


class Entry(NamedTuple):
    """A variable as the header describes it; begin: its position in bytes, in the file or in a row."""

    dims: tuple[str, ...]
    shape: tuple[int, ...]
    attributes: dict[str, str | np.ndarray]
    dtype: np.dtype
    in_rows: bool
    begin: int


def header_checksum(head: bytes, places: Mapping[str, tuple[int, int]]) -> str:
    """Return the CRC-32 of the bytes before the first row, except the number of rows, the report and the checksum."""
    checksum, at = 0, 0
    for begin, size in sorted([(COUNT_AT, 4), places[HEADER_CHECKSUM], places.get("report", (COUNT_AT, 0))]):
        checksum, at = zlib.crc32(head[at:begin], checksum), begin + size
    return f"{zlib.crc32(head[at:], checksum):08x}"


def header_of(variables: dict[str, Variable], attributes: Mapping[str, str | bytes | int],
              along: str = "time") -> bytes:
    """Return the header and the variables that are not in rows; along: the dimension of the rows."""
    sizes, entries, fixed = {along: 0}, {}, {}
    for name, variable in variables.items():
        values, dims = variable.values, variable.dims
        labels = {"units": variable.units, "long_name": variable.long_name}
        if values.dtype.kind == "U" or (values.dtype.kind == "S" and values.dtype.itemsize > 1):
            # characters along one more dimension, like xarray
            texts = values if values.dtype.kind == "S" else np.char.encode(values, "utf-8")
            values = texts.view("S1").reshape(*texts.shape, texts.itemsize)
            dims = (*dims, f"string{texts.itemsize}")
            labels["_Encoding"] = "utf-8"
        sizes |= {dim: size for dim, size in zip(dims, values.shape, strict=True) if dim != along}
        entries[name] = (dims, labels, _CHAR if values.dtype.kind == "S" else _DOUBLE)
        if dims[:1] != (along,):
            fixed[name] = _padded(values.astype(_TYPES[entries[name][2]]).tobytes())
    number = {dim: k for k, dim in enumerate(sizes)}
    size = {name: np.dtype(_TYPES[kind]).itemsize * int(np.prod([sizes[d] for d in dims if d != along], dtype=int))
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


def parsed(header: bytes) -> tuple[int, dict[str, Any], dict[str, tuple[int, int]], dict[str, Entry]]:
    """Return the number of rows, the attributes, their positions and sizes, and the variables.

    Raises ValueError, or an error of struct or dict, for a header that is damaged or incomplete.
    """
    at = len(MAGIC)
    if header[:at] != MAGIC:
        raise ValueError("it does not begin as the classic format with 64-bit offsets does")

    def ints(count: int) -> tuple[int, ...]:
        nonlocal at
        found = struct.unpack_from(f">{count}i", header, at)
        at += 4 * count
        return found

    def integer() -> int:
        return int(ints(1)[0])

    def data(size: int) -> bytes:
        nonlocal at
        found = header[at : at + size]
        if size < 0 or len(found) < size:
            raise IndexError
        at += -(-size // 4) * 4
        return found

    def attributes() -> tuple[dict[str, Any], dict[str, tuple[int, int]]]:
        found: dict[str, Any] = {}
        places = {}
        for _ in range(ints(2)[1]):
            name = data(integer()).decode()
            kind, count = ints(2)
            dtype = np.dtype(_TYPES[kind])
            places[name] = at, count
            value = data(dtype.itemsize * count)
            found[name] = value.decode() if kind == _CHAR else np.frombuffer(value, dtype)
        return found, places

    def in_range(value: int, largest: int) -> int:
        if not 0 <= value <= largest:
            raise ValueError("the header is damaged")
        return value

    rows = in_range(integer(), 2**31)
    dims = [(data(integer()).decode(), in_range(integer(), 2**31)) for _ in range(ints(2)[1])]
    general, places = attributes()
    entries = {}
    for _ in range(ints(2)[1]):
        name = data(integer()).decode()
        along = [dims[in_range(k, len(dims) - 1)] for k in ints(in_range(integer(), len(dims)))]
        labels, _ = attributes()
        kind, _ = ints(2)
        (begin,) = struct.unpack_from(">q", header, at)
        at += 8
        in_rows = bool(along) and along[0][1] == 0
        shape = tuple(size for _, size in along[in_rows:])
        in_range(begin, 2**62)
        entries[name] = Entry(tuple(dim for dim, _ in along), shape, labels, np.dtype(_TYPES[kind]), in_rows, begin)
    return rows, general, places, entries


def size_of(entry: Entry) -> int:
    """Return the bytes of a variable, or of its part of a row."""
    return entry.dtype.itemsize * math.prod(entry.shape)


def report_line(text: str) -> bytes:
    """Return a JSON object as a line of the report, with its checksum as the first entry."""
    bare = f'{_REPORT_CHECKSUM}{NO_CHECKSUM}", {text[1:]}'
    checksum = f"{zlib.crc32(bare.encode()):08x}"
    return f'{_REPORT_CHECKSUM}{checksum}", {text[1:]}\n'.encode()


def last_report(text: str, has_checksum: bool) -> dict[str, Any]:
    """Return the content of the last complete line of the attribute `report`, or of a report without lines.

    Raises ValueError for a damaged report.
    """
    lines = text.split("\n")
    line = (lines[:-1] or lines)[-1].strip(" ")
    if has_checksum:
        begin = len(_REPORT_CHECKSUM)
        end = begin + len(NO_CHECKSUM)
        bare = line[:begin] + NO_CHECKSUM + line[end:]
        if not line.startswith(_REPORT_CHECKSUM) or line[begin:end] != f"{zlib.crc32(bare.encode()):08x}":
            raise ValueError("the report is damaged: it has another checksum")
    try:
        report = json.loads(line)
    except RecursionError:
        raise ValueError("the report is damaged") from None
    if not isinstance(report, dict):
        raise ValueError("the report is damaged")
    report.pop("checksum", None)
    return report
