"""The numbers of machines by formulas by hand, which tests/benchmarks/machines.py prints."""

import pytest
from machines import MACHINES

WALK = "walking load: largest deflection over the static one"
BOUNDS = {"saddle: ratio of tensions": 1e-5, WALK: 1e-4}
"""Relative; of others 1e-7."""


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("machine", MACHINES)
def test_a_machine_has_the_number_of_its_formula(machine, validated):
    found, closed = MACHINES[machine]()
    case, quantity = machine.split(": ")
    quantity, _, unit = quantity.partition(", ")
    validated("Machines", case, quantity, closed, found, unit=unit, bound=BOUNDS.get(machine, 1e-7),
              source="published table" if machine == WALK else "formula by hand")
