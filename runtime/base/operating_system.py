"""Differences of operating systems: locks of files, reads and writes at a position of a file, the machine's memory.

Windows lacks `fcntl` and some functions of `os`, for which it gets its own ones.
"""

from __future__ import annotations

import ctypes
import importlib
import os
import threading
from typing import Any


def _module(name: str) -> Any:
    """Return a module of the standard library, None where this system lacks it."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError:
        return None


fcntl, msvcrt = _module("fcntl"), _module("msvcrt")  # one of the two, for POSIX and for Windows

# Flags of os.open, where a system has them: unchanged bytes, no inheritance by child processes; no links.
BYTES = getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_NOINHERIT", 0)
NO_LINK = getattr(os, "O_NOFOLLOW", 0)

_LOCKED_BYTE = 2**31 - 2  # Windows locks bytes against reading: this one is behind the end of most files
_one_at_a_time = threading.Lock()


def lock(descriptor: int) -> None:
    """Lock an open file until it is closed, also by the end of the process.

    Raises BlockingIOError where it is locked already, OSError where the file system has no locks.
    """
    if fcntl:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return
    with _one_at_a_time:
        place = os.lseek(descriptor, 0, os.SEEK_CUR)
        os.lseek(descriptor, _LOCKED_BYTE, os.SEEK_SET)
        try:
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        except PermissionError as error:
            raise BlockingIOError(error.errno, "the file is locked") from None
        finally:
            os.lseek(descriptor, place, os.SEEK_SET)


def read_at(descriptor: int, size: int, at: int) -> bytes:
    """Return `size` bytes of a file from `at` on, fewer at its end. Raises OSError."""
    if hasattr(os, "pread"):
        return os.pread(descriptor, size, at)
    with _one_at_a_time:
        os.lseek(descriptor, at, os.SEEK_SET)
        return os.read(descriptor, size)


def read_into(descriptor: int, buffer: memoryview, at: int) -> int:
    """Fill a buffer with bytes from `at` on; return their number. Raises OSError."""
    if hasattr(os, "preadv"):
        return os.preadv(descriptor, [buffer], at)
    data = read_at(descriptor, len(buffer), at)
    buffer[: len(data)] = data
    return len(data)


def write_at(descriptor: int, data: memoryview, at: int) -> int:
    """Write bytes into a file from `at` on; return the number of written bytes. Raises OSError."""
    if hasattr(os, "pwrite"):
        return os.pwrite(descriptor, data, at)
    with _one_at_a_time:
        os.lseek(descriptor, at, os.SEEK_SET)
        return os.write(descriptor, data)


def machine_memory() -> int:
    """Return the memory of the machine, in bytes."""
    if hasattr(os, "sysconf"):
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    status = (ctypes.c_uint64 * 8)(64)  # MEMORYSTATUSEX: its size and the load in the first word, then the total
    windows: Any = ctypes  # type checkers know its names for Windows only there
    if not windows.windll.kernel32.GlobalMemoryStatusEx(status):
        raise windows.WinError()
    return status[1]
