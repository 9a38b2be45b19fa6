"""Runs of ropes over sheaves against independent solutions (ropes/): errors with their bars, CPU time of a run.

Rows of ropes without mass follow those of ropes with mass.

A second table has the errors of refined meshes, zones and steps, with the order between two of them; a third one what
a reference leaves out: the bending of the belt, the wraps of the elevator; a fourth one operations of elements through
which the material moves; the last one a step of a crane by the length in store.

    python tests/benchmarks/sheaves.py [--out FILE.csv] [--repetitions 5]
"""

import time
import warnings
from collections.abc import Callable

from ropes import CASES
from ropes.belts import EI
from ropes.case import Case
from ropes.costs import operations, stores
from ropes.massless_runs import RUNS as WITHOUT_MASS
from ropes.refinements import SERIES
from ropes.runs import RUNS, belt
from ropes.scenes import Found
from table import arguments, few, show


def rows_of(case: Case, runs: dict[str, Callable[[], Found]] = RUNS, suffix: str = "") -> list[dict]:
    """Run a case and return a row for each of its quantities."""
    begin = time.process_time()
    found = runs[case.key]()
    seconds = time.process_time() - begin
    rows = []
    for quantity, reference in zip(case.quantities, case.reference(), strict=True):
        if quantity.name in found:
            error = abs(found[quantity.name] - reference) / (1.0 if quantity.absolute else abs(reference))
            rows.append({"case": case.key + suffix, "quantity": f"{quantity.name}, {quantity.unit}",
                         "run": f"{found[quantity.name]:.7g}", "reference": f"{reference:.7g}", "error": error,
                         "bar": quantity.bar, "CPU s": seconds})
    return rows


def shares_left_out() -> list[dict]:
    """Run the belt and the elevator without and with what the references leave out; return their differences."""
    pairs = (("belt, bending", belt(), belt(EI)),
             ("elevator, wraps", RUNS["elevator"](), RUNS["elevator with wraps"]()))
    return [{"case": case, "quantity": name, "without": f"{without[name]:.7g}", "with": f"{found[name]:.7g}",
             "share": found[name] / without[name] - 1}
            for case, without, found in pairs for name in found]


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__, repetitions=(5, "runs of the crane, the least time of which counts"))
    warnings.simplefilter("ignore")
    cases = sorted((case for case in CASES if case.key in RUNS), key=lambda case: case.key != "run-on with bending")
    without = [] if options.smallest else [row for case in CASES if case.key in WITHOUT_MASS
                                           for row in rows_of(case, WITHOUT_MASS, ", no mass")]
    show([row for case in few(cases) for row in rows_of(case)] + without, options.out)
    print()
    show([row for series in (SERIES[1:2] if options.smallest else SERIES) for row in series.rows()],
         table="refinements")
    if not options.smallest:
        print()
        show(shares_left_out(), table="left out")
    print()
    show(operations(), table="operations")
    print()
    show(stores(options.repetitions), table="stores")


if __name__ == "__main__":
    main()
