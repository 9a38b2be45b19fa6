"""The velocity of a fluid on a grid in time and space, from numbers or a file."""

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import model_validator

from ..base.deferred import dataclass
from ..errors import near
from .data_files import MAX_NUMBERS, FileArrays, arrays_of
from .part import Part
from .plane import flattened
from .schemas import FileEntry, checked
from .validation import LIMITS, OTHER_LIMITS, list_of, one_of, show

if TYPE_CHECKING:
    import xarray

AXES = ("time", "x", "y", "z")
COMPONENTS = ("u", "v", "w")
UNITS = {"time": "s", "x": "m", "y": "m", "z": "m"}
DEGREES = {"linear": 1, "cubic": 3}
MAX_OVERSHOOT = 0.5
"""Of splines half-way between the values, over the range of the values."""

Times = Annotated[tuple[float, ...] | None, list_of("s", least=2)]
Lengths = Annotated[tuple[float, ...] | None, list_of("m", least=2)]


def _as_tuples(value: Any) -> Any:
    return tuple(map(_as_tuples, value)) if isinstance(value, list) else value


def _velocities(value: Any) -> Any:
    """Return nested tuples of finite numbers, in m/s."""
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise ValueError("must be lists of numbers in lists, of equal lengths") from None
    _check_numbers(array)
    return _as_tuples(array.tolist())


def _check_numbers(array: np.ndarray) -> None:
    if array.size > MAX_NUMBERS:
        raise ValueError(f"must not have more than {MAX_NUMBERS} numbers, got {array.size}", "take a coarser grid")
    wrong = np.argwhere(~np.isfinite(array))
    if len(wrong):
        raise ValueError(f"must be finite, got {array[tuple(wrong[0])]} at the indices {wrong[0].tolist()}, one of "
                         f"{len(wrong)} such places", "fill in missing values, such as those on land")
    if np.abs(array).max(initial=0.0) > OTHER_LIMITS[1]:
        raise ValueError(f"must not exceed {show(OTHER_LIMITS[1], 'm/s')} in size")


@dataclass(eq=False)  # tables are compared by their entries
class Grid:
    """Velocities (time, x, y, z, 3) in m/s, of size 1 along other axes than those by name."""

    axes: dict[str, np.ndarray]
    velocity: np.ndarray


