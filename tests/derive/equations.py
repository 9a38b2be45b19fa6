"""Places of the equations of the paper: the tags `(eq N)` in the sources, and the table of README made from them.

    python tests/derive/equations.py
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

TOP = Path(__file__).parents[2]
EQUATIONS = range(1, 39)
SOURCES = [("derive", "*.py"), ("runtime", "*.py"), ("runtime/engine", "*.[ch]"), ("runtime/engine", "*.pxi")]
SUBJECTS = {
    "derive/spec.py": "nodal coordinates", "derive/elements": "shape functions, mass",
    "runtime/engine": "kinetic energy, equations of motion, accelerations and multipliers",
    "derive/laws/continuum": "strain, elastic energy and force",
    "derive/couplings": "joints, and the slide: C, G, H, W",
    "derive/bodies": "modal body on a floating frame", "derive/algebra": "tangent frame"}
"""What the equations of a file or folder are about; a new one needs its entry."""


def tags() -> list[tuple[int, str]]:
    """Return (number, file) for each tag, in order of the numbers."""
    found = []
    for folder, pattern in SOURCES:
        for file in sorted((TOP / folder).rglob(pattern)):
            numbers = re.findall(r"\(eq (\d+)\)", file.read_text(encoding="utf-8"))
            found += [(int(number), file.relative_to(TOP).as_posix()) for number in numbers]
    return sorted(found)


def table() -> str:
    """Return the table of README: a row for each subject, in order of its first equation."""
    rows = ["| equations | subject | file |", "|---|---|---|"]
    files: dict[str, dict[str, list[int]]] = {}
    for number, file in tags():
        subject = next(subject for place, subject in SUBJECTS.items() if file.startswith(place))
        files.setdefault(subject, {}).setdefault(file, []).append(number)
    for subject, numbers in files.items():
        every = ", ".join(ranges(sorted(n for of_file in numbers.values() for n in of_file)))
        rows.append(f"| {every} | {subject} | {', '.join(f'`{file}`' for file in numbers)} |")
    return "\n".join(rows)


def ranges(numbers: list[int]) -> Iterator[str]:
    """Yield "3" for a number alone, and "5-8" for a run of them."""
    for _, run in groupby(enumerate(numbers), key=lambda pair: pair[1] - pair[0]):
        first, *more = (number for _, number in run)
        yield f"{first}-{more[-1]}" if more else str(first)


if __name__ == "__main__":
    print(table())
