"""Input files of MoorDyn-2: tables below headings with dashes, each with a line of names and a line of units."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping
from dataclasses import field
from typing import TypeVar

from ..base.bounded_files import MAX_SCENE_BYTES, TooLargeError, read_bytes
from ..base.deferred import dataclass
from ..errors import SceneError, near, shown_path
from ..parts.validation import shown

TABLES = {"line types": ("LINE TYPES", "LINE DICTIONARY"), "rod types": ("ROD TYPES", "ROD DICTIONARY"),
          "bodies": ("BODIES", "BODY LIST", "BODY PROPERTIES"), "rods": ("RODS", "ROD LIST", "ROD PROPERTIES"),
          "points": ("POINTS", "POINT LIST", "POINT PROPERTIES", "CONNECTION PROPERTIES", "NODE PROPERTIES"),
          "lines": ("LINES", "LINE LIST", "LINE PROPERTIES"), "mean tensions": ("SYROPE IC",),
          "failures": ("FAILURE",), "control": ("CONTROL",),
          "options": ("OPTIONS",), "outputs": ("OUTPUT",)}
"""Words of the heading of each table, the first that fits."""
WITHOUT_NAMES = "options", "outputs"
"""Tables without lines of names and units."""
MAX_ROWS = 100_000
"""Of a table."""

T = TypeVar("T")


@dataclass(frozen=True)
class Row:
    """A line of a table: its number in the file, and its words; where: file and number, for messages."""

    where: str
    words: tuple[str, ...]

    def refused(self, cause: str, remedy: str | None = None) -> SceneError:
        """Return the error of this line."""
        return SceneError(self.where, cause, remedy)

    def word(self, k: int, what: str) -> str:
        """Return word number k. Raises SceneError where the line is shorter."""
        if k >= len(self.words):
            raise self.refused(f"{what} is missing, number {k + 1} of the line")
        return self.words[k]

    def number(self, k: int, what: str, default: float | None = None) -> float:
        """Return word number k as a finite number; of a shorter line the default, if any. Raises SceneError."""
        if k >= len(self.words) and default is not None:
            return default
        word = self.word(k, what)
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.refused(f"{what} must be a number, got {shown(word)}", "files are read of the axial "
                               "stiffness alone: give one number, and the law in the scene written")
        return value

    def numbers(self, k: int, what: str, size: int) -> tuple[float, ...]:
        """Return the numbers with bars between them of a word, one, which stands for all, or `size`. Raises SceneError.
        """
        parts = self.word(k, what).split("|")
        if len(parts) not in (1, size):
            raise self.refused(f"{what} must be 1 or {size} numbers with | between them, got {shown(self.words[k])}")
        found = tuple(Row(self.where, (part,)).number(0, what) for part in parts)
        return found if len(found) == size else found * size


@dataclass
class MoorDynFile:
    """The tables of a file by name, see `TABLES`; name: of the file in messages."""

    name: str
    tables: dict[str, list[Row]] = field(default_factory=dict)

    def rows(self, table: str) -> list[Row]:
        """Return the lines of a table, none if the file has no such table."""
        return self.tables.get(table, [])

    def by_id(self, table: str, read: Callable[[Row], T]) -> dict[str, T]:
        """Return what `read` makes of the lines of a table, by their first word. Raises SceneError for one twice."""
        found: dict[str, T] = {}
        for row in self.rows(table):
            if row.words[0] in found:
                raise row.refused(f"there is already a line {shown(row.words[0])} of {table}", "give each its own ID")
            found[row.words[0]] = read(row)
        return found


def named(found: Mapping[str, T], name: str, row: Row, what: str) -> T:
    """Return an entry by name. Raises SceneError at a line that names none."""
    if name not in found:
        raise row.refused(f"there is no {what} {shown(name)}", near(name, found))
    return found[name]


def read_file(path: str | os.PathLike[str]) -> MoorDynFile:
    """Return the tables of a file. Raises SceneError."""
    name = shown_path(path)
    try:
        text = read_bytes(path, MAX_SCENE_BYTES, "leave out what is no mooring").decode("utf-8", "replace")
    except TooLargeError as error:
        raise SceneError(name, *error.args) from None
    except (OSError, ValueError) as error:
        raise SceneError(name, f"cannot be read: {getattr(error, 'strerror', None) or error}") from None
    made, table, skipped = MoorDynFile(name), "", 0
    for number, line in enumerate(text.splitlines(), start=1):
        where = f"{name}, line {number}"
        if "---" in line:
            table, skipped = _table(line, where), 0
            made.tables.setdefault(table, [])
        elif table and table not in WITHOUT_NAMES and skipped < 2:
            skipped += 1
            if skipped == 1:
                _check_names(table, line, where)
        elif table and (words := tuple(line.split())) and not words[0].startswith("#"):
            if len(made.tables[table]) >= MAX_ROWS:
                raise SceneError(where, f"more than {MAX_ROWS} {table}", "give fewer")
            made.tables[table].append(Row(where, words))
    for needed in ("line types", "points", "lines"):
        if not made.rows(needed):
            raise SceneError(name, f"has no {needed}", f"a table of them has the heading --- {needed.upper()} ---")
    return made


def _table(line: str, where: str) -> str:
    """Return the name of the table of a heading, "" for the end of the file. Raises SceneError."""
    heading = line.replace("-", " ").strip().upper()
    for name, words in TABLES.items():
        if any(heading.startswith(word) or f" {word}" in heading for word in words):
            return name
    if not heading or "NEED THIS LINE" in heading or heading.startswith(("END", "MOORDYN")):
        return ""
    raise SceneError(where, f"the heading {shown(heading)} is not known",
                     "known: " + ", ".join(words[0] for words in TABLES.values()))


def _check_names(table: str, line: str, where: str) -> None:
    """Raise SceneError for the columns of MoorDyn-1."""
    names = line.upper().split()
    if table == "lines" and len(names) > 2 and names[2].startswith("UNSTR"):
        raise SceneError(where, "has the columns of MoorDyn-1", "give those of MoorDyn-2: ID LineType AttachA AttachB "
                         "UnstrLen NumSegs Outputs")
    if table == "line types" and len(names) > 5 and names[5].startswith(("CA", "CD")):
        raise SceneError(where, "has the columns of MoorDyn-1", "give those of MoorDyn-2: Name Diam Mass/m EA BA EI Cd "
                         "Ca CdAx CaAx")
