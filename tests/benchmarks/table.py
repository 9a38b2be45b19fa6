"""Command lines of benchmarks, and their tables: printed, and written as CSV and JSON.

Every script takes --smallest: it runs with numbers of 1 and the first of its cases alone, in seconds, to show that it
still runs; its output is then no measurement. `few` shortens a list of cases for that. With --json every table goes to
tests/benchmarks/measured (records.py), from which the pages are printed (print_pages.py).
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import ClassVar, TypeVar

import records

T = TypeVar("T")


class Parser(argparse.ArgumentParser):
    """A command line with --smallest, which sets its numbers to their minimum."""

    smallest = False
    """Whether the script that runs is to run at its smallest size."""

    json: Path | None = None
    """Where the script that runs records its tables."""
    recorded: ClassVar[list[str]] = []
    """Tables of this process in the record: the next rows of one of them are added to it."""

    least: dict[str, int]

    def parse_args(self, args: Sequence[str] | None = None, namespace=None) -> argparse.Namespace:
        """Return the given options; with --smallest the numbers of `parser` are minimal."""
        found = super().parse_args(args, namespace)
        Parser.smallest = found.smallest
        Parser.json = records.FOLDER / f"{Path(sys.argv[0]).stem}.json" if found.json == HERE else found.json
        Parser.recorded = []
        if found.smallest and found.json == HERE:
            self.error("--smallest measures nothing: give --json a FILE")
        if found.smallest:
            vars(found).update(self.least)
        return found


HERE = Path("tests/benchmarks/measured")
"""What --json stands for without a file."""


def few(cases: Iterable[T]) -> list[T]:
    """Return the cases, with --smallest the first of them alone."""
    return list(cases)[: 1 if Parser.smallest else None]


def parser(description: str, **numbers: tuple[int, str] | tuple[int, str, int]) -> Parser:
    """Return a command line: --out FILE.csv, --json FILE, --smallest, and integers by name with default, help and
    minimum, 1 by default.
    """
    made = Parser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    made.least = {name: least[0] if least else 1 for name, (_, _, *least) in numbers.items()}
    made.add_argument("--out", type=Path, metavar="FILE.csv", help="write the table here as well")
    made.add_argument("--json", type=Path, nargs="?", const=HERE, metavar="FILE",
                      help=f"record the tables in this file (without a name: that of the script in {HERE})")
    made.add_argument("--smallest", action="store_true", help="run the least that there is, to show that it runs")
    for name, (default, text, *_) in numbers.items():
        made.add_argument(f"--{name}", type=int, default=default, help=f"{text} (default {default})")
    return made


def arguments(description: str, **numbers: tuple[int, str] | tuple[int, str, int]) -> argparse.Namespace:
    """Return the options on the command line of `parser`."""
    return parser(description, **numbers).parse_args()


def show(rows: list[dict], out: Path | None = None, table: str = "measured") -> None:
    """Print rows of equal keys; write them to ``out`` if given, and record them as a table of this name."""
    cells = [list(rows[0])] + [[f"{v:.3g}" if isinstance(v, float) else str(v) for v in row.values()] for row in rows]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    for line in cells:
        print("  ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True)))
    write(rows, out, table)


def write(rows: list[dict], out: Path | None, table: str = "measured") -> None:
    """Write rows of equal keys to ``out`` if given, and record them as a table of this name with --json."""
    if Parser.json is not None:
        records.record(Parser.json, table, rows, add=table in Parser.recorded)
        Parser.recorded.append(table)
    if out is not None:
        with out.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
        print(f"written: {out}")
