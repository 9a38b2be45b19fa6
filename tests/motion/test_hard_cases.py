"""The hard cases of tests/benchmarks/hard_cases: every figure within its bound; -rP shows all of them."""

import pytest
from hard_cases import CASES, broken

PAIRS = [pytest.param(case, integrator, id=f"{case.name}, {integrator}",
                      marks=[pytest.mark.slow] * (integrator in case.slow))
         for case in CASES for integrator in case.integrators]


@pytest.mark.parametrize(("case", "integrator"), PAIRS)
def test_figures_stay_within_their_bounds(case, integrator):
    figures, limits = case.measure(integrator), case.limits(integrator)
    print(", ".join(f"{name} {value:.4g}" for name, value in figures.items()))
    wrong = {name: (figures[name], bound) for name, bound in limits.items() if broken(figures[name], bound)}
    assert not wrong, f"figures and their bounds: {wrong}"
