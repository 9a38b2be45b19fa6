"""Natural frequencies and shapes: strings, beams, free bodies, riders; about equilibria; large scenes."""

import numpy as np
import pytest
from funicular import FunicularWarning, GeneralSection, Material, Rectangle, Scene, SceneError
from shared_scenes import SQUARE, TABLE_1, add_cable, cable_scene

THIN = GeneralSection(area=1e-4, second_moment_about_z=1e-14, second_moment_about_y=1e-14)
WIRE = Material(youngs_modulus=1e9, poisson_ratio=0, density=1e4)


def string(elements, strain=1e-3, element="cable12") -> Scene:
    """Return a string of 1 m between its ends, 1 kg/m, without weight, with negligible bending stiffness."""
    return cable_scene(pins="ends", gravity=(0, 0, 0), elements=elements, element=element, strain="engineering",
                       rest_length=1 / (1 + strain), section=THIN, material=WIRE)


@pytest.mark.parametrize(("element", "of_each"), [("cable12", 2), ("cable8p", 1)])
def test_a_taut_string(element, of_each, validated):
    """n pi sqrt(T / m) in both transverse directions, with the mass per stretched length."""
    found = string(16, element=element).modes(4 * of_each).angular_frequency
    tension, mass = 1e5 * 1e-3, 1.0 / (1 + 1e-3)
    expected = np.repeat(np.arange(1, 5), of_each) * np.pi * np.sqrt(tension / mass)
    validated("Modes", "taut string", "angular frequencies 1 to 4", expected, found, unit="rad/s", bound=1e-4,
              source="closed form", variant=element, mesh="16 elements")


def test_sparse_and_dense_solvers_agree(monkeypatch):
    from funicular.solve.linear import spectrum
    from funicular.solve.modes import modes as modal

    dense = string(12).modes(6).angular_frequency
    monkeypatch.setattr(modal, "MAX_DENSE_UNKNOWNS", 0)
    monkeypatch.setattr(spectrum, "MAX_DENSE_DEGREES", 0)
    np.testing.assert_allclose(string(12).modes(6).angular_frequency, dense, rtol=1e-8)


def test_shapes_are_sines_of_one_metre():
    modes = string(16, element="cable8p").modes(3)
    s = np.linspace(0, 1, 17)
    for k in range(3):
        shape = modes["wire.displacement"][k, :, 1]
        expected = np.sin((k + 1) * np.pi * s)
        np.testing.assert_allclose(shape * np.sign(shape[1]), expected / np.abs(expected).max(), atol=1e-3)


@pytest.mark.parametrize(("element", "law", "rigid"), [
    ("beam24", "continuum", 6), ("beam24", "structural", 6), ("beam12p", "continuum", 3), ("cable12", "", 6),
    ("cable8p", "", 3)])
def test_what_is_free_moves_without_frequency(element, law, rigid):
    """The number of zero frequencies equals that of rigid motions, one less for a cable in space, whose rotation about
    its axis moves nothing.
    """
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("wire", start=(0, 0, 0), end=(1.2, 0.5, 0), elements=3, element=element, section=SQUARE,
                material=TABLE_1, **({"law": law} if law else {}))
    found = scene.modes(8).angular_frequency
    zeros = rigid - (element == "cable12")
    assert np.all(found[:zeros] == 0)
    assert np.all(found[zeros:] > 1)


def test_a_rider_adds_its_mass_across_and_is_free_along():
    """A point mass M in the middle of a light taut string: w² = 4 T / (M L), 0.2 % off with 64 elements, whose cubics
    round the kink at the mass.
    """
    scene = string(64, element="cable8p")
    half = scene.cables["wire"].length / 2
    scene.rigid_body("A", mass=300.0, inertia=(1, 1, 1), position=(0.5, 0, 0))
    scene.slide("A", along="wire", s=half)
    modes = scene.modes(3)
    frequencies = modes.angular_frequency
    assert np.count_nonzero(frequencies == 0) == 2, "along the wire, and a turn about the point it is held at"
    mass = 300 + 1 / 3  # a triangle's share of the string
    assert frequencies[2] == pytest.approx(np.sqrt(4 * 100 / mass), rel=3e-3)
    assert modes["A.displacement"][2] == pytest.approx([0, modes["A.displacement"][2, 1], 0], abs=1e-6)


def test_modes_are_read_as_a_mapping():
    """`for name in modes` iterates over names; the length is that of the frequencies."""
    modes = string(4).modes(3)
    assert list(modes) == modes.keys() == ["wire.nodal_vectors", "wire.displacement"]
    assert {name: len(shapes) for name, shapes in modes.items()} == dict.fromkeys(modes, len(modes))
    assert "wire.displacement" in modes and "wire.position" not in modes and 0 not in modes
    assert modes._ipython_key_completions_() == modes.keys()


