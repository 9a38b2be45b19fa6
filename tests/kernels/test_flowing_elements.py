"""Elements through which the material of a rope moves cost little more than those from which they come."""

from ropes.costs import crane, operations


def test_operations():
    found = {(row["element"], row["term"]): row["ratio"] for row in operations()}
    assert len(found) == 8
    assert max(ratio for (_, term), ratio in found.items() if term == "all") < 2.5


def test_a_long_store_costs_no_more():
    """The unknowns are the same, and 2 % more iterations at most."""
    reports = [crane(store).run(5.0, step=0.02, output_step=1.0, integrator="genalpha", progress=False).report
               for store in (10.0, 1000.0)]
    assert reports[0]["unknowns"] == reports[1]["unknowns"]
    assert reports[1]["newton_iterations"] <= 1.02 * reports[0]["newton_iterations"]
