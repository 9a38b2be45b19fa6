"""A note reports an object that a cable may pass between its contact points, with a sufficient mesh."""

import re

import funicular as fu
import pytest

NOTE = "may be more than .* undetected; in the contact zone, take elements of at most ([0-9.]+) m"
SHAPES = {"sphere": fu.Sphere(radius=0.02, at=(0.545, -0.055, 0)),
          "cylinder": fu.Cylinder(radius=0.02, length=1, at=(0.545, -0.055, 0)),
          "box": fu.Box(size=(0.04, 0.04, 1), at=(0.545, -0.055, 0)),
          "ridge": fu.HeightField.of(lambda x: -0.035 - 500 * (x - 0.545) ** 2, [0.525 + 0.005 * k for k in range(9)])}


def dropped(shape, elements):
    """Return a rope of 2 m between supports above an object smaller than the resolution of its elements."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    rope = scene.cable("rope", start=(0, 0, 0), end=(2, 0, 0), elements=elements, element="cable12",
                       section=fu.Circle(radius=5e-3),
                       material=fu.Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000))
    for s in (0, 2):
        scene.pin(rope, s=s)
    scene.surface("thing", shape)
    scene.contact("rope", "thing", stiffness=1e5)
    return scene


def run(scene):
    return scene.run(0.3, tol=1e-3, output_step=0.01, progress=False)


def notes(messages):
    return [found for message in messages if (found := re.search(NOTE, message))]


@pytest.mark.parametrize("shape", SHAPES)
def test_what_elements_are_too_long_to_see_is_noted_with_those_that_see_it(shape):
    with pytest.warns(fu.FunicularWarning, match=NOTE):
        coarse = run(dropped(SHAPES[shape], 4))
    assert not coarse.report["events"], "else the scene does not show what the note is for"
    longest = float(notes(coarse.report["messages"])[0][1])
    fine = run(dropped(SHAPES[shape], int(2 / longest) + 1))
    assert not notes(fine.report["messages"])
    assert fine.report["events"][0]["what"] == "came into contact"


@pytest.mark.parametrize("shape", [fu.Plane(point=(0, -0.035, 0)), fu.Sphere(radius=20, at=(0.545, -20.035, 0)),
                                   fu.HeightField([0, 1], [-0.035, -0.04])])
def test_what_is_flat_beside_the_elements_is_not_noted(shape):
    found = run(dropped(shape, 4))
    assert found.report["events"] and not notes(found.report["messages"])


@pytest.mark.parametrize("find", [fu.Scene.equilibrium, fu.Scene.relax])
def test_states_of_rest_tell_it_too(find):
    with pytest.warns(fu.FunicularWarning, match=NOTE):
        state = find(dropped(SHAPES["sphere"], 4))
    assert notes(state.messages)
