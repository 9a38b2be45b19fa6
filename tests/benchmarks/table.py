"""Tables of benchmarks: printed, and written as CSV."""

from __future__ import annotations

import argparse
import csv
from pathlib import Path


def parser(description: str, **numbers: tuple[int, str]) -> argparse.ArgumentParser:
    """A command line: --out FILE.csv, and integers by name with default and help."""
    made = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    made.add_argument("--out", type=Path, metavar="FILE.csv", help="write the table here as well")
    for name, (default, text) in numbers.items():
        made.add_argument(f"--{name}", type=int, default=default, help=f"{text} (default {default})")
    return made


def arguments(description: str, **numbers: tuple[int, str]) -> argparse.Namespace:
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
