"""Properties that every element in the list must have; a new element is tested by being there."""

import numpy as np
import pytest
import sympy as sp
from funicular.derive.elements import ELEMENTS
from funicular.derive.gram import Gram
from funicular.derive.spec import Element, l, x, y, z
from funicular.derive.verify_states import element_state, reference, rotation, section
from funicular.generated import kernels

CONTINUUM = [name for name in ELEMENTS if hasattr(kernels, f"{name}_stiffness")]


@pytest.fixture(params=ELEMENTS)
def element(request) -> Element:
    return ELEMENTS[request.param]


def kernel(element: Element, name: str):
    return getattr(kernels, f"{element.name}_{name}")


@pytest.fixture
def state(element) -> dict:
    """A deformed element with its constants."""
    random = np.random.default_rng(7)
    s = element_state(element, random)
    pairs = element.dim * (element.dim - 1) // 2
    D = np.concatenate([np.full(element.dim, 50.0), np.full(pairs, 10.0), np.full(pairs, 20.0)])
    s["A"] = kernel(element, "stiffness")(s["l"], s["section"], D)
    s["D"] = D
    return s


def positions(element: Element) -> np.ndarray:
    return np.array(element.is_position, dtype=float)


def test_nodality(element):
    conditions = element.nodal_conditions(element.shape_functions)
    assert sp.simplify(conditions - sp.eye(element.n_vectors)) == sp.zeros(element.n_vectors)


def test_partition_of_unity(element):
    total = sum(n for n, p in zip(element.shape_functions, element.is_position, strict=True) if p)
    assert sp.expand(total) == 1


def test_the_straight_reference_is_reproduced(element):
    """r(x, y, z) = (x, y, z), as far as the basis has these coordinates."""
    e = reference(element, 1.3)
    at = np.array([0.4, 0.1, -0.2])
    _, r = kernel(element, "position")(1.3, at, e)
    held = [c in element.basis for c in (x, y, z)][: element.dim]
    np.testing.assert_allclose(r, np.where(held, at[: element.dim], 0.0), atol=1e-15)


def test_shape_functions_of_the_kernel_are_those_of_the_spec(element):
    at = (0.37, 0.11, -0.06)
    N, _ = kernel(element, "position")(0.9, at, reference(element, 0.9))
    expected = [float(n.subs({x: at[0], y: at[1], z: at[2], l: 0.9})) for n in element.shape_functions]
    np.testing.assert_allclose(N, expected, rtol=1e-13, atol=1e-15)


def test_mass_totals(element):
    density, length, sides = 7850.0, 1.7, section(0.1, 0.2)
    m = kernel(element, "mass")(length, density, sides)
    p = positions(element)
    mass = density * 0.1 * 0.2 * length
    assert p @ m @ p == pytest.approx(mass, rel=1e-14)
    np.testing.assert_array_equal(m, m.T)
    assert np.linalg.eigvalsh(m).min() > 0
    # first and second moments about the start: sum over the reference, which the element reproduces
    e = reference(element, length)
    assert p @ m @ e[:, 0] == pytest.approx(mass * length / 2, rel=1e-13)
    assert e[:, 0] @ m @ e[:, 0] == pytest.approx(mass * length**2 / 3, rel=1e-13)
    if element.dim == 3 and y in element.basis:
        assert e[:, 1] @ m @ e[:, 1] == pytest.approx(density * sides[1] * length, rel=1e-13)


def test_gravity_total(element):
    g = np.arange(1.0, element.dim + 1)
    Q = kernel(element, "gravity")(1.7, 7850.0, section(0.1, 0.2), g)
    np.testing.assert_allclose(positions(element) @ Q, 7850.0 * 0.02 * 1.7 * g, rtol=1e-14)


@pytest.mark.parametrize("lengths", [0.0, 1e2, 1e4])
def test_rigid_motion_stores_no_energy_and_makes_no_force(element, state, lengths):
    random = np.random.default_rng(11)
    e = reference(element, state["l"]) @ rotation(random, element.dim).T
    e[element.is_position] += lengths * state["l"] * random.uniform(-1, 1, element.dim)
    stiff = np.abs(state["A"]).max()
    chord = 2.3e-16 * (1 + lengths)  # to this, coordinates hold a chord
    assert abs(kernel(element, "energy")(state["l"], e, state["A"])[0]) < 50 * stiff * chord**2
    assert np.abs(kernel(element, "elastic_force")(state["l"], e, state["A"])).max() < 20 * stiff / state["l"] * chord


