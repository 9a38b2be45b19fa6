"""Properties of every element in the list; a new element is tested through the list."""

import numpy as np
import pytest
import sympy as sp
from funicular.derive.algebra.gram import Gram
from funicular.derive.catalogue import families
from funicular.derive.elements import ELEMENTS
from funicular.derive.laws.continuum.continuum import Form
from funicular.derive.spec import ASSUMED_LAWS, CABLE_LAWS, MAX_SEGMENTS, Element, l, x, y, z
from funicular.derive.verify.samples.element import element_state, loads
from funicular.derive.verify.samples.shapes import reference, rotation, section
from funicular.generated import described, kernels
from funicular.kernels.elements import manifest, part_of_manifest
from funicular.model.constants import element_constants

LAWS = [(name, law) for name, element in ELEMENTS.items() for law in element.laws]
CABLES = [(name, law) for name, law in LAWS if law in CABLE_LAWS + ASSUMED_LAWS]
LEFT, TRANSITION = 0.2, 0.1
YOUNGS_MODULUS = 50.0


@pytest.fixture(params=ELEMENTS)
def element(request) -> Element:
    return ELEMENTS[request.param]


def kernel(*name: str):
    """Return a kernel by family and name: an element's, or a law's on an element."""
    return getattr(kernels, "_".join(name))


def cable_stiffness(law: str, EA: float, EI: float) -> np.ndarray:
    """Return S of a law of cables: upper modes of an assumed strain also have EA; a share of EA remains in compression;
    a table has one straight segment.
    """
    if law.endswith("_tabulated"):
        return np.array([EA, EI, 1, 0, 0, 0, EA, *[0] * (6 * MAX_SEGMENTS - 4)])
    more = [EA] if law.endswith("_assumed") else [LEFT, TRANSITION] if law.endswith("_tension_only") else []
    return np.array([EA, EI, *more])


def part_of_stiffness(law: str, strain: float) -> float:
    """Return the share of the axial energy EA strain^2/2 that a law has."""
    if not law.endswith("_tension_only"):
        return 1.0
    return LEFT + (1 - LEFT) / 2 * (1 + strain / (np.hypot(strain, TRANSITION) + TRANSITION))


def force_of_strain(law: str, strain: float) -> float:
    """Return the axial force of a law over EA."""
    if not law.endswith("_tension_only"):
        return strain
    smooth = np.hypot(strain, TRANSITION)
    return LEFT * strain + (1 - LEFT) / 4 * (2 * strain + smooth + strain**2 / smooth - TRANSITION)


def at_rest(name: str, law: str, l: float) -> tuple:
    """Return the straight reference, for laws with a reference."""
    return (reference(ELEMENTS[name], l),) if law == "structural" or law.endswith("_curved") else ()


class Elastic:
    """A law on an element, in a deformed state."""

    def __init__(self, name: str, law: str):
        self.element, self.law, self._family = ELEMENTS[name], law, f"{name}_{law}"
        self.state = element_state(self.element, np.random.default_rng(7))
        self.l, self.e, self.v = (self.state[key] for key in ("l", "e", "v"))
        self.section = self.state["section"]
        area, EI = YOUNGS_MODULUS * self.section[0], YOUNGS_MODULUS * self.section[1]
        self.energy_scale = max(area * self.l, EI / self.l)
        if law.startswith("continuum"):
            pairs = self.element.dim * (self.element.dim - 1) // 2
            D = np.concatenate([np.full(self.element.dim, YOUNGS_MODULUS), np.full(pairs, 10.0), np.full(pairs, 20.0)])
            S = np.outer(D, self.section)
            self.energy_scale = np.abs(kernel(name, "continuum", "stiffness")(self.l, S)).max()
        elif law == "structural":
            S = np.array([area, 0.4 * area, 0.3 * area, 0.6 * EI, 0.7 * EI, EI, 0.8 * area, 0.9 * area, 0.5 * area,
                          0.1 * np.sqrt(area * EI)])
            S = S if self.element.dim == 3 else S[[0, 1, 5, 6]]
        else:
            S = cable_stiffness(law, area, EI)
        self.A = element_constants(None, name, law, self.l, S, *at_rest(name, law, self.l))

    def __call__(self, name: str):
        return kernel(self._family, name)

    def at(self, name: str, e: np.ndarray) -> np.ndarray:
        """Return a kernel of the elastic energy."""
        return self(name)(self.l, e, self.A)

    def damping(self, name: str, e: np.ndarray, v: np.ndarray, tau: float) -> np.ndarray:
        """Return a kernel of the damping, of the law itself or shared, with its number of constants."""
        full = families()[self._family].kernel(name)
        size, = next(a["shape"] for a in described(manifest())[full]["inputs"] if a["name"] == "A")
        return kernel(full)(self.l, e, v, self.A[:size], tau)


