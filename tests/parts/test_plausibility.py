"""Numbers in probably wrong units are noted in the report and accepted."""

import logging

import funicular as fu
import pytest


def scene(gravity=(0, -9.81, 0), **material):
    made = fu.Scene(gravity)
    made.cable("wire", start=(0, 0, 0), end=(0, -1, 0), elements=2, element="cable8p", section=fu.Circle(radius=0.01),
               material=fu.Material(**{"youngs_modulus": 2e11, "poisson_ratio": 0.3, "density": 7850} | material))
    made.pin("wire", s=0.0)
    return made


@pytest.mark.parametrize(("given", "notes"), [
    ({}, []),
    ({"youngs_modulus": 200, "density": 7.85},
     ["youngs_modulus is 200 Pa: is it in Pa", "density is 7.85 kg/m³: is it"]),
    ({"density": 7.85e-9}, ["density is 7.85e-09 kg/m³: is it in kg/m³"]),
    ({"density": 30}, ["make axial waves of 8.16e+04 m/s"]),
    ({"gravity": (0, -9810, 0)}, ["gravity is 9810 m/s²: is it in m/s², and are all lengths in m"]),
])
def test_other_units_are_noted(given, notes):
    made = scene(**given)
    found = made.run(duration=1e-6, tol=1e-3).report["messages"]
    assert len([each for each in found if each.endswith(("?", "rubber 1e6", "water 1000"))]) == len(notes)
    for note in notes:
        assert any(note in each for each in found)


@pytest.mark.parametrize("shape", ["drawn", "surface"])
@pytest.mark.parametrize(("given", "noted"), [({}, True), ({"radius": 0.1}, False), ({"points": [(0, 0, 0)]}, False)])
def test_a_body_with_a_shape_that_touches_by_its_origin_alone_is_noted(shape, given, noted):
    """A box of 0.2 m would rest with its middle on the ground."""
    made = fu.Scene()
    made.rigid_body("box", mass=1, inertia=(0.01,) * 3, position=(0, 1, 0),
                    shape=fu.Box(size=(0.2, 0.2, 0.2)) if shape == "drawn" else None)
    made.surface("ground", fu.Plane())
    if shape == "surface":
        made.surface("skin", fu.Sphere(radius=0.1), on="box")
    made.contact("box", "ground", name="foot", restitution=0.2, **given)
    found = made.run(duration=1e-3, tol=1e-3).report["messages"]
    says = 'contact "foot" acts at the origin of "box" alone, not on the surface of that body: give points='
    assert any(each.startswith(says) for each in found) == noted


def test_an_equilibrium_has_the_notes_too():
    assert any("is it in kg/m³" in each for each in scene(density=7.85).equilibrium().messages)


def test_what_happens_is_logged_under_the_name_of_the_package(caplog):
    with caplog.at_level(logging.INFO, logger="funicular"):
        scene().run(duration=1e-6, tol=1e-3)
    assert [record.name.split(".")[0] for record in caplog.records] == ["funicular"] * len(caplog.records)
    assert any(record.message.startswith("run of 1e-06 s: 12 degrees of freedom, ") for record in caplog.records)
    assert any(record.message.startswith("run completed after ") for record in caplog.records)
