"""Bounds on files that are read: scenes, and the files that they name, may come from a stranger.

Each kind of file has two bounds, one on its bytes and one on the numbers that its headers announce: a compressed file,
or one that uses an array many times, may hold any number.
"""

from __future__ import annotations

import os
from collections.abc import Iterable

MAX_NUMBERS = 100_000_000
"""Numbers in all arrays of a file together: 800 MB."""
MAX_ARRAY_BYTES = 10 * MAX_NUMBERS
"""Bytes of a file of arrays: `MAX_NUMBERS` numbers of 8 bytes, and their headers."""
MAX_SCENE_BYTES = 50_000_000
"""Bytes of a scene file; the reader needs about ten times the memory."""
MAX_MESH_BYTES = 200_000_000
"""Bytes of a mesh and of the files that it names: four million triangles."""

COARSER = "take a coarser grid, or leave out what is not needed"
"""Remedy for a file of too many numbers."""


class TooLargeError(ValueError):
    """A file is larger than the bound of its kind; its arguments are cause and remedy."""


def check_bytes(path: str | os.PathLike[str], most: int, remedy: str = COARSER) -> None:
    """Raise TooLargeError where a file has more than `most` bytes. Raises OSError, too."""
    if (size := os.stat(path).st_size) > most:
        raise TooLargeError(f"has {size} bytes; at most {most} are read", remedy)


def check_numbers(numbers: Iterable[tuple[str, int]], what: str = "arrays") -> None:
    """Raise TooLargeError where a file has too many numbers; numbers: the name and size of each array."""
    numbers = list(numbers)
    if (total := sum(size for _, size in numbers)) > MAX_NUMBERS:
        largest, _ = max(numbers, key=lambda each: each[1])
        raise TooLargeError(f"has {what} of {total} numbers, most of them in {largest}; at most {MAX_NUMBERS} are "
                            "read", COARSER)


def read_bytes(path: str | os.PathLike[str], most: int, remedy: str = COARSER) -> bytes:
    """Return the bytes of a file. Raises OSError; TooLargeError, also where the system reports a smaller size."""
    check_bytes(path, most, remedy)
    with open(path, "rb") as file:
        data = file.read(most + 1)
    if len(data) > most:
        raise TooLargeError(f"has more than {most} bytes, which are read at most", remedy)
    return data
