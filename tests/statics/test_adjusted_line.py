"""Droppers of an overhead line of 55 m, found by the heights of its contact wire.

A span of a published line: lengths of its droppers, and their forces in the limit of strings; a parabola of 55 mm
between the outer droppers. At its masts the wire is vertically free, as on a steady arm.
"""

import adjusting
import funicular as fu
import numpy as np
import pytest

G, SPAN = 9.81, 55.0
X = np.array([4.5, 10.25, 16, 21.75, 27.5, 33.25, 39, 44.75, 50.5])
SAG = 0.055 * (1 - ((X - 27.5) / 23) ** 2)
PUBLISHED = np.array([1.017, 0.896, 0.810, 0.758, 0.741])
CONTACT = {"tension": 22e3, "area": 150e-6, "modulus": 100e9, "bending": 179.0, "mass": 1.35}
MESSENGER = {"tension": 16e3, "area": 120e-6, "modulus": 97e9, "bending": 111.0, "mass": 1.08}


def wire(scene, name, y, excess, data, bending, elements):
    """Add a wire that is longer than the span by an excess under its given tension."""
    area, modulus = data["area"], data["modulus"]
    section = fu.GeneralSection(area=area, second_moment_about_z=bending * data["bending"] / modulus)
    length = (SPAN + excess) / (1 + data["tension"] / (modulus * area))
    return scene.cable(name, start=(0, y, 0), end=(SPAN, y, 0), elements=elements, element="cable8p", section=section,
                       strain="engineering", rest_length=length,
                       material=fu.Material(youngs_modulus=modulus, poisson_ratio=0.3, density=data["mass"] / area))


def line(bending=1.0, elements=44):
    """Return the line with droppers of one length, many of them slack; bending: relative to that of the data."""
    scene = fu.Scene()
    contact = wire(scene, "contact", 0.0, 0.0, CONTACT, bending, elements)
    messenger = wire(scene, "messenger", 1.2, 0.03, MESSENGER, bending, elements)
    for s in (0, messenger.length):
        scene.pin(messenger, s=s)
    for s in (0, contact.length):
        scene.motion(contact, s=s, displacement=(0, "free", 0))
    for k, x in enumerate(X):
        upper, lower = x / SPAN * messenger.length, x / SPAN * contact.length
        scene.spring((messenger, upper), (contact, lower), name=f"dropper_{k}", stiffness=200e3 / 0.85, length=0.85,
                     tension_only=True)
        scene.force(messenger, s=upper, value=(0, -G * (0.195 + 0.117 * 0.85), 0))
        scene.force(contact, s=lower, value=(0, -G * 0.165, 0))
    return scene


def adjusted(scene):
    """Return the equilibrium with the given heights and tensions."""
    length = scene.cables["contact"].length
    heights = {f"contact@{x / SPAN * length:.12g}.position.y": -sag for x, sag in zip(X, SAG, strict=True)}
    pulls = {"contact@0.force.x": -22e3, "messenger@0.force.x": -16e3}
    lengths = {f"dropper_{k}.length": (0.3, 1.5) for k in range(9)}
    return scene.equilibrium(adjust={**lengths, "contact.rest_length": "free", "messenger.rest_length": "free"},
                             to={**heights, **pulls})


def droppers(rest, quantity):
    return np.array([float(rest[f"dropper_{k}.{quantity}"]) for k in range(9)])


def test_droppers_by_the_heights_of_the_contact_wire():
    rest = adjusted(line())
    lengths = np.array([rest.adjusted[f"dropper_{k}.length"] for k in range(9)])
    assert lengths[:5] == pytest.approx(PUBLISHED, abs=2e-3)
    assert lengths == pytest.approx(lengths[::-1], abs=1e-8)
    assert np.any(droppers(line().equilibrium(), "tension") == 0.0)
    assert np.all(droppers(rest, "tension") > 40.0)
    assert 1 <= rest.adjustment.iterations <= 6
    assert rest.adjustment.misfits[-1] < 1e-9
    assert rest.residual < 1e-5
    assert rest["contact@0.force"][0] == pytest.approx(-22e3, rel=1e-8)
    plain = rest.scene.equilibrium()
    assert plain["contact.position"] == pytest.approx(rest["contact.position"], abs=1e-8)


def test_forces_near_the_string_limit_as_bending_goes():
    rest = adjusted(line(bending=0.01, elements=88))
    forces = droppers(rest, "tension")
    assert forces[[0, 8]] == pytest.approx(191.35, rel=5e-3)
    assert forces[1:8] == pytest.approx(51.46, rel=1.5e-2)  # the kinks are rounded off over an element
    assert forces.sum() == pytest.approx(742.9, rel=2e-3)


def test_a_dropper_on_a_node_may_pass_to_the_next_element():
    """A change of the wire's length divides its chain elsewhere and renumbers its unknowns."""
    _, rest = adjusting.adjusted("droppers", 3, "z = 0")
    assert rest.adjustment.iterations <= 4
    assert rest.adjustment.misfits[-1] < 1e-9
