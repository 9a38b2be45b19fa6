"""The hard cases of tests/benchmarks/hard_cases: every figure within its bound; -rP shows all of them.

The default run takes one quick integrator of each case, in turn.
"""

import pytest
from hard_cases import CASES, broken


def pairs():
    """Yield each case with each of its integrators, all but one marked slow."""
    for number, case in enumerate(CASES):
        quick = [integrator for integrator in case.integrators if integrator not in case.slow]
        chosen = quick[number % len(quick)] if quick else None
        for integrator in case.integrators:
            yield pytest.param(case, integrator, id=f"{case.name}, {integrator}",
                               marks=[pytest.mark.slow] * (integrator != chosen))


@pytest.mark.parametrize(("case", "integrator"), list(pairs()))
def test_figures_stay_within_their_bounds(case, integrator):
    figures, limits = case.measure(integrator), case.limits(integrator)
    print(", ".join(f"{name} {value:.4g}" for name, value in figures.items()))
    wrong = {name: (figures[name], bound) for name, bound in limits.items() if broken(figures[name], bound)}
    assert not wrong, f"figures and their bounds: {wrong}"
