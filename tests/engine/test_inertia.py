"""The inertia of constrained stiffnesses against dense eigenvalues: random, banded, repeated, singular, redundant."""

import numpy as np
import pytest
from funicular.solve.linear.inertia import Inertia, inertia
from scipy.linalg import eigvalsh, null_space
from scipy.sparse import csc_array, random_array


def banded(n, negatives, rng, width=6):
    """Return a banded symmetric matrix, shifted to have the given number of negative eigenvalues."""
    A = rng.standard_normal((n, n))
    A = np.triu(np.tril(A + A.T, width), -width)
    values = np.linalg.eigvalsh(A)
    return A - np.eye(n) * (values[negatives] + values[negatives - 1]) / 2


def constraints(n, m, rng):
    return random_array((m, n), density=6 / n, rng=rng).toarray()


@pytest.mark.parametrize("n", [30, 210])  # dense and sparse
@pytest.mark.parametrize("m", [0, 1, 9])
@pytest.mark.slow_cases("1-210", "9-210", "0-210")
def test_counts_what_dense_eigenvalues_say(n, m):
    rng = np.random.default_rng(n + m)
    for negatives in (1, 2, n // 3, n - 1):
        K, C = banded(n, negatives, rng), constraints(n, m, rng)
        free = null_space(C) if m else np.eye(n)
        expected = int(np.count_nonzero(eigvalsh(free.T @ K @ free) < 0))
        found = inertia(csc_array(K), csc_array(C))
        assert found == Inertia(expected, 0, free.shape[1] - expected)


@pytest.mark.parametrize("n", [40, 210])
def test_redundant_constraints_count_once(n):
    rng = np.random.default_rng(1)
    K, C = banded(n, 5, rng), constraints(n, 6, rng)
    twice = np.vstack([C, C[0] + C[1], 2 * C[2], np.zeros(n)])
    assert inertia(K, twice) == inertia(K, C)
    assert sum(inertia(K, C)) == n - np.linalg.matrix_rank(C)


@pytest.mark.parametrize("n", [60, 600])
def test_a_chain_that_is_free_has_zero_directions(n):
    """Three free chains of springs of 1 N/m, of 1e8 N/m, and under compression, and two free unknowns."""
    chain = 2 * np.eye(n // 3) - np.eye(n // 3, k=1) - np.eye(n // 3, k=-1)
    chain[0, 0] = chain[-1, -1] = 1
    K = np.zeros((n + 2, n + 2))
    for k, stiffness in enumerate((1.0, 1e4, -1e2)):
        part = slice(k * (n // 3), (k + 1) * (n // 3))
        K[part, part] = stiffness * chain
    assert inertia(csc_array(K)) == Inertia(n // 3 - 1, 5, 2 * (n // 3 - 1))


@pytest.mark.parametrize("n", [30, 350])
def test_no_negative_eigenvalue_and_the_first_one(n):
    """Counts just beside zero, and at zero within rounding. A positive definite K is factored once."""
    rng = np.random.default_rng(n)
    K, C = banded(n, 1, rng), constraints(n, 3, rng)
    least = eigvalsh(K)[0] * np.eye(n)
    for off, expected in ((1e-6, (0, 0, n)), (1e-15, (0, 1, n - 1)), (-1e-6, (1, 0, n - 1))):
        assert inertia(csc_array(K - least + off * np.eye(n))) == Inertia(*expected)
    assert inertia(csc_array(K - least + 1e-6 * np.eye(n)), np.vstack([C, C[:1]])) == Inertia(0, 0, n - 3)


def test_rounding_in_a_free_direction_is_no_stiffness():
    K = np.diag([1e9, 1e9, -1e-11])
    assert inertia(K) == Inertia(0, 1, 2)
    assert inertia(np.diag([1e9, 1e9, -1e-2])) == Inertia(1, 0, 2)


def test_saddle_points_without_diagonal():
    """A zero diagonal needs exchanges: the count uses the two-by-two blocks of LAPACK."""
    n = 500
    K = np.zeros((n, n))
    for k in range(0, n, 2):
        K[k, k + 1] = K[k + 1, k] = 1.0
    assert inertia(K) == Inertia(n // 2, 0, n // 2)


def test_refused():
    with pytest.raises(ValueError, match="not symmetric"):
        inertia(np.array([[1.0, 1.0], [0.0, 1.0]]))
    with pytest.raises(ValueError, match="not finite"):
        inertia(np.array([[np.nan]]))


def mechanism():
    """Return a rope with a tied rider, a trolley, a door on two hinges (redundant), a spring, and a compressed strut.
    """
    from funicular import Scene
    from shared_scenes import SQUARE, TABLE_1

    scene = Scene()
    rope = {"section": SQUARE, "material": TABLE_1, "element": "cable12"}
    scene.cable("rope", start=(0, 0, 0), end=(3, 0, 0), elements=30, **rope)
    scene.cable("strut", start=(0, 1, 0), end=(0, 1.5, 0), up=(1, 0, 0), elements=8, rest_length=0.7, **rope)
    for name, s in (("rope", 0), ("rope", 3), ("strut", 0), ("strut", 0.7)):
        scene.pin(name, s=s)
    for name, x, y in (("A", 1, 0), ("B", 2, 0), ("door", 4, 0.5)):
        scene.rigid_body(name, mass=1, inertia=(0.01, 0.02, 0.02), position=(x, y, 0))
    scene.slide("A", along="rope", s=1.0, frame="tangent", roll="fixed", up=(0, 1, 0), name="tied")
    scene.slide("B", along="rope", s=2.0, name="trolley")
    for y in (-0.5, 0.5):
        scene.joint("revolute", (4, 0.5 + y, 0), ("door", (0, y, 0)), axis=(0, 1, 0))
    scene.spring("door", (4, 0.5, 1), stiffness=10.0, length=0.5)
    return scene


def test_scenes_with_slides_joints_springs_and_redundant_constraints(monkeypatch):
    """The sparse count against all eigenvalues of the same stiffness."""
    from funicular.parts.settings import EquilibriumSettings
    from funicular.solve.linear import inertia as module
    from funicular.solve.statics.static_problem import StaticProblem

    problem = StaticProblem(mechanism(), EquilibriumSettings())
    change = np.random.default_rng(2).standard_normal(len(problem.weight)) * np.where(problem.weight == 1, 1e-3, 0)
    problem.move(change)
    K, C, units = problem.stiffness()
    assert K.shape[0] > module.MAX_DENSE_UNKNOWNS
    counted = inertia((K + K.T) / 2, C, units)
    monkeypatch.setattr(module, "MAX_DENSE_UNKNOWNS", 10**6)
    assert counted == inertia((K + K.T) / 2, C, units)
    assert counted.negative > 0
    assert sum(counted) == K.shape[0] - np.linalg.matrix_rank(C.toarray())
