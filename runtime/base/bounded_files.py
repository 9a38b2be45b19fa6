"""Files that are bounded before they are read: scenes, and what they name, may come from a stranger.

Two bounds hold for each kind of file: bytes on the disk, and the numbers that its headers announce, since files that
compress well, or that use one array many times, may hold any number.
"""

from __future__ import annotations

import os
from collections.abc import Iterable

MOST_NUMBERS = 100_000_000
"""Numbers of all arrays of a file together: 800 MB."""
MOST_BYTES = 10 * MOST_NUMBERS
"""Bytes of a file of arrays: so many numbers of 8 bytes, and their headers."""
MOST_TEXT = 50_000_000
"""Bytes of a scene file, of which the reader needs about ten times the memory."""
MOST_MESH = 200_000_000
"""Bytes of a mesh and of the files that it names: four million triangles."""

COARSER = "take a coarser grid, or leave out what is not needed"
"""What to do with a file of too many numbers."""


class TooLargeError(ValueError):
    """A file is larger than what is read of its kind; its arguments are cause and remedy."""


def check_bytes(path: str | os.PathLike, most: int, remedy: str = COARSER) -> None:
    """Raise TooLargeError where a file has more bytes than are read. Raises OSError, too."""
    if (size := os.stat(path).st_size) > most:
        raise TooLargeError(f"has {size} bytes; at most {most} are read", remedy)


def check_numbers(numbers: Iterable[tuple[str, int]], what: str = "arrays") -> None:
    """Raise TooLargeError where a file has more numbers than are read; numbers: by name, of each of its arrays."""
    numbers = list(numbers)
    if (total := sum(size for _, size in numbers)) > MOST_NUMBERS:
        largest, _ = max(numbers, key=lambda each: each[1])
        raise TooLargeError(f"has {what} of {total} numbers, most of them in {largest}; at most {MOST_NUMBERS} are "
                            "read", COARSER)


def read_bytes(path: str | os.PathLike, most: int, remedy: str = COARSER) -> bytes:
    """Return the bytes of a file. Raises TooLargeError, also where its size is not what the system says; OSError."""
    check_bytes(path, most, remedy)
    with open(path, "rb") as file:
        data = file.read(most + 1)
    if len(data) > most:
        raise TooLargeError(f"has more than {most} bytes, which are read at most", remedy)
    return data
