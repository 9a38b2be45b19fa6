"""`funicular verify`: derivatives by independent methods, rounding, and invariances of the generated C.

The files of generated/ are compiled as they stand: verification finds a sign changed by hand. Relations, invariances,
references and samples are packages with a file for each role. Methods and their ceilings are in verify/methods.py,
rounding and its ceilings in verify/rounding.py. Families come from the list in catalogue.py, so new elements and riders
are covered.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import mpmath
import numpy as np

from ..catalogue import families, named
from ..codegen.drift import folder
from ..codegen.family import Family
from ..codegen.program import Program
from . import numbers as verify_numbers
from .compiled import CompilerError, Library
from .exact import DIGITS
from .invariances import invariances
from .methods import Finding, examine
from .relations import relations
from .report import Report
from .rounding import Rounding, roundings
from .samples import states

Item = Finding | Rounding | tuple[str, float, float]


@dataclass(frozen=True)
class Subject:
    """A family with its programs during compilation."""

    family: Family
    programs: list[Program]
    libraries: dict[str, Library]

    def kinds(self) -> dict[str, verify_numbers.Numbers]:
        """Return the three evaluators; waits for the compiler."""
        name = self.family.name
        return {"exact": verify_numbers.exact(name, self.programs),
                "real": verify_numbers.real(name, self.programs, self.libraries["real"].load()),
                "complex": verify_numbers.complex_(name, self.programs, self.libraries["complex"].load())}


def prepare(family: Family, generated: Path, work: Path, programs: list[Program] | None = None) -> Subject:
    """Derive a family, unless its pruned programs are given, and start compiling its generated file."""
    if programs is None:
        programs = [program.prune() for program in family.build()]
    libraries = {kind: Library(family.name, programs, generated, work, dtype)
                 for kind, dtype in (("real", float), ("complex", complex))}
    return Subject(family, programs, libraries)


def uncovered(family: Family, programs: list[Program]) -> list[str]:
    """Return the outputs without a relation."""
    known = {(f"{family.name}_{r.kernel}", r.output) for r in relations(family)}
    return [f"{p.name}: {a.name}" for p in programs for a in p.outputs if (p.name, a.name) not in known]


def verify(subject: Subject) -> Iterator[Item]:
    """Return the findings of a family's relations, rounding of its kernels, its invariances: the worst over the sample
    states.
    """
    kinds = subject.kinds()
    samples = states(subject.family, kinds["exact"])
    for relation in relations(subject.family):
        yield examine(f"{subject.family.name}_{relation.kernel}", relation, kinds, samples)
    yield from roundings(subject.family, kinds, samples)
    real = kinds["real"]
    worst: dict[str, tuple[float, float]] = {}
    for text, error, ceiling in invariances(subject.family, real, [real.state(s) for s in samples]):
        error = error if np.isfinite(error) else np.inf
        if text not in worst or error > worst[text][0]:
            worst[text] = error, ceiling
    yield from ((text, *value) for text, value in worst.items())


def main(names: list[str], generated: Path | None = None) -> int:
    """Verify the named families, or all, and return the exit code of the command.

    `generated` is the folder of the C files, this installation's by default.
    """
    start = time.perf_counter()
    try:
        wanted = named(names) if names else families()
    except KeyError as unknown:
        print(f"funicular verify: {unknown.args[0]}", file=sys.stderr)
        return 1
    try:
        failures = examined(list(wanted.values()), generated or folder()).show()
    except CompilerError as problem:
        print(f"funicular verify: {problem}", file=sys.stderr)
        return 1
    print(f"{'all agree' if not failures else f'{failures} failures'}, {time.perf_counter() - start:.0f} s")
    return 1 if failures else 0


Catalogue = Callable[[], dict[str, Family]]


def examined(wanted: list[Family], generated: Path, catalogue: Catalogue = families) -> Report:
    """Return everything found about families whose C is in `generated`; `catalogue` finds them by name in other
    processes.
    """
    report = Report()
    with report.progress(len(wanted)) as progress:
        for name, (outputs, items) in _results(wanted, generated, catalogue, progress).items():
            report.missing(outputs)
            for item in items:
                report.add(name, item)
    return report


def _results(wanted: list[Family], generated: Path, catalogue: Catalogue,
             progress: Callable[[], None]) -> dict[str, tuple[list[str], list[Item]]]:
    """Return what `_examined` returns, by family in the order wanted; one process a core, the longest files first."""
    names = [family.name for family in wanted]
    found = {}
    workers = min(os.cpu_count() or 1, len(names))
    if workers == 1:
        for name in names:
            found[name] = _examined(name, generated, catalogue)
            progress()
        return found
    with ProcessPoolExecutor(workers, get_context("spawn")) as pool:
        waiting = {pool.submit(_examined, name, generated, catalogue): name for name in
                   sorted(names, key=lambda name: -_size(generated / f"{name}.c"))}
        try:
            for future in as_completed(waiting):
                found[waiting[future]] = future.result()
                progress()
        except CompilerError:
            pool.shutdown(cancel_futures=True)
            raise
    return {name: found[name] for name in names}


def _size(path: Path) -> int:
    return path.stat().st_size if path.is_file() else 0


def _examined(name: str, generated: Path, catalogue: Catalogue) -> tuple[list[str], list[Item]]:
    """Return the outputs of a family that no relation is about, findings and invariances."""
    with tempfile.TemporaryDirectory(prefix="funicular-verify-") as work:
        return findings(prepare(catalogue()[name], generated, Path(work)))


def findings(subject: Subject) -> tuple[list[str], list[Item]]:
    """Return the outputs of a family that no relation is about, findings and invariances."""
    # what a broken kernel returns is a finding, not a warning
    with mpmath.workdps(DIGITS), np.errstate(all="ignore"):
        return uncovered(subject.family, subject.programs), [
            item.plain() if isinstance(item, Finding) else item for item in verify(subject)]
