"""Checksums of the rows of a result file, fast enough for every row that is written.

Multilinear hashing modulo 2^64: the sum of the row's words times random odd numbers (M. Dietzfelbinger and others,
J. Algorithms 25, 1997; D. Lemire and O. Kaser, Comput. J. 57, 2014), for all rows of a block at once. A change of one
word always changes the sum; other damage stays undetected with probability 2^-53.
"""

from __future__ import annotations

from functools import cache

import numpy as np

_EMPTY = 0x9E3779B97F4A7C15
"""The sum of a row without words. A row of zeros, as a hole in a file reads, therefore has a checksum other than 0."""


def row_checksums(words: np.ndarray) -> np.ndarray:
    """Return the checksums (rows,) of words (rows, words), unsigned 64-bit as in the file: 53 bits, exact as float."""
    mixed = words >> np.uint64(32)
    mixed ^= words  # one to one; the low bits then depend on the high bits
    sums: np.ndarray = np.einsum("ij,j->i", mixed, _weights(words.shape[1])) + np.uint64(_EMPTY)
    return (sums >> np.uint64(11)).astype(float)


@cache
def _weights(n: int) -> np.ndarray:
    """Return (n,): odd numbers from the generator splitmix64 (G. Steele and others, OOPSLA 2014)."""
    with np.errstate(over="ignore"):
        z = np.arange(1, n + 1, dtype=np.uint64) * np.uint64(_EMPTY)
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return (z ^ (z >> np.uint64(31))) | np.uint64(1)
