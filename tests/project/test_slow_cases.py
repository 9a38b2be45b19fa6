"""The mark `slow_cases` moves the cases that it names to the slow tests, and a name without a case is found."""

from types import SimpleNamespace

import pytest
from slow_cases import pytest_collection_modifyitems, pytest_itemcollected, unknown


def item(case: str, *names: str) -> SimpleNamespace:
    """Return one case of a test with the mark."""
    marks = [pytest.mark.slow_cases(*names).mark] if names else []
    return SimpleNamespace(nodeid=f"test_a.py::test[{case}]", callspec=SimpleNamespace(id=case), added=(added := []),
                           get_closest_marker=lambda name: next(iter(marks), None), add_marker=added.append)


def test_the_cases_that_are_named_are_slow():
    items = [item(case, "3-radau", "2-radau") for case in ("2-radau", "2-energy", "3-radau")] + [item("3-radau")]
    for each in items:
        pytest_itemcollected(each)
    assert [each.added for each in items] == [["slow"], [], ["slow"], []]


def test_a_name_without_a_case_is_found():
    items = [item(case, "b", "c") for case in ("a", "b")]
    assert unknown(items) == ["test_a.py::test[c]"]
    with pytest.raises(pytest.UsageError, match=r"not there: test_a.py::test\[c\]"):
        pytest_collection_modifyitems(SimpleNamespace(args=["tests"]), items)
    pytest_collection_modifyitems(SimpleNamespace(args=["test_a.py::test[a]"]), items[:1])
