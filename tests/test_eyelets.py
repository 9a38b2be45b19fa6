"""A point of the ground as the rider: an eyelet through which a cable slides."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused


def cable_through(eyelet, element="cable8p", frame="point", **given):
    scene = fu.Scene()
    wire = scene.cable("wire", start=(0, 0, 0), end=(1, 0, 0), elements=4, element=element,
                       section=fu.Rectangle(height=0.02, width=0.02),
                       material=fu.Material(youngs_modulus=1e6, poisson_ratio=0.0, density=1000), **given)
    if eyelet:
        scene.slide((0.5, 0, 0), along=wire, s=0.5, name="eye", frame=frame)
    else:
        body = scene.rigid_body("B", mass=1.0, inertia=(1, 1, 1), position=(0.5, 0, 0))
        scene.joint("weld", body, (0.5, 0, 0))
        scene.slide(body, along=wire, s=0.5, name="eye", frame=frame)
    return scene


@pytest.mark.parametrize("integrator", ["explicit", "radau", "genalpha"])
@pytest.mark.parametrize(("element", "frame"), [("cable8p", "point"), ("cable12", "tangent"), ("beam24", "tangent"),
                                                ("beam24", "section")])
def test_as_a_body_welded_to_the_ground(integrator, element, frame):
    """With tol genalpha leaves 1e-9 of the scene's size to the steps to come, which is another 1e-9 in another scene;
    fixed steps of scenes with slides are solved to rounding.
    """
    steps = {"step": 1e-3} if integrator == "genalpha" else {"tol": 1e-6}
    runs = [cable_through(eyelet, element, frame, velocity=(0.3, 0, 0)).run(
        duration=0.1, output_step=0.02, integrator=integrator, **steps) for eyelet in (True, False)]
    for name in ("eye.s", "wire.position", "eye.force"):
        one, other = (run[name] for run in runs)
        np.testing.assert_allclose(one, other, atol=1e-10 * np.abs(other).max())
    assert np.ptp(runs[0]["eye.s"]) > 0.02


def test_equilibrium_over_an_eyelet():
    """A cable from a pin through an eyelet, pulled by a force at its other end: what acts on it adds up to nothing."""
    scene = cable_through(True)
    scene.pin("wire", s=0.0)
    scene.force("wire", s=1.0, value=(20, -20, 0))
    rest = scene.equilibrium()
    force = rest["eye.force"]
    r = rest["wire.nodal_vectors"]
    weight = 1000 * 0.02**2 * 1.0 * 9.81
    np.testing.assert_allclose(rest["wire@0.force"] - force + [20, -20 - weight, 0], 0, atol=1e-6)
    assert 0.5 > float(rest["eye.s"]) > 0.4 and r[-1, 0, 1] < -0.2


def test_written_to_a_file_and_read_back():
    text = cable_through(True).to_toml()
    assert "body = [0.5, 0.0, 0.0]" in text
    assert fu.Scene.from_toml(text).to_toml() == text


@pytest.mark.parametrize(("given", "message"), [
    ({"body": (0.5, 0.3, 0)}, 'slide "ground_on_wire": the point of the ground at (0.5, 0.3, 0) m is 0.3 m away from '
     'cable "wire" at s = 0.5 m; slide from s = 0.5 m'),
    ({"body": (0.5, 0, 0), "at": (0, 1, 0)}, "slide: body is a point of the ground and takes no at; leave at out"),
    ({"body": None}, "slide: body is missing; give a body, (cable, s), or a point (x, y, z) of the ground"),
    ({"body": (0.5, 0, 0), "name": "twin"}, 'slide "twin": puts the same point of the ground on cable "wire" as slide '
     '"eye"; leave one of them out, or give them different points at'),
])
def test_refused(given, message):
    with refused(message):
        cable_through(True).slide(**{"along": "wire", "s": 0.5} | given)
