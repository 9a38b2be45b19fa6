"""Axial strain of cable elements: full, assumed, reduced (derive/laws/cable/assumed.py)."""

import numpy as np
import pytest
import taut_rope
from funicular import Circle, FunicularWarning, Material, Ramp, Scene, SceneError
from funicular.derive.verify.samples.shapes import reference, rotation
from funicular.generated import kernels
from funicular.kernels.elements import built_in
from funicular.parts.section_stiffness import STABILISATION, section_stiffness
from funicular.scene.file import loads
from shared_scenes import cable_scene
from test_elements import ELEMENTS

ELASTIC = Material(youngs_modulus=1e8, poisson_ratio=0.3, density=1000)
EA, EI = 1.0, 1e-4
LAWS = [(element, f"{strain}_{curvature}") for element in ("cable8p", "cable12") for strain in ("green", "engineering")
        for curvature in ("exact", "linear")]


def cable(membrane=None, element="cable12", **given) -> Scene:
    return cable_scene("rope", element=element, elements=4, section=Circle(radius=0.01), material=ELASTIC,
                       membrane=membrane, **given)


def at_rest(element: str, l: float = 1.0) -> np.ndarray:
    return reference(ELEMENTS[element], l)


def bent(element: str) -> np.ndarray:
    """Return an element whose slope turns by about 30 degrees, with a stretch that varies along it."""
    e = at_rest(element)
    dim = e.shape[1]
    e[1] = 1.02 * rotation(np.random.default_rng(1), dim, angle=0.3)[:, 0]
    e[3] = 0.97 * rotation(np.random.default_rng(2), dim, angle=0.2)[:, 0]
    return e


# --- what the user says ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("given", "law", "kernels_"), [
    ({}, "green_exact", "green_exact"),
    ({"membrane": "full"}, "green_exact", "green_exact"),
    ({"membrane": "assumed"}, "green_exact_assumed", "green_exact_assumed"),
    ({"membrane": "reduced", "strain": "engineering"}, "engineering_exact_reduced", "engineering_exact_assumed"),
    ({"membrane": "assumed", "curvature": "linear"}, "green_linear_assumed", "green_linear_assumed"),
    ({"membrane": "reduced", "element": "cable18"}, "green_exact_reduced", "green_exact_assumed"),
    ({"law": "green_linear_reduced"}, "green_linear_reduced", "green_linear_assumed"),
])
def test_a_membrane_chooses_a_law(given, law, kernels_):
    made = cable(**given).cables["rope"]
    assert (made.law, made.kernel_law) == (law, kernels_)


@pytest.mark.parametrize("membrane", ["assumed", "reduced"])
def test_a_membrane_survives_the_scene_file(membrane):
    scene = cable(membrane, strain="engineering")
    copy = loads(scene.to_toml(), "copy")
    assert copy.cables["rope"] == scene.cables["rope"]
    assert copy.to_toml() == scene.to_toml()


@pytest.mark.parametrize(("given", "message"), [
    ({"membrane": "half"}, 'membrane "half" is not known'),
    ({"membrane": "assumed", "element": "beam24"}, "membrane are for cable elements, beam24 is a beam"),
    ({"membrane": "assumed", "element": "cable18", "curvature": "linear"},
     'law "green_linear_assumed" is not possible for cable18'),
    ({"membrane": "assumed", "law": "green_exact"}, 'law "green_exact" disagrees with strain, curvature and membrane'),
    ({"membrane": "reduced", "points": [(0, 0, 0), (0.5, 0.1, 0), (1, 0, 0)]},
     'cable12 with law "green_exact_reduced" is stress-free only where it is straight, but it is drawn curved'),
])
def test_what_a_membrane_cannot_be(given, message):
    with pytest.raises(SceneError) as refused:
        cable(**given)
    assert message in str(refused.value)


