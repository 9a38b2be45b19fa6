"""Results of parts: dimensions, unit and meaning of each quantity, and how other axes change it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from ..engine import OUTPUTS
from .schemas import DIRECTION, ORIENTATION, POINT

UNCHANGED: Final = ""
IN_BODY_AXES: Final = "body axes"
NODAL_VECTORS: Final = "nodal vectors"
"""How other axes change a quantity: the words of the engine's outputs; and nodal vectors, the first of which is a
point, and unit quaternions from body axes.
"""
TURNS = (UNCHANGED, POINT, DIRECTION, IN_BODY_AXES, NODAL_VECTORS, ORIENTATION)
VECTORS = {"xyz", "wxyz"}
"""Dimensions of what other axes change."""


@dataclass(frozen=True)
class Quantity:
    """A quantity of a part over the time of a run: the names of its dimensions, its unit, its meaning; `turns` says how
    other axes change it, one of `TURNS`. Raises ValueError for a vector that does not say that.
    """

    dims: tuple[str, ...]
    units: str
    long_name: str
    turns: str = UNCHANGED

    def __post_init__(self) -> None:
        if self.turns not in TURNS or bool(VECTORS & {*self.dims}) == (self.turns == UNCHANGED):
            raise ValueError(f"{self.long_name}: a quantity over {self.dims} does not turn as {self.turns!r}; give one "
                             f"of {', '.join(TURNS[1:])} for a vector, and nothing for a number")


def of_time(units: str, long_name: str) -> Quantity:
    """Return a quantity of one number at each time."""
    return Quantity(("time",), units, long_name)


def vector_of_time(units: str, long_name: str, turns: str = DIRECTION) -> Quantity:
    """Return a quantity of three components along the ground's axes, or along body axes, at each time."""
    return Quantity(("time", "xyz"), units, long_name, turns)


def of_engine(kind: str, name: str, long_name: str, along: str = "xyz") -> Quantity:
    """Return the output of this name of the engine's couplings of a kind: unit, size and turning are the engine's.

    along: the dimension of one of several components.
    """
    output = OUTPUTS[kind][name]
    return Quantity(("time",) if output.size == 1 else ("time", along), output.units, long_name, output.turns)


def all_of_engine(kind: str, **long_names: str) -> dict[str, Quantity]:
    """Return outputs of the engine's couplings of a kind by their names, in this order."""
    return {name: of_engine(kind, name, long_name) for name, long_name in long_names.items()}
