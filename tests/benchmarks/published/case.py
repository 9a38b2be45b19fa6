"""A published case: numbers with their source, and the scene that computes them with an element and a law."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from typing import TypeVar

import numpy as np

Value = TypeVar("Value")


@dataclass(frozen=True)
class Kind:
    """An element and its elastic law, by the names of scenes."""

    element: str
    law: str

    def __str__(self) -> str:
        return f"{self.element} {self.law}"

    @property
    def is_cable(self) -> bool:
        """Return whether it has axial and bending stiffness alone."""
        return self.element.startswith("cable")

    @property
    def is_planar(self) -> bool:
        """Return whether it moves in the plane z = 0 only."""
        return self.element.endswith("p")

    @property
    def is_green(self) -> bool:
        """Return whether it is a cable with green strain, whose curvature is per deformed length."""
        return self.law.startswith("green")


CABLES = [Kind(element, law) for element in ("cable12", "cable18", "cable8p")
          for law in ("green_exact", "engineering_exact")]
MEMBRANES = [Kind("cable8p", f"engineering_exact_{membrane}") for membrane in ("assumed", "reduced")]
"""Other representations of the axial strain, of one cable: what they change does not depend on the rest."""
BEAMS = [Kind(element, law) for element in ("beam24", "beam12p")
         for law in ("structural", "poisson_split", "continuum")]
STRUCTURAL = [kind for kind in BEAMS if kind.law == "structural"]
SPATIAL_BEAMS = [kind for kind in BEAMS if not kind.is_planar]
KINDS = CABLES + MEMBRANES + BEAMS


@dataclass(frozen=True)
class Quantity:
    """A published number with the scale of its errors, its own size by default."""

    name: str
    unit: str
    reference: float
    scale: float | None = None

    def error(self, value: float) -> float:
        """Return the deviation of a value over the scale."""
        return abs(value - self.reference) / (abs(self.reference) if self.scale is None else self.scale)


def lookup(table: dict[str, Value], kind: Kind, default: Value) -> Value:
    """Return the entry of a table for an element with its law, else for the law, else for the element."""
    return table.get(str(kind), table.get(kind.law, table.get(kind.element, default)))


@dataclass(frozen=True, eq=False)
class Case:
    """A published case.

    quantities, values: functions of a kind and a number of elements: published numbers, and those of a scene. elements:
    their number in the table, own_elements for kinds with another one. ordered: kinds whose order of convergence the
    table has, from half the elements. notes: causes of errors. cannot: reasons for missing numbers. Notes, cannot and
    own_elements are by kind, law or element, see `lookup`.
    """

    name: str
    title: str
    source: str
    quantities: Callable[[Kind, int], list[Quantity]]
    values: Callable[[Kind, int], tuple[float, ...]]
    elements: int
    kinds: list[Kind]
    own_elements: dict[str, int] = field(default_factory=dict)
    ordered: list[Kind] = field(default_factory=list)
    notes: dict[str, str] = field(default_factory=dict)
    cannot: dict[str, str] = field(default_factory=dict)

    def count(self, kind: Kind) -> int:
        """Number of elements in the table."""
        return lookup(self.own_elements, kind, self.elements)

    @cache  # noqa: B019 - cases live as long as the program
    def found(self, kind: Kind, elements: int) -> list[tuple[Quantity, float]]:
        """Return the quantities and the values of the scene, the worst first."""
        values = map(float, self.values(kind, elements))
        pairs = zip(self.quantities(kind, elements), values, strict=True)
        return sorted(pairs, key=lambda pair: -pair[0].error(pair[1]))

    def error(self, kind: Kind, elements: int | None = None) -> float:
        """Largest error of the quantities."""
        quantity, value = self.found(kind, elements or self.count(kind))[0]
        return quantity.error(value)

    def observed_order(self, kind: Kind) -> float:
        """Order of convergence in the length of the elements: error ~ length^order."""
        n = self.count(kind)
        return float(np.log2(self.error(kind, n // 2) / self.error(kind, n)))
