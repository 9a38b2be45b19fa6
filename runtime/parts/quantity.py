"""Results of parts: dimensions, unit, meaning and turning of each quantity."""

from __future__ import annotations

from typing import Final

from ..base.deferred import dataclass
from ..engine import OUTPUTS
from .schemas import DIRECTION, ORIENTATION, POINT

UNCHANGED: Final = ""
IN_BODY_AXES: Final = "body axes"
NODAL_VECTORS: Final = "nodal vectors"
"""How other axes change a quantity: the words of the engine's outputs, nodal vectors with a point first, and unit
quaternions from body axes.
"""
TURNS = (UNCHANGED, POINT, DIRECTION, IN_BODY_AXES, NODAL_VECTORS, ORIENTATION)
VECTORS = {"xyz", "wxyz"}
"""Dimensions of quantities that other axes change."""


@dataclass(frozen=True)
class Quantity:
    """A quantity of a part in a run: dimensions, unit, meaning; turns: how other axes change it, of `TURNS`.

    Raises ValueError for a vector without turns.
    """

    dims: tuple[str, ...]
    units: str
    long_name: str
    turns: str = UNCHANGED

    def __post_init__(self) -> None:
        if self.turns not in TURNS or bool(VECTORS & {*self.dims}) == (self.turns == UNCHANGED):
            raise ValueError(f"{self.long_name}: a quantity over {self.dims} does not turn as {self.turns!r}; give one "
                             f"of {', '.join(TURNS[1:])} for a vector, and nothing for a number")

    def dims_of(self, part: str) -> tuple[str, ...]:
        """Return the dimensions of the quantity of a part of this name."""
        return tuple([dim.format(part=part) if "{" in dim else dim for dim in self.dims])


def of_time(units: str, long_name: str) -> Quantity:
    """Return a quantity of one number at each time."""
    return Quantity(("time",), units, long_name)


def vector_of_time(units: str, long_name: str, turns: str = DIRECTION) -> Quantity:
    """Return a quantity of three components along the ground's axes, or along body axes, at each time."""
    return Quantity(("time", "xyz"), units, long_name, turns)


def of_engine(kind: str, name: str, long_name: str, along: str = "xyz") -> Quantity:
    """Return an output of a kind of couplings of the engine; along: the dimension of several components."""
    output = OUTPUTS[kind][name]
    return Quantity(("time",) if output.size == 1 else ("time", along), output.units, long_name, output.turns)


def all_of_engine(kind: str, **long_names: str) -> dict[str, Quantity]:
    """Return outputs of a kind of couplings of the engine by name."""
    return {name: of_engine(kind, name, long_name) for name, long_name in long_names.items()}
