"""Arrays of a page: float32 numbers at screen resolution, as one compressed text, and back.

An array is stored as 32-bit integers, in one of three ways:

- ``"fixed"``: multiples of ``step``, a power of two; the integer -2^31 stands for a missing number (NaN).
- ``"float"``: the bit patterns of float32 numbers, their mantissa rounded to ``FLOAT_BITS`` bits.
- ``"integer"``: as they are (corners of triangles).

Differences are then taken modulo 2^32 along the axes in ``differences``, in that order; they are small for smooth
motion. They become 0, 1, 2, 3, 4 ... for 0, -1, 1, -2, 2 ..., and their four bytes go to four planes, the lowest bytes
first; small numbers leave planes of zeros.

The arrays are concatenated, deflated (zlib), and encoded as one base64 text. The header gives the shape, kind, step and
differences of each array.

To read: inflate, join the planes, restore the signs, take cumulative sums modulo 2^32 along the axes in reverse order,
and multiply by ``step`` or reinterpret. Times need double precision; float32 is enough for the rest.
``page_source/src/data.js`` does this in the browser, `unpack` in Python.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Sequence
from typing import Any

import numpy as np

FLOAT_BITS = 16  # of 23: five digits
SAMPLED_ROWS = 64  # for the choice of differences
MISSING = np.int32(-(2**31))
# Candidate axes of differences: time is the first axis, stations the second.
DIFFERENCES = ((), (0,), (0, 0), (0, 1), (0, 0, 1), (1,), (1, 1), (0, 1, 1))


class Packer:
    """Numbers arrays and compresses them together."""

    def __init__(self) -> None:
        self.descriptions: list[dict[str, Any]] = []
        self._planes: list[bytes] = []

    def fixed(self, values: np.ndarray, step: float) -> int:
        """Add numbers rounded to multiples of the largest power of two up to ``step``; return the array's number.

        Infinite numbers become missing ones. Raises ValueError where a number has more than 2^31 steps.
        """
        step = power_of_two(step)
        scaled = np.round(np.asarray(values, dtype=float) / step)
        finite = np.isfinite(scaled)
        if np.abs(scaled, where=finite, out=np.zeros_like(scaled)).max(initial=0) >= 2**31:
            raise ValueError(f"a step of {step:g} is too small for numbers up to {np.abs(values[finite]).max():g}")
        integers = np.where(finite, scaled, MISSING).astype(np.int32)
        return self._add(integers, {"kind": "fixed", "step": step})

    def floats(self, values: np.ndarray) -> int:
        """Add numbers rounded to ``FLOAT_BITS`` bits; return the array's number."""
        return self._add(rounded(values).view(np.int32), {"kind": "float"})

    def integers(self, values: np.ndarray) -> int:
        """Add integers of at most 32 bits; return the array's number."""
        return self._add(np.asarray(values).astype(np.int32), {"kind": "integer"})

    def text(self) -> str:
        """Return all arrays so far as one base64 text."""
        return base64.b64encode(zlib.compress(b"".join(self._planes), 9)).decode("ascii")

    def _add(self, integers: np.ndarray, description: dict[str, Any]) -> int:
        axes, rest = smallest_differences(np.ascontiguousarray(integers).view(np.uint32))
        self._planes.append(rest.reshape(-1, 1).astype("<u4").view(np.uint8).T.tobytes())
        self.descriptions.append({**description, "shape": list(integers.shape), "differences": list(axes)})
        return len(self.descriptions) - 1


def power_of_two(step: float) -> float:
    """Return the largest power of two that is not above ``step``, a positive number; float32 holds its multiples."""
    return float(2.0 ** np.floor(np.log2(step)))


def rounded(values: np.ndarray) -> np.ndarray:
    """Return float32 numbers with a mantissa of ``FLOAT_BITS`` bits, halves to even; NaN and infinity stay."""
    single = np.array(values, dtype=np.float32, order="C")
    drop = np.uint32(23 - FLOAT_BITS)
    bits = single.view(np.uint32)
    even = (bits >> drop) & np.uint32(1)
    cut = (bits + (np.uint32(1) << (drop - np.uint32(1))) - np.uint32(1) + even) >> drop << drop
    return np.where(np.isfinite(single), cut, bits).astype(np.uint32).view(np.float32)


def smallest_differences(integers: np.ndarray) -> tuple[tuple[int, ...], np.ndarray]:
    """Return the axes of the differences with the fewest bits, and these differences (uint32, the same shape)."""
    middle = max(0, (len(integers) - SAMPLED_ROWS) // 2)
    sample = integers[middle: middle + SAMPLED_ROWS]
    possible = [axes for axes in DIFFERENCES
                if all(axis < integers.ndim and integers.shape[axis] > 1 for axis in axes)]
    axes = min(possible, key=lambda axes: _bits(differences(sample, axes)))
    return axes, zigzag(differences(integers, axes))


def differences(integers: np.ndarray, axes: Sequence[int]) -> np.ndarray:
    """Return the differences along ``axes`` in turn, the first values against 0."""
    for axis in axes:
        integers = np.diff(integers, axis=axis, prepend=np.uint32(0))
    return integers


def _bits(integers: np.ndarray) -> float:
    return float(np.log2(1.0 + np.abs(integers.view(np.int32).astype(float))).sum())


def zigzag(integers: np.ndarray) -> np.ndarray:
    """Return 0, 1, 2, 3, 4 ... for 0, -1, 1, -2, 2 ...: small numbers of both signs have zeros in their high bytes."""
    return (integers << np.uint32(1)) ^ (np.uint32(0) - (integers >> np.uint32(31)))


def unpack(text: str, descriptions: Sequence[dict[str, Any]]) -> list[np.ndarray]:
    """Return the arrays of a page, decoded as in the browser."""
    content = np.frombuffer(zlib.decompress(base64.b64decode(text)), dtype=np.uint8)
    arrays, start = [], 0
    for description in descriptions:
        count = int(np.prod(description["shape"], dtype=int))
        planes = content[start: start + 4 * count].reshape(4, count)
        start += 4 * count
        coded = np.ascontiguousarray(planes.T).view("<u4").reshape(description["shape"]).astype(np.uint32)
        integers = (coded >> np.uint32(1)) ^ (np.uint32(0) - (coded & np.uint32(1)))
        for axis in reversed(description["differences"]):
            integers = np.cumsum(integers, axis=axis, dtype=np.uint32)
        arrays.append(_values(integers, description))
    return arrays


def _values(integers: np.ndarray, description: dict[str, Any]) -> np.ndarray:
    signed = integers.view(np.int32)
    if description["kind"] == "integer":
        return signed
    if description["kind"] == "float":
        return integers.view(np.float32)
    return np.where(signed == MISSING, np.nan, signed * float(description["step"]))
