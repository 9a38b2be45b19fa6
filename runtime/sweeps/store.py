"""The file of a sweep: netCDF with a row for each point, written while the sweep runs.

Each row stands at the place of its point and has a checksum. So a resumed sweep finds the rows that are missing or
incomplete. Other readers see the rows before the first missing one: the number of rows in the header grows when all
rows before it are complete.
"""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ResultFileError
from ..results.files import check_writable
from ..results.locks import being_written, claimed_for, locked
from ..results.netcdf import MAX_ROW_BYTES, File, create
from ..results.netcdf_header import last_report
from .layout import POINT, STATUS, Layout
from .parameters import SWEEP
from .subject import FAILED

SWEEP_FORMAT = 1
"""Version of the format; it increases when a reader of older files could misread new ones."""
FORMAT = "funicular_sweep"
DIFFERENCES = {"subject": "another scene or function, or other settings", "points": "other parameters or values",
               "keep": "other results to keep", "programs": "another version of funicular, NumPy or SciPy"}
"""Facts that must be equal in a resumed sweep, and the cause in words where they differ."""


@dataclass
class Store:
    """The file of a sweep, open for writing by this process alone.

    finished: (points,), whether the row of each point is complete.
    """

    file: File
    facts: Mapping[str, Any]
    finished: np.ndarray

    @property
    def missing(self) -> np.ndarray:
        """Return the numbers of the points that have no row yet."""
        return np.flatnonzero(~self.finished)

    def put(self, numbers: np.ndarray, rows: np.ndarray) -> None:
        """Write the sealed rows (n,) of points, whose numbers rise. Raises ResultFileError."""
        starts = np.flatnonzero(np.diff(numbers, prepend=-2) != 1)
        try:
            for begin, end in zip(starts, [*starts[1:], len(numbers)], strict=True):
                self.file.put_rows(int(numbers[begin]), rows[begin:end])
            self.finished[numbers] = True
            at = self.file.rows
            if at < len(self.finished) and self.finished[at]:
                gap = int(np.argmin(self.finished[at:]))
                self.file.count_rows(len(self.finished) if self.finished[at + gap] else at + gap)
        except OSError as error:
            raise ResultFileError(f"{self.file.path}: the results could not be written: {error.strerror}; make room, "
                                  "and repeat the sweep: finished points are not computed again") from error

    def failed(self) -> np.ndarray:
        """Return the numbers of the points that were recorded as failed."""
        found = [np.zeros(0, int)]
        for start, block in self.file.blocks(len(self.finished)):
            status = np.ascontiguousarray(block[STATUS]).view(f"S{block[STATUS].shape[1]}")[:, 0]
            found.append(start + np.flatnonzero((status == FAILED.encode()) & self.finished[start:start + len(block)]))
        return np.concatenate(found)


def stored(path: str | os.PathLike[str], facts: Mapping[str, Any]) -> Store | None:
    """Return the file of a resumed sweep with these facts, None where there is none yet.

    Raises ResultFileError where the file is no sweep, or holds another one.
    """
    resolved = check_writable(path)
    try:
        descriptor = locked(resolved, SWEEP)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise ResultFileError(f"{resolved}: cannot be read: {error.strerror}") from None
    try:
        file = File(resolved, descriptor=descriptor)
    except (OSError, ValueError) as error:
        raise ResultFileError(f"{resolved}: there is a file that is no sweep of funicular, or a damaged one: {error}; "
                              "delete it, or give another name") from None
    try:
        old = facts_in(file)
        for name, what in DIFFERENCES.items():
            if old[name] != facts[name]:
                raise ResultFileError(f"{file.path}: holds a sweep of {what}; delete it, or give another name")
        return Store(file, old, complete_rows(file, int(old["number"])))
    except OSError as error:
        file.close()
        raise ResultFileError(f"{file.path}: cannot be read: {error}; delete it, or give another name") from None
    except BaseException:
        file.close()  # which gives its lock back
        raise


def new_store(path: str | os.PathLike[str] | None, layout: Layout, facts: Mapping[str, Any], scene: str) -> Store:
    """Return the file of a new sweep, without rows; path: None for one without a name, which ends with the process.

    scene: the text of the scene, empty of a function. Raises ResultFileError.
    """
    number = int(facts["number"])
    if layout.row_bytes > MAX_ROW_BYTES:
        raise ResultFileError(f"{SWEEP}: a point has {layout.row_bytes:.3g} bytes, more than a file can have; "
                              "keep less")
    if path is None:
        descriptor, part = tempfile.mkstemp(prefix="funicular-", suffix=".nc")
        resolved = Path(part)
    else:
        resolved = check_writable(path)
        part = os.fspath(resolved.with_name(f".{resolved.name}.part"))
        descriptor = claimed_for(Path(part), resolved, SWEEP)
        if resolved.exists():  # another sweep made it just now
            os.close(descriptor)
            os.unlink(part)
            raise being_written(resolved, SWEEP)
    free = shutil.disk_usage(resolved.parent).free
    if layout.row_bytes * number > free:
        os.close(descriptor)
        os.unlink(part)
        raise ResultFileError(f"{resolved}: {number} points of {layout.row_bytes} bytes do not fit in the {free:.3g} "
                              "bytes that are free; keep less, or save elsewhere")
    attributes: dict[str, str | int] = {FORMAT: SWEEP_FORMAT, "scene": scene}
    file = None
    try:
        file = create(part, layout.coords, layout.for_file(), attributes, json.dumps(facts), 0, descriptor, POINT)
        file.reserve(number)
        if path is None:
            os.unlink(part)
        else:
            file.rename(resolved)
    except BaseException as error:
        if file is not None:
            file.close()
        Path(part).unlink(missing_ok=True)
        if not isinstance(error, OSError):
            raise
        raise ResultFileError(f"{resolved}: the results cannot be written here: {error.strerror}") from error
    return Store(file, facts, np.zeros(number, bool))


def facts_in(file: File) -> dict[str, Any]:
    """Return the facts of the sweep in a file. Raises ResultFileError where it is no sweep's, or damaged."""
    if FORMAT not in file.attributes:
        raise ResultFileError(f"{file.path}: is not the file of a sweep; delete it, or give another name")
    if int(np.asarray(file.attributes[FORMAT]).item()) > SWEEP_FORMAT:
        raise ResultFileError(f"{file.path}: was written by a newer funicular; update this one to read it")
    try:
        facts = last_report(file.attributes["report"], file.has_checksums)
        if not file.has_checksums or not isinstance(facts["number"], int):
            raise ValueError("it lacks its checksums")
    except (ValueError, LookupError, TypeError) as error:
        raise ResultFileError(f"{file.path}: is damaged: {error}") from None
    return facts


def complete_rows(file: File, number: int) -> np.ndarray:
    """Return (number,): whether each row of a sweep's file is complete. Raises OSError where the file is shorter."""
    finished = np.ones(number, bool)
    finished[file.damaged_rows(number)] = False
    return finished
