"""Tables of Markdown from rows of records: cells, and rows arranged by one of their columns."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import records

FOLDER = Path(__file__).parent
Row = dict[str, Any]
RECORDS = """A command with `--json` renews its record, and [print_pages.py](print_pages.py) the page. A record that
names no processor was transcribed from an earlier table, and its date is that of the table."""


@dataclass(frozen=True)
class Table:
    """A table of a page, from a table of a script's record.

    columns: headings by key. by: a key whose values become columns, with the text of their cells, with keys in braces;
    ``columns`` then identify the rows. rows: which rows, and their changes before. options: of the recording command.
    """

    script: str
    columns: dict[str, str]
    table: str = "measured"
    by: tuple[str, str] | None = None
    rows: Callable[[list[Row]], list[Row]] = list
    options: str = ""
    text: str = ""

    @property
    def record(self) -> dict[str, Any]:
        """The table of the record, with date and conditions."""
        return records.load(records.FOLDER / f"{self.script}.json")[self.table]

    def lines(self) -> list[str]:
        """Return text, command, conditions and table."""
        found = self.record
        command = f"    .venv/bin/python tests/benchmarks/{self.script}.py{' ' + self.options if self.options else ''}"
        said = f"Measured {found['measured']}: {found['conditions']}."
        return [*([paragraphs(self.text), ""] if self.text else []), command, "", said, "", *self.markdown(), ""]

    def markdown(self) -> list[str]:
        """Return the table."""
        rows = self.rows(self.record["rows"])
        if self.by is None:
            return markdown(list(self.columns.values()), [[cell(row[key]) for key in self.columns] for row in rows])
        key, text = self.by
        across = list(dict.fromkeys(cell(row[key]) for row in rows))
        lines: dict[tuple[str, ...], dict[str, str]] = {}
        for row in rows:
            of = lines.setdefault(tuple(cell(row[name]) for name in self.columns), {})
            of[cell(row[key])] = re.sub(r"{([^}]+)}", lambda name, row=row: cell(row[name[1]]), text)
        return markdown([*self.columns.values(), *across],
                        [[*name, *(of.get(each, "") for each in across)] for name, of in lines.items()])


@dataclass(frozen=True)
class Section:
    """A section of a page: its text, its tables, and the test that asserts its figures, if there is one."""

    title: str
    text: str
    tables: list[Table] = field(default_factory=list)
    test: str = ""

    def lines(self) -> list[str]:
        """Return the section."""
        asserted = [f"`{self.test}` asserts it.", ""] if self.test else []
        head = [f"## {self.title}", "", paragraphs(self.text), ""]
        return [*head, *asserted, *(line for table in self.tables for line in table.lines())]


def paragraphs(text: str) -> str:
    """Return a text in lines of 120 characters, except commands and pictures."""
    return "\n\n".join(part if part.startswith(("    ", "![")) else
                       textwrap.fill(part, 120, break_long_words=False, break_on_hyphens=False)
                       for part in text.split("\n\n"))


def markdown(head: list[str], rows: list[list[str]]) -> list[str]:
    """Return a table; cells of the first column that repeat the one above are empty."""
    lines, above = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)], None
    for row in rows:
        first = "" if row[0] == above and len(row) > 2 else row[0]
        above = row[0]
        lines.append(re.sub(r"\|  (?=\|)", "| ", f"| {' | '.join([first, *row[1:]])} |"))
    return lines


def cell(value: Any) -> str:
    """Return a value for a table: numbers with three digits, small and large ones with two."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value:,}" if value >= 10_000 else str(value)
    if isinstance(value, float):
        small = value != 0 and not 1e-2 <= abs(value) < 1e5
        text = f"{value:.1e}".replace(".0e", "e") if small else f"{value:.3g}"
        return re.sub(r"e([+-])0*(\d)", lambda found: f"e{found[1].strip('+')}{found[2]}", text)
    return str(value).replace("|", "\\|")


def scripts() -> dict[str, str]:
    """Return the benchmarks by name, with the first sentence of each docstring."""
    found = {}
    for file in sorted(FOLDER.glob("*.py")):
        text = file.read_text(encoding="utf-8")
        if re.search(r"^from table import .*^if __name__ == ", text, re.MULTILINE | re.DOTALL):
            first = (ast.get_docstring(ast.parse(text)) or "").partition("\n\n")[0].replace("\n", " ")
            found[file.stem] = re.split(r"(?<=\w\w)\. ", first)[0].rstrip(".")
    return found
