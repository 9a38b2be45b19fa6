"""The command `funicular derive --explain NAME`: how a kernel was derived.

It derives the family and prints, for each kernel, the stages with their operations, the most expensive terms, the
intermediate results with several uses, and the reasons for the form: docstrings of the sources, loops, blocks and
shared macros of the printed text. It reads generated/ and writes nothing.
"""

from __future__ import annotations

import ast
import difflib
import re
import sys
import textwrap
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import sympy as sp
from rich import box
from rich.console import Console
from rich.table import Table

from .catalogue import families, named
from .codegen import drift
from .codegen import rendering as emit
from .codegen.family import Family
from .codegen.loops import sections
from .codegen.program import Program, operations_of
from .codegen.provenance import deciding
from .codegen.sharing import header

MAX_ROWS = 12
"""Largest number of terms in a table; a last row sums the others."""
REASONS = ("elements/", "laws/", "bodies/", "couplings/", "algebra/")
"""Folders whose sources say why a kernel has its form."""
CONSOLE_WIDTH = 150
DERIVE = Path(__file__).parent
NAME = re.compile(r"^    ([A-Z][A-Z0-9_]+)$", re.MULTILINE)
"""The name of a shared stage in a kernel."""


def main(names: list[str]) -> int:
    """Explain families, or single kernels of them, and return the exit code of the command."""
    console = Console(highlight=False, markup=False)
    if not console.is_terminal:
        console = Console(highlight=False, markup=False, width=CONSOLE_WIDTH)
    try:
        for name in names:
            family, kernel = chosen(name)
            for part in explained(family, kernel):
                console.print(part)
    except KeyError as unknown:
        print(f"funicular derive: {unknown.args[0]}", file=sys.stderr)
        return 1
    return 0


def chosen(name: str) -> tuple[Family, str]:
    """Return the family of a name, and the kernel if the name is that of a kernel, else an empty name.

    Raises KeyError for a name of neither.
    """
    every = families()
    of = max((f for f in every if name.startswith(f"{f}_")), key=len, default="")
    return (every[of], name) if of and name not in every else (named([name])[name], "")


def explained(family: Family, kernel: str = "") -> Iterator[str | Table]:
    """Yield the explanation of a family and its kernels, or of one of them, as text and tables.

    Raises KeyError for a kernel that the family has not.
    """
    derived, sources = traced(family)
    programs = [p for p in derived.programs if isinstance(p, Program) and kernel in ("", p.name)]
    if not programs:
        every = [p.name for p in derived.programs]
        likely = difflib.get_close_matches(kernel, every, n=3) or every
        raise KeyError(f'no kernel "{kernel}"; did you mean {", ".join(likely)}?')
    yield f"{family.name}: {family.doc}\n\nWhy this form, by the sources that derived it:\n"
    for file, text in sources.items():
        yield f"derive/{file}\n{textwrap.indent(text, '    ')}\n"
    for program in programs:
        yield from _kernel(program, family, program.name in emit.block_kernels(derived))


def traced(family: Family) -> tuple[emit.Derived, dict[str, str]]:
    """Derive a family; return it, and the docstrings of the modules whose functions took part, by file."""
    files = dict.fromkeys(file for file in deciding(family.modules) if file.startswith(REASONS))
    called: set[str] = set()
    before = sys.getprofile()
    sys.setprofile(lambda frame, event, _: called.add(frame.f_code.co_filename) if event == "call" else None)
    try:
        derived = emit.derive(family)
    finally:
        sys.setprofile(before)
    own = {module.replace(".", "/") + ".py" for module in family.modules}
    took_part = [file for file in files if file in own or str(DERIVE / file) in called]
    documented = {file: ast.get_docstring(ast.parse((DERIVE / file).read_text(encoding="utf-8"))) or ""
                  for file in took_part}
    return derived, {file: text for file, text in documented.items() if text}


@dataclass(frozen=True)
class Term:
    """Definitions of one name up to numbers and directions: how many, their operations, the uses of their values."""

    name: str
    definitions: int
    operations: int
    uses: int
    saved: int


def terms(program: Program) -> list[Term]:
    """Return the definitions and outputs of a program by name, numbers and directions left out, in order.

    saved: operations that the names save, in comparison with an expression that is repeated at each use.
    """
    definitions = [*((s.name, s, e) for stage in program.stages for s, e in stage.definitions),
                   *((a.name, None, e) for a in program.outputs for e in program.values[a.name].ravel())]
    uses: Counter[sp.Symbol] = Counter()
    for _, _, expr in definitions:
        uses.update(_occurrences(expr))
    found: dict[str, list[tuple[int, int]]] = {}
    for name, symbol, expr in definitions:
        cost = _total([expr])
        used = 0 if symbol is None else uses[symbol]
        found.setdefault(re.sub(r"\d+", "#", re.sub(r"_[xyz]{1,2}(?=_|$)", "_*", name)), []).append((cost, used))
    return [Term(name, len(of), sum(cost for cost, _ in of), sum(used for _, used in of),
                 sum(cost * max(used - 1, 0) for cost, used in of)) for name, of in found.items()]