@pytest.fixture(params=LAWS, ids="_".join)
def elastic(request) -> Elastic:
    return Elastic(*request.param)


def positions(element: Element) -> np.ndarray:
    return np.array(element.is_position, dtype=float)


def spins(dim: int) -> list[np.ndarray]:
    """Return infinitesimal rotations in every coordinate plane."""
    return [np.outer(np.eye(dim)[i], np.eye(dim)[j]) - np.outer(np.eye(dim)[j], np.eye(dim)[i])
            for i in range(dim) for j in range(i)]


def degree(element: Element) -> int:
    """Return the degree of the centreline."""
    return max(int(sp.degree(b, x)) for b in element.basis)


def test_nodality(element):
    conditions = element.nodal_conditions(element.shape_functions)
    assert sp.simplify(conditions - sp.eye(element.n_vectors)) == sp.zeros(element.n_vectors)


def test_partition_of_unity(element):
    total = sum(n for n, p in zip(element.shape_functions, element.is_position, strict=True) if p)
    assert sp.expand(total) == 1


def test_the_straight_reference_is_reproduced(element):
    """r(x, y, z) = (x, y, z), for the coordinates of the basis."""
    e = reference(element, 1.3)
    at = np.array([0.4, 0.1, -0.2])
    _, r = kernel(element.name, "position")(1.3, at, e)
    held = [c in element.basis for c in (x, y, z)][: element.dim]
    np.testing.assert_allclose(r, np.where(held, at[: element.dim], 0.0), atol=1e-15)


def test_shape_functions_of_the_kernel_are_those_of_the_spec(element):
    at = (0.37, 0.11, -0.06)
    N, _ = kernel(element.name, "position")(0.9, at, reference(element, 0.9))
    expected = [float(n.subs({x: at[0], y: at[1], z: at[2], l: 0.9})) for n in element.shape_functions]
    np.testing.assert_allclose(N, expected, rtol=1e-13, atol=1e-15)


def test_mass_totals(element):
    density, length, sides = 7850.0, 1.7, section(0.1, 0.2)
    m = kernel(element.name, "mass")(length, density, sides)
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
    Q = kernel(element.name, "gravity")(1.7, 7850.0, section(0.1, 0.2), g)
    np.testing.assert_allclose(positions(element) @ Q, 7850.0 * 0.02 * 1.7 * g, rtol=1e-14)


def test_the_centreline_is_where_y_and_z_are_zero(element):
    at = 0.37
    N, N_x = kernel(element.name, "on_axis")(0.9, at)
    whole, _ = kernel(element.name, "position")(0.9, (at, 0, 0), reference(element, 0.9))
    np.testing.assert_allclose(N, whole, rtol=0, atol=2e-16)
    slopes = [float(sp.diff(n, x).subs({x: at, y: 0, z: 0, l: 0.9})) for n in element.shape_functions]
    np.testing.assert_allclose(N_x, slopes, rtol=1e-14, atol=1e-15)


def test_a_follower_force_has_its_components_in_the_frame_of_the_section(element):
    """A straight element that is rotated: c along the rotated axes."""
    e = reference(element, 1.3)
    c = loads(element, np.random.default_rng(2))["c"]
    Q = rotation(np.random.default_rng(3), element.dim)
    f, _ = kernel(element.name, "follower_force")(1.3, 0.4, e @ Q.T, c)
    np.testing.assert_allclose(positions(element) @ f, Q[:, : len(c)] @ c, rtol=1e-14)


def test_a_moment_works_on_the_rotation_of_the_section(element):
    """f . v = M . omega where the element rotates as a whole, except a cable about its own axis."""
    state = element_state(element, np.random.default_rng(7))
    l, at, e = (state[name] for name in ("l", "x", "e"))
    M = loads(element, np.random.default_rng(2))["M"]
    f, _ = kernel(element.name, "moment")(l, at, e, M)
    tangent = kernel(element.name, "on_axis")(l, at)[1] @ e
    for spin in spins(element.dim):
        omega = spin[1, :1] if element.dim == 2 else np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
        if element.dim == 3 and not element.director:
            omega = omega - tangent * (tangent @ omega) / (tangent @ tangent)
        assert np.sum(f * (e @ spin.T)) == pytest.approx(M @ omega, rel=1e-13)


