"""Refined meshes, zones and steps of ropes converge."""

import pytest
from ropes.refinements import SERIES, Series

MESH, ZONES, GENALPHA, RADAU = SERIES
pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


def check(series: Series, order: float, last: float) -> None:
    """Assert the least order between all, and the last error."""
    rows = list(series.rows())
    assert min(row["order"] for row in rows[1:]) > order, rows
    assert rows[-1]["error"] < last, rows


def test_zones_converge():
    """Order 2: errors 4.9e-2, 1.3e-2, 3.2e-3, 8.0e-4."""
    check(ZONES, 1.9, 8.1e-4)


@pytest.mark.slow
def test_steps_converge():
    """Order 2 of genalpha."""
    check(GENALPHA, 1.9, 3e-7)


@pytest.mark.slow
def test_steps_of_radau_converge():
    """The stiff tension reduces its order: errors 1.9e-7, 5.9e-8, 6e-9 m."""
    check(RADAU, 1.6, 1e-8)


@pytest.mark.slow
def test_meshes_converge():
    """Errors 1.3e-4, 2.3e-5, 3e-6, 4e-8 m of a motion of 3 m."""
    check(MESH, 2.0, 1e-7)
