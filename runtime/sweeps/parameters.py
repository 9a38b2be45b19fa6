"""The points of a sweep: values of its parameters on a grid, in a list, or drawn from distributions."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Annotated, Any, ClassVar, Protocol, runtime_checkable

import numpy as np
from pydantic import model_validator

from ..errors import SceneError, near
from ..parts.part import Part
from ..parts.validation import MAX_COUNT, finite, positive, show, shown

SWEEP = "sweep"
METHODS = ("grid", "list", "random", "latin")
DRAWN = ("random", "latin")
"""Methods that draw their points from distributions."""
MAX_POINTS = 2**31 - 1
"""Rows of a file."""


@runtime_checkable
class Distribution(Protocol):
    """A distribution to draw values from: `Uniform`, `LogUniform`, or a frozen distribution of scipy.stats."""

    def ppf(self, q: np.ndarray) -> np.ndarray:
        """Return the quantiles (n,) of cumulative probabilities q (n,)."""


class _Bounded(Part):
    """A distribution between two bounds."""

    positional: ClassVar[tuple[str, ...]] = ("low", "high")
    low: Annotated[float, finite()]
    high: Annotated[float, finite()]

    @model_validator(mode="after")
    def _rises(self) -> _Bounded:
        if not self.low < self.high:
            raise ValueError(f"high must be above low = {show(self.low)}, got {show(self.high)}")
        return self


class Uniform(_Bounded):
    """All values between ``low`` and ``high`` are equally likely."""

    def ppf(self, q: np.ndarray) -> np.ndarray:
        """Return the quantiles (n,) of cumulative probabilities q (n,)."""
        return self.low + (self.high - self.low) * q


class LogUniform(_Bounded):
    """The logarithms of all values between those of ``low`` and ``high`` are equally likely; both positive."""

    low: Annotated[float, positive()]
    high: Annotated[float, positive()]

    def ppf(self, q: np.ndarray) -> np.ndarray:
        """Return the quantiles (n,) of cumulative probabilities q (n,)."""
        return self.low * (self.high / self.low) ** q


@dataclass(frozen=True)
class Points:
    """All points, numbered from 0; in a grid the last parameter varies fastest.

    columns: values by parameter, of each point (n,) or along each axis of a grid; arrays of int, float, bool or str.
    """

    method: str
    columns: Mapping[str, np.ndarray]

    @property
    def is_grid(self) -> bool:
        """Return whether the parameters span a grid."""
        return self.method == "grid"

    @property
    def shape(self) -> tuple[int, ...]:
        """Return the number of values along each dimension: the parameters of a grid, or the points."""
        sizes = tuple(len(values) for values in self.columns.values())
        return sizes if self.is_grid else sizes[:1]

    @property
    def number(self) -> int:
        """Return the number of points."""
        return math.prod(self.shape)

    def at(self, numbers: np.ndarray | Iterable[int]) -> dict[str, np.ndarray]:
        """Return the values of the points of these numbers, (numbers,) by parameter."""
        at = np.asarray(numbers, int)
        places = np.unravel_index(at, self.shape) if self.is_grid else [at] * len(self.columns)
        return {name: values[k] for (name, values), k in zip(self.columns.items(), places, strict=True)}

    def point(self, number: int) -> dict[str, Any]:
        """Return the values of one point by parameter, as plain int, float, bool or str."""
        return {name: values[0].item() for name, values in self.at([number]).items()}

    @property
    def digest(self) -> str:
        """Return the digest of all names and values."""
        digest = hashlib.sha256(self.method.encode())
        for name, values in self.columns.items():
            digest.update(f"\n{name} {values.dtype.str} {len(values)}\n".encode())
            digest.update(np.ascontiguousarray(values).tobytes())
        return digest.hexdigest()


def points_of(parameters: Mapping[str, Any], method: str = "grid", samples: int | None = None,
              seed: int = 0) -> Points:
    """Return the points of a sweep.

    parameters: by name a list of values, for "grid" (all combinations) and "list" (the first values of all, the second
    ones, ...), or a distribution, for "random" and "latin" (Latin hypercube) samples; samples: their number; seed: of
    the generator that draws them. Raises SceneError.
    """
    if method not in METHODS:
        raise SceneError(SWEEP, f'there is no method "{method}"', near(str(method), METHODS))
    if not isinstance(parameters, Mapping) or not parameters:
        raise SceneError(SWEEP, f"takes parameters by name, got {shown(parameters)}",
                         'give such as {"A.mass": [1.0, 2.0]}')
    for name in parameters:
        if not isinstance(name, str) or not name:
            raise SceneError(SWEEP, f"the name of a parameter must be a text, got {shown(name)}")
    if method in DRAWN:
        columns = _drawn(parameters, method, samples, seed)
    else:
        if samples is not None:
            raise SceneError(SWEEP, f'the method "{method}" takes no number of samples', 'add method="latin", or '
                             "leave it out")
        columns = {name: _values(name, given) for name, given in parameters.items()}
    points = Points(method, columns)
    _check_lengths(points)
    return points


def _check_lengths(points: Points) -> None:
    if points.is_grid:
        for name, values in points.columns.items():
            kinds, counts = np.unique(values, return_counts=True)
            if np.any(counts > 1):
                raise SceneError(SWEEP, f"{name} has the value {kinds[counts > 1][0]} twice", "give each value once")
    elif len({len(values) for values in points.columns.values()}) > 1:
        counted = ", ".join(f"{name} {len(values)}" for name, values in points.columns.items())
        raise SceneError(SWEEP, f"the lists have different numbers of values: {counted}",
                         'give each parameter one value a point, or method="grid"')
    if points.number > MAX_POINTS:
        raise SceneError(SWEEP, f"{points.number} points are more than a file can have, {MAX_POINTS}",
                         "sweep in parts")


def check_whole(name: str, value: Any, least: int, most: int | None = None) -> None:
    """Raise SceneError where a value is not a whole number within bounds."""
    if isinstance(value, bool) or not isinstance(value, Integral) or not least <= int(value) <= (most or int(value)):
        bounds = f"{least} or more" if most is None else f"from {least} to {most}"
        raise SceneError(SWEEP, f"{name} must be a whole number, {bounds}, got {shown(value)}")


def _drawn(parameters: Mapping[str, Any], method: str, samples: int | None, seed: int) -> dict[str, np.ndarray]:
    """Return samples (samples,) by parameter, from uniform ones by the inverse of each distribution."""
    if samples is None:
        raise SceneError(SWEEP, f'the method "{method}" needs a number of samples', "give samples=")
    check_whole("samples", samples, 1, 100 * MAX_COUNT)
    check_whole("seed", seed, 0)
    samples = int(samples)
    for name, given in parameters.items():
        if not isinstance(given, Distribution):
            raise SceneError(SWEEP, f'{name} must be a distribution for the method "{method}", got {shown(given)}',
                             "give fu.Uniform(low, high), fu.LogUniform(low, high), or one of scipy.stats")
    generator = np.random.default_rng(int(seed))
    if method == "random":
        unit = generator.random((samples, len(parameters)))
    else:
        from scipy.stats import qmc  # 0.5 s, for those who draw such samples

        unit = qmc.LatinHypercube(d=len(parameters), seed=generator).random(samples)
    columns = {name: np.asarray(given.ppf(unit[:, k]), float) for k, (name, given) in enumerate(parameters.items())}
    for name, values in columns.items():
        if values.shape != (samples,) or not np.all(np.isfinite(values)):
            raise SceneError(SWEEP, f"the distribution of {name} gives values that are not finite")
    return columns


def _values(name: str, given: Any) -> np.ndarray:
    """Return (n,): the values of a parameter, all of one type."""
    if isinstance(given, Distribution):
        raise SceneError(SWEEP, f"{name} is a distribution, and the points are not drawn",
                         'add method="latin" (or "random") and samples=')
    try:
        if isinstance(given, str | bytes | Mapping):
            raise TypeError
        values = [each.item() if isinstance(each, np.generic) else each for each in given]
    except TypeError:
        raise SceneError(SWEEP, f"the values of {name} must be a list, got {shown(given)}") from None
    if not values:
        raise SceneError(SWEEP, f"the list of values of {name} is empty", "give one value, or leave it out")
    for kind in (bool, str, Integral, Real):
        if all(isinstance(each, kind) and (kind is bool or not isinstance(each, bool)) for each in values):
            try:
                return np.array(values, {bool: bool, str: str, Integral: int, Real: float}[kind])
            except OverflowError:
                raise SceneError(SWEEP, f"{name} has an integer of too many digits",
                                 "write it as a number such as 1e9") from None
    odd = next((each for each in values if not isinstance(each, bool | str | Real)), None)
    if odd is None:
        raise SceneError(SWEEP, f"the values of {name} must be all numbers, all texts, or all true or false, got "
                         + shown(values))
    raise SceneError(SWEEP, f"a value of {name} must be a number or a text, got {shown(odd)}",
                     f"sweep one component of a vector, such as {name}.x, or give a function that makes the scene")
