"""Provenance of a formula: the generated function with its file and line, its operations, and its verification."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ..catalogue import families
from ..codegen.drift import folder
from ..verify.relations import relations
from .scopes import programs_of

DERIVE = Path(__file__).parents[1]
TAG = re.compile(r"\(eq (\d+)\)")


@dataclass(frozen=True)
class Kernel:
    """A generated function: its place in generated/, its arithmetic operations, and for an output what verifies it."""

    name: str
    file: str
    line: int
    operations: int
    output: str
    unit: str
    verified: str


@cache
def _lines(family: str) -> tuple[str, ...]:
    path = folder() / f"{family}.c"
    return tuple(path.read_text(encoding="utf-8").splitlines()) if path.is_file() else ()


@cache
def _relations(family: str) -> dict[tuple[str, str], str]:
    found: dict[tuple[str, str], str] = {}
    for r in relations(families()[family]):
        found[r.kernel, r.output] = "; ".join(t for t in (found.get((r.kernel, r.output)), r.text) if t)
    return found


def operations(family: str, kernel: str) -> int:
    """Return the arithmetic operations of a kernel."""
    return sum(programs_of(family)[kernel].operations().values())


def kernel(family: str, name: str, output: str) -> Kernel:
    """Return where an output of a kernel is computed."""
    program = programs_of(family)[name]
    start = re.compile(rf"\b{re.escape(program.name)}\(")
    line = next((k for k, text in enumerate(_lines(family), 1) if start.search(text)), 0)
    unit = next(a.unit for a in program.outputs if a.name == output)
    return Kernel(program.name, f"generated/{family}.c", line, operations(family, name), output, unit,
                  _relations(family).get((name, output), ""))


@cache
def tagged() -> dict[int, str]:
    """Return the place of each equation of the paper in the sources, "derive/spec.py:82", as far as they are here."""
    found: dict[int, str] = {}
    roots = [(DERIVE, "derive", "*.py"), (DERIVE.parent / "runtime", "runtime", "*.[chp]*")]
    for root, label, pattern in roots:
        for path in sorted(root.rglob(pattern)) if root.is_dir() else ():
            if path.suffix not in (".py", ".c", ".h", ".pxi") or path.is_relative_to(DERIVE / "theory"):
                continue
            for k, text in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                for number in TAG.findall(text):
                    found.setdefault(int(number), f"{label}/{path.relative_to(root).as_posix()}:{k}")
    return found
