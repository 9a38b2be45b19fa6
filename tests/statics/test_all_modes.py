"""No mode is lost, on any mesh and for any proportions: repeated, free, unstable ones, heavy parts on light ones."""

import warnings

import numpy as np
import pytest
from funicular import Circle, Friction, FunicularWarning, GeneralSection, Material, Rectangle, Scene, SceneError
from shared_scenes import cable_scene

STEEL = Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7850)
SQUARE = Rectangle(height=0.02, width=0.02)
MESHES = [16, 104, 112, 120, 128, 136, 144, 152, 160, 168, 176, 184, 192, 200, 208, 216, 224, 232, 240, 248, 256]
FEW = [pytest.param(n, marks=() if n in (16, 128, 200) else pytest.mark.slow) for n in MESHES]


def beam(elements, element="cable12", rest_length=1.0, section=SQUARE, material=STEEL, **end) -> Scene:
    """Return a beam of 1 m between two pins."""
    return cable_scene("beam", pins="ends", gravity=(0, 0, 0), elements=elements, element=element, section=section,
                       material=material, rest_length=rest_length, strain="engineering", **end)


def bending(n: int, each: int, compression: float = 0.0) -> np.ndarray:
    """Return (n each,) squared angular frequencies of the pinned beam: w² = ((k π)² EI - P) (k π)² / ρA at 1 m."""
    area, inertia = SQUARE.area, SQUARE.second_moment_about_z
    k = (np.arange(1, n + 1) * np.pi) ** 2
    return np.repeat((k * 2e11 * inertia - compression) * k / (7850 * area), each)


@pytest.mark.parametrize("elements", FEW)
def test_every_bending_mode_of_a_square_beam_comes_twice(elements, validated):
    found = beam(elements).modes(12)
    validated("Modes", "square beam on two pins, every frequency twice", "squares of angular frequencies 1 to 6",
              bending(6, 2), found.angular_frequency**2, unit="rad²/s²", bound=3e-3 if elements == 16 else 2e-6,
              source="closed form", variant="cable12", mesh=f"{elements} elements")
    assert found.messages == []


@pytest.mark.parametrize("elements", [16, 200])
def test_and_of_a_planar_beam_once(elements):
    found = beam(elements, element="cable8p").modes(6).angular_frequency
    np.testing.assert_allclose(found**2, bending(6, 1), rtol=3e-3 if elements == 16 else 2e-6)


@pytest.mark.slow
def test_two_thousand_elements():
    """Rounding of the stiffness gives 7e-5 in the first frequency, within the reported uncertainty."""
    with pytest.warns(FunicularWarning, match="rounding of the stiffness may change the frequencies of modes 1, 2 by"):
        found = beam(2000).modes(8)
    expected = np.sqrt(bending(4, 2))
    assert np.all(np.abs(found.angular_frequency - expected) < found.uncertainty)
    np.testing.assert_allclose(found.angular_frequency, expected, rtol=1e-3)


@pytest.mark.parametrize("elements", FEW)
def test_a_body_on_a_spherical_joint(elements):
    """Its three rotations are free, and the modes of the beam come in pairs."""

    def found(elements):
        scene = beam(elements)
        scene.rigid_body("ball", mass=2.0, inertia=(1e-3, 1e-3, 1e-3), position=(0.5, 0, 0))
        scene.joint("spherical", "ball", ("beam", 0.5))
        return scene.modes(11).angular_frequency

    here = found(elements)
    assert np.all(here[:3] == 0)
    np.testing.assert_allclose(here[3::2], here[4::2], rtol=1e-6)
    mass = 2.0 + 17 / 35 * 7850 * SQUARE.area  # Rayleigh's estimate of the beam's share
    assert here[3] == pytest.approx(np.sqrt(48 * 2e11 * SQUARE.second_moment_about_z / mass), rel=2e-3)
    np.testing.assert_allclose(here[3:], found(32)[3:], rtol=3e-4)


@pytest.mark.parametrize(("elements", "element"), [(3, "cable12"), (128, "cable12"), (60, "beam24")])
def test_free_motions_are_counted(elements, element):
    """A cable in space has five rigid motions, a beam six. The next frequencies are (4.730 / L)² sqrt(EI / ρA), less
    0.2 % for shear and rotary inertia in the stout beam.
    """
    scene = Scene(gravity=(0, 0, 0))
    kind = {"law": "structural"} if element == "beam24" else {}
    scene.cable("beam", start=(0, 0, 0), end=(1, 0, 0), elements=elements, element=element, section=SQUARE,
                material=STEEL, **kind)
    found, zeros = scene.modes(8).angular_frequency, 5 if element == "cable12" else 6
    assert np.all(found[:zeros] == 0)
    first = 4.730040745**2 * np.sqrt(2e11 * SQUARE.second_moment_about_z / (7850 * SQUARE.area))
    np.testing.assert_allclose(found[zeros : zeros + 2], first, rtol=3e-2 if elements == 3 else 4e-3)


@pytest.mark.parametrize("elements", [12, 128])
def test_unstable_motions_are_counted(elements):
    """A beam under five times its Euler load: two pairs of modes grow."""
    euler = np.pi**2 * 2e11 * SQUARE.second_moment_about_z
    strain = 5 * euler / (2e11 * SQUARE.area)
    found = beam(elements, rest_length=1 / (1 - strain)).modes(8)
    expected = bending(4, 2, 5 * euler)
    assert np.count_nonzero(expected < 0) == 4
    squares = found.angular_frequency**2 - found.growth_rate**2
    np.testing.assert_allclose(squares, np.sort(expected), rtol=2e-2)  # of the slenderness: ρA and L as compressed


