"""Arrays in files of data, .npz or netCDF."""

from __future__ import annotations

import math
import os
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..base.bounded_files import MAX_ARRAY_BYTES, TooLargeError, check_bytes, check_numbers
from ..base.deferred import dataclass
from ..errors import shown_path

if TYPE_CHECKING:
    import xarray

NETCDF = {b"CDF\1": "scipy", b"CDF\2": "scipy", b"CDF\5": None, b"\x89HDF": None}
"""Engines of xarray by the first bytes of a file, None for its choice."""

MAX_NUMBERS = 50_000_000
"""Of an array: 400 MB."""


@dataclass
class FileArrays:
    """Arrays of a file by name; dims, units: names of the axes and unit of each array, where the file has them."""

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
    if not os.path.isfile(file):  # False also for what cannot be a path
        raise ValueError(f'there is no file "{shown_path(path)}"')
    try:
        check_bytes(file, MAX_ARRAY_BYTES)
        if file.suffix == ".npz":
            check_numbers(_sizes_in_npz(file))
            with np.load(file, allow_pickle=False) as found:  # a pickle runs code
                return FileArrays({name: found[name] for name in found.files})
        import xarray  # 0.5 s

        with open(file, "rb") as opened:
            head = opened.read(4)
        if head not in NETCDF:
            raise ValueError("it begins like no netCDF file")
        with xarray.open_dataset(file, engine=NETCDF[head], decode_times=False) as found:
            check_numbers((str(name), _numbers(each.shape, each.dtype)) for name, each in found.variables.items())
            made = FileArrays.of(found)
            made.units = {str(name): str(each.attrs.get("units", "")) for name, each in found.variables.items()}
            return made
    except TooLargeError as error:
        cause, remedy = error.args
        raise ValueError(f'"{path}" {cause}', remedy) from None
    except Exception as error:
        raise ValueError(f'"{path}" could not be read: {error}', "give an .npz or a netCDF file") from error


def _numbers(shape: tuple[int, ...], dtype: np.dtype) -> int:
    """Return the least number of 8-byte numbers that hold an array."""
    return math.prod(shape) * max(1, -(-dtype.itemsize // 8))


def _sizes_in_npz(file: Path) -> list[tuple[str, int]]:
    """Return the size of each array of an .npz from the headers of the arrays. Raises errors of damaged files.

    An archive may have two members of one name, with and without the ending .npy.
    """
    import zipfile  # for few scenes

    sizes = []
    with zipfile.ZipFile(file) as archive:
        for name in archive.namelist():
            with archive.open(name) as member:
                version = np.lib.format.read_magic(member)
                read = (np.lib.format.read_array_header_1_0 if version == (1, 0)
                        else np.lib.format.read_array_header_2_0)
                shape, _, dtype = read(member)
                sizes.append((name.removesuffix(".npy"), _numbers(shape, dtype)))
    return sizes