@pytest.mark.parametrize("name", ["beam24", "beam12p"])
def test_a_moment_turns_a_section_and_does_not_strain_it(name):
    """At rest the moment makes opposite forces on opposite faces and does not widen the section or lengthen the axis.
    """
    element = ELEMENTS[name]
    e = reference(element, 1.0)
    f, _ = kernel(name, "moment")(1.0, 0.0, e, [3.0] if element.dim == 2 else [1.0, 2.0, 3.0])
    by_slope = dict(zip(element.names, f, strict=True))
    expected = {"beam12p": {"r_y1": [-3, 0]}, "beam24": {"r_y1": [-3, 0, 0.5], "r_z1": [2, -0.5, 0]}}[name]
    for slope, force in by_slope.items():
        np.testing.assert_allclose(force, expected.get(slope, 0.0), atol=1e-15, err_msg=slope)


@pytest.mark.parametrize("lengths", [0.0, 1e2, 1e4])
def test_rigid_motion_stores_no_energy_and_makes_no_force(elastic, lengths):
    random, element = np.random.default_rng(11), elastic.element
    e = reference(element, elastic.l) @ rotation(random, element.dim).T
    e[element.is_position] += lengths * elastic.l * random.uniform(-1, 1, element.dim)
    chord = 2.3e-16 * (1 + lengths)  # to this, coordinates hold a chord
    assert abs(elastic.at("energy", e)[0]) < 50 * elastic.energy_scale * chord**2
    assert np.abs(elastic.at("elastic_force", e)).max() < 20 * elastic.energy_scale / elastic.l * chord


@pytest.mark.parametrize("power", [7, 14])
def test_force_and_tangent_keep_every_digit_far_from_the_origin(elastic, power):
    """Translations by 2^7 and 2^14 m do not round the coordinates."""
    near = np.round(elastic.e * 2**20) / 2**20
    far = near + np.outer(positions(elastic.element), np.full(elastic.element.dim, 2.0**power))
    for name in ("energy", "elastic_force", "elastic_tangent"):
        np.testing.assert_array_equal(elastic.at(name, far), elastic.at(name, near), err_msg=name)


def test_forces_are_in_equilibrium(elastic):
    f, e, p = elastic.at("elastic_force", elastic.e), elastic.e, positions(elastic.element)
    product = (e - np.outer(p, e[0])).T @ f
    np.testing.assert_allclose(p @ f, 0, atol=1e-14 * np.abs(f).max())
    np.testing.assert_allclose(product, product.T, atol=1e-13 * np.abs(product).max())


def test_the_tangent_is_symmetric_and_turns_the_force(elastic):
    K, f = (elastic.at(name, elastic.e) for name in ("elastic_tangent", "elastic_force"))
    np.testing.assert_array_equal(K, K.T)
    for spin in spins(elastic.element.dim):
        np.testing.assert_allclose(K @ (elastic.e @ spin.T).ravel(), (f @ spin.T).ravel(),
                                   atol=1e-12 * np.abs(K).max())


def test_energy_turns_with_no_frame(elastic):
    Q = rotation(np.random.default_rng(5), elastic.element.dim)
    assert elastic.at("energy", elastic.e @ Q.T)[0] == pytest.approx(elastic.at("energy", elastic.e)[0], rel=1e-13)


@pytest.mark.parametrize("stretch", [-0.2, 1e-6, 0.3])
def test_homogeneous_stretch_stores_what_the_law_says(elastic, stretch):
    """F = diag(1 + stretch, 1, ...): U = 1/2 E A strain^2 l (D11 is E here), by the strain of the law."""
    F = np.eye(elastic.element.dim)
    F[0, 0] += stretch
    U = elastic.at("energy", reference(elastic.element, elastic.l) @ F.T)[0]
    strain = stretch if elastic.law.startswith(("engineering", "structural")) else stretch + stretch**2 / 2
    energy = YOUNGS_MODULUS * strain**2 / 2 * elastic.section[0] * elastic.l
    assert U == pytest.approx(part_of_stiffness(elastic.law, strain) * energy, rel=1e-9)


