"""What results tell of a part: names of dimensions, unit and meaning of each quantity."""

from __future__ import annotations

from typing import NamedTuple


class Quantity(NamedTuple):
    """A quantity of a part over the time of a run: the names of its dimensions, its unit, what it is."""

    dims: tuple[str, ...]
    units: str
    long_name: str


def of_time(units: str, long_name: str) -> Quantity:
    """Return a quantity of one number at each time."""
    return Quantity(("time",), units, long_name)


def vector_of_time(units: str, long_name: str) -> Quantity:
    """Return a quantity of three components along the ground's axes, or those that it names, at each time."""
    return Quantity(("time", "xyz"), units, long_name)
