"""Checksums of files of results: of rows, quick enough to be taken of each, and of text and headers.

A row is hashed by multiplication modulo 2^64 of its words with random odd numbers (M. Dietzfelbinger and others,
J. Algorithms 25, 1997; D. Lemire and O. Kaser, Comput. J. 57, 2014), for all rows of a block at once: a change of one
word always changes the sum, any other damage goes unseen once in 2^53.
"""

from __future__ import annotations

import zlib
from functools import cache

import numpy as np

_EMPTY = 0x9E3779B97F4A7C15
"""What no words sum up to: a row of zeros, as a hole in a file reads, does not have the checksum zero."""


def text_checksum(data: bytes, before: int = 0) -> int:
    """Return CRC-32 of bytes, going on from that of the bytes before."""
    return zlib.crc32(data, before)


def row_checksums(words: np.ndarray) -> np.ndarray:
    """Return (rows,) of (rows, words) unsigned 64-bit words as they stand in the file: 53 bits each, exact as a float.
    """
    mixed = words >> np.uint64(32)
    mixed ^= words  # one to one, and the last bits of what two words' first ones change
    sums = np.einsum("ij,j->i", mixed, _weights(words.shape[1])) + np.uint64(_EMPTY)
    return (sums >> np.uint64(11)).astype(float)


@cache
def _weights(n: int) -> np.ndarray:
    """Return (n,): odd numbers from the generator splitmix64 (G. Steele and others, OOPSLA 2014)."""
    with np.errstate(over="ignore"):
        z = np.arange(1, n + 1, dtype=np.uint64) * np.uint64(_EMPTY)
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return (z ^ (z >> np.uint64(31))) | np.uint64(1)