def test_a_bent_cable_that_is_stress_free_straight_has_any_membrane():
    for membrane in ("assumed", "reduced"):
        points = [(0, 0, 0), (0.5, 0.1, 0), (1, 0, 0)]
        assert cable(membrane, points=points, rest="straight").cables["rope"].law.endswith(membrane)


def test_upper_modes_have_their_stiffness():
    full, assumed, reduced = (section_stiffness(f"green_exact{kind}", Circle(radius=0.01), ELASTIC)
                              for kind in ("", "_assumed", "_reduced"))
    np.testing.assert_array_equal(assumed, [*full, full[0]])
    np.testing.assert_array_equal(reduced, [*full, STABILISATION * full[0]])


# --- the energy ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("element", "law"), LAWS)
def test_leaving_modes_out_leaves_energy_out(element, law):
    """The strain is projected: the energy is at most the full one, and less where the slope turns."""
    e = bent(element)
    full = getattr(kernels, f"{element}_{law}_energy")(1.0, e, [EA, 0.0])[0]
    assumed, reduced = (getattr(kernels, f"{element}_{law}_assumed_energy")(1.0, e, [EA, 0.0, upper])[0]
                        for upper in (EA, STABILISATION * EA))
    assert 0 < reduced < assumed < full


@pytest.mark.parametrize(("element", "law"), LAWS)
def test_a_straight_cable_with_engineering_strain_has_the_full_energy_and_with_green_strain_to_fourth_order(element,
                                                                                                            law):
    """|r'| - 1 of a straight element has degree 2, the number of modes; the Green strain has degree 4."""
    left = []
    for size in (0.2, 0.1):
        e = at_rest(element)
        e[1, 0], e[3, 0] = 1 + size, 1 - size / 2
        full = getattr(kernels, f"{element}_{law}_energy")(1.0, e, [EA, 0.0])[0]
        assumed = getattr(kernels, f"{element}_{law}_assumed_energy")(1.0, e, [EA, 0.0, EA])[0]
        left.append(abs(full - assumed) / full)
    if law.startswith("engineering"):
        assert max(left) < 1e-14
    else:
        assert np.log2(left[0] / left[1]) == pytest.approx(2, abs=0.3)  # of the energy, itself of second order


@pytest.mark.parametrize(("upper", "zeros"), [(EA, 3), (STABILISATION * EA, 3), (0.0, 4)])
@pytest.mark.parametrize("law", ["green_exact", "engineering_exact"])
def test_without_stiffness_of_the_upper_mode_slopes_change_their_length_freely(law, upper, zeros):
    """A straight planar element has three rigid motions. With the mean and linear modes alone there is a fourth motion
    without energy: slopes of 1 + a at both ends, fixed nodes, strain a P_2.
    """
    e = at_rest("cable8p")
    K = getattr(kernels, f"cable8p_{law}_assumed_elastic_tangent")(1.0, e, [EA, EI, upper])
    assert np.sum(np.linalg.eigvalsh(K) < 1e-10) == zeros
    slopes = np.array([[0, 0], [1, 0], [0, 0], [1, 0]]).ravel()
    assert slopes @ K @ slopes == pytest.approx(upper / 5, abs=1e-14)


@pytest.mark.parametrize(("strain", "stable"), [(-0.5 * STABILISATION, True), (-2 * STABILISATION, False)])
def test_compression_beyond_the_stabilisation_makes_the_slopes_unstable(strain, stable):
    """Green strain: a P_2 has a^2/10 of mean strain, so the mode's stiffness is (EA_upper + N)/5."""
    e = at_rest("cable8p")
    e[2, 0] = np.sqrt(1 + 2 * strain)
    e[1, 0] = e[3, 0] = e[2, 0]
    K = kernels.cable8p_green_exact_assumed_elastic_tangent(1.0, e, [EA, EI, STABILISATION * EA])
    along = K[::2, ::2]
    assert (np.linalg.eigvalsh(along).min() > -1e-12) == stable