def test_about_an_equilibrium(validated):
    """A hanging chain's frequencies are sqrt(g / L) times zeros of J0 over 2."""
    scene = Scene()
    chain = scene.cable("chain", start=(0, 0, 0), end=(0, -1, 0), up=(1, 0, 0), elements=24, element="cable12",
                        section=GeneralSection(area=1e-4, second_moment_about_z=1e-17, second_moment_about_y=1e-17),
                        material=Material(youngs_modulus=1e11, poisson_ratio=0, density=1e4))
    scene.pin(chain, s=0.0)
    found = scene.modes(6, about=scene.equilibrium()).angular_frequency
    expected = np.repeat(np.array([2.404825557695773, 5.520078110286311, 8.653727912911013]), 2) / 2 * np.sqrt(9.81)
    validated("Modes", "hanging chain", "angular frequencies 1 to 3", expected, found, unit="rad/s", bound=2e-4,
              source="closed form, zeros of J₀", variant="cable12", mesh="24 elements")


def test_a_state_that_is_not_stable_grows():
    """A chain that stands on its end, straight by symmetry."""
    scene = Scene(gravity=(0, 9.81, 0))
    chain = scene.cable("chain", start=(0, 0, 0), end=(0, -1, 0), up=(1, 0, 0), elements=6, element="cable8p",
                        section=GeneralSection(area=1e-4, second_moment_about_z=1e-12, second_moment_about_y=1e-12),
                        material=Material(youngs_modulus=1e9, poisson_ratio=0, density=1e4))
    scene.pin(chain, s=0.0)
    with pytest.warns(FunicularWarning, match="the state is unstable: 12 independent directions lower its energy"):
        state = scene.equilibrium(seek_stable=False)
    modes = scene.modes(2, about=state)
    assert np.all(modes.angular_frequency == 0)
    assert modes.growth_rate[0] > np.sqrt(9.81)


def test_a_spring_between_bodies(validated):
    """Two masses, one spring: w² = k (1 / m1 + 1 / m2)."""
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("a", mass=2.0, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.rigid_body("b", mass=3.0, inertia=(1, 1, 1), position=(1, 0, 0))
    scene.spring("a", "b", stiffness=60.0)
    modes = scene.modes(12)
    assert np.count_nonzero(modes.angular_frequency) == 1
    validated("Modes", "two masses on a spring", "angular frequency", np.sqrt(60 * (1 / 2 + 1 / 3)),
              float(modes.angular_frequency[-1]), unit="rad/s", bound=1e-10, source="closed form")
    assert modes.frequency[-1] == pytest.approx(modes.angular_frequency[-1] / 2 / np.pi)


def test_more_than_there_are():
    scene = Scene(gravity=(0, 0, 0))
    add_cable(scene, elements=1, element="cable12", section=Rectangle(height=0.05, width=0.05))
    with pytest.raises(SceneError, match="modes: the scene has 6 degrees of freedom, 7 modes were asked for; ask for "
                                         "fewer modes, or take more elements"):
        scene.modes(7)


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_a_scene_without_cables_is_not_told_to_take_fewer_elements():
    scene = Scene(gravity=(0, 0, 0))
    for x, name in enumerate("AB"):
        scene.rigid_body(name, mass=1.0, inertia=(1, 1, 1), position=(x, 0, 0))
    scene.spring("A", "B", stiffness=1e14)
    scene.spring("B", (3, 0, 0), stiffness=1.0)
    scene.spring(("A", (0, 1, 0)), (0, 0, 1), stiffness=1e-3)
    notes = scene.modes(12).messages
    assert "; look for a part that is far stiffer or far lighter than the others" in str(notes)
    with pytest.raises(SceneError, match=r"ask for fewer modes$"):
        scene.modes(13)


def test_nodes_of_a_modal_body_move_from_the_state_that_they_swing_about():
    """A beam on a hinge is drawn horizontally and hangs at rest: its end swings sideways."""
    scene = Scene()
    scene.modal_body("link", start=(0, 0, 0), end=(1, 0, 0), section=SQUARE, boundary="attached", modes=2,
                     material=TABLE_1)
    scene.joint("revolute", "link", (0, 0, 0), axis=(0, 0, 1))
    rest = scene.equilibrium()
    np.testing.assert_allclose(rest["link.nodes"][-1], (0, -1, 0), atol=1e-3)
    np.testing.assert_allclose(np.abs(scene.modes(1, about=rest)["link.nodes"][0, -1]), (1, 0, 0), atol=1e-3)
