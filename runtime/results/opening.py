"""Reading of runs from result files."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from ..errors import ResultFileError
from .checkpoints import add_events
from .files import FILE_FORMAT, WITH_CHECKSUMS, check_rows, read_report
from .netcdf import ROW_CHECKSUM, File, Stored
from .run import ReadScene, Run, SceneText


def opened(file: File, read_scene: ReadScene, libraries: Iterable[str | os.PathLike[str]] = (), salvage: bool = False,
           check: bool = True) -> Run:
    """Return the run in an open file, see `funicular.load_run`; check: verify the rows. Raises ResultFileError."""
    path = file.path
    if "funicular_format" not in file.attributes:
        raise ResultFileError(f"{path}: is a netCDF file, but not one that funicular wrote")
    try:
        made = np.asarray(file.attributes["funicular_format"]).item()
        if not isinstance(made, int):
            raise ValueError("its format is no number")
        if made > FILE_FORMAT:
            raise ResultFileError(f"{path}: was written by a newer funicular; update this one to read it")
        if made >= WITH_CHECKSUMS and not file.has_checksums:
            raise ValueError("it lacks its checksums")
        report, scene = read_report(file), file.attributes["scene"]
        rows = report.pop("rows", None)
        if check:
            check_rows(file, rows, salvage)
        names = [name for name, entry in file.entries.items()
                 if entry.dims[:1] != (name,) and not (name == ROW_CHECKSUM and file.has_checksums)]
        coords = {name: file.variable(name, file.read(name)) for name in file.entries
                  if name not in {*names, ROW_CHECKSUM}}
        if not isinstance(scene, str) or "time" not in coords:
            raise ValueError("it has no times, or no scene")
    except (OSError, ValueError, LookupError, TypeError, OverflowError) as error:
        raise ResultFileError(f"{path}: is damaged: {error}") from error
    if report["status"] == "unfinished":
        add_events(report, Path(path))
    return Run(Stored(file, names), coords, report, SceneText(scene, read_scene, libraries))
