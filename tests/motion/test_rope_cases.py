"""Runs of ropes keep the bars of the reference solutions."""

import pytest
from ropes import CASES
from ropes.runs import RUNS

BY_KEY = {case.key: case for case in CASES}
QUICK = ("heavy rope", "free rope", "run-on with bending", "capstan", "elevator", "elevator with wraps", "ropeway",
         "held cylinder", "wave", "fleet angle at rest", "fleet angle with mass", "drum", "pendulum hauled in",
         "tackle", "two weights")
SLOW = sorted(set(RUNS) - set(QUICK))


def beyond_bars(key: str) -> list[str]:
    """Return the quantities of a case whose error is beyond the bar."""
    case, found = BY_KEY[key], RUNS[key]()
    names = [quantity.name for quantity in case.quantities]
    assert found and not set(found) - set(names)
    errors = [(quantity, abs(found[quantity.name] - reference) / (1.0 if quantity.absolute else abs(reference)))
              for quantity, reference in zip(case.quantities, case.reference(), strict=True) if quantity.name in found]
    return [f"{quantity.name}: {error:.2e} of {quantity.bar:g}" for quantity, error in errors if error > quantity.bar]


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("key", QUICK)
@pytest.mark.slow_cases("two weights", "fleet angle with mass")
def test_a_run_keeps_the_bars(key):
    assert beyond_bars(key) == []


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("key", SLOW)
def test_a_longer_run_keeps_the_bars(key):
    assert beyond_bars(key) == []
