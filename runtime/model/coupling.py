"""The common part of all couplings of a model: a type of the engine, and internal unknowns and multipliers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import field
from typing import Any, ClassVar

import numpy as np

from ..base.deferred import dataclass
from .attachments import AttachmentModel, ModelBuilder


def no_numbers() -> np.ndarray:
    """Return an array (0,)."""
    return np.zeros(0)


@dataclass(eq=False, repr=False, kw_only=True)
class CouplingModel:
    """Base of the models of couplings. The engine reads fields of its type from attributes and entries of these names.

    type: the engine's type of coupling. name: of its part. n_coordinates: number of internal coordinates in a Newton
    system. scale: factors of the equations of its internal forces there, kg or kg m. n_multipliers: the largest number
    of multipliers of eq 38. n_numbers: of its history variables. needs_reactions, is_damped: whether a force depends on
    these multipliers, on velocities. has_inertia: whether it adds mass. drive: number of the signal that prescribes a
    motion, or -1. follows_law: whether a law gives the internal forces, and not constraints. redundant_rows:
    constraints that follow from others, without forces (redundant_constraints.py). unknown, multiplier: the first of
    each, of unknowns beyond the dofs, as `number` counts them; number: its place among all couplings. entries: fields
    that the engine alone reads.

    keeps_forces: whether a search for rest continues from the internal forces of the last state, which else start at
    zero; reports_cost: whether the report of a run has its computing time; ties_adjacent: whether its tangent has
    entries between its attachments and adjacent dofs.
    """

    keeps_forces: ClassVar[bool] = True
    reports_cost: ClassVar[bool] = False
    ties_adjacent: ClassVar[bool] = True
    type: str
    name: str = ""
    n_coordinates: int = 0
    scale: Sequence[float] | np.ndarray = ()
    n_multipliers: int = 0
    n_numbers: int = 0
    needs_reactions: bool = False
    is_damped: bool = False
    has_inertia: bool = False
    drive: int = -1
    follows_law: bool = False
    redundant_rows: set[int] = field(default_factory=set)
    unknown: int = -1
    multiplier: int = -1
    number: int = -1
    entries: dict[str, Any] = field(default_factory=dict)

    @property
    def kernel_families(self) -> list[str]:
        """Return the names of the kernel families that it uses."""
        of_points = {end.rope_point for end in self.ends if end.rope_point}
        return [*([self.kernel] if hasattr(self, "kernel") else []), *sorted(of_points)]

    @property
    def ends(self) -> Sequence[AttachmentModel]:
        """Return the attachments that it acts on."""
        return getattr(self, "attachments", ())

    @property
    def along(self) -> Sequence[int]:
        """Return the numbers of the cables on which its places move."""
        return ()

    @property
    def adjacent(self) -> Sequence[np.ndarray]:
        """Return arrays of dofs beside those of cables that its mass and its tangent couple to each other."""
        return ()

    def ties_ends(self, dim: int) -> bool:
        """Return whether its tangent has entries between the attachments, beside those of its internal unknowns."""
        return not self.n_forces

    @property
    def is_driven(self) -> bool:
        """Return whether a signal does work on it."""
        return self.drive >= 0

    @property
    def free_coordinates(self) -> list[int]:
        """Return the unknowns that are internal coordinates and that equilibrium determines."""
        return [] if self.is_driven else [self.unknown + k for k in range(self.n_coordinates)]

    @property
    def force_unknowns(self) -> list[int]:
        """Return the unknowns that are internal forces, without redundant rows."""
        first = self.unknown + self.n_coordinates
        return [first + k for k in range(self.n_forces) if k not in self.redundant_rows]

    @property
    def n_forces(self) -> int:
        """Return the number of its internal forces in a Newton system."""
        return len(self.scale)


def number(couplings: Iterable[CouplingModel]) -> tuple[int, int]:
    """Number the unknowns and the multipliers of couplings in their order; return the numbers of both."""
    n_unknowns = n_multipliers = 0
    for k, coupling in enumerate(couplings):
        coupling.number, coupling.unknown, coupling.multiplier = k, n_unknowns, n_multipliers
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
