"""What benchmarks share: their command lines, and tables that are printed and written as CSV.

Every script takes --smallest: it runs with numbers of 1 and the first of its cases alone, in seconds, to show that it
still runs; what it then prints is no measurement. A list of cases goes through `few` for that.
"""

from __future__ import annotations

import argparse
import csv
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")


class Parser(argparse.ArgumentParser):
    """A command line with --smallest, which makes its numbers least."""

    smallest = False
    """Whether the script that runs is to run at its smallest size."""

    least: dict[str, int]

    def parse_args(self, args: Sequence[str] | None = None, namespace=None) -> argparse.Namespace:
        """Return what was given; with --smallest the numbers of `parser` are least."""
        found = super().parse_args(args, namespace)
        Parser.smallest = found.smallest
        if found.smallest:
            vars(found).update(self.least)
        return found


def few(cases: Iterable[T]) -> list[T]:
    """Return the cases, with --smallest the first of them alone."""
    return list(cases)[: 1 if Parser.smallest else None]


def parser(description: str, **numbers: tuple[int, str] | tuple[int, str, int]) -> Parser:
    """A command line: --out FILE.csv, --smallest, and integers by name with default, help and least value, 1 if not
    given.
    """
    made = Parser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    made.least = {name: least[0] if least else 1 for name, (_, _, *least) in numbers.items()}
    made.add_argument("--out", type=Path, metavar="FILE.csv", help="write the table here as well")
    made.add_argument("--smallest", action="store_true", help="run the least that there is, to show that it runs")
    for name, (default, text, *_) in numbers.items():
        made.add_argument(f"--{name}", type=int, default=default, help=f"{text} (default {default})")
    return made


def arguments(description: str, **numbers: tuple[int, str] | tuple[int, str, int]) -> argparse.Namespace:
    """What was given on the command line of `parser`."""
    return parser(description, **numbers).parse_args()


def show(rows: list[dict], out: Path | None = None) -> None:
    """Print rows of equal keys; write them to ``out`` if given."""
    cells = [list(rows[0])] + [[f"{v:.3g}" if isinstance(v, float) else str(v) for v in row.values()] for row in rows]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    for line in cells:
        print("  ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True)))
    write(rows, out)


def write(rows: list[dict], out: Path | None) -> None:
    """Write rows of equal keys to ``out`` if given."""
    if out is not None:
        with out.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
        print(f"written: {out}")
