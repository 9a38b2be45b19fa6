"""`funicular derive --spec FILE --out DIR`: derive, check, verify, compile, time, and only then write."""

from __future__ import annotations

import tempfile
import time
from functools import partial
from pathlib import Path
from typing import Any

from funicular.kernels.libraries import load as load_library
from rich import box
from rich.console import Console
from rich.table import Table

from ..codegen import rendering as emit
from ..codegen.described import described
from ..codegen.family import Family, LawFamily
from ..laws import law_name
from ..laws.kernels import Kernels
from ..verify import timing
from ..verify.command import examined
from ..verify.compiled import SHARED_FLAGS, CompilerError, compile_units, compiler, link_shared
from ..verify.report import PIPED_WIDTH, Report
from . import basis, energy, library, load
from .load import SpecError

ROUNDS = 5  # of timing; the least counts


def main(spec: Path, out: Path) -> None:
    """Run the command. Raises SpecError, also for a compiler that is missing."""
    begin = time.perf_counter()
    console = Console(highlight=False, markup=False, soft_wrap=True)
    if not console.is_terminal:
        console = Console(highlight=False, markup=False, width=PIPED_WIDTH)
    spec, out = spec.resolve(), out.resolve()
    library.check_destination(out)
    try:
        compiler()
        for element in load.elements(spec):
            basis.check(element, str(spec))
        families = load.own_families(spec)
        _check_duplicates(spec, families)
        if library.is_current(out, list(families.values())):
            console.print(f"{out}: up to date with {spec.name}; nothing was written")
            return
        out.parent.mkdir(parents=True, exist_ok=True)
        # on the same disk as DIR, so that moving there is a renaming
        with tempfile.TemporaryDirectory(prefix=f".{out.name}-", dir=out.parent) as folder:
            _make(spec, families, Path(folder), out, console)
    except CompilerError as problem:
        raise SpecError(str(spec), f"cannot be compiled: {problem}") from None
    except OSError as problem:
        cause = f"cannot be written: {problem.strerror or problem}"
        raise SpecError(str(out), cause, "give another --out DIR") from None
    console.print(f"written: {out}, {time.perf_counter() - begin:.0f} s. In a scene: element = "
                  f'"{next(iter(families))}", library = "{out}"')


def _check_duplicates(spec: Path, families: dict[str, Family]) -> None:
    named = [element.name for element in load.elements(spec)]
    twice = sorted({name for name in named if named.count(name) > 1})
    if twice:
        raise SpecError(str(spec), f"defines two elements of the name {', '.join(twice)}", "give each its own name")


def _make(spec: Path, families: dict[str, Family], work: Path, out: Path, console: Console) -> None:
    made, extra = work / "library", work / "work"
    made.mkdir()
    extra.mkdir()
    derived = []
    for family in families.values():
        with console.status(f"derive {family.name}"):
            derived.append(_derived(spec, family))
    try:
        files = library.render(derived)
    except ValueError as problem:
        raise SpecError(str(spec), str(problem)) from None
    for name, text in files.items():
        (made / name).write_text(text, encoding="utf-8", newline="\n")
    report = examined(list(families.values()), made, partial(load.own_families, spec))
    if report.failures:
        report.show()
        raise SpecError(str(spec), f"{report.failures} checks of verification fail, the first: {report.first_failure}",
                        "the tables above have the figures; nothing was written")
    with console.status("compile and time"):
        units = compile_units(sorted(made.glob("*.c")), [*SHARED_FLAGS, f"-I{made}"], extra)
        shared = link_shared(units, made)
        manifest = library.write_manifest(derived, files, spec, shared)
        program = timing.build(families.values(), manifest, load_library(made).kernels, units,
                               [*SHARED_FLAGS, f"-I{made}"], extra)
        times, sizes = timing.times(program, ROUNDS), timing.code_sizes(program)
    console.print(_table(described(manifest), times, sizes, report))
    library.move(made, out)


def _derived(spec: Path, family: Family) -> emit.Derived:
    """Derive a family. Errors of the user's code and of the law name their place."""
    assert family.element is not None  # a user's families are those of elements
    place = f'{spec}: element "{family.element.name}"' + (f', law "{family.law}"' if family.law else "")
    with load.blaming(spec, place):
        if not isinstance(family, LawFamily):
            return emit.derive(family)
        law = next(law for law in family.element.laws if law_name(law) == family.law)
        energy.check_arithmetic([Kernels(family.element, law).energy()], place)  # first: a kink may have no derivatives
        programs = family.build()
        made = emit.derived(family, programs)  # without what no output needs
        energy.check_arithmetic(programs, place)
        energy.check_law(family, programs, place)
        return made


def _table(kernels: dict[str, Any], times: dict[str, list[float]], sizes: dict[str, int], report: Report) -> Table:
    """Return the kernels with operations, bytes of code, errors and time."""
    table = Table(title="Errors are relative to the output's largest entry; times are of one thread",
                  title_justify="left", box=box.SIMPLE_HEAD)
    for name in ("kernel", "operations", "bytes of code", "rounding", "50 digits", "µs a call"):
        table.add_column(name, justify="left" if name == "kernel" else "right", no_wrap=True)
    for name, entry in kernels.items():
        errors = [f.errors for f in report.findings if f.kernel == name]
        rounding = max((e["rounding"] for e in errors), default=0.0)
        slope = max((e["50 digits"] for e in errors), default=0.0)
        table.add_row(name, str(sum(entry["operations"].values())), str(sizes.get(name, "")), f"{rounding:.1e}",
                      f"{slope:.1e}", f"{min(times[name]):.3g}")
    return table

