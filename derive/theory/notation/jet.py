"""Numbers that carry their derivatives: forward differentiation, nested by levels, for the derivatives of a formula."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

Scalar = Any
"""A float or a Jet."""


class Jet:
    """value + sum of slope_k eps_k with eps_j eps_k = 0; of two jets the one of the higher level takes the other as a
    constant.
    """

    __slots__ = ("level", "slope", "value")

    def __init__(self, level: int, value: Scalar, slope: np.ndarray):
        self.level, self.value, self.slope = level, value, slope

    def _with(self, other: Scalar) -> tuple[int, Scalar, Any, Scalar, Any]:
        """Return the level of the result, and value and slope of both at it; slope None of a constant."""
        if not isinstance(other, Jet) or other.level < self.level:
            return self.level, self.value, self.slope, other, None
        if other.level > self.level:
            return other.level, self, None, other.value, other.slope
        return self.level, self.value, self.slope, other.value, other.slope

    def __add__(self, other: Scalar) -> Jet:
        if isinstance(other, np.ndarray):
            return NotImplemented  # entry by entry
        level, a, da, b, db = self._with(other)
        return Jet(level, a + b, _joined(da, db))

    def __neg__(self) -> Jet:
        return Jet(self.level, -self.value, -self.slope)

    def __sub__(self, other: Scalar) -> Jet:
        difference: Jet = self + (-other)
        return difference

    def __rsub__(self, other: Scalar) -> Jet:
        difference: Jet = -self + other
        return difference

    def __mul__(self, other: Scalar) -> Jet:
        if isinstance(other, np.ndarray):
            return NotImplemented  # entry by entry
        level, a, da, b, db = self._with(other)
        left, right = None if da is None else _scaled(da, b), None if db is None else _scaled(db, a)
        return Jet(level, a * b, _joined(left, right))

    __radd__, __rmul__ = __add__, __mul__

    def inverse(self) -> Jet:
        """Return 1 over it."""
        value = 1 / self.value if not isinstance(self.value, Jet) else self.value.inverse()
        return Jet(self.level, value, _scaled(self.slope, -value * value))

    def __truediv__(self, other: Scalar) -> Jet:
        if isinstance(other, np.ndarray):
            return NotImplemented  # entry by entry
        return self * (other.inverse() if isinstance(other, Jet) else 1 / other)

    def __rtruediv__(self, other: Scalar) -> Jet:
        quotient: Jet = self.inverse() * other
        return quotient

    def __pow__(self, n: int) -> Scalar:
        if n < 0:
            return self.inverse() ** -n
        result: Any = 1.0
        for _ in range(n):
            result = self * result
        return result

    def __lt__(self, other: Scalar) -> bool:
        return plain(self) < plain(other)

    def __gt__(self, other: Scalar) -> bool:
        return plain(self) > plain(other)


def _joined(left: np.ndarray | None, right: np.ndarray | None) -> np.ndarray:
    """Return the sum of two slopes, of which one may be missing."""
    if left is None or right is None:
        slope = right if left is None else left
        assert slope is not None
        return slope
    return np.asarray(left + right)


def _scaled(slope: np.ndarray, factor: Scalar) -> np.ndarray:
    if isinstance(factor, Jet):
        return np.array([s * factor for s in slope], dtype=object)
    return np.asarray(slope * factor)


def plain(value: Scalar) -> float:
    """Return the value without derivatives."""
    while isinstance(value, Jet):
        value = value.value
    return float(value)


def sqrt(value: Scalar) -> Scalar:
    """Return the square root."""
    if not isinstance(value, Jet):
        return math.sqrt(value)
    root = sqrt(value.value)
    return Jet(value.level, root, _scaled(value.slope, 0.5 / root))


def sin(value: Scalar) -> Scalar:
    """Return the sine."""
    if not isinstance(value, Jet):
        return math.sin(value)
    return Jet(value.level, sin(value.value), _scaled(value.slope, cos(value.value)))


def cos(value: Scalar) -> Scalar:
    """Return the cosine."""
    if not isinstance(value, Jet):
        return math.cos(value)
    return Jet(value.level, cos(value.value), _scaled(value.slope, -sin(value.value)))


def seeded(level: int, column: np.ndarray) -> np.ndarray:
    """Return a matrix of numbers as jets: each its own direction."""
    flat = column.ravel()
    jets = [Jet(level, v, np.eye(1, len(flat), k)[0]) for k, v in enumerate(flat)]
    return np.array(jets, dtype=object).reshape(column.shape)


def slope_of(value: Scalar, level: int, directions: int) -> list[Any]:
    """Return the derivatives of a number by the directions of a level."""
    if isinstance(value, Jet) and value.level == level:
        return list(value.slope)
    return [0.0] * directions