def test_the_straight_element_has_its_rigid_motions_and_no_other(elastic):
    """At rest, straight: K is positive semidefinite, with the rigid motions as its null space.

    A straight cable has no torsion, so that rotation about its axis moves no coordinate: five rigid motions in space. A
    beam has six, and both have three in the plane.
    """
    element = elastic.element
    e = reference(element, elastic.l)
    moves = [np.outer(positions(element), axis) for axis in np.eye(element.dim)]
    moves += [e @ spin.T for spin in spins(element.dim)]
    rigid = np.linalg.matrix_rank(np.reshape(moves, (len(moves), -1)))
    assert rigid == {2: 3, 3: 6 if element.director else 5}[element.dim]
    values = np.linalg.eigvalsh(elastic.at("elastic_tangent", e))
    assert np.abs(values[:rigid]).max() < 1e-12 * values[-1]
    assert values[rigid] > 1e-6 * values[-1]


def test_damping_takes_energy_out(elastic):
    args = elastic.e, elastic.v, elastic.state["tau"]
    P = elastic.damping("dissipation", *args)[0]
    assert P > 0
    assert P == pytest.approx(np.sum(elastic.damping("damping_force", *args) * elastic.v), rel=1e-13)


def test_a_straight_element_in_rigid_motion_is_not_damped(elastic):
    e = reference(elastic.element, elastic.l) @ rotation(np.random.default_rng(5), elastic.element.dim).T
    scale = elastic.energy_scale / elastic.l
    for spin in spins(elastic.element.dim):
        f = elastic.damping("damping_force", e, e @ spin.T, 1.0)
        assert np.abs(f).max() < 1e-14 * scale


def arc(element: Element, length: float, radius: float = 1.0) -> np.ndarray:
    """Return the nodal vectors of a circular arc with its exact length."""
    turn = [float(ratio) * length / radius for ratio in element.node_ratios]
    rows = {"r": lambda t: (radius * np.sin(t), radius * (1 - np.cos(t)), 0.0),
            "r_x": lambda t: (np.cos(t), np.sin(t), 0.0),
            "r_xx": lambda t: (-np.sin(t) / radius, np.cos(t) / radius, 0.0)}
    return np.array([rows[v](t)[: element.dim] for t in turn for v in element.nodal_vectors])


def bending(name: str, law: str, length: float) -> float:
    """Return the bending energy of the arc of radius 1 with EI = 1."""
    return kernel(name, law, "energy")(length, arc(ELEMENTS[name], length), cable_stiffness(law, 0.0, 1.0))[0]


@pytest.mark.parametrize(("name", "law"), CABLES)
def test_an_arc_holds_the_bending_energy_of_its_circle(name, law):
    """The energy is 1/2 EI/R^2 l; the error is the first variation by the interpolation error, of order degree + 1."""
    order = degree(ELEMENTS[name]) + 1
    errors = [abs(bending(name, law, length) / (length / 2) - 1) for length in (1.0, 0.5)]
    assert errors[0] < 0.01
    assert np.log2(errors[0] / errors[1]) > order - 0.5


@pytest.mark.parametrize(("name", "law"), [c for c in CABLES if "linear" in c[1]])
def test_linear_curvature_is_the_exact_one_where_the_cable_keeps_its_length(name, law):
    """|r'| - 1 on the interpolant of an arc is of third order in l/R and changes sign: energies differ in fourth order.
    """
    exact = law.replace("linear", "exact")
    apart = [abs(bending(name, law, length) / bending(name, exact, length) - 1) for length in (1.0, 0.5)]
    assert apart[0] < 0.01
    assert np.log2(apart[0] / apart[1]) > 3.5


def test_nodal_conditions_that_do_not_fix_the_basis_are_refused():
    bad = Element("bad", 2, (1, x, x**2, x**3), ("r", "r_y"), "r_y", (), "", "")
    with pytest.raises(ValueError, match="bad: 4 nodal conditions do not fix 4 basis functions"):
        _ = bad.shape_functions


def test_beam24_mass_as_published():
    """Case E1 of tests/benchmarks/published."""
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
    form = Form(gram)
    assert len(gram.pairs) == 28
    assert len(form.form) <= 114
    assert len(form.constants) <= 61


def test_a_part_of_the_manifest_is_read_without_the_others():
    assert all(part_of_manifest(name) == part for name, part in manifest().items())
    with pytest.raises(ValueError):
        part_of_manifest("operations")  # of a kernel, within a part
