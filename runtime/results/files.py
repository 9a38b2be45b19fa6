"""Files of results: checks before writing, creation, opening, and checks of their content."""

from __future__ import annotations

import errno
import json
import os
import threading
import warnings
from collections.abc import Mapping
from operator import methodcaller
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict

from ..errors import FunicularWarning, ResultFileError, shown_path
from .locks import Taken, created, lock
from .netcdf import File, create
from .netcdf_header import last_report
from .quantities import Variable

FILE_FORMAT = 3
"""Increases when a reader of older files could misread new ones."""
WITH_CHECKSUMS = 3
"""The first format with checksums; older files are read with a warning."""
MAX_ROWS_IN_MESSAGE = 10
"""Damaged rows that a message lists."""


def check_writable(path: str | os.PathLike[str]) -> Path:
    """Return the path without links; leaves no file. Raises ResultFileError if no file can be written there."""
    try:
        resolved = Path(path).resolve()  # a link stays
        thread = threading.get_native_id()  # several threads may check at once
        probe = resolved.with_name(f".{resolved.name}.{thread}.probe")  # longer than the names of other files beside it
        if resolved.is_dir():
            cause, remedy = "this is a directory", "add a name"
        elif resolved.exists() and not resolved.is_file():
            cause, remedy = "this is a device, not a file", "give another path"
        elif resolved.exists() and not os.access(resolved, os.W_OK):
            cause, remedy = "the file is write-protected", "give another path"
        else:
            os.close(created(probe))
            probe.unlink()
            return resolved
    except ValueError as error:  # a NUL, half of a surrogate pair
        cause, remedy = f"this is no path: {error}", "give another one"
    except OSError as error:
        cause, remedy = error.strerror or str(error), "give a path in a directory that exists and is yours to write to"
        if error.errno == errno.ENAMETOOLONG:
            remedy = "give a shorter name, below 240 bytes"
    raise ResultFileError(f"{shown_path(path)}: the results cannot be written here: {cause}; {remedy}") from None


def check_free(path: Path) -> None:
    """Raise ResultFileError if a run is writing the file."""
    try:
        with open(path) as older:
            lock(older.fileno())
    except Taken:
        raise ResultFileError(f"{path}: a run is writing it; wait for its end, or give another name") from None
    except OSError:
        pass  # no such file


def over_time(coords: Mapping[str, Variable], variables: Mapping[str, Variable]) -> dict[str, np.ndarray]:
    """Return the values of the rows of a file."""
    return {"time": coords["time"].values} | {name: variable.values for name, variable in variables.items()}


def file_text(report: dict[str, Any], rows: int | None = None) -> str:
    """Return a report as one line of JSON; rows: the number of rows of a complete file."""
    return json.dumps(report if rows is None else {"rows": rows, **report}, default=methodcaller("tolist"))


def create_file(path: str | os.PathLike[str], coords: Mapping[str, Variable], variables: Mapping[str, Variable],
                scene: str, report: str, spare: int = 0, descriptor: int | None = None) -> File:
    """Return a new file of results without rows; report: from `file_text`; see `netcdf.create`. Raises OSError."""
    return create(path, coords, variables, {"funicular_format": FILE_FORMAT, "scene": scene}, report, spare, descriptor)


def open_file(path: str | os.PathLike[str]) -> File:
    """Return a file of results, open for reading. Raises ResultFileError."""
    if not os.path.isfile(path):
        raise ResultFileError(f"{shown_path(path)}: there is no such file")
    try:
        return File(path)
    except (OSError, ValueError) as error:
        raise ResultFileError(f"{path}: is no netCDF file, or was cut short or damaged: {error}") from error


class _Report(BaseModel):
    """Schema of the report in a file; parts that a report lacks have defaults."""

    model_config = ConfigDict(strict=True, extra="allow", defer_build=True)

    status: str
    message: str
    messages: list[str]
    settings: dict[str, Any]
    events: list[dict[str, Any]] = []
    time_s: dict[str, float] = {}
    us_per_step: dict[str, float] = {}
    modes: dict[str, str] = {}
    rows: int | None = None


def read_report(file: File) -> dict[str, Any]:
    """Return the report in a file. Raises ValueError, KeyError for a damaged one."""
    report = last_report(file.attributes["report"], file.has_checksums)
    _Report.model_validate(report)
    return report


def check_rows(file: File, rows: int | None, salvage: bool) -> None:
    """Raise ResultFileError for damaged rows, or leave them out; warn about a file without checksums.

    rows: the number of rows by the report, None for an unfinished run.
    """
    if rows is not None and rows != file.rows:
        raise ValueError(f"its header says that it has {file.rows} times, its report {rows}")
    if not file.has_checksums:
        warnings.warn(f"{file.path}: has no checksums, as an older funicular or another program wrote it: damage to it "
                      "would not be found", FunicularWarning, stacklevel=4)
        return
    damaged = file.damaged_rows()
    if not len(damaged):
        return
    named = ", ".join(map(str, damaged[:MAX_ROWS_IN_MESSAGE]))
    named += ", ..." if len(damaged) > MAX_ROWS_IN_MESSAGE else ""
    found = f"{file.path}: {len(damaged)} of its {file.rows} output times are damaged, those of the rows {named}"
    if not salvage or len(damaged) == file.rows:
        raise ResultFileError(f"{found}; take a copy of it, run the scene again, or read the other times with "
                              "load_run(path, salvage=True)")
    file.left_out = damaged
    warnings.warn(f"{found}; they are left out", FunicularWarning, stacklevel=4)
