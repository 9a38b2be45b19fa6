"""Published cases of elements: figures of each element with each elastic law beside the published numbers.

    python tests/benchmarks/cases.py [--out FILE.csv]

A row is an element with a law in a case: the quantity with the largest error, its value and reference, the error
relative to the scale in tests/benchmarks/published, the elements used, and, where meshes are compared, the order of
convergence p of the error ~ length^p, from half the elements. The note gives the cause of an error, or the reason for a
missing number.
"""

from __future__ import annotations

from published import CASES, Case, Kind
from published.case import lookup
from table import arguments, few, show

COLUMNS = ("case", "element", "law", "elements", "quantity", "value", "reference", "error", "order", "note")


def row(case: Case, kind: Kind) -> dict:
    """Return the row of an element with a law."""
    n = case.count(kind)
    quantity, value = case.found(kind, n)[0]
    order = f"{case.observed_order(kind):.1f}" if kind in case.ordered else ""
    cells = (case.name, kind.element, kind.law, n, f"{quantity.name} [{quantity.unit}]", f"{value:.9g}",
             f"{quantity.reference:.9g}", f"{case.error(kind):.1e}", order, lookup(case.notes, kind, ""))
    return dict(zip(COLUMNS, cells, strict=True))


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__)
    rows = []
    for case in few(CASES):
        print(f"{case.name}: {case.title} ({case.source})", flush=True)
        rows += [row(case, kind) for kind in few(case.kinds)]
        rows += [dict(zip(COLUMNS, (case.name, element, *[""] * 7, why), strict=True))
                 for element, why in case.cannot.items()]
    print()
    show(rows, options.out)


if __name__ == "__main__":
    main()
