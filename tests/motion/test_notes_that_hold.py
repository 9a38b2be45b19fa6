"""Notes apply where they are given: no note on a drawing that is not the start, or on elements without contact."""

import pytest
from funicular import Circle, Cylinder, FunicularWarning, Material, Scene

SOFT = Material(youngs_modulus=4e6, poisson_ratio=0, density=1000, damping_time=1e-2)
OVERLAP = "the lines overlap by 0.005 m as drawn"


def crossed():
    """Return two fixed lines that are drawn 5 mm too close to each other."""
    scene = Scene()
    for name, y, x, z in (("low", 0.0, 0.5, 0), ("high", 0.015, 0, 0.5)):
        scene.cable(name, start=(-x, y, -z), end=(x, y, z), elements=5, element="cable12", section=Circle(radius=0.01),
                    material=SOFT)
        scene.pin(name, s=0)
        scene.pin(name, s=1.0)
    with pytest.warns(FunicularWarning, match=OVERLAP):
        scene.crossing("low", "high", stiffness=1e4, name="touch")
    return scene


@pytest.mark.parametrize("initial", ["drawn", "equilibrium", "rest", "state"])
def test_a_drawing_is_noted_in_runs_that_start_from_it(initial):
    scene = crossed()
    rest = scene.equilibrium()
    short = scene.run(duration=1e-3, output_step=1e-3, initial=rest)
    start = {"rest": rest, "state": short.at(1e-3)}.get(initial, initial)
    run = scene.run(duration=1e-3, output_step=1e-3, initial=start)
    assert any(OVERLAP in message for message in run.report["messages"]) == (initial == "drawn")


def over_a_bar(nodes):
    """Return a rope over a thin bar, with nodes at these arc-lengths."""
    scene = Scene()
    scene.cable("rope", start=(-1, 0.011, 0), end=(1, 0.011, 0), element="cable8p", nodes=nodes,
                section=Circle(radius=1e-3), material=SOFT)
    for s in (0, 2):
        scene.pin("rope", s=s)
    scene.surface("bar", Cylinder(radius=0.01, length=0.2, axis=(0, 0, 1)))
    scene.contact("rope", "bar", stiffness=1e4)
    return scene


FINE = [0.9 + 0.01 * k for k in range(21)]


@pytest.mark.parametrize(("nodes", "noted"), [([0, 0.3, 0.6, *FINE, 1.4, 1.7, 2], False),
                                              ([0, 0.3, 0.6, 0.9, 1.1, 1.4, 1.7, 2], True)], ids=["fine", "coarse"])
def test_long_elements_that_do_not_touch_are_not_noted(nodes, noted):
    scene = over_a_bar(nodes)
    coarse = "has contact points that are up to"
    assert any(coarse in message for message in scene.equilibrium().messages) == noted
    run = scene.run(duration=0.02, output_step=0.01, tol=1e-3)
    assert any(coarse in message for message in run.report["messages"]) == noted