def written_out(program: Program) -> int:
    """Return the operations of a program whose outputs are written in its inputs, without any intermediate result."""
    whole: dict[sp.Symbol, int] = {}
    for stage in program.stages:
        for symbol, expr in stage.definitions:
            whole[symbol] = _with_uses(expr, whole)
    return sum(_with_uses(expr, whole) for value in program.values.values() for expr in value.ravel())


def _with_uses(expr: sp.Expr, whole: dict[sp.Symbol, int]) -> int:
    return _total([expr]) + sum(n * whole.get(symbol, 0) for symbol, n in _occurrences(expr).items())


def _occurrences(expr: sp.Expr) -> Counter[sp.Symbol]:
    """Return how often each symbol stands in the C text of an expression, where a small power is a product."""
    if expr.is_Symbol:
        return Counter([expr])
    found: Counter[sp.Symbol] = Counter()
    for arg in expr.args:
        if isinstance(arg, sp.Basic):
            found.update(_occurrences(arg))
    times = abs(int(expr.exp)) if expr.is_Pow and expr.exp.is_Integer else 1
    return Counter({symbol: n * times for symbol, n in found.items()})


def _total(exprs: Iterable[sp.Expr]) -> int:
    return sum(operations_of(exprs).values())


def _kernel(program: Program, family: Family, several: bool) -> Iterator[str | Table]:
    operations = program.operations()
    total, every = sum(operations.values()), terms(program)
    kinds = ", ".join(f"{n} {kind}" for kind, n in operations.items() if n)
    yield f"{program.name}: {program.doc} ({program.source})"
    yield (f"  {total} operations{f' ({kinds})' if kinds else ''}; {written_out(program)} if the outputs were written "
           "in the inputs without intermediate results")
    definitions = sum(len(stage.definitions) for stage in program.stages)
    lines = sum(len(section.lines) for section in sections(program))
    entries = sum(a.size for a in program.outputs)
    yield (f"  {definitions} intermediate results and {entries} numbers of output stand in {lines} lines of C before "
           "stages are shared" + ("; compiled for several elements or points at once as well" if several else ""))
    yield _stages(program, _macros(program.name, family), total)
    if total:
        yield _ranked("Operations by term (# is a number, * a direction)", every, "operations", total)
    if any(term.saved for term in every):
        yield _ranked("Shared subexpressions: operations that one evaluation for all uses saves", every, "saved", 0)
    yield ""


def _stages(program: Program, macros: dict[str, str], total: int) -> Table:
    table = _table("Stages", ["stage", "definitions", "add", "mul", "div", "sqrt", "other", "share", "shared as"],
                   left=("stage", "shared as"))
    outputs = [e for v in program.values.values() for e in v.ravel()]
    for title, exprs in [*((s.title, [e for _, e in s.definitions]) for s in program.stages), ("outputs", outputs)]:
        count = operations_of(exprs)
        of = sum(count.values())
        plain = [count.pop(kind) for kind in ("add", "mul", "div", "sqrt")]
        table.add_row(title, str(len(exprs)), *map(str, plain), str(sum(count.values())),
                      f"{of / total:.0%}" if total else "-", macros.get(title, ""))
    return table


def _ranked(title: str, every: list[Term], by: str, total: int) -> Table:
    table = _table(title, ["term", "definitions", "uses", "operations", "saved", *(["share"] if total else [])],
                   left=("term",))
    ranked = sorted((term for term in every if getattr(term, by)), key=lambda term: -getattr(term, by))
    rest = ranked[MAX_ROWS:]
    shown = ranked[:MAX_ROWS]
    if rest:
        shown.append(Term(f"{len(rest)} others", *(sum(getattr(term, part) for term in rest)
                                                   for part in ("definitions", "operations", "uses", "saved"))))
    for term in shown:
        table.add_row(term.name, str(term.definitions), str(term.uses), str(term.operations), str(term.saved),
                      *([f"{term.operations / total:.0%}"] if total else []))
    return table


def _table(title: str, columns: list[str], left: tuple[str, ...]) -> Table:
    table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD)
    for name in columns:
        table.add_column(name, justify="left" if name in left else "right", no_wrap=name not in left)
    return table


def _macros(kernel: str, family: Family) -> dict[str, str]:
    """Return the macros of generated/ that stand for stages of a kernel, with their users, by title of the stage."""
    own = drift.current(f"{family.name}.c") or ""
    shared = own + (drift.current(header(family.group)) or "" if family.group else "")
    body = own.partition(f"void {kernel}(")[2].partition("\n}\n")[0]
    found = {}
    for macro in NAME.findall(body):
        told = re.search(rf"/\* (.*): of (.*) and (\d+) more \*/\n#define {macro} ", shared)
        if told:
            found[told[1]] = f"{macro}, {int(told[3]) + 1} kernels"
    return found
