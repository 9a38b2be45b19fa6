"""Tables of `funicular verify`, and for each failure its worst entries: analytic, other method, difference."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
from rich import box
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from .inputs import KINDS
from .methods import METHODS, Finding
from .rounding import ENTRY, NORM, Rounding

CONSOLE_WIDTH = 220  # columns from which on a table has all its columns
PIPED_WIDTH = 1000  # more than any line has: piped lines stay whole


class Report:
    """Collects findings, prints them."""

    def __init__(self) -> None:
        self.findings: list[Finding] = []
        self.invariances: list[tuple[str, str, float, float]] = []
        self.roundings: list[Rounding] = []
        self.uncovered: list[str] = []
        self.out = Console(highlight=False, markup=False)
        if not self.out.is_terminal:
            self.out = Console(highlight=False, markup=False, width=PIPED_WIDTH)

    @contextmanager
    def progress(self, total: int) -> Iterator[Callable[[], None]]:
        """Yield what advances a bar on a terminal; there is no bar when piped."""
        console = Console(stderr=True)
        with Progress(console=console, disable=not console.is_terminal, transient=True) as bar:
            task = bar.add_task("verify", total=total)
            yield lambda: bar.advance(task)

    def add(self, family: str, item: Finding | Rounding | tuple[str, float, float]) -> None:
        """Add one finding, rounding or invariance of a family."""
        if isinstance(item, Finding):
            self.findings.append(item)
        elif isinstance(item, Rounding):
            self.roundings.append(item)
        else:
            self.invariances.append((family, *item))

    def missing(self, outputs: list[str]) -> None:
        """Note outputs that have no relation."""
        self.uncovered += outputs

    @property
    def failures(self) -> int:
        """Return how many findings, outputs, roundings and invariances are not as they must be."""
        return len(self._failed) + len(self.uncovered) + len(self._rounded) + len(self._broken)

    @property
    def first_failure(self) -> str:
        """Return the first failure in a line."""
        for f in self._failed:
            return f"{f.kernel}: {f.place(f.worst_entry)} is not {f.relation.text} ({', '.join(f.failed)})"
        for output in self.uncovered:
            return f"{output} is not verified"
        for r in self._rounded:
            return f"{r.kernel}: {r.place} loses digits on input of the kind {r.kind}"
        return "; ".join(f"{family}: {text}" for family, text, *_ in self._broken[:1])

    @property
    def _failed(self) -> list[Finding]:
        return [f for f in self.findings if f.failed]

    @property
    def _rounded(self) -> list[Rounding]:
        return [r for r in self.roundings if r.failed]

    @property
    def _broken(self) -> list[tuple[str, str, float, float]]:
        return [i for i in self.invariances if not i[2] <= i[3]]

    def show(self) -> int:
        """Print everything; returns the number of failures."""
        self.out.print(self._derivatives())
        self.out.print(self._rounding())
        self.out.print(self._invariances())
        for finding in self._failed:
            self._detail(finding)
        for output in self.uncovered:
            self.out.print(f"{output}: no relation verifies this output; add one in verify/relations")
        for r in self._rounded:
            self.out.print(f"{r.kernel}: {r.place} loses digits on input of the kind {r.kind}: {r.computed:.16g} is "
                           f"off by {r.error:.2g}, {r.entry:.2g} times what rounded inputs allow, may be {ENTRY:.0f}; "
                           f"the output by {r.norm:.2g} times, may be {NORM:.0f}")
        for family, text, error, ceiling in self._broken:
            self.out.print(f"{family}: {text}: {error:.2g}, may be {ceiling:.2g}")
        return self.failures

    def _derivatives(self) -> Table:
        wide = self.out.width >= CONSOLE_WIDTH
        table = _table("Every output against what it is: worst error, relative to its largest entry",
                       left=["kernel", "output", "is"] if wide else ["kernel", "output"],
                       right=[*METHODS, "step"], last=["worst at"])
        last = ""
        for f in self.findings:
            about = [f.relation.output, f.relation.text] if wide else [f.relation.output]
            errors = [f"{f.errors[m]:.1e}" if m in f.errors else "-" for m in METHODS]
            table.add_row(_verdict(not f.failed), _once(f.kernel, last, f.failed), *about, *errors,
                          f"{f.step:.0e}" if f.step else "-", f.place(f.worst_entry),
                          style="red" if f.failed else None)
            last = f.kernel
        worst = [max((f.errors[m] for f in self.findings if m in f.errors), default=0.0) for m in METHODS]
        table.add_section()
        table.add_row("", "worst", *[""] * (2 if wide else 1), *(f"{w:.1e}" for w in worst))
        return table

    def _rounding(self) -> Table:
        table = _table("Rounding against 50 digits, in units of what rounded inputs allow: worst entry by kind of "
                       "input, worst output", left=["kernel"], right=[*KINDS, "output"], last=["worst at"])
        by_kernel: dict[str, list[Rounding]] = {}
        for r in self.roundings:
            by_kernel.setdefault(r.kernel, []).append(r)
        for kernel, found in by_kernel.items():
            entries = {r.kind: f"{r.entry:.2g}" for r in found}
            norm, worst = max(r.norm for r in found), max(found, key=lambda r: r.entry)
            ok = not any(r.failed for r in found)
            table.add_row(_verdict(ok), kernel, *(entries.get(kind, "-") for kind in KINDS), f"{norm:.2g}",
                          f"{worst.place}, {worst.kind}", style=None if ok else "red")
        table.add_section()
        largest = [max((r.entry for r in self.roundings if r.kind == kind), default=0.0) for kind in KINDS]
        table.add_row("", "worst", *(f"{w:.2g}" for w in largest),
                      f"{max((r.norm for r in self.roundings), default=0.0):.2g}")
        return table

    def _invariances(self) -> Table:
        table = _table("Invariances: worst error, relative to the sample's scale", left=["family", "invariance"],
                       right=["error", "may be"], last=[])
        last = ""
        for family, text, error, ceiling in self.invariances:
            ok = error <= ceiling
            table.add_row(_verdict(ok), _once(family, last, not ok), text, f"{error:.1e}", f"{ceiling:.1e}",
                          style=None if ok else "red")
            last = family
        return table

    def _detail(self, finding: Finding) -> None:
        self.out.print(f"\n{finding.kernel}: {finding.relation.output} is not {finding.relation.text}")
        for method in finding.failed:
            self.out.print(f"  {method}: error {finding.errors[method]:.2g}, may be {finding.ceiling(method):.0e}")
            self.out.print(f"    {'entry':14}{'analytic':>25}{'by ' + method:>25}{'difference':>12}")
            for entry, analytic, other in finding.samples[method]:
                analytic, other = float(np.real(analytic)), float(np.real(other))
                self.out.print(f"    {finding.place(entry):14}{analytic:25.16g}{other:25.16g}{analytic - other:12.2g}")


def _table(title: str, left: list[str], right: list[str], last: list[str]) -> Table:
    table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD)
    table.add_column("", min_width=4, no_wrap=True)
    for name in [*left, *right, *last]:
        # a narrow terminal shortens names, never figures
        table.add_column(name, justify="right" if name in right else "left", no_wrap=True,
                         min_width=8 if name in right else None)
    return table


def _once(name: str, last: str, failed: object) -> str:
    """Return a name at its first row and wherever something failed, else nothing."""
    return name if failed or name != last else ""


def _verdict(ok: bool) -> str:
    return "ok" if ok else "FAIL"
