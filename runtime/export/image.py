"""A packed scene: the memory of a run before its start, as bytes that a program places anywhere (engine/host/packed.h).

Nothing describes the structures of the engine once more: the memory of two runs that were prepared alike is compared.
Words that differ are addresses, and must be those of the same places in both; addresses of tables of the program are
known. Whatever else differs, or points into the program, is an error, so that no address is taken for a number.
"""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ..engine import Engine, packed_format

WORD = 8
HEAD = struct.Struct("=8sII32s5Q8I")
"""fu_packed of engine/host/packed.h."""
DIGEST_AT, COVERED_FROM = 16, 48
GAP = 4
"""Words of zeros between two segments, at least."""
NEAR_TABLES = 1 << 24
"""Distance in bytes from a table of the program within which a number would be an address of the program."""
WORDS_NOT_KERNELS = ("lapack", "matter", "integrator", "blocks", "coupling", "events")
"""Roles of tables that every engine has."""


class Value(NamedTuple):
    """A number of a row by name: factor times an entry of an array of the engine's record."""

    name: str
    unit: str
    array: int
    entry: int
    factor: float


class Packed(NamedTuple):
    """A packed scene: its bytes, their digest, and the kernels that it needs, by role and name."""

    content: bytes
    digest: bytes
    kernels: list[tuple[str, str]]


class _Memory(NamedTuple):
    """The memory of a run: its words one block after the other, and the addresses, offsets and sizes of the blocks."""

    words: np.ndarray
    starts: np.ndarray
    offsets: np.ndarray
    sizes: np.ndarray

    @classmethod
    def of(cls, engine: Engine, alignment: int) -> _Memory:
        """Return the memory of a run that is ready."""
        blocks = engine.memory_blocks()
        sizes = np.array([each.nbytes for _, each in blocks])
        offsets = np.concatenate([[0], np.cumsum(-(-sizes // alignment) * alignment)])
        words = np.zeros(offsets[-1] // WORD, dtype=np.uint64)
        for offset, (_, each) in zip(offsets, blocks, strict=False):
            words[offset // WORD : offset // WORD + len(each)] = each
        return cls(words, np.array([address for address, _ in blocks], dtype=np.uint64), offsets[:-1], sizes)

    def place(self, addresses: np.ndarray) -> np.ndarray:
        """Return the offsets of addresses, -1 for those outside of all blocks."""
        order = np.argsort(self.starts)
        block = order[np.searchsorted(self.starts[order], addresses, side="right") - 1]
        within = (addresses - self.starts[block]).astype(np.int64)
        return np.where((within >= 0) & (within < self.sizes[block]), self.offsets[block] + within, -1)


def packed(engine: Engine, twin: Engine, *, every: int, values: Sequence[Value], couplings: Sequence[str],
           stops: Iterable[bool], inputs: Sequence[tuple[str, str]] = ()) -> Packed:
    """Return the packed scene of a run that is ready; twin: another one, prepared alike.

    every: rows between pauses; couplings: kinds and names of all; stops: whether an event of the user ends the run;
    inputs: names and units.
    Raises RuntimeError where the two differ in more than addresses.
    """
    version, magic, layout, alignment = packed_format()
    one, other = (_Memory.of(each, alignment) for each in (engine, twin))
    if not np.array_equal(one.sizes, other.sizes):
        raise RuntimeError("two preparations of one run have other sizes of memory")
    words = one.words
    at = np.flatnonzero(words != other.words)
    to = one.place(words[at])
    if (to < 0).any() or (to != other.place(other.words[at])).any():
        raise RuntimeError("two preparations of one run differ in numbers")
    words[at] = 0
    tables = engine.program_tables()
    links = _links(words, np.array(sorted(tables), dtype=np.uint64))
    texts = _Texts()
    linked = [(int(k) * WORD, *tables[int(words[k])]) for k in links]
    words[links] = 0
    segments = _segments(words)
    run = int(one.place(np.array([engine.run_address], dtype=np.uint64))[0])
    stopping = [int(stop) for stop in stops]
    parts = [
        np.array([(first * WORD, (end - first) * WORD) for first, end in segments], dtype=np.uint64).tobytes(),
        np.stack([at.astype(np.uint64) * np.uint64(WORD), to.astype(np.uint64)], axis=1).tobytes(),
        b"".join(struct.pack("=QII", place, texts.at(role), texts.at(name)) for place, role, name in linked),
        b"".join(struct.pack("=IIIId", texts.at(each.name), texts.at(each.unit), each.array, each.entry, each.factor)
                 for each in sorted(values, key=lambda value: value.name.encode())),
        _padded(struct.pack(f"={len(couplings)}I", *map(texts.at, couplings))),
        _padded(struct.pack(f"={len(stopping)}I", *stopping)),
        b"".join(struct.pack("=II", texts.at(name), texts.at(unit)) for name, unit in inputs),
        b"".join(words[first:end].tobytes() for first, end in segments),
    ]
    body = b"".join(parts) + _padded(bytes(texts.content))
    head = HEAD.pack(magic, version, layout, bytes(32), HEAD.size + len(body), WORD * len(words), run, len(parts[-1]),
                     len(texts.content), len(segments), len(at), len(linked), len(values), len(couplings),
                     len(stopping), len(inputs), every)
    digest = hashlib.sha256(head[COVERED_FROM:] + body).digest()
    content = head[:DIGEST_AT] + digest + head[COVERED_FROM:] + body
    kernels = sorted({(role, name) for _, role, name in linked if role not in WORDS_NOT_KERNELS})
    return Packed(content, digest, kernels)


class _Texts:
    """Texts with their offsets, each once."""

    def __init__(self) -> None:
        self.content = bytearray(b"\0")
        self._at: dict[str, int] = {"": 0}

    def at(self, text: str) -> int:
        """Return the offset of a text."""
        if text not in self._at:
            self._at[text] = len(self.content)
            self.content += text.encode() + b"\0"
        return self._at[text]


def _padded(content: bytes) -> bytes:
    return content + bytes(-len(content) % WORD)


def _links(words: np.ndarray, tables: np.ndarray) -> np.ndarray:
    """Return the indices of words that are addresses of tables. Raises RuntimeError for another place near them."""
    known = np.isin(words, tables)
    after = np.searchsorted(tables, words)
    near = np.zeros(len(words), dtype=bool)
    for neighbour in (tables[np.minimum(after, len(tables) - 1)], tables[np.maximum(after - 1, 0)]):
        near |= np.where(words > neighbour, words - neighbour, neighbour - words) < NEAR_TABLES
    if (near & ~known).any():
        raise RuntimeError("the memory of the run points to an unknown table of the program")
    return np.flatnonzero(known)


def _segments(words: np.ndarray) -> list[tuple[int, int]]:
    """Return the ranges of words that are not zero, with short gaps in them."""
    there = np.flatnonzero(words)
    if not len(there):
        return []
    breaks = np.flatnonzero(np.diff(there) > GAP)
    firsts, lasts = there[np.append(0, breaks + 1)], there[np.append(breaks, len(there) - 1)]
    return [(int(first), int(last) + 1) for first, last in zip(firsts, lasts, strict=True)]
