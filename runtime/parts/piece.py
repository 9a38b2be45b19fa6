"""Pieces of a cable: consecutive lengths, each with one section, one material and equal elements."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import BeforeValidator, Field

from .cubic_segments import value
from .material import Material
from .part import Part
from .section import AnySection, Section
from .validation import Count, Flag, items, positive, shown


class Piece(Part):
    """A piece of a cable, from the end of the piece before it.

    length: undeformed length, m
    section: cross-section
    material: material
    elements: number of elements of equal length
    hinge: whether a hinge joins it to the piece before it: the tangent, and of beams the section, may jump there. No
        slide and no crossing passes a hinge
    """

    kind = "piece"
    positional = ("length",)
    length: Annotated[float, positive("m")]
    section: AnySection
    material: Material
    elements: Count
    hinge: Flag = False


class UniformPiece(NamedTuple):
    """Elements of a cable, from `first` to the one before `end`, with one section and one material; hinge: as of a
    `Piece`.
    """

    first: int
    end: int
    section: Section
    material: Material
    hinge: bool = False

    @property
    def axial_stiffness(self) -> float:
        """Return EA in N, or the mean slope of the table of its force."""
        table = self.section.tension_table
        return self.material.youngs_modulus * self.section.area if table is None else table.force[-1] / table.strain[-1]

    def tension_at(self, strain: np.ndarray) -> np.ndarray:
        """Return the axial force at engineering strains, N: EA times the strain, or by the table."""
        table = self.section.tension_table
        return self.axial_stiffness * strain if table is None else value(table.numbers(), strain)


def _listed(value: Any) -> list[Any]:
    if (given := items(value, 1)) is None:
        raise ValueError(f"must be a list of pieces, got {shown(value)}",
                         "give them from start to end, such as pieces=[fu.Piece(length=...), ...]")
    return given


Pieces = Annotated[tuple[Piece, ...], Field(json_schema_extra={"minItems": 1}), BeforeValidator(_listed)]


def boundaries(pieces: Iterable[Piece]) -> np.ndarray:
    """Return (elements + 1,): the arc-lengths of the ends of the elements of pieces, in m."""
    found = np.zeros(1)
    for piece in pieces:
        found = np.append(found, found[-1] + piece.length * np.arange(1, piece.elements + 1) / piece.elements)
    return found


def with_elements(pieces: tuple[Piece, ...], elements: int) -> tuple[Piece, ...]:
    """Return pieces with about this number of elements in all, in the same proportions, and at least one each."""
    ratio = elements / sum(piece.elements for piece in pieces)
    return tuple(piece.remade({"elements": max(1, round(piece.elements * ratio))}) for piece in pieces)
