"""Modes of lines in contact do not depend on the contact points of a mesh."""

import numpy as np
import pytest
from funicular import Cylinder, GeneralSection, Material, Plane, Scene
from funicular.model.build import build
from funicular.solve.modes.contact_edges import resolve_contact_edges

AREA, LENGTH = 4.69e-2, 165.0


def mooring(elements, on_body=False):
    """Return a line of EI 1.99e4 N m² on a bed, which it leaves towards its upper end."""
    scene = Scene(gravity=(0, -9.80665, 0))
    scene.cable("line", start=(0, 0, 0), end=(150, 40, 0), elements=elements, element="cable8p", rest_length=LENGTH,
                section=GeneralSection(area=AREA, second_moment_about_y=1.99e-6, second_moment_about_z=1.99e-6),
                material=Material(youngs_modulus=1e10, poisson_ratio=0.3, density=36.7 / AREA), strain="engineering")
    scene.pin("line", s=0)
    scene.pin("line", s=LENGTH)
    if on_body:  # whose x is upwards
        scene.rigid_body("barge", mass=1, inertia=(1, 1, 1), position=(10, -5, 0),
                         orientation=(0.5**0.5, 0, 0, 0.5**0.5))
        scene.joint("weld", (10, -5, 0), "barge")
        scene.surface("bed", Plane(point=(4.99, 10, 0), normal=(1, 0, 0)), on="barge")
    else:
        scene.surface("bed", Plane(point=(0, -0.01, 0), normal=(0, 1, 0)))
    scene.contact("line", "bed", stiffness=1.6e4, radius=1e-6, name="lie")
    return scene


def frequencies(scene):
    return scene.modes(5, about=scene.equilibrium()).frequency


def test_frequencies_of_a_line_on_a_bed_do_not_scatter_with_the_mesh():
    found = np.array([frequencies(mooring(elements)) for elements in (70, 80, 90, 100, 120)])
    fine = frequencies(mooring(400))
    assert np.abs(found / fine - 1).max() < 6e-4  # 4.8e-4; 3.0e-3 where points touched in whole
    assert fine[0] == pytest.approx(0.30880, rel=1e-3)


def test_the_bed_may_be_part_of_a_body():
    """The lengths in contact equal those on the bed of the ground."""
    rest, found = mooring(100).equilibrium(), []
    for on_body in (False, True):
        scene = mooring(100, on_body)
        model = build(scene)
        q = np.append(rest.static_state["q"], model.q[len(rest.static_state["q"]):])  # of the body
        resolve_contact_edges(model, scene, q)
        found.append(model.contacts[0].weights)
    np.testing.assert_allclose(found[1], found[0], rtol=1e-9)
    whole = build(mooring(100)).contacts[0].weights
    assert np.count_nonzero(abs(found[0] / whole - 1) > 1e-9) == 2, "where it comes down and where it leaves"


def test_a_rope_over_a_drum_has_the_stiffness_of_what_touches():
    def hung(elements):
        scene = Scene(gravity=(0, -9.81, 0))
        scene.cable("rope", start=(-1, 0, 0), end=(1, 0, 0), elements=elements, element="cable8p", strain="engineering",
                    section=GeneralSection(area=1e-4, second_moment_about_y=1e-9, second_moment_about_z=1e-9),
                    material=Material(youngs_modulus=1e9, poisson_ratio=0, density=5e3))
        scene.pin("rope", s=0)
        scene.pin("rope", s=2)
        scene.surface("drum", Cylinder(radius=0.5, length=1.0, axis=(0, 0, 1), at=(0.1, -0.501, 0)))
        scene.contact("rope", "drum", stiffness=1e5, radius=1e-3)
        return frequencies(scene)

    fine = hung(200)
    for elements in (36, 48):
        assert np.abs(hung(elements) / fine - 1).max() < 2e-3  # 1.1e-3; 8e-3 where points touched in whole
