"""Errors, energy balances and joint residuals of the hard cases with every integrator, and CPU seconds.

    python tests/benchmarks/hard.py [--out FILE.csv] [--only WORDS]

(!) marks a broken bound; tests/motion/test_hard_cases.py asserts the bounds. Errors are over the largest motion,
`balance` over the energy exchanged, distances in m.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from time import process_time

from hard_cases import CASES, broken
from table import few, parser, write


def main() -> None:
    """Measure and print."""
    options = parser(__doc__)
    options.add_argument("--only", default="", help="cases whose name holds this")
    options = options.parse_args()
    rows = []
    for case in few(case for case in CASES if options.only in case.name):
        for integrator in few(case.integrators):
            begin = process_time()
            figures, limits = case.measure(integrator), case.limits(integrator)
            seconds = process_time() - begin
            wrong = {name for name, bound in limits.items() if broken(figures[name], bound)}
            told = ", ".join(f"{name} {value:.3g}" + " (!)" * (name in wrong) for name, value in figures.items())
            print(f"{case.name} | {integrator} | {seconds:.2f} s | {told}", flush=True)
            rows += [{"case": case.name, "integrator": integrator, "figure": name, "value": value,
                      "bound": limits.get(name, ""), "broken": name in wrong} for name, value in figures.items()]
    write(rows, options.out)


if __name__ == "__main__":
    main()
