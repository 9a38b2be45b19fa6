"""A reference case of ropes that run: quantities with their published numbers, and the function that computes them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache


@dataclass(frozen=True)
class Quantity:
    """A number of a case as it is written down, so that its digits are known.

    bar: largest error that a run of a rope may have, over the number itself, or in the unit where absolute.
    uncertainty: how far the true number may be from the written one, by default a unit of its last digit.
    """

    name: str
    unit: str
    written: str
    bar: float
    absolute: bool = False
    uncertainty: float | None = None

    @property
    def value(self) -> float:
        """Return the number."""
        return float(self.written)

    @property
    def within(self) -> float:
        """Return how far the true number may be from the written one."""
        decimals = len(self.written.partition(".")[2])
        return 10.0**-decimals if self.uncertainty is None else self.uncertainty

    def error(self, found: float) -> float:
        """Return the error of a result, as the bar counts it."""
        return abs(found - self.value) / (1.0 if self.absolute else abs(self.value))


def numbers(names: str, unit: str, written: str, bar: float, *, absolute: bool = False,
            uncertainty: float | None = None) -> tuple[Quantity, ...]:
    """Return quantities of one unit and bar: names between commas, numbers between blanks."""
    return tuple(Quantity(name.strip(), unit, number, bar, absolute, uncertainty)
                 for name, number in zip(names.split(","), written.split(), strict=True))


@dataclass(frozen=True, eq=False)
class Case:
    """A case with an independent solution.

    A run is to be compared with `reference`: written numbers may have fewer digits than the bar asks for, and some are
    no better than their uncertainty. compute: returns the quantities in their order, by means of numpy and scipy alone.
    slow: whether that takes more than some seconds.
    """

    key: str
    title: str
    quantities: tuple[Quantity, ...]
    compute: Callable[[], tuple[float, ...]]
    slow: bool = False

    @cache  # noqa: B019 - cases live as long as the program
    def reference(self) -> tuple[float, ...]:
        """Return the quantities of the independent solution."""
        return tuple(map(float, self.compute()))

    @property
    def values(self) -> tuple[float, ...]:
        """Return the published numbers."""
        return tuple(each.value for each in self.quantities)
