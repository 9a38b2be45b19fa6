"""Tables of `funicular verify`, and for each failure its worst entries: analytic, other method, difference."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
from funicular.derive.verify_methods import METHODS, Finding
from rich.console import Console
from rich.progress import Progress
from rich.table import Table


class Report:
    """Collects findings, prints them."""

    def __init__(self):
        self.findings: list[Finding] = []
        self.invariances: list[tuple[str, str, float, float]] = []
        self.uncovered: list[str] = []
        # piped output keeps whole lines
        self.out = Console(highlight=False, markup=False)
        if not self.out.is_terminal:
            self.out = Console(highlight=False, markup=False, width=180)

    @contextmanager
    def progress(self, total: int) -> Iterator[Callable[[], None]]:
        """A bar on a terminal, nothing when piped; yields what moves it on."""
        console = Console(stderr=True)
        with Progress(console=console, disable=not console.is_terminal, transient=True) as bar:
            task = bar.add_task("verify", total=total)
            yield lambda: bar.advance(task)

    def add(self, family: str, item: Finding | tuple[str, float, float]) -> None:
        """One finding or invariance of a family."""
        if isinstance(item, Finding):
            self.findings.append(item)
        else:
            self.invariances.append((family, *item))

    def missing(self, outputs: list[str]) -> None:
        """Outputs without a relation."""
        self.uncovered += outputs

    def show(self) -> int:
        """Print everything; returns the number of failures."""
        self.out.print(self._derivatives())
        self.out.print(self._invariances())
        failed = [f for f in self.findings if f.failed]
        for finding in failed:
            self._detail(finding)
        for output in self.uncovered:
            self.out.print(f"{output}: no relation verifies this output; add one in verify_relations.py")
        broken = [i for i in self.invariances if not i[2] <= i[3]]
        for family, text, error, ceiling in broken:
            self.out.print(f"{family}: {text}: {error:.2g}, may be {ceiling:.2g}")
        return len(failed) + len(self.uncovered) + len(broken)

    def _derivatives(self) -> Table:
        table = Table(title="Every output against what it is: worst error, relative to its largest entry",
                      title_justify="left")
        for name in ("kernel", "output", "is", *METHODS, "step", "worst at", ""):
            table.add_column(name, justify="right" if name in (*METHODS, "step") else "left", no_wrap=True)
        last = ""
        for f in self.findings:
            errors = [f"{f.errors[m]:.1e}" if m in f.errors else "-" for m in METHODS]
            table.add_row("" if f.kernel == last else f.kernel, f.relation.output, f.relation.text, *errors,
                          f"{f.step:.0e}" if f.step else "-", f.place(f.worst_entry), "FAIL" if f.failed else "ok",
                          style="red" if f.failed else None)
            last = f.kernel
        return table

    def _invariances(self) -> Table:
        table = Table(title="Invariances: worst error, relative to the sample's scale", title_justify="left")
        for name in ("family", "invariance", "error", "may be", ""):
            table.add_column(name, justify="right" if name in ("error", "may be") else "left", no_wrap=True)
        last = ""
        for family, text, error, ceiling in self.invariances:
            ok = error <= ceiling
            table.add_row("" if family == last else family, text, f"{error:.1e}", f"{ceiling:.1e}",
                          "ok" if ok else "FAIL", style=None if ok else "red")
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
