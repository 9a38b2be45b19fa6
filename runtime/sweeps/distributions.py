"""Distributions of parameters that samples are drawn from, by the inverse of their cumulative distribution."""

from __future__ import annotations

from typing import Annotated, ClassVar, Protocol, runtime_checkable

import numpy as np
from pydantic import model_validator

from ..parts.part import Part
from ..parts.validation import finite, positive, show


@runtime_checkable
class Distribution(Protocol):
    """What values can be drawn from: `Uniform`, `LogUniform`, or a frozen distribution of scipy.stats."""

    def ppf(self, q: np.ndarray) -> np.ndarray:
        """Return the values (n,) below which the parts q (n,) of all values lie."""


class Uniform(Part):
    """All values between ``low`` and ``high`` are equally likely."""

    positional: ClassVar[tuple[str, ...]] = ("low", "high")
    low: Annotated[float, finite()]
    high: Annotated[float, finite()]

    @model_validator(mode="after")
    def _rises(self) -> Uniform:
        _check_rises(self.low, self.high)
        return self

    def ppf(self, q: np.ndarray) -> np.ndarray:
        """Return the values (n,) below which the parts q (n,) of all values lie."""
        return self.low + (self.high - self.low) * q


class LogUniform(Part):
    """The logarithms of all values between those of ``low`` and ``high`` are equally likely; both positive."""

    positional: ClassVar[tuple[str, ...]] = ("low", "high")
    low: Annotated[float, positive()]
    high: Annotated[float, positive()]

    @model_validator(mode="after")
    def _rises(self) -> LogUniform:
        _check_rises(self.low, self.high)
        return self

    def ppf(self, q: np.ndarray) -> np.ndarray:
        """Return the values (n,) below which the parts q (n,) of all values lie."""
        return self.low * (self.high / self.low) ** q


def _check_rises(low: float, high: float) -> None:
    if not low < high:
        raise ValueError(f"high must be above low = {show(low)}, got {show(high)}")
