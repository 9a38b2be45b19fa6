"""The command `funicular derive --watch NAME`: one family at every save of a source.

Each round runs in a process of its own, which reads the sources anew. It derives the family alone, compiles it in a
temporary folder, verifies it as `funicular verify` does, and prints operations and time of its kernels. Other
families and generated/ do not change, so that a round takes seconds; `funicular derive` writes the files at the
end.
"""

from __future__ import annotations

import ctypes
import json
import sys
import tempfile
import time
import traceback
from collections.abc import Iterator
from multiprocessing import get_context
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from funicular.kernels.libraries import Kernel
from rich import box
from rich.table import Table

from .catalogue import named
from .codegen import drift, manifest
from .codegen import rendering as emit
from .codegen.described import described
from .codegen.family import Family
from .codegen.program import Program
from .verify import timing
from .verify.command import findings, prepare
from .verify.compiled import SHARED_FLAGS, CompilerError, compile_units, link_shared
from .verify.report import Report

PAUSE = 0.3
"""Seconds between two looks at the sources."""
WATCHED = ("*.py", "*.jinja")
ROUNDS = 3
"""Repetitions of a timing, of which the shortest counts."""
SOURCES = Path(__file__).parent


def main(names: list[str]) -> int:
    """Watch families until Ctrl-C, and return the exit code of the command."""
    try:
        named(names)
    except KeyError as unknown:
        print(f"funicular derive: {unknown.args[0]}", file=sys.stderr)
        return 1
    for _ in saves(SOURCES):
        in_own_process(names)
        print(f"{time.strftime('%H:%M:%S')} waiting for a change in {SOURCES}; Ctrl-C ends. `funicular derive` writes "
              "generated/", flush=True)
    return 0


def saves(folder: Path, pause: float = PAUSE) -> Iterator[set[Path]]:
    """Yield the sources in a folder that are new, changed or gone: at first all of them, then at each change."""
    known: dict[Path, tuple[int, int]] = {}
    while True:
        found = {path: _stamp(path) for pattern in WATCHED for path in folder.rglob(pattern)}
        changed = {path for path in {*known, *found} if known.get(path) != found.get(path)}
        known = found
        if changed:
            yield changed
        time.sleep(pause)


def _stamp(path: Path) -> tuple[int, int]:
    """Return when a file was changed and its size; an editor may have removed it just now."""
    try:
        status = path.stat()
    except OSError:
        return 0, -1
    return status.st_mtime_ns, status.st_size


def in_own_process(names: list[str]) -> None:
    """Run a round in a process of its own, with the modules as they are saved."""
    process = get_context("spawn").Process(target=round_of, args=(names,))
    process.start()
    process.join()


def round_of(names: list[str]) -> int:
    """Derive, compile, verify and time families; print it, and return the number of failures."""
    failures = 0
    for name in names:
        try:
            failures += attempt(named([name])[name])
        except CompilerError as problem:
            print(f"{name}: {problem}", file=sys.stderr)
            failures += 1
        except Exception:  # whatever an unfinished spec raises
            traceback.print_exc()
            failures += 1
    return failures


def attempt(family: Family) -> int:
    """Derive, compile, verify and time a family; print it, and return the number of failures.

    Raises CompilerError, and whatever the spec raises.
    """
    clock = [time.perf_counter()]

    def lap() -> float:
        clock.append(time.perf_counter())
        return clock[-1] - clock[-2]

    derived = emit.derive(family)
    content = json.loads(manifest.text([derived], manifest.origin([family]), {}))
    with tempfile.TemporaryDirectory(prefix="funicular-watch-") as folder:
        work = Path(folder)
        for name, text in emit.render([derived], [family.name], lambda _: None).items():
            (work / name).write_text(text, encoding="utf-8", newline="\n")
        taken = [f"derived in {lap():.1f} s"]
        microseconds = _times(family, content, work)
        taken.append(f"compiled and timed in {lap():.1f} s")
        report = _verified(family, [p for p in derived.programs if isinstance(p, Program)], work)
        taken.append(f"verified in {lap():.1f} s")
    if report.failures:
        report.show()
    verdict = f"{report.failures} failures, the first: {report.first_failure}" if report.failures else "all agree"
    record = drift.record()
    before = described(record, {family.name} & record.get("kernels", {}).keys())
    report.out.print(_table(described(content), before, microseconds))
    report.out.print(f"{family.name}: {', '.join(taken)}; {verdict}", soft_wrap=True)
    return report.failures


def _times(family: Family, content: dict[str, Any], work: Path) -> dict[str, float]:
    """Return the microseconds a call by kernel, from the C in a folder."""
    flags = [*SHARED_FLAGS, f"-I{work}"]
    units = compile_units([work / f"{family.name}.c"], flags, work)
    shared = ctypes.CDLL(str(link_shared(units, work)))
    kernels = SimpleNamespace(**{name: Kernel(shared, name, entry) for name, entry in described(content).items()})
    program = timing.build([family], content, kernels, units, flags, work)
    return {name: min(times) for name, times in timing.times(program, ROUNDS).items()}


def _verified(family: Family, programs: list[Program], work: Path) -> Report:
    report = Report()
    uncovered, found = findings(prepare(family, work, work, programs))
    report.missing(uncovered)
    for item in found:
        report.add(family.name, item)
    return report


def _table(kernels: dict[str, Any], before: dict[str, Any], microseconds: dict[str, float]) -> Table:
    """Return operations as they are and as generated/ has them, and times of one thread, by kernel."""
    table = Table(box=box.SIMPLE_HEAD)
    for name in ("kernel", "operations", "in generated/", "µs a call"):
        table.add_column(name, justify="left" if name == "kernel" else "right", no_wrap=True)
    for name, entry in kernels.items():
        here = sum(entry["operations"].values())
        there = sum(before[name]["operations"].values()) if name in before else None
        table.add_row(name, str(here), "none" if there is None else str(there) if there != here else "the same",
                      f"{microseconds[name]:.3g}")
    return table
