"""Families of kernels: one generated file each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from types import MappingProxyType

from ..spec import Element, LawTraits, PointLaw
from .program import Program

SPACE = {2: "the plane", 3: "space"}


class FamilyError(ValueError):
    """Families of one role whose kernels do not fit one table."""


@dataclass(frozen=True)
class Family:
    """The kernels of one generated file.

    name, doc        of the family; names of its kernels begin with the name
    build            derives the programs of its kernels
    modules          its specs: their text, and that of all modules that they import here, decides the spec hash
    group            families of one group have stages in common, which stand in a header of the group
    role             families of one role have kernels of the same signatures; the engine finds them in one table
    facts            integers of the family in the engine's table
    outside_table    kernels of its own signature, which the table leaves out
    shared           by kernel, the family of the role whose kernel this one takes instead of one of its own
    missing          kernels of the role that this family lacks: null pointers in the table
    element, law, rider (name of a body), dim    what the kernels are about: verification samples their states
    stiffness_of     the law in laws/ whose section stiffness the law takes: itself, but for a law of the user's
    traits           what the law is
    spec             the user's file that defines the element; None for the elements of this package
    """

    name: str
    doc: str
    build: Callable[[], list[Program]]
    modules: tuple[str, ...]
    group: str = ""
    role: str = ""
    facts: dict[str, int] = field(default_factory=dict)
    outside_table: tuple[str, ...] = ()
    shared: dict[str, str] = field(default_factory=dict)
    missing: tuple[str, ...] = ()
    element: Element | None = None
    law: str | None = None
    stiffness_of: str | None = None
    traits: LawTraits | None = None
    rider: str | None = None
    dim: int | None = None
    spec: Path | None = None

    @property
    def not_own(self) -> set[str]:
        """Return the kernels of the role that this family has from another one, or not at all."""
        return {*self.shared, *self.missing}

    def kernel(self, suffix: str) -> str:
        """Return the C name of a kernel for the engine's table: "0", a null pointer, where the family lacks it."""
        if suffix in self.missing:
            return "0"
        return f"{self.shared.get(suffix, self.name)}_{suffix}"


@dataclass(frozen=True, kw_only=True)
class ElementFamily(Family):
    """The kernels of an element that no law enters."""

    element: Element


@dataclass(frozen=True, kw_only=True)
class LawFamily(ElementFamily):
    """The kernels of a law on an element."""

    law: str
    stiffness_of: str
    traits: LawTraits


@dataclass(frozen=True, kw_only=True)
class BodyFamily(Family):
    """The kernels of a body, rigid or modal."""

    rider: str


@dataclass(frozen=True, kw_only=True)
class SlideFamily(ElementFamily, BodyFamily):
    """The kernels of the slide of a rider on an element, of a rope where the ends of the element flow."""

    element: Element
    rider: str
    flows: bool = False


@dataclass(frozen=True, kw_only=True)
class CouplingFamily(Family):
    """The kernels of a coupling that knows its attachments by points and axes alone."""

    dim: int

    @classmethod
    def each(cls, role: str, doc: str, names: Mapping[int, str], build: Callable[[int], list[Program]],
             missing: Mapping[int, tuple[str, ...]] = MappingProxyType({})) -> list[CouplingFamily]:
        """Return the families of a role whose spec is the module of its name, in each dimension that `names` has."""
        return [cls(name, f"{doc} in {SPACE[dim]}", partial(build, dim), (f"couplings.{role}",), role=role,
                    missing=missing.get(dim, ()), facts={"dim": dim}, dim=dim) for dim, name in names.items()]


@dataclass(frozen=True, kw_only=True)
class PointLawFamily(CouplingFamily):
    """The kernels of a force between two points."""

    point_law: PointLaw
