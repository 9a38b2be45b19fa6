"""Reference solutions of ropes that run give the published numbers to their digits."""

import pytest
from ropes import CASES
from ropes.case import Case
from ropes.chains import heavy_atwood

FAST = [case for case in CASES if not case.slow]
SLOW = [case for case in CASES if case.slow]


def off(case: Case) -> list[str]:
    """Return the quantities that differ from the published numbers by more than these are sure."""
    pairs = zip(case.quantities, case.reference(), strict=True)
    return [f"{each.name}: {found:.9g}, not {each.written}" for each, found in pairs
            if abs(found - each.value) > each.within * (1 + 1e-9)]


def test_cases_have_keys_of_their_own():
    assert len({case.key for case in CASES}) == len(CASES)
    for case in CASES:
        assert len({each.name for each in case.quantities}) == len(case.quantities), case.key


@pytest.mark.parametrize("case", FAST, ids=lambda case: case.key)
def test_a_reference_gives_the_published_numbers(case):
    assert off(case) == []


@pytest.mark.slow
@pytest.mark.parametrize("case", SLOW, ids=lambda case: case.key)
def test_a_slow_reference_gives_the_published_numbers(case):
    assert off(case) == []


@pytest.mark.slow
def test_a_short_chain_is_within_the_bar():
    """26 masses: error 4e-4 m of a bar of 5e-4 m."""
    case = next(each for each in CASES if each.compute is heavy_atwood)
    for each, found in zip(case.quantities, heavy_atwood(26), strict=True):
        assert each.error(found) < each.bar, each.name
