"""The results of a sweep as one xarray dataset, whose arrays are read from the file on demand."""

from __future__ import annotations

import os
import warnings
from typing import Any

import numpy as np
import xarray
from xarray.backends import BackendArray
from xarray.core import indexing

from ..errors import FunicularWarning, ResultFileError
from ..results.files import open_file
from ..results.netcdf import ROW_CHECKSUM, File, texts
from .layout import OF_STATUS, POINT, STATUS
from .store import FORMAT, complete_rows, facts_in

KINDS = {"int": int, "float": float, "bool": bool, "str": str}
"""Types of the values of parameters."""
MAX_FIXED_TEXT = 64
"""Characters of a text of fixed length; longer ones, most of which are empty, are Python's."""
READ_BYTES = 1 << 24
"""Bytes of rows that are read at once."""
NOT_RUN = "not run"
"""The status of a point that a sweep has not reached."""


class _OfPoints(BackendArray):
    """One variable over the points, read on demand; NaN where a point was not run."""

    def __init__(self, file: File, name: str, shape: tuple[int, ...], absent: np.ndarray):
        """shape: of the points, in place of the file's rows; absent: the numbers of the points that are left out."""
        entry = file.entries[name]
        self._source = file.path if os.path.exists(file.path) else file.descriptor  # the file may have no name
        self._name, self._of_points, self._absent = name, shape, absent
        self._row, self._first = file.row_dtype, file.first_row_at
        self._is_text = entry.dtype.kind == "S"
        self.shape = shape if self._is_text else (*shape, *entry.shape)
        text = np.dtype(object if entry.shape[0] > MAX_FIXED_TEXT else f"U{entry.shape[0]}") if self._is_text else None
        self.dtype = text or np.dtype(float)

    def __getitem__(self, key: Any) -> Any:
        """Return the values at an index of xarray's."""
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._read)

    def _read(self, key: tuple[Any, ...]) -> np.ndarray:
        """Return the values at numbers, slices or arrays, one for each dimension."""
        axes = [np.arange(size)[each] for size, each in zip(self.shape, key, strict=True)]
        many = [np.atleast_1d(axis) for axis in axes]
        dims = len(self._of_points)
        numbers = np.ravel_multi_index(np.ix_(*many[:dims]), self._of_points).ravel()
        found = np.empty((len(numbers), *map(len, many[dims:])), self.dtype)
        step = max(1, READ_BYTES // self._row.itemsize)
        for at in range(0, len(numbers), step):
            some = slice(at, at + step)
            found[some] = self._rows(numbers[some], many[dims:])
        gone = np.isin(numbers, self._absent)
        found[gone] = (NOT_RUN if self._name == STATUS else "") if self._is_text else np.nan
        return found.reshape([axis.size for axis in axes if axis.ndim])

    def _rows(self, numbers: np.ndarray, others: list[np.ndarray]) -> np.ndarray:
        """Return the values of points of these numbers, at places along the other dimensions.

        Only the part of the file between them is mapped: pages that were read count as memory until it is unmapped.
        """
        first, last = int(numbers.min()), int(numbers.max())
        with open(self._source, "rb", closefd=isinstance(self._source, str)) as opened:
            rows = np.memmap(opened, self._row, "r", self._first + first * self._row.itemsize, (last - first + 1,))
        field = rows[self._name]
        return texts(field[numbers - first]) if self._is_text else field[np.ix_(numbers - first, *others)]


def dataset_of(file: File, facts: dict[str, Any], finished: np.ndarray) -> xarray.Dataset:
    """Return the dataset of a sweep's file; finished: (points,), whether the row of each is complete."""
    parameters = facts["parameters"]
    is_grid = facts["method"] == "grid"
    shape = tuple(len(each["values"]) for each in parameters) if is_grid else (len(finished),)
    dims = tuple(each["name"] for each in parameters) if is_grid else (POINT,)
    absent = np.flatnonzero(~finished)

    def lazy(name: str) -> xarray.Variable:
        entry = file.entries[name]
        labels = {label: str(entry.attributes.get(label, "")) for label in ("units", "long_name")}
        return xarray.Variable(dims + (() if entry.dtype.kind == "S" else entry.dims[1:]),
                               indexing.LazilyIndexedArray(_OfPoints(file, name, shape, absent)), labels)

    coords = {}
    for name, entry in file.entries.items():
        if not entry.in_rows:  # a coordinate of results, the same for all points
            fixed = file.variable(name, file.read(name))
            coords[name] = xarray.Variable(fixed.dims, fixed.values, {"units": fixed.units,
                                                                      "long_name": fixed.long_name})
    for each in parameters:
        name, labels = each["name"], {"units": each["units"] or "1", "long_name": "parameter"}
        values = np.array(each["values"]) if is_grid else lazy(name).values
        if is_grid or finished.all() or each["kind"] in ("float", "str"):
            values = values.astype(KINDS[each["kind"]])
        coords[name] = xarray.Variable((name if is_grid else POINT,), values, labels)
    left_out = {ROW_CHECKSUM, *(each["name"] for each in parameters)}
    names = [name for name, entry in file.entries.items() if entry.in_rows and name not in left_out]
    names.sort(key=lambda name: name in OF_STATUS)
    attributes = {"scene": str(file.attributes["scene"]), "method": facts["method"], "seed": facts["seed"],
                  "finished": int(finished.sum()), "funicular_sweep": int(np.asarray(file.attributes[FORMAT]).item())}
    return xarray.Dataset({name: lazy(name) for name in names}, coords, attributes)


def load_sweep(path: str | os.PathLike[str], salvage: bool = False) -> xarray.Dataset:
    """Open the results of a sweep as an xarray.Dataset, also of one that is running or was killed.

    Its dimensions are the parameters of a grid, or ``point`` with the parameters along it. Arrays are read from the
    file on demand. ``status`` is "failed" for a point whose error ``message`` gives, and "not run" for one that the
    sweep has not reached; both are NaN. All rows are checked. salvage: take damaged rows for points that were not run,
    with a `FunicularWarning`, where the file would be refused otherwise. Raises ResultFileError.
    """
    file = open_file(path)
    facts = facts_in(file)
    try:
        finished = complete_rows(file, facts["number"])
    except OSError as error:
        raise ResultFileError(f"{file.path}: is damaged: {error}") from error
    if damaged := int(np.sum(~finished[: file.rows])):
        found = f"{file.path}: {damaged} of its points are damaged, the first is number {int(np.argmin(finished))}"
        if not salvage:
            raise ResultFileError(f"{found}; repeat the sweep with the same command, which computes them again, or "
                                  "read the others with load_sweep(path, salvage=True)")
        warnings.warn(f"{found}; they are left out", FunicularWarning, stacklevel=2)
    return dataset_of(file, facts, finished)
