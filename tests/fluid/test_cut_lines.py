"""Lines cut by the surface of a fluid: energy of falling lines, section forces, quadrature."""

from math import pi

import funicular as fu
import numpy as np
import pytest
from expectations import unaccounted
from funicular.engine import Engine
from funicular.model.build import build
from funicular.results.section_forces.spreads import Rule

G, WATER = 9.81, 1025.0


def test_sections_of_a_line_that_stands_in_water_bear_what_is_below():
    """T = g A (rho (4 - s) - rho_w times the wet length), also within the element that the surface cuts."""
    scene = fu.Scene()
    wire = scene.cable("line", start=(0, 1.1, 0), end=(0, -2.9, 0), elements=3, element="cable12", strain="engineering",
                       section=fu.Circle(radius=0.02), material=fu.Material(youngs_modulus=1e11, poisson_ratio=0.0,
                                                                           density=1700))
    scene.pin(wire, s=0.0)
    scene.fluid("sea", density=WATER, surface=0.0)
    scene.fluid("air", density=1.2)
    scene.drag(wire, normal=1.2, added_mass=1.0)
    s = np.array([0.1, 0.7, 1.0, 1.2, 1.3, 2.5, 3.5, 4.0])
    tension = np.array(scene.equilibrium().section_forces("line", s)["tension"])
    in_water, below = np.minimum(2.9, 4 - s), 4 - s
    expected = G * pi * 0.02**2 * (1700 * below - WATER * in_water - 1.2 * (below - in_water))
    assert tension == pytest.approx(expected, abs=1e-5 * expected[0])


def test_sections_at_the_free_end_of_a_rope_that_falls_in_bear_nothing():
    run = thrown().run(0.6, tol=1e-6, integrator="radau", output_step=0.05)
    cut = run.section_forces("rope", [1.5, run.scene.cables["rope"].length])
    for values in (np.array(cut["force"]), np.array(cut["moment"])):
        assert np.abs(values[:, 1]).max() < 1e-9 * np.abs(values).max()


@pytest.mark.parametrize("ulps", [-3, -1, 0, 1, 3])
def test_a_wet_part_ends_with_its_element_whatever_the_rounding(ulps):
    """One that ended beyond it by rounding was cut at its end, by a polynomial: 2e-5 N at a free end."""
    cable = build(thrown()).cables[0]
    length = cable.mesh.length(0)
    places, weights = np.polynomial.legendre.leggauss(8)
    for start, stop in ((0.6 * length, length), (0.0, 0.6 * length)):
        x = (start + stop + (stop - start) * places) / 2 + ulps * np.spacing(length)
        rule = Rule.between_cuts(cable, 0, x, weights * (stop - start) / 2)
        assert rule.stop == length if stop == length else rule.start == 0.0


def test_sections_on_both_sides_of_a_node_bear_the_same():
    """A rope with added mass: the force on its slope is a polynomial from points within the elements to the node."""
    run = thrown(added_mass=1.0, added_mass_tangential=0.2).run(0.6, tol=1e-6, integrator="radau", output_step=0.05)
    nodes = run.scene.cables["rope"].length * np.array([0.25, 0.5, 0.75])
    before, after = (np.array(run.section_forces("rope", nodes, side=side)["force"]) for side in ("before", "after"))
    assert np.abs(after).max() > 1
    assert np.abs(after - before).max() < 5e-3 * np.abs(after).max()


def thrown(level=0.0, shift=0.0, element="cable12", **drag):
    """Return a rope that falls obliquely into flowing water."""
    scene = fu.Scene()
    wire = scene.cable("rope", start=(shift, level + 0.5, 0), end=(shift + 3, level + 1.5, 0), elements=4,
                       element=element, section=fu.Circle(radius=0.02), material=fu.Material(
                           youngs_modulus=5e6, poisson_ratio=0, density=700, damping_time=2e-3))
    scene.fluid("sea", density=WATER, surface=level, velocity=(0.5, 0, 0))
    scene.drag(wire, normal=1.2, tangential=0.02, **drag)
    return scene


@pytest.mark.parametrize(("integrator", "tol"), [("explicit", 1e-4), ("radau", 1e-5), ("energy", 1e-4)])
def test_a_rope_that_falls_in_balances_its_energy_with_the_water_that_it_moves(integrator, tol):
    """The balance holds up to the quadrature at the surface, 1e-5 of the exchanged energy."""
    run = thrown(added_mass=1.0, added_mass_tangential=0.1).run(0.7, tol=tol, integrator=integrator, output_step=0.1)
    heights = run["rope.position"][:, :, 1]
    assert heights[3].max() > 0.02 and heights[-1].max() < -0.02
    assert unaccounted(run) < 2e-5 * run.energy_balance().exchanged


def test_a_rope_falls_in_alike_at_another_level_and_in_the_plane():
    settings = {"tol": 1e-6, "integrator": "radau", "output_step": 0.2}
    one = thrown().run(0.8, **settings)["rope.position"]
    for level, shift, element in ((250.0, 40.0, "cable12"), (0.0, 0.0, "cable8p")):
        other = thrown(level, shift, element).run(0.8, **settings)["rope.position"]
        assert np.abs(other - [shift, level, 0] - one).max() < 1e-7


def circle_below(level, heights, radius):
    u = np.clip((level - heights) / radius, -1, 1)
    return (u * np.sqrt(1 - u * u) + np.arcsin(u)) / pi + 0.5


@pytest.mark.parametrize("element", ["cable12", "cable18", "cable8p", "beam12p"])
def test_the_quadrature_of_cut_elements_is_that_of_forty_thousand_points(element):
    """Elements of random shapes cut several times by two surfaces: errors relative to the wet element mostly below
    1e-6, all below 3e-4.
    """
    random, errors = np.random.default_rng(5), []
    for _ in range(12):
        radius, bottom, length = 10 ** random.uniform(-2.5, -0.5), -random.uniform(0.01, 0.3), random.uniform(0.5, 4)
        scene = fu.Scene()
        scene.cable("wire", start=(0, 0, 0), end=(length, 0, 0), elements=1, element=element,
                    section=fu.Circle(radius=radius),
                    material=fu.Material(youngs_modulus=1e7, poisson_ratio=0, density=700))
        scene.fluid("brine", density=1200, surface=bottom)
        scene.fluid("sea", density=WATER, surface=0.05)
        scene.drag("wire", normal=0.1, fluid="sea")
        model = build(scene)
        cable = model.cables[0]
        nodal = random.normal(size=cable.shape) * random.choice([0.02, 0.3, 1.0])
        nodal[:, 0, 0] += [0, length]
        q = np.zeros(model.n_q)
        q[cable.coordinates] = nodal.ravel()
        found = Engine(model).drag_densities(0, 1, 0.0, q, np.zeros(model.n_dof))
        x = np.linspace(0, length, 40001)
        N = np.array(cable.kernel("on_axis").rows(len(x), length, x)[0]).reshape(len(x), -1)
        heights = N @ nodal.reshape(-1, cable.shape[2])[:, 1]
        wet = circle_below(0.05, heights, radius) - circle_below(bottom, heights, radius)
        unit = WATER * G * pi * radius**2
        errors.append(abs(found[:, 3] @ found[:, 5] / unit / length - np.trapezoid(wet, x) / length))
    assert np.median(errors) < 1e-6 and max(errors) < 3e-4


def test_pictures_have_all_quantities():
    run = thrown().run(0.4, tol=1e-3, output_step=0.1)
    assert not any("could not be computed" in note for note in run.animation("falls").notes)
