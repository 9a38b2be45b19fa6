"""The experiments of cosseratbench with funicular, PyElastica and MuJoCo: the error of each experiment, and CPU time.

    python tests/benchmarks/cosserat.py [--out FILE.csv] [--experiments crossing,capstan] [--solvers funicular]

It needs cosseratbench; peers that are not installed are left out (pip install '.[bench]' installs all). All solvers
have the number of elements of the experiment. CPU time is that of the run alone: cosseratbench runs each solver once
for a thousandth of the duration first. `error` is the experiment's first metric, `second` the next one: lengths are
relative to that of the rod, other numbers to those of the reference; the slide of the capstan is in m. `depth` is the
largest penetration of rods into obstacles or each other, in radii.

The reference of the crossing has 2001 points, and its metrics use the nearest of them: with the required 51 elements
the exact shape has the errors 2.5e-4 and 5.4e-3, with 50 it has none. A row with 50 elements shows this.

With --meshes funicular alone runs with half, once and twice the elements. An error that stays is that of the reference,
of the experiment, or of the time that it allows for settling.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from collections.abc import Iterable
from dataclasses import dataclass, field
from time import process_time
from typing import Any

from cosseratbench import registry
from cosseratbench.experiment import run
from table import few, parser, show

METRICS = {"catenary": ("shape_error", "sag_error"), "cantilever": ("tip_deflection_error", None),
           "pendulum": ("period_error", "amplitude_change"), "twist": ("critical_twist_error", None),
           "crossing": ("shape_error", "lift_error"), "capstan": ("slide", None)}
"""Of each experiment the metrics that are shown; how far it still moves is another one."""

OTHER_ELEMENTS = {"crossing": 50}
"""Of experiments that are run once more with another number of elements: see above."""

SOLVERS = ("funicular", "pyelastica", "mujoco")


@dataclass
class Timed:
    """A solver that records the CPU time of its last run, in s."""

    inner: Any
    cpu: float = float("nan")
    name: str = field(init=False)
    capabilities: frozenset = field(init=False)

    def __post_init__(self) -> None:
        self.name, self.capabilities = self.inner.name, self.inner.capabilities

    def run(self, *args, **given) -> Any:
        """Return the result of the solver."""
        start = process_time()
        try:
            return self.inner.run(*args, **given)
        finally:
            self.cpu = process_time() - start


def row(name: str, solver: str, elements: int | None = None, **options: Any) -> dict | None:
    """Return a row of the table, None if the solver is not installed. elements: those of the experiment by default."""
    experiment = registry.load_experiment(name)
    try:
        timed = Timed(registry.load_solver(solver, **options))
    except ImportError:
        return None
    result = run(experiment, timed, n_elements=elements)
    first, second = METRICS[name]
    seen = result.metrics | result.observations
    return {"experiment": name, "solver": solver + "".join(f" {k}={v}" for k, v in options.items()),
            "elements": result.n_elements, "error": seen.get(first, result.outcome), "second": seen.get(second, ""),
            "depth": seen.get("max_rod_overlap" if name == "crossing" else "max_penetration", ""),
            "cpu_s": timed.cpu if result.metrics else ""}


def rows(names: Iterable[str], solvers: Iterable[str], meshes: bool) -> list[dict]:
    """Return all rows of installed solvers."""
    found = []
    for name in names:
        usual = registry.load_experiment(name).n_elements
        if meshes:
            even = OTHER_ELEMENTS.get(name, usual)
            found += [row(name, "funicular", elements) for elements in (even // 2, even, 2 * even)]
            continue
        found += [row(name, solver) for solver in solvers]
        if name == "catenary" and "funicular" in solvers:
            found.append(row(name, "funicular", bending=False))
        if name in OTHER_ELEMENTS:
            found += [row(name, solver, OTHER_ELEMENTS[name]) for solver in solvers]
    return [each for each in found if each is not None]


if __name__ == "__main__":
    command = parser(__doc__)
    command.add_argument("--experiments", default=",".join(METRICS), help="names, by commas (default: all)")
    command.add_argument("--solvers", default=",".join(SOLVERS), help="names, by commas (default: all)")
    command.add_argument("--meshes", action="store_true", help="funicular with half, once and twice the elements")
    given = command.parse_args()
    show(rows(few(given.experiments.split(",")), few(given.solvers.split(",")), given.meshes), given.out,
         "meshes" if given.meshes else "peers")
