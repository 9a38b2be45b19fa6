"""The fixture `validated`: a recorded comparison with an external number, with an assertion.

A test gives case, source, quantity, reference, bound and result. The record, tests/benchmarks/measured/validation.json,
keeps them with the name of the test, and the page Validation is printed from it. A test that differs from its record
fails, with the command that renews it:

    python -m pytest -n 0 -m "" --record-validation tests/motion/test_cases.py && python tests/benchmarks/print_pages.py
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import records
from numpy.typing import ArrayLike

Numbers = float | ArrayLike

FILE = records.FOLDER / "validation.json"
RENEW = "record it: python -m pytest -n 0 -m '' --record-validation {0} && python tests/benchmarks/print_pages.py"
SAID = ("subject", "source", "bound", "note")
"""What a test gives, and a record must say alike; the reference, too, but for rounding, where it is of one quantity."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add --record-validation."""
    parser.addoption("--record-validation", action="store_true",
                     help="write what tests with the fixture `validated` find to tests/benchmarks/measured")


def row(node: str, subject: str, case: str, quantity: str, reference: Numbers, ours: Numbers, *, bound: float,
        source: str,
        unit: str = "", scale: float | None = None, stays: float | None = None, worst: bool = False, variant: str = "",
        note: str = "", mesh: str | Callable[[], str] = "") -> dict[str, Any]:
    """Return a row of the record.

    bound: of the error, |ours - reference| over ``scale``, by default the reference itself. stays: an error that an
    element has on any mesh, found to a part ``bound`` of it. worst: whether the quantity has the largest error of
    several, so that machines may differ in the choice; of arrays the entry with the largest error counts. variant:
    element, law or integrator. mesh: the mesh of the result, called for a record alone.
    """
    if np.ndim(reference) or np.ndim(ours):
        reference, ours, over = np.broadcast_arrays(reference, ours, np.abs(reference) if scale is None else scale)
        at = np.argmax(np.abs(ours - reference) / over)
        reference, ours, scale, worst = float(reference.flat[at]), float(ours.flat[at]), float(over.flat[at]), True
    error = abs(ours - reference) / (abs(reference) if scale is None else scale)
    limit = f"{bound:.2g}" if stays is None else f"{stays:.3g} ± {100 * bound:.2g} %"
    made = {"subject": subject, "case": case, "source": source, "quantity": quantity, "unit": unit,
            "reference": f"{reference:.9g}", "ours": f"{ours:.9g}", "error": float(error), "bound": limit, "note": note,
            "mesh": mesh, "variant": variant, "worst": worst, "test": node}
    return {key: value if callable(value) else records.plain(value) for key, value in made.items()}


def name_of(row: dict[str, Any]) -> tuple[str, str, str]:
    """Return the key of a row of the record."""
    return row["test"], row["case"], "" if row["worst"] else row["quantity"]


def recorded() -> list[dict[str, Any]]:
    """Return the rows of the record."""
    return records.load(FILE).get("validation", {"rows": []})["rows"]


def keep(made: dict[str, Any], first: bool) -> None:
    """Add a row to the record; the first row of a test replaces all its earlier rows."""
    made = made | {"mesh": made["mesh"]() if callable(made["mesh"]) else made["mesh"]}
    rows, own = recorded(), [old["test"] == made["test"] for old in recorded()]
    at = own.index(True) if True in own else len(rows)
    if first:
        rows = [old for old, is_own in zip(rows, own, strict=True) if not is_own]
    else:
        at += sum(own)
    records.record(FILE, "validation", [*rows[:at], made, *rows[at:]])


@pytest.fixture
def validated(request: pytest.FixtureRequest) -> Callable[..., None]:
    """Return a function with the arguments of `row` after the first: it asserts the bound and keeps the record."""
    node, renewed = request.node.nodeid, request.config.getoption("record_validation")
    seen: set[tuple[str, str, str]] = set()

    def check(*args: Any, **given: Any) -> None:
        made = row(node, *args, **given)
        assert name_of(made) not in seen, f"{made['case']}, {made['quantity']}: a comparison needs a name of its own"
        seen.add(name_of(made))
        stays, bound = given.get("stays"), given["bound"]
        off = abs(made["error"] - stays) / stays if stays is not None else made["error"]
        assert off <= bound, f"{made['case']}, {made['quantity']}: {made['ours']}, not {made['reference']} to {bound}"
        if renewed:
            keep(made, first=len(seen) == 1)
            return
        known = next((old for old in recorded() if name_of(old) == name_of(made)), None)
        renew = RENEW.format(node.partition("::")[0])
        assert known is not None, renew
        assert {key: made[key] for key in SAID} == {key: known[key] for key in SAID}, renew
        same = math.isclose(float(made["reference"]), float(known["reference"]), rel_tol=1e-5, abs_tol=1e-9)
        assert made["worst"] or same, renew

    return check