def test_a_run_that_compresses_a_reduced_cable_too_much_says_so():
    def run(membrane, by):
        scene = cable(membrane, curvature="linear")
        scene.clamp("rope", s=0)
        scene.motion("rope", s=1.0, displacement=(Ramp(start=0, end=0.05, after=-by), 0, 0))
        return scene.run(0.05, tol=1e-3, progress=False)

    with pytest.warns(FunicularWarning, match='cable "rope" was compressed by 0.0.* of its length at t = .* s: '
                                              'membrane="reduced" keeps'):
        noted = run("reduced", 0.03)
    assert any("compressed" in message for message in noted.report["messages"])
    for quiet in (run("reduced", 0.002), run("assumed", 0.03)):
        assert not any("compressed" in message for message in quiet.report["messages"])


# --- beside a rider --------------------------------------------------------------------------------------------------


def test_catenaries_that_meet_under_a_load_are_in_equilibrium():
    """The nodes of a fine mesh of elements without locking lie on the reference."""
    found = taut_rope.at_rest(192, "reduced", 0.0)
    assert found["position"] < 2e-3
    assert found["force"] < 2e-4


@pytest.mark.parametrize(("membrane", "least", "most"), [("full", 0.07, 0.09), ("assumed", 0.05, 0.07),
                                                         ("reduced", 0.0, 0.01)])
@pytest.mark.parametrize("elements", [12, 24, 48])
def test_tension_beside_a_rider_at_rest(elements, membrane, least, most):
    """At 0.3 of an element the errors are 8 %, 6 % and 0.9 %, on any mesh."""
    assert least < taut_rope.at_rest(elements, membrane, 0.3)["tension"] < most


@pytest.mark.parametrize(("membrane", "least", "most"), [("full", 0.08, 0.09), ("reduced", 0.0, 0.005)])
def test_tension_beside_a_rider_at_rest_on_a_quintic_cable(membrane, least, most):
    """The errors are 8 % and 0.4 %."""
    assert least < taut_rope.at_rest(24, membrane, 0.3, element="cable18")["tension"] < most


def test_a_quintic_cable_whose_upper_modes_have_the_axial_stiffness_has_the_full_energy():
    """Five quadrature points, five modes."""
    e = at_rest("cable18")
    e[1:3] += 0.1 * np.random.default_rng(3).normal(size=(2, 3))
    for strain in ("green", "engineering"):
        full, assumed = (getattr(kernels, f"cable18_{strain}_exact{kind}_energy")(1.0, e, A)[0]
                         for kind, A in (("", [EA, EI]), ("_assumed", [EA, EI, EA])))
        assert assumed == pytest.approx(full, rel=1e-14)


def test_positions_under_a_rider_are_of_the_first_order_with_any_membrane():
    """A cubic cannot represent the kink."""
    for membrane, rider in (("full", 1.21e-2), ("assumed", 1.16e-2), ("reduced", 1.10e-2)):
        coarse, fine = (taut_rope.at_rest(n, membrane, 0.3)["rider"] for n in (24, 48))
        assert coarse == pytest.approx(rider, rel=0.01)
        assert np.log2(coarse / fine) == pytest.approx(1, abs=0.05)


def test_tension_beside_a_rider_in_motion():
    """The zip line with 24 elements, t = 8 to 10 s: the range of the tension about the rider is 0.111, 0.080, 0.016."""
    for membrane, bound in (("full", (0.10, 0.12)), ("assumed", (0.07, 0.09)), ("reduced", (0, 0.02))):
        found = taut_rope.in_motion(24, membrane)
        assert bound[0] < found["mean range"] < bound[1]


def test_reduced_strain_of_a_cable_is_offered_where_its_assumed_one_is():
    for name, kind in built_in().items():
        assumed = [law for law in kind.laws if law.endswith("_assumed")]
        assert len(assumed) == {"cable8p": 4, "cable12": 4, "cable18": 2}.get(name, 0)
