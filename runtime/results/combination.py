"""Several runs as one dataset, along a new dimension."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..errors import FunicularError
from .run import Run

if TYPE_CHECKING:
    import xarray
    from numpy.typing import ArrayLike


def combine(runs: Sequence[Run], **values: ArrayLike) -> xarray.Dataset:
    """Return the results of runs as one xarray.Dataset along a new dimension.

    values: the name of the dimension and a coordinate for each run: ``combine(runs, mass=[1.0, 2.0])``. Results, times
    and nodes of the runs must be the same. ``report`` and ``scene`` are texts along the new dimension. Raises
    FunicularError.
    """
    import xarray  # 0.5 s

    if len(values) != 1:
        raise FunicularError(f"combine: give one dimension, such as mass=[1.0, 2.0], got {len(values)}")
    (name, coordinate), = values.items()
    labels = np.asarray(coordinate)
    if labels.shape != (len(runs),) or not runs:
        raise FunicularError(f"combine: {name} must have one value for each of the {len(runs)} runs, got the shape "
                             f"{labels.shape}")
    first = runs[0]
    if name in first.variables or name in first.coords:
        raise FunicularError(f'combine: the runs have "{name}" already; name the dimension otherwise')
    for run, label in zip(runs[1:], labels[1:], strict=True):
        if run.keys() != first.keys():
            differ = ", ".join(sorted(set(run.keys()) ^ set(first.keys()))[:4])
            raise FunicularError(f"combine: the run of {name} = {label} has other results than the first: {differ}")
        for key, known in first.coords.items():
            if not np.array_equal(run.coords[key].values, known.values):
                raise FunicularError(f'combine: the run of {name} = {label} has another "{key}" than the first; for '
                                     "the same times give all the same duration and output_step")
    datasets = [run.dataset for run in runs]
    texts = {text: (name, [dataset.attrs[text] for dataset in datasets]) for text in ("report", "scene")}
    found = xarray.concat(datasets, dim=xarray.Variable(name, labels), data_vars="all", coords="minimal",
                          compat="override", join="override", combine_attrs="drop_conflicts")
    return found.assign(texts)
