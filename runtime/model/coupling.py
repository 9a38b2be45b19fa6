"""What all couplings have in common in a model: a name, and unknowns and multipliers of their own."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(kw_only=True)
class CouplingModel:
    """Base of what acts between attachments.

    name: of the part that it is of. n_unknowns: of its own in a Newton system, coordinates and then forces.
    n_multipliers: the most multipliers of eq 38 that it needs. unknown, multiplier: the first of each, of unknowns
    beyond the dofs, as `number` counts them.
    """

    name: str = ""
    n_unknowns: int = 0
    n_multipliers: int = 0
    unknown: int = -1
    multiplier: int = -1


def number(couplings: Iterable[CouplingModel]) -> tuple[int, int]:
    """Number the unknowns and the multipliers of couplings in their order; return how many of each there are."""
    n_unknowns = n_multipliers = 0
    for coupling in couplings:
        coupling.unknown, coupling.multiplier = n_unknowns, n_multipliers
        n_unknowns += coupling.n_unknowns
        n_multipliers += coupling.n_multipliers
    return n_unknowns, n_multipliers
