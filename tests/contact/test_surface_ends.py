"""Contact beyond the ends of a cylinder or the table of a height field is reported; contact within is not."""

import re

import funicular as fu
import numpy as np
import pytest

FIELD = fu.HeightField.of(lambda x: 0.0 * x, np.linspace(-1, 1, 5))
GRID = fu.HeightField(x=[-1, 0, 1], across=[-2, 0, 2], heights=[[0.0] * 3] * 3)
DRUM = fu.Cylinder(radius=0.1, length=0.2, axis=(0, 0, 1))


def told(messages) -> list[float]:
    """Return the reported distance of contact beyond an end, m."""
    return [float(found[1]) for each in messages if (found := re.search(r"up to (\S+) m beyond the (end|table)", each))]


def ball(shape, x=0.0, z=0.0, gravity=(0, 0, 0), **law) -> fu.Scene:
    """Return a scene of a ball that flies at a surface and touches it at x, z."""
    scene = fu.Scene(gravity=gravity)
    scene.surface("ground", shape)
    scene.rigid_body("ball", mass=1.0, inertia=(0.1,) * 3, position=(x, 0.5, z), velocity=(0, -1, 0))
    scene.contact("ball", "ground", points=[(0, 0, 0)], **law or {"stiffness": 1e6})
    return scene


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("law", [{"stiffness": 1e6}, {"restitution": 0.0}, {"restitution": 0.5}])
@pytest.mark.parametrize(("shape", "at", "beyond"), [
    (DRUM, {"z": 5.0}, 4.9), (DRUM, {"z": -0.3}, 0.2), (DRUM, {"z": 0.09}, None), (DRUM, {"z": 0.1}, None),
    (fu.Capsule(radius=0.1, length=0.2, axis=(0, 0, 1)), {"z": 0.15}, None),
    (FIELD, {"x": 3.0}, 2.0), (FIELD, {"x": -0.9}, None), (FIELD, {"z": 9.0}, None),
    (GRID, {"z": 2.5}, 0.5), (GRID, {"x": -1.25, "z": 1.0}, 0.25), (GRID, {"x": 1.0, "z": 2.0}, None)])
def test_contact_between_rows_is_told_where_it_is_beyond(shape, at, beyond, law):
    run = ball(shape, **at, **law).run(0.8, output_step=0.8, progress=False)
    assert any("contact" in event["what"] or event["what"] == "struck" for event in run.events)
    assert told(run.report["messages"]) == ([] if beyond is None else [pytest.approx(beyond, rel=1e-2)])


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize(("z", "beyond"), [(0.3, 0.2), (0.05, None)])
def test_a_cable_that_touches_beyond(z, beyond):
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.surface("drum", DRUM)
    scene.cable("rope", start=(-0.5, 0.3, z), end=(0.5, 0.3, z), elements=12, element="cable12", velocity=(0, -1, 0),
                section=fu.Circle(radius=0.01),
                material=fu.Material(youngs_modulus=1e7, poisson_ratio=0, density=2000))
    scene.contact("rope", "drum", stiffness=1e7)
    run = scene.run(0.25, output_step=0.25, progress=False)
    assert run.events
    assert told(run.report["messages"]) == ([] if beyond is None else [pytest.approx(beyond, rel=1e-2)])


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
@pytest.mark.parametrize("law", [{"stiffness": 1e6}, {"restitution": 0.0}])
@pytest.mark.parametrize(("x", "beyond"), [(1.5, 0.5), (0.5, None)])
def test_a_state_of_rest_beyond_a_table(x, beyond, law):
    scene = ball(FIELD, x=x, gravity=(0, -9.81, 0), **law)
    for across in ((1, 0, 0), (0, 0, 1)):
        scene.spring("ball", tuple(np.array([x, 0.01, 0]) + across), stiffness=100.0, length=1.0)
    assert told(scene.equilibrium().messages) == ([] if beyond is None else [pytest.approx(beyond, rel=1e-2)])
