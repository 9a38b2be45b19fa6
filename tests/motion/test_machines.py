"""The numbers of machines by formulas by hand, which tests/benchmarks/machines.py prints."""

import pytest
from machines import MACHINES

BOUNDS = {"saddle: ratio of tensions": 1e-5, "walking load: largest deflection over the static one": 1e-4}
"""Relative; of others 1e-7."""


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("machine", MACHINES)
def test_a_machine_has_the_number_of_its_formula(machine):
    found, closed = MACHINES[machine]()
    assert found == pytest.approx(closed, rel=BOUNDS.get(machine, 1e-7))