class VelocityTable(Part):
    """The velocity of a fluid on a grid of time and place, between which it is interpolated.

    Beyond the edges of the grid the velocity is that at the edge. A start beyond them is refused, and a run notes when
    a cable or body leaves the grid.

    file: a netCDF file with these names (components along an axis ``xyz``, or in three variables ``u``, ``v``, ``w``),
        or an .npz of them
    time: places of the grid, increasing, two or more, s
    x, y, z: places of the grid along the ground's axes, m. The velocity does not depend on axes that are left out
    velocity: an array over those axes, in this order, and the three components, m/s
    interpolation: "cubic", splines whose second derivatives are continuous (four values or more along each axis), or
        "linear"
    """

    file: Annotated[str | None, checked(lambda value: str(value), {"type": "string"}, FileEntry())] = None
    time: Times = None
    x: Lengths = None
    y: Lengths = None
    z: Lengths = None
    velocity: Annotated[Any, checked(_velocities, {"type": "array", "description": "in m/s"})] = None
    interpolation: Annotated[str, one_of(tuple(DEGREES))] = "cubic"

    @classmethod
    def of(cls, data: "xarray.Dataset", interpolation: str = "cubic") -> "VelocityTable":
        """Return the table of an xarray.Dataset with the names that a file has. Raises SceneError."""
        grid = _grid(FileArrays.of(data), "the dataset")
        given = {name: values.tolist() for name, values in grid.axes.items()}
        shape = [len(values) for values in given.values()]
        return cls(**given, velocity=grid.velocity.reshape(*shape, 3).tolist(), interpolation=interpolation)

    @model_validator(mode="after")
    def _is_a_grid(self) -> "VelocityTable":
        given = [name for name in (*AXES, "velocity") if getattr(self, name) is not None]
        if self.file is not None and given:
            raise ValueError(f"has file and {given[0]}", "give the file, or the numbers")
        if self.file is None and self.velocity is None:
            raise ValueError("velocity is missing", "give velocity over time, x, y or z, or a file")
        for name, values in self.grid.axes.items():
            if self.interpolation == "cubic" and len(values) < 4:
                raise ValueError(f"{name} has {len(values)} values, and cubic splines need four",
                                 'give more, or take interpolation="linear"')
        if self.interpolation == "cubic":
            _check_overshoot(self.grid)
        return self

    @cached_property
    def grid(self) -> Grid:
        """Return its axes and velocities. Raises ValueError(cause, remedy)."""
        if self.file is not None:
            return _grid(arrays_of(self.file), f'"{self.file}"')
        given = {name: getattr(self, name) for name in (*AXES, "velocity")}
        return _grid(FileArrays({name: np.array(each) for name, each in given.items() if each is not None}), "it")

    def turned(self, axes: np.ndarray) -> "VelocityTable":
        """Return the table with velocities along other axes, the columns of ``axes`` (3, 3); the grid stays."""
        made = self.model_copy()
        made.__dict__.pop("_splines", None)  # the copy has the splines of its original
        made.__dict__["grid"] = Grid(self.grid.axes, flattened(self.grid.velocity @ axes))
        return made

    def off_plane(self) -> Iterator[str]:
        """Yield the velocity on its grid of the largest z component, see `Part.off_plane`."""
        velocities = self.grid.velocity.reshape(-1, 3)
        fastest = velocities[np.argmax(np.abs(velocities[:, 2]))]
        if fastest[2]:
            yield show(fastest, "m/s")

    def splines(self, dim: int) -> tuple[int, dict[str, np.ndarray], np.ndarray]:
        """Return degree, breakpoints by axis, and coefficients (n_time, n_x, n_y, n_z, dim) of its splines."""
        knots, coefficients = self._splines
        return DEGREES[self.interpolation], knots, np.ascontiguousarray(coefficients[..., :dim])

    @cached_property
    def _splines(self) -> tuple[dict[str, np.ndarray], np.ndarray]:
        """Return breakpoints by axis and read-only coefficients of all three components."""
        from scipy.interpolate import make_interp_spline  # slow to import

        knots, coefficients = {}, self.grid.velocity
        for name, values in self.grid.axes.items():
            spline = make_interp_spline(values, coefficients, DEGREES[self.interpolation], axis=AXES.index(name))
            knots[name], coefficients = spline.t, np.moveaxis(spline.c, 0, AXES.index(name))
        coefficients = np.ascontiguousarray(coefficients)
        coefficients.flags.writeable = False
        return knots, coefficients

    def value(self, time: np.ndarray, place: np.ndarray) -> np.ndarray:
        """Return the velocity (..., 3) in m/s at times (s) and places (..., 3) in m."""
        from scipy.interpolate import NdBSpline  # slow to import

        degree, knots, coefficients = self.splines(3)
        shape = np.broadcast_shapes(np.shape(time), place.shape[:-1])
        at = {name: np.broadcast_to(values, shape) for name, values in zip(
            AXES, (np.asarray(time), *np.moveaxis(place, -1, 0)), strict=True)}
        inside = [np.clip(at[name], values[0], values[-1]).ravel() for name, values in self.grid.axes.items()]
        needed = coefficients.reshape(*(len(knots[name]) - degree - 1 for name in knots), 3)
        return NdBSpline(tuple(knots.values()), needed, degree)(np.stack(inside, axis=-1)).reshape(*shape, 3)

    def margin(self, time: np.ndarray, place: np.ndarray) -> tuple[float, str]:
        """Return the least distance of times and places from the edges over the length of an axis, and the axis."""
        least, worst = np.inf, ""
        for name, values in self.grid.axes.items():
            at = np.asarray(time) if name == "time" else place[..., AXES.index(name) - 1]
            margin = float(np.min(np.minimum(at - values[0], values[-1] - at)) / (values[-1] - values[0]))
            if margin < least:
                least, worst = margin, name
        return least, worst