@pytest.mark.parametrize(("elements", "mass"), [(16, 1.0), (200, 1.0), (200, 1e4), (17, 1e4)])
def test_a_heavy_body_on_a_light_string(elements, mass):
    """A string of 1e-6 kg, EA 1e5 N: the body swings at w² = 4 T / (M L), far below the frequencies of the string, and
    vibrates along it at 4 EA / (M L).
    """
    scene = beam(elements, rest_length=1 / (1 + 1e-3), section=GeneralSection(area=1e-6, second_moment_about_z=1e-20),
                 material=Material(youngs_modulus=1e11, poisson_ratio=0, density=1.0))
    scene.rigid_body("body", mass=mass, inertia=(1e-3 * mass,) * 3, position=(0.5, 0, 0))
    on_node = elements % 2 == 0
    half = scene.cables["beam"].length / 2
    if on_node:
        scene.joint("spherical", "body", ("beam", half))
    else:
        scene.slide("body", along="beam", s=half)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = scene.modes(8).angular_frequency
    zeros = 3 if on_node else 4  # a slide lets it go along the string, too
    assert np.all(found[:zeros] == 0)
    swing = np.sqrt(4 * 1e5 * 1e-3 / mass)
    np.testing.assert_allclose(found[zeros : zeros + 2], swing, rtol=1e-2)  # the kink at the body, as sharp as cubics
    if on_node:
        assert found[5] == pytest.approx(np.sqrt(4 * 1e5 / mass), rel=1e-2)
    string = 2 * np.pi * np.sqrt(1e5 * 1e-3 * (1 + 1e-3) / 1e-6)
    np.testing.assert_allclose(found[6:8], string, rtol=2e-3)


def test_a_thin_cable_is_resolved():
    """A micrometre thick and 1 m long, with 200 elements: the squared frequencies span a factor of 1e17. The rounded
    lengths of elements strain them, which changes the squares by 2.5e-5 and is reported.
    """
    found, expected = beam(200, section=Rectangle(height=1e-6, width=1e-6)).modes(4), np.sqrt(2.5e-9 * bending(2, 2))
    np.testing.assert_allclose(found.angular_frequency, expected, rtol=2e-5)
    assert np.all(np.abs(found.angular_frequency - expected) < found.uncertainty)


def test_a_thinner_one_is_reported_as_uncertain():
    """At 10 nm the strain by rounded lengths dominates."""
    with pytest.warns(FunicularWarning, match="^rounding of the stiffness") as warned:
        found = beam(200, section=Rectangle(height=1e-8, width=1e-8)).modes(4)
    assert [str(w.message) for w in warned] == found.messages
    w, grows = found.angular_frequency, found.growth_rate
    assert np.all(np.abs(np.where(grows > 0, -grows, w) - np.sqrt(2.5e-13 * bending(2, 2))) < 2 * found.uncertainty)


@pytest.mark.parametrize(("width", "cause"), [
    (1e-9, "rounding of the stiffness hides the 6 lowest modes"), (1e-80, "its inertia comes to")])
def test_extreme_proportions_are_refused(width, cause):
    """These gave six zeros, or an error of LAPACK. The second is thinner than the bounds of sections."""
    section = Rectangle.model_construct(height=width, width=width)
    scene = Scene(gravity=(0, 0, 0))
    scene.clamp(scene.cable("beam", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section, material=STEEL), s=0.0)
    with pytest.raises(SceneError, match=f"modes: .*{cause}.*; "):
        scene.modes(6)


def test_a_body_of_1e20_kg():
    """Its mass matrix must not count as indefinite; the body vibrates along the cable at sqrt(EA / (M L))."""
    scene = Scene(gravity=(0, 0, 0))
    scene.pin(scene.cable("beam", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=SQUARE, material=STEEL), s=0.0)
    scene.rigid_body("body", mass=1e20, inertia=(1e20,) * 3, position=(1, 0, 0))
    scene.joint("spherical", "body", ("beam", 1.0))
    with pytest.warns(FunicularWarning, match="1 of those given as 0 may be higher"):  # the beam's own turn
        found = scene.modes(7).angular_frequency
    assert np.all(found[:6] == 0)
    assert found[6] == pytest.approx(np.sqrt(2e11 * SQUARE.area / 1e20), rel=1e-4)


def test_friction_is_left_out_and_reported():
    scene = beam(8, section=Circle(radius=0.01))
    for name, s in (("a", 0.3), ("b", 0.6)):
        scene.rigid_body(name, mass=1.0, inertia=(1e-3, 1e-3, 1e-3), position=(s, 0, 0))
    scene.slide("a", along="beam", s=0.3, name="trolley", friction=Friction(coefficient=0.3))
    scene.slide("b", along="beam", s=0.6, name="free")
    with pytest.warns(FunicularWarning, match='modes leave out the friction of slide "trolley"$'):
        found = scene.modes(4)
    assert found.messages == ['modes leave out the friction of slide "trolley"']


def test_loads_that_turn_keep_their_limit():
    """The unsymmetric stiffness of a follower force is solved densely or refused."""
    scene = beam(8)
    scene.force("beam", s=0.5, value=(100.0, 0, 0), follower=True)
    assert len(scene.modes(4, as_drawn=True)) == 4
    many = beam(600)
    many.force("beam", s=0.5, value=(1e6, 0, 0), follower=True)
    with pytest.raises(SceneError, match="has 3600 degrees of freedom: such modes are computed for up to 3000"):
        many.modes(4, as_drawn=True)
