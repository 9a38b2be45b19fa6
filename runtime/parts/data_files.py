"""Arrays in files of data, .npz or netCDF."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..errors import shown_path

if TYPE_CHECKING:
    import xarray

NETCDF = {b"CDF\1": "scipy", b"CDF\2": "scipy", b"CDF\5": None, b"\x89HDF": None}
"""How files of data begin, and what reads them: None leaves it to xarray."""


@dataclass
class FileArrays:
    """Arrays of a file by name; dims: the names of the axes of each, and units, where the file tells them."""

    arrays: dict[str, np.ndarray]
    dims: dict[str, tuple[str, ...]] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, dataset: xarray.Dataset) -> FileArrays:
        """Return the arrays of a dataset, coordinates included, without their units."""
        return cls({str(name): each.values for name, each in dataset.variables.items()},
                   {str(name): tuple(map(str, each.dims)) for name, each in dataset.variables.items()})


def arrays_of(path: str) -> FileArrays:
    """Return the arrays in a file, coordinates included. Raises ValueError(cause, remedy)."""
    file = Path(path)
    if not os.path.isfile(file):  # False also of what no path can be
        raise ValueError(f'there is no file "{shown_path(path)}"')
    try:
        if file.suffix == ".npz":
            with np.load(file, allow_pickle=False) as found:  # a pickle would run code
                return FileArrays({name: found[name] for name in found.files})
        import xarray  # 0.5 s, for files of netCDF alone

        with open(file, "rb") as opened:
            head = opened.read(4)
        if head not in NETCDF:
            raise ValueError("it begins like no netCDF file")
        with xarray.open_dataset(file, engine=NETCDF[head], decode_times=False) as found:
            made = FileArrays.of(found)
            made.units = {str(name): str(each.attrs.get("units", "")) for name, each in found.variables.items()}
            return made
    except Exception as error:
        raise ValueError(f'"{path}" could not be read: {error}', "give an .npz or a netCDF file") from error
