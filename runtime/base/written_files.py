"""Files written under a temporary name and renamed when complete: a full disk or Ctrl-C leaves the older file."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

from ..errors import ResultFileError, shown_path
from .interruptions import interruptible, uninterrupted


def write_whole(path: str | os.PathLike[str], write: Callable[[Path], object], what: str = "the file") -> Path:
    """Let ``write`` make a file under a temporary name, and rename it to ``path`` once it is complete.

    The target of a link is replaced; the link stays. A device or a pipe is written to directly. what: the file in
    messages. Returns the path as given. Raises ResultFileError.
    """
    try:
        target = Path(os.path.realpath(path))
        if target.exists() and not target.is_file():
            if target.is_dir():
                raise IsADirectoryError(0, "this is a directory")
            write(target)
            return Path(path)
        if target.exists() and not os.access(target, os.W_OK):
            raise PermissionError(0, "the file is write-protected")
        with uninterrupted():
            part = _beside(target)
            os.close(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))  # follows no link
            try:
                with interruptible():
                    write(part)
                if target.exists():
                    shutil.copymode(target, part)
                os.replace(part, target)
            finally:
                part.unlink(missing_ok=True)
    except (OSError, ValueError) as error:
        raise unwritable(path, what, error) from error
    return Path(path)


def unwritable(path: str | os.PathLike[str], what: str, error: OSError | ValueError) -> ResultFileError:
    """Return the error of a file that cannot be written; what: the file in messages."""
    reason = getattr(error, "strerror", None) or str(error) or "this is no path"
    return ResultFileError(f"{shown_path(path)}: {what} cannot be written here: {reason}")


def write_text(path: str | os.PathLike[str], text: str, what: str = "the file") -> Path:
    """Write a text in UTF-8 with its own line ends; see `write_whole`. Raises ResultFileError."""
    return write_whole(path, lambda part: part.write_text(text, encoding="utf-8", newline=""), what)


def _beside(path: Path) -> Path:
    """Return an unpredictable name in the same folder; libraries choose the format by the ending, which stays."""
    return path.with_name(f".{path.stem[:32]}-{os.urandom(8).hex()}.part{path.suffix}")
