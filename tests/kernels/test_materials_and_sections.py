"""Requirements of laws on materials and sections: incompressible rubber, vertical ropes, rotary inertia."""

import numpy as np
import pytest
from funicular import Circle, GeneralSection, Material, Rectangle, Scene, SceneError, Tube
from shared_scenes import cable_scene

RUBBER = Material(youngs_modulus=1e6, poisson_ratio=0.5, density=1100)


def cable(**changes) -> Scene:
    return cable_scene(clamps=(0.0,), **{"elements": 4, "element": "beam24", "law": "structural",
                                         "section": Circle(radius=0.01), "material": RUBBER} | changes)


@pytest.mark.parametrize(("element", "law"), [
    ("cable12", None), ("cable8p", None), ("beam24", "structural"), ("beam12p", "structural"), ("beam12p", "continuum"),
    ("beam12p", "poisson_split")])
def test_a_poisson_ratio_of_a_half_suits_laws_that_need_e_and_g_alone(element, law):
    """All energies have a limit at 0.5, which lower ratios approach."""

    def sag(nu):
        scene = cable(element=element, law=law, material=Material(youngs_modulus=1e6, poisson_ratio=nu, density=1100))
        return scene.equilibrium(load_steps=4)["wire.position"][-1]

    np.testing.assert_allclose(sag(0.5), sag(0.5 - 1e-9), atol=1e-7)


@pytest.mark.parametrize("modulus", [1e6 / 3, 333333.0])
def test_a_shear_modulus_of_a_third_is_a_poisson_ratio_of_a_half(modulus):
    material = Material(youngs_modulus=1e6, shear_modulus=modulus, density=1100)
    assert material.is_incompressible
    assert material.lame()[1] == pytest.approx(modulus, rel=1e-12)
    cable(material=material).check()


@pytest.mark.parametrize("law", ["continuum", "poisson_split"])
@pytest.mark.parametrize("material", [RUBBER, Material(youngs_modulus=1e6, shear_modulus=333333.0, density=1100)])
def test_laws_of_a_solid_refuse_it(law, material):
    with pytest.raises(SceneError, match=f'law "{law}" needs a poisson_ratio below 0.5, at which Lamé\'s '
                                         r'λ is infinite, got 0.5\d*; take law="structural"'):
        cable(law=law, material=material)


def test_a_refused_modulus_differs_from_its_bound_as_it_is_shown():
    with pytest.raises(SceneError, match=r"shear_modulus must be at least youngs_modulus / 3 = 333333\.333 Pa, got "
                                         r"333329 Pa; the Poisson ratio E / \(2 G\) - 1 = 0\.5000195 "):
        Material(youngs_modulus=1e6, shear_modulus=333329.0, density=1)


@pytest.mark.parametrize(("element", "section"), [
    ("cable12", Circle(radius=0.01)), ("cable12", Rectangle(height=0.02, width=0.02)), ("beam24", Circle(radius=0.01)),
    ("beam24", Tube(outer_radius=0.01, inner_radius=0.005))])
def test_a_round_cable_on_end_needs_no_up(element, section):
    """A cable along y, the default of `up`, vibrates as one along z, whose `up` is across it."""
    assert cable(start=(0, 0, 0), end=(0, 1, 0), element=element, law=None if element == "cable12" else "structural",
                 section=section).cables["wire"].axes.tolist() == [[0, 1, 0], [1, 0, 0], [0, 0, -1]]

    def lowest(end, gravity):
        scene = cable(end=end, element=element, law=None if element == "cable12" else "structural", section=section)
        scene.gravity = gravity
        return scene.modes(4)

    upright, along = lowest((0, 1, 0), (0, 0, 0)), lowest((0, 0, 1), (0, 0, 0))
    off = np.abs(upright.angular_frequency - along.angular_frequency)
    assert np.all(off <= 1e-9 * along.angular_frequency + upright.uncertainty + along.uncertainty)
    assert np.all(along.uncertainty < 1e-6 * along.angular_frequency)


