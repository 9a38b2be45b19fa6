"""Sections of a catenary one after the other, with spans in which two of them are side by side."""

from __future__ import annotations

from collections.abc import Sequence

from ..errors import SceneError
from .building import Section
from .line import Line

LENGTH_TOLERANCE = 1e-6
"""m: by which the lengths of spans differ at most where two sections have them in common."""


def in_sections(lines: Sequence[Line], overlaps: int | Sequence[int]) -> list[Section]:
    """Return lines as sections, the first mast of the first at x = 0; overlaps: see `form.scene`. Raises SceneError."""
    if not lines:
        raise SceneError("catenary", "has no lines", "give one, or its form")
    common = [overlaps] * (len(lines) - 1) if isinstance(overlaps, int) else [*overlaps]
    if len(common) != len(lines) - 1:
        raise SceneError("catenary", f"has {len(lines)} sections, but {len(common)} overlaps",
                         f"give {len(lines) - 1}, one for each pair of sections that follow each other, or one number")
    sections = [Section(lines[0])]
    for number, (line, spans, before) in enumerate(zip(lines[1:], common, [0, *common], strict=False), start=2):
        _check(sections[-1].line, line, spans, before, number)
        sections.append(Section(line, number, sections[-1].masts[-1 - spans]))
    return sections


def _check(first: Line, second: Line, spans: int, before: int, number: int) -> None:
    """Raise SceneError where two lines do not have spans in common; before: those of the first with the one before it.

    number: of the second section, from 1.
    """
    where = f"overlap of sections {number - 1} and {number}"
    for at, line, free in ((number - 1, first, first.spans - before), (number, second, second.spans)):
        if not 1 <= spans <= free:
            raise SceneError(where, f"must be of 1 to {free} spans, which section {at} has"
                             f"{' besides its other overlap' if free < line.spans else ''}, got {spans}",
                             "take fewer spans in common, or a longer section")
    for k, (a, b) in enumerate(zip(first.each[-spans:], second.each[:spans], strict=True), start=1):
        if abs(a.length - b.length) > LENGTH_TOLERANCE:
            raise SceneError(where, f"has masts of both at different places: its span {k} is {a.length:.9g} m long in "
                             f"section {number - 1} and {b.length:.9g} m in section {number}",
                             "give both the same spans there")
    if first.gravity != second.gravity:
        raise SceneError(where, f"is of sections with gravity {first.gravity:.9g} and {second.gravity:.9g} m/s²",
                         "give both the same")
