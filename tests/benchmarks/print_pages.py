"""Prints the pages Validation and Speed, and the list of scripts in README.md, from records and docstrings.

    python tests/benchmarks/print_pages.py [--check]

--check writes nothing, and fails if a page differs from its records.
"""

from __future__ import annotations

import sys
from collections.abc import Callable

import records
from printed import FOLDER, RECORDS, Row, cell, markdown, scripts
from speed_page import CONDITIONS, SPEED
from validation_page import INTRODUCTION, STUDIES, SUBJECTS

NOTE = "<!-- Printed by tests/benchmarks/print_pages.py from tests/benchmarks/measured: change that, not this. -->"
BEGIN, END = "<!-- scripts: printed by print_pages.py -->\n", "\n<!-- end of scripts -->"
HEAD = ["case", "source", "quantity", "reference", "ours", "error", "bound", "with", "test"]


def validation() -> str:
    """Return the page Validation: rows of tests by subject, then studies."""
    table = records.load(records.FOLDER / "validation.json")["validation"]
    lines = ["# Validation", "", NOTE, "", INTRODUCTION, "", RECORDS, "",
             f"Recorded {table['measured']}: {table['conditions']}.", ""]
    for subject in SUBJECTS:
        rows = [row for row in table["rows"] if row["subject"] == subject]
        lines += [f"## {subject}", "", *markdown(HEAD, compared(rows)), ""]
    return "\n".join([*lines, *(line for section in STUDIES for line in section.lines())]).rstrip() + "\n"


def compared(rows: list[Row]) -> list[list[str]]:
    """Return a line for each case, quantity and bound: the largest error of all elements, laws and integrators."""
    groups: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        test = row["test"].partition("[")[0]
        several = row["subject"] in SUBJECTS[:2]  # each element errs most in a quantity of its own
        key = row["case"], row["source"], "" if several else row["quantity"], row["bound"], test
        groups.setdefault(key, []).append(row)
    found = []
    for (case, source, _, _, test), of in groups.items():
        worst = max(of, key=lambda row: row["error"])
        unit = f" {worst['unit']}" if worst["unit"] else ""
        numbers = [f"{shown(worst[key])}{unit}" for key in ("reference", "ours")]
        by = "; ".join(filter(None, (variants(of), worst["mesh"])))
        found.append([case, source, worst["quantity"], *numbers, cell(worst["error"]), allowed(worst), by, f"`{test}`"])
    return found


def allowed(row: Row) -> str:
    """Return the bound of a row with its note."""
    expected, _, part = row["bound"].partition(" ± ")
    note = f" ({row['note']})" if row["note"] else ""
    return f"{cell(float(expected))}{' ± ' + part if part else ''}{note}"


def shown(number: str) -> str:
    """Return a number of a record with seven digits."""
    return f"{float(number):.7g}"


def variants(rows: list[Row]) -> str:
    """Return elements with their laws, or integrators, of rows."""
    laws: dict[str, list[str]] = {}
    for row in rows:
        first, _, rest = row["variant"].replace(",", "").partition(" ")
        laws.setdefault(first, [])
        if rest and rest not in laws[first]:
            laws[first].append(rest)
    return ", ".join(f"{name} ({', '.join(rest)})" if rest else name for name, rest in laws.items() if name)


def speed() -> str:
    """Return the page Speed."""
    head = ["# Speed", "", NOTE, "", CONDITIONS, "", RECORDS, ""]
    return "\n".join([*head, *(line for section in SPEED for line in section.lines())]).rstrip() + "\n"


def readme() -> str:
    """Return README.md with the list of scripts from their docstrings."""
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    after = rest.partition(END)[2]
    rows = [[f"[{name}]({name}.py)", cell(what)] for name, what in scripts().items()]
    return before + BEGIN + "\n" + "\n".join(markdown(["script", "what it measures"], rows)) + "\n" + END + after


PAGES: dict[str, Callable[[], str]] = {"validation.md": validation, "speed.md": speed, "README.md": readme}


def main() -> None:
    """Write or compare the pages."""
    stale = []
    for name, text in ((name, made()) for name, made in PAGES.items()):
        file = FOLDER / name
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            stale.append(name)
            if "--check" not in sys.argv[1:]:
                file.write_text(text, encoding="utf-8")
    print(f"{', '.join(stale) or 'none'} changed")
    if stale and "--check" in sys.argv[1:]:
        sys.exit("print them: python tests/benchmarks/print_pages.py")


if __name__ == "__main__":
    main()