@pytest.mark.parametrize(("section", "up"), [(Rectangle(height=0.02, width=0.02), (0, 1, 0)),
                                             (Circle(radius=0.01), (0, 0, 0))])
def test_an_up_that_is_needed_or_is_none_is_still_asked_for(section, up):
    with pytest.raises(SceneError, match="up must not be zero or parallel to the axis"):
        cable(end=(0, 1, 0), section=section, up=up)


def test_a_slide_that_keeps_its_roll_on_a_cable_on_end():
    scene = cable(end=(0, 1, 0), element="cable12", law=None)
    scene.gravity = (0, 0, 0)
    scene.rigid_body("A", mass=1, inertia=(1, 1, 1), position=(0, 0.5, 0))
    assert scene.slide("A", along="wire", s=0.5, frame="tangent", roll="fixed").up == (1.0, 0.0, 0.0)


def test_rotary_inertia_apart_from_the_stiffness():
    """Torsion of a clamped beam: (π / 2 L) sqrt(GJ / ρI_p)."""
    stiff = {"area": 1e-4, "second_moment_about_z": 1e-9, "torsion_constant": 2e-9, "shear_factors": (1, 1)}
    material = Material(youngs_modulus=2e11, shear_modulus=8e10, density=7850)

    def turning(**rotary):
        modes = cable(section=GeneralSection(**stiff, **rotary), material=material, elements=8).modes(14, as_drawn=True)
        moves, turns = (np.abs(modes["wire.nodal_vectors"][:, -1, vector]).max(axis=1) for vector in (0, 2))
        return modes.angular_frequency[np.flatnonzero(turns > 1e6 * moves)[0]]

    expected = np.pi / 2 * np.sqrt(8e10 / 7850)
    assert turning() == pytest.approx(expected, rel=2e-3)
    assert turning(rotary_moment_about_z=16e-9) == pytest.approx(expected / 4, rel=2e-3)
    assert turning(rotary_moment_about_z=12e-9, rotary_moment_about_y=20e-9) == pytest.approx(expected / 4, rel=2e-3)


def test_rotary_inertia_slows_bending():
    """Rayleigh's correction of a pinned beam with rigid shear: w² = w0² / (1 + (π / L)² I_rotary / A)."""
    material = Material(youngs_modulus=2e11, shear_modulus=8e10, density=7850)

    def lowest(rotary):
        section = GeneralSection(area=1e-2, second_moment_about_z=1e-8, torsion_constant=2e-8, shear_factors=(1, 1),
                          rotary_moment_about_z=rotary)
        scene = Scene(gravity=(0, 0, 0))
        beam = scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=32, element="beam12p", law="structural",
                           section=section, material=material)
        scene.pin(beam, s=0.0)
        scene.pin(beam, s=1.0)
        return scene.modes(1).angular_frequency[0] ** 2

    assert lowest(1e-12) / lowest(1e-4) == pytest.approx(1 + np.pi**2 * 1e-2, rel=3e-4)


def test_rotary_inertia_in_a_file():
    scene = cable(section=GeneralSection(area=1e-4, second_moment_about_z=1e-9, torsion_constant=2e-9,
                                         shear_factors=(1, 1),
                                  rotary_moment_about_y=3e-9))
    assert "rotary_moment_about_y = 3e-09" in scene.to_toml()
    from funicular.scene.file import loads

    assert loads(scene.to_toml(), "here").to_toml() == scene.to_toml()


def test_a_cable_has_no_rotary_inertia():
    with pytest.raises(SceneError, match=r"section\.rotary_moment is given, but cable12 has no rotary inertia; leave "
                                         'it out, or take element="beam24"'):
        cable(element="cable12", law=None,
              section=GeneralSection(area=1, second_moment_about_z=1, rotary_moment_about_z=2))


def test_rotary_moments_are_those_about_their_axes():
    section = GeneralSection(area=1, second_moment_about_z=2, second_moment_about_y=3, rotary_moment_about_z=4,
                             rotary_moment_about_y=5)
    assert section.moments()[:3].tolist() == [1, 2, 3] and section.mass_moments()[:3].tolist() == [1, 4, 5]
