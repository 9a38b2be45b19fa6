"""Exclusive access to result files: locks that end with their process, and new files that follow no links.

filelock and portalocker lock a file beside the one that is written, and neither notices that the file was renamed.
"""

from __future__ import annotations

import errno
import os
from pathlib import Path

from ..base import operating_system
from ..base.operating_system import BYTES, NO_LINK
from ..errors import ResultFileError

_NEW = os.O_RDWR | os.O_CREAT | BYTES | NO_LINK
_MODE = 0o666


class Taken(Exception):  # noqa: N818  always caught within the package
    """Another process, or another run of this one, has locked the file."""


class NoLocks(Exception):  # noqa: N818
    """The file exists, and its file system has no locks that would show whether another process writes it."""


def created(path: str | os.PathLike[str]) -> int:
    """Return a descriptor of a new file for reading and writing, which replaces an older file or link. Raises OSError.
    """
    Path(path).unlink(missing_ok=True)
    return os.open(path, _NEW | os.O_EXCL, _MODE)


def claimed(path: str | os.PathLike[str]) -> int:
    """Return a descriptor of a new or existing file for reading and writing, locked until it is closed.

    Raises Taken, NoLocks, OSError (ELOOP for a link).
    """
    while True:
        try:
            descriptor, is_new = os.open(path, _NEW | os.O_EXCL, _MODE), True
        except FileExistsError:
            if not NO_LINK and Path(path).is_symlink():
                raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), os.fspath(path)) from None
            descriptor, is_new = os.open(path, _NEW, _MODE), False
        try:
            if not lock(descriptor) and not is_new:
                raise NoLocks
            if is_at(descriptor, path):
                return descriptor
        except BaseException:
            os.close(descriptor)
            raise
        os.close(descriptor)  # the previous owner renamed or removed it meanwhile


def claimed_for(part: Path, path: Path, writer: str) -> int:
    """Return a locked descriptor of the part file that is renamed to `path` once it is complete; see `claimed`.

    writer: "run" or "sweep", for messages. Raises ResultFileError.
    """
    try:
        return claimed(part)
    except Taken:
        raise being_written(path, writer) from None
    except NoLocks:
        raise ResultFileError(f"{path}: another {writer} may be writing it: there is {part.name}, and this file system "
                              f"has no locks; delete {part.name} if there is none") from None
    except OSError as error:
        if error.errno == errno.ELOOP:
            raise ResultFileError(f"{path}: {part.name} beside it is a link; delete the link") from None
        raise ResultFileError(f"{path}: the results cannot be written here: {error.strerror}; give another path"
                              ) from None


def locked(path: Path, writer: str) -> int:
    """Return a locked descriptor of an existing file; writer: as for `claimed_for`. Raises OSError, ResultFileError."""
    descriptor = os.open(path, os.O_RDWR | BYTES)
    try:
        lock(descriptor)
    except Taken:
        os.close(descriptor)
        raise being_written(path, writer) from None
    return descriptor


def being_written(path: Path, writer: str) -> ResultFileError:
    """Return the error for a file that another run or sweep writes."""
    return ResultFileError(f"{path}: another {writer} is writing it; wait for its end, or give another name")


def lock(descriptor: int) -> bool:
    """Lock an open file; return False if the file system has no locks. Raises Taken."""
    try:
        operating_system.lock(descriptor)
    except BlockingIOError:
        raise Taken from None
    except OSError:
        return False
    return True


def is_at(descriptor: int, path: str | os.PathLike[str]) -> bool:
    """Return whether an open file still has this name."""
    try:
        return os.path.samestat(os.fstat(descriptor), os.stat(path, follow_symlinks=False))
    except OSError:
        return False
