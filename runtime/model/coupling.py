"""The common part of all couplings of a model: a type of the engine, and internal unknowns and multipliers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from .attachments import AttachmentModel, ModelBuilder


@dataclass(kw_only=True)
class CouplingModel:
    """Base of what acts between attachments. The engine reads its attributes by the names of the fields of its type.

    type: the engine's type of coupling. name: of the part that it is of. n_coordinates: of its own in a Newton system.
    scale: what the equations of each of its own forces are multiplied by there, kg or kg m. n_multipliers: the most
    multipliers of eq 38 that it needs. reacts, is_damped: a force of it depends on those multipliers, on velocities;
    has_inertia: it has a mass. drive: the number of a signal that prescribes a motion of it, or -1. follows_law: its
    own forces are given by a law, and else by constraints. redundant_rows: those of its constraints that others imply,
    whose forces are nil (model/redundant_constraints.py). unknown, multiplier: the first of each, of unknowns beyond
    the dofs, as `number` counts them.

    keeps_forces: a search for rest goes on from its own forces, which else begin at zero in each state; reports_cost:
    the report of a run says how long it takes.
    """

    keeps_forces: ClassVar[bool] = True
    reports_cost: ClassVar[bool] = False
    type: str
    name: str = ""
    n_coordinates: int = 0
    scale: Sequence[float] | np.ndarray = ()
    n_multipliers: int = 0
    n_numbers: int = 0
    reacts: bool = False
    is_damped: bool = False
    has_inertia: bool = False
    drive: int = -1
    follows_law: bool = False
    redundant_rows: set[int] = field(default_factory=set)
    unknown: int = -1
    multiplier: int = -1

    @property
    def kernel_families(self) -> list[str]:
        """Return the names of the generated kernels that it takes."""
        return [self.kernel] if hasattr(self, "kernel") else []

    @property
    def ends(self) -> Sequence[AttachmentModel]:
        """Return the attachments that it acts on, `attachments` where it has these."""
        return getattr(self, "attachments", ())

    @property
    def along(self) -> Sequence[int]:
        """Return the numbers of cables that it acts on at places that move."""
        return ()

    def ties_ends(self, dim: int) -> bool:
        """Return whether the tangent of its forces has entries between what it acts on, beside its own unknowns."""
        return not self.n_forces

    @property
    def is_driven(self) -> bool:
        """Return whether a signal does work on it."""
        return self.drive >= 0

    @property
    def free_coordinates(self) -> list[int]:
        """Return the unknowns that are its own coordinates, as far as equilibrium determines them."""
        return [] if self.is_driven else [self.unknown + k for k in range(self.n_coordinates)]

    @property
    def force_unknowns(self) -> list[int]:
        """Return the unknowns that are its own forces, but for redundant rows."""
        first = self.unknown + self.n_coordinates
        return [first + k for k in range(self.n_forces) if k not in self.redundant_rows]

    @property
    def n_forces(self) -> int:
        """Return the number of its own forces in a Newton system."""
        return len(self.scale)


def number(couplings: Iterable[CouplingModel]) -> tuple[int, int]:
    """Number the unknowns and the multipliers of couplings in their order; return how many of each there are."""
    n_unknowns = n_multipliers = 0
    for coupling in couplings:
        coupling.unknown, coupling.multiplier = n_unknowns, n_multipliers
        n_unknowns += coupling.n_coordinates + coupling.n_forces
        n_multipliers += coupling.n_multipliers
    return n_unknowns, n_multipliers


@dataclass(frozen=True)
class CouplingKind:
    """A kind of coupling: name of the engine's type, group of its parts, and the function that makes its models.

    has_state: a state of rest has unknowns of it, so that the state fits only scenes with the same parts of the group.
    """

    name: str
    group: str
    models: Callable[[ModelBuilder], Iterable[CouplingModel]]
    has_state: bool = True