def _grid(data: FileArrays, what: str) -> Grid:
    """Return the grid in arrays with the names of a `VelocityTable`. Raises ValueError(cause, remedy)."""
    arrays = data.arrays
    axes = {name: _axis(name, arrays[name], data.units.get(name, "")) for name in AXES if name in arrays}
    if not axes:
        raise ValueError(f"{what} has none of time, x, y and z",
                         "give the places of the grid, or a velocity without one")
    order = tuple(axes)
    if "velocity" in arrays:
        velocity = _ordered(arrays, data.dims, "velocity", (*order, "xyz"))
    elif all(name in arrays for name in COMPONENTS):
        velocity = np.stack([_ordered(arrays, data.dims, name, order) for name in COMPONENTS], axis=-1)
    else:
        raise ValueError(f"{what} has no velocity, nor u, v and w", near("velocity", arrays))
    shape = tuple(len(values) for values in axes.values())
    if velocity.shape != (*shape, 3):
        raise ValueError(f"velocity must have the shape {(*shape, 3)}, of {', '.join(order)} and the three components, "
                         f"got {velocity.shape}")
    _check_numbers(velocity)
    return Grid(axes, velocity.reshape(*(len(axes[name]) if name in axes else 1 for name in AXES), 3))


def _check_overshoot(grid: Grid) -> None:
    """Raise ValueError where splines overshoot their values, as between distant places."""
    from scipy.interpolate import make_interp_spline  # slow to import

    low, high = (extreme(grid.velocity.reshape(-1, 3), axis=0) for extreme in (np.min, np.max))
    allowed = MAX_OVERSHOOT * (high - low) + 1e-9 * np.abs(grid.velocity).max()
    for name, values in grid.axes.items():
        middle = (values[1:] + values[:-1]) / 2
        found = np.moveaxis(make_interp_spline(values, grid.velocity, 3, axis=AXES.index(name))(middle),
                            AXES.index(name), 0)
        beyond = np.maximum(found - high, low - found) - allowed
        if beyond.max() > 0:
            k, *at = np.unravel_index(np.argmax(beyond), beyond.shape)
            unit = UNITS[name]
            there = f"{name} = {show(float(values[k]), unit)} and {show(float(values[k + 1]), unit)}"
            raise ValueError("its cubic splines go far beyond its values, to "
                             f"{show(float(found[k, *at]), 'm/s')} between {there}",
                             f'give {name} at more even distances, or take interpolation="linear"')


def _axis(name: str, values: np.ndarray, unit: str) -> np.ndarray:
    """Return the checked places of an axis."""
    known = {"time": ("s", "second", "seconds"), "x": ("m", "metre", "meter", "metres", "meters")}
    if unit and unit not in known.get(name, known["x"]):
        raise ValueError(f'{name} is in "{unit}"', f"give it in {UNITS[name]}")
    values = np.asarray(values)
    if values.ndim != 1 or values.dtype.kind not in "iuf" or len(values) < 2:
        raise ValueError(f"{name} must be a list of two numbers or more",
                         "leave out what the velocity does not depend on")
    values = values.astype(float)
    if not np.all(np.abs(values) <= LIMITS[UNITS[name]][1]):
        raise ValueError(f"{name} must be finite, within {show(LIMITS[UNITS[name]][1], UNITS[name])}")
    if not np.all(np.diff(values) > 0):
        raise ValueError(f"{name} must increase")
    return values


def _ordered(arrays: Mapping[str, np.ndarray], dims: Mapping[str, tuple[str, ...]], name: str,
             order: tuple[str, ...]) -> np.ndarray:
    """Return an array with its axes in an order, where its file names them."""
    array = np.asarray(arrays[name], dtype=float)
    if name not in dims:
        return array
    if sorted(dims[name]) != sorted(order):
        raise ValueError(f"{name} has the axes {', '.join(dims[name])}", f"it needs {', '.join(order)}")
    return np.transpose(array, [dims[name].index(each) for each in order])
