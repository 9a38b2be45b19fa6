"""The mark `slow_cases`: cases of a parametrised test that are slow, by the ends of their names.

They assert what the other cases assert, by another element, integrator or size: `-m slow` takes them, and the default
run the others.
"""

from collections.abc import Sequence

import pytest


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark a case that is named slow."""
    if (named := item.get_closest_marker("slow_cases")) and item.callspec.id in named.args:
        item.add_marker("slow")


def unknown(items: Sequence[pytest.Item]) -> list[str]:
    """Return the names of slow cases that no item has, of tests of which the items have all cases."""
    named, found = {}, {}
    for item in items:
        if mark := item.get_closest_marker("slow_cases"):
            test = item.nodeid.removesuffix(f"[{item.callspec.id}]")
            named[test] = mark.args
            found.setdefault(test, set()).add(item.callspec.id)
    return [f"{test}[{case}]" for test, cases in named.items() for case in cases if case not in found[test]]


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Fail if a test has no case of a name, where no case was asked for."""
    if not any("::" in argument for argument in config.args) and (wrong := unknown(items)):
        raise pytest.UsageError(f"slow_cases that are not there: {', '.join(wrong)}")
