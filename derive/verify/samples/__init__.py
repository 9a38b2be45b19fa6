"""Sample inputs of the kernels: ordinary states with finite rotation and strain, the same on every machine.

The module called as the role of a family has `sample(family, exact, random)`, and `at_rest(family, exact, first)` where
rest is another case than the first sample. Sizes are stout and of order one, so that no term hides below the rounding
of another.
"""

from __future__ import annotations

from importlib import import_module

import numpy as np

from ...codegen.family import Family
from ..numbers import Numbers, State

SEEDS = (20050401, 20050705)  # days on which the paper was received and accepted


def states(family: Family, exact: Numbers) -> list[State]:
    """Return states of a family: values by argument name, with `rectangle` and the second rates that only paths use.

    Constants that one kernel makes for another (m, A) come from the 50-digit programs: a fault in the compiled one
    then shows up there and nowhere else.
    """
    of_role = import_module(f".{family.role}", __name__)
    found: list[State] = [of_role.sample(family, exact, np.random.default_rng(seed)) for seed in SEEDS]
    return [*found, of_role.at_rest(family, exact, found[0])] if hasattr(of_role, "at_rest") else found
