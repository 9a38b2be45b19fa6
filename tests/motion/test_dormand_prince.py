"""The coefficients of the explicit method fulfil their order conditions, one for each rooted tree."""

from functools import cache
from itertools import combinations_with_replacement

import numpy as np
import pytest
from funicular.integrators import dormand_prince as method
from scipy.integrate import DOP853

Tree = tuple  # of the subtrees at its root
WHOLE = np.vstack([np.pad(method.A, ((0, 0), (0, 1))), np.append(method.B, 0.0)])  # with the next step's first stage


@cache
def size(tree: Tree) -> int:
    return 1 + sum(size(branch) for branch in tree)


@cache
def density(tree: Tree) -> int:
    return size(tree) * int(np.prod([density(branch) for branch in tree]))


@cache
def trees(order: int) -> tuple[Tree, ...]:
    """Return the rooted trees with this number of nodes."""
    def forests(nodes: int, largest: int) -> list[Tree]:
        if nodes == 0:
            return [()]
        found = []
        for top in range(min(nodes, largest), 0, -1):
            for count in range(1, nodes // top + 1):
                found += [chosen + rest for chosen in combinations_with_replacement(trees(top), count)
                          for rest in forests(nodes - count * top, top - 1)]
        return found

    return tuple(forests(order - 1, order - 1))


@cache
def stages(tree: Tree) -> np.ndarray:
    """Return the elementary weights of the stages, (13,)."""
    return np.prod([WHOLE @ stages(branch) for branch in tree], axis=0) if tree else np.ones(len(WHOLE))


def residual(weights: np.ndarray, order: int) -> float:
    """Return the largest residual of the conditions of one order."""
    return max(abs(weights @ stages(tree) - 1 / density(tree)) for tree in trees(order))


def test_numbers_of_trees():
    assert [len(trees(order)) for order in range(1, 9)] == [1, 1, 2, 4, 9, 20, 48, 115]


@pytest.mark.parametrize(("less", "order"), [(np.zeros(13), 8), (method.ERROR, 5), (method.COARSE_ERROR, 3)])
def test_order_conditions(less, order):
    """The method is of order 8, the embedded ones of orders 5 and 3, and of no higher one."""
    weights = np.append(method.B, 0.0) - less
    assert max(residual(weights, k) for k in range(1, order + 1)) < 4e-15
    if order < 8:
        assert residual(weights, order + 1) > 1e-4


def test_nodes_are_sums_of_rows():
    assert method.A.sum(axis=1) == pytest.approx(method.C, abs=2e-14)


def test_scipy_has_the_same_bits():
    for ours, theirs in ((method.A, DOP853.A), (method.B, DOP853.B), (method.C, DOP853.C), (method.ERROR, DOP853.E5),
                         (method.COARSE_ERROR, DOP853.E3)):
        assert np.array_equal(ours, theirs)
    assert (method.STAGES, method.ERROR_ORDER) == (DOP853.n_stages, DOP853.error_estimator_order)