@pytest.mark.parametrize("power", [7, 14])
def test_force_and_tangent_keep_every_digit_far_from_the_origin(element, state, power):
    """2^7 and 2^14 m away, on coordinates that the shift does not round."""
    near = np.round(state["e"] * 2**20) / 2**20
    far = near + np.outer(positions(element), np.full(element.dim, 2.0**power))
    for name in ("energy", "elastic_force", "elastic_tangent"):
        there, here = (kernel(element, name)(state["l"], e, state["A"]) for e in (far, near))
        np.testing.assert_array_equal(there, here, err_msg=name)


def test_forces_are_in_equilibrium(element, state):
    f = kernel(element, "elastic_force")(state["l"], state["e"], state["A"])
    p = positions(element)
    product = (state["e"] - np.outer(p, state["e"][0])).T @ f
    np.testing.assert_allclose(p @ f, 0, atol=1e-14 * np.abs(f).max())
    np.testing.assert_allclose(product, product.T, atol=1e-13 * np.abs(product).max())


def test_the_tangent_is_symmetric_and_turns_the_force(element, state):
    K = kernel(element, "elastic_tangent")(state["l"], state["e"], state["A"])
    np.testing.assert_array_equal(K, K.T)
    f = kernel(element, "elastic_force")(state["l"], state["e"], state["A"])
    spin = np.zeros((element.dim, element.dim))
    spin[0, 1], spin[1, 0] = -1.0, 1.0
    np.testing.assert_allclose(K @ (state["e"] @ spin.T).ravel(), (f @ spin.T).ravel(), atol=1e-12 * np.abs(K).max())


def test_energy_turns_with_no_frame(element, state):
    Q = rotation(np.random.default_rng(5), element.dim)
    args = state["l"], state["A"]
    U, turned = (kernel(element, "energy")(args[0], e, args[1])[0] for e in (state["e"], state["e"] @ Q.T))
    assert turned == pytest.approx(U, rel=1e-13)


@pytest.mark.parametrize("stretch", [1e-6, 0.3])
def test_homogeneous_stretch_stores_what_the_law_says(element, state, stretch):
    """F = diag(1 + stretch, 1, ...): U = 1/2 D11 E^2 A l with E = stretch + stretch^2/2, and nothing else."""
    if element.name not in CONTINUUM:
        pytest.skip("no continuum law")
    F = np.eye(element.dim)
    F[0, 0] += stretch
    U = kernel(element, "energy")(state["l"], reference(element, state["l"]) @ F.T, state["A"])[0]
    E = stretch + stretch**2 / 2
    assert U == pytest.approx(state["D"][0] * E**2 / 2 * state["section"][0] * state["l"], rel=1e-9)


def test_the_straight_element_has_its_rigid_motions_and_no_other(element, state):
    """At rest, straight: K is positive semidefinite, null on translations and rotations alone."""
    K = kernel(element, "elastic_tangent")(state["l"], reference(element, state["l"]), state["A"])
    values = np.linalg.eigvalsh(K)
    rigid = element.dim * (element.dim + 1) // 2
    assert np.abs(values[:rigid]).max() < 1e-12 * values[-1]
    assert values[rigid] > 1e-6 * values[-1]


def test_damping_takes_energy_out(element, state):
    args = state["l"], state["e"], state["v"], state["A"], state["tau"]
    P = kernel(element, "dissipation")(*args)[0]
    assert P > 0
    assert P == pytest.approx(np.sum(kernel(element, "damping_force")(*args) * state["v"]), rel=1e-13)


def test_nodal_conditions_that_do_not_fix_the_basis_are_refused():
    bad = Element("bad", 2, (1, x, x**2, x**3), ("r", "r_y"), "r_y", "", "")
    with pytest.raises(ValueError, match="bad: 4 nodal conditions do not fix 4 basis functions"):
        _ = bad.shape_functions


def test_beam24_mass_as_published():
    """CASES E1."""
    m = kernels.beam24_mass(1.0, 7850.0, section(0.1, 0.1))
    row = [29.1571428571429, 4.11190476190476, 0, 0, 10.0928571428571, -2.42976190476190, 0, 0]
    np.testing.assert_allclose(m[0], row, rtol=2e-14)
    published = {(1, 1): 0.747619047619048, (1, 5): -0.560714285714286, (2, 2): 0.0218055555555556,
                 (3, 3): 0.0218055555555556, (2, 6): 0.0109027777777778}
    for place, value in published.items():
        assert m[place] == pytest.approx(value, rel=5e-15)


def test_beam24_form_stays_sparse():
    """The constant form A in Legendre strain vectors: 114 entries of 28 x 28, 61 of them different."""
    gram = Gram(ELEMENTS["beam24"])
    assert len(gram.pairs) == 28
    assert len(gram.form) <= 114
    assert len(gram.constants) <= 61
