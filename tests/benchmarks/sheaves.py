"""Runs of ropes over sheaves against independent solutions (ropes/): errors with their bars, CPU time of a run.

    python tests/benchmarks/sheaves.py [--out FILE.csv]
"""

import time
import warnings

from ropes import CASES
from ropes.case import Case
from ropes.runs import RUNS
from table import arguments, few, show


def rows_of(case: Case) -> list[dict]:
    """Run a case and return a row for each of its quantities."""
    begin = time.process_time()
    found = RUNS[case.key]()
    seconds = time.process_time() - begin
    rows = []
    for quantity, reference in zip(case.quantities, case.reference(), strict=True):
        if quantity.name in found:
            error = abs(found[quantity.name] - reference) / (1.0 if quantity.absolute else abs(reference))
            rows.append({"case": case.key, "quantity": f"{quantity.name}, {quantity.unit}",
                         "run": f"{found[quantity.name]:.7g}", "reference": f"{reference:.7g}", "error": error,
                         "bar": quantity.bar, "CPU s": seconds})
    return rows


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__)
    warnings.simplefilter("ignore")
    cases = sorted((case for case in CASES if case.key in RUNS), key=lambda case: case.key != "run-on with bending")
    show([row for case in few(cases) for row in rows_of(case)], options.out)


if __name__ == "__main__":
    main()
