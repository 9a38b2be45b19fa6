"""The rounding of distances in contacts and joints is relative to the lengths from which they are computed."""

from math import hypot

import funicular as fu
import numpy as np
import pytest

POINTS = [(-.05, -.05, -.05), (.05, -.05, -.05), (0, -.05, .05)]
SHAPE_SIZE = 1e3
"""m: the radius of round surfaces; over 0.1 m they are flat to 5e-6 m, and turn by 1e-4."""
FLAT = {
    "box": fu.Box(size=(10, 10, 10), at=(0, -5, 0)),
    "large box": fu.Box(size=(100, 2 * SHAPE_SIZE, 100), at=(0, -SHAPE_SIZE, 0)),
    "turned box": fu.Box(size=(10, 10, 10), at=(0, -5, 0), along=(0.6, 0, 0.8)),
    "plane from afar": fu.Plane(point=(3000, 0, -2000)),
    "height field": fu.HeightField(x=[-5, 0, 5], heights=[0, 0, 0]),
    "two-way height field": fu.HeightField(x=[-5, 0, 5], across=[-3, 3], heights=[[0, 0]] * 3),
}
ROUND = {
    "sphere": fu.Sphere(radius=SHAPE_SIZE, at=(0, -SHAPE_SIZE, 0)),
    "cylinder": fu.Cylinder(radius=SHAPE_SIZE, length=10, at=(0, -SHAPE_SIZE, 0)),
    "capsule": fu.Capsule(radius=SHAPE_SIZE, length=10, at=(0, -SHAPE_SIZE, 0)),
}


def slid(shape, integrator="radau", radius=0.0):
    """Return the displacements (time, 3) of a body on three feet that falls on a surface in y = 0, slides and tips."""
    scene = fu.Scene()
    scene.rigid_body("b", mass=4.0, inertia=(7e-3, 7e-3, 8e-3), position=(.1, .1, .05), velocity=(.3, 0, .1),
                     orientation=(.98, .1, .1, .1386))
    scene.surface("g", shape)
    scene.contact("b", "g", restitution=0.0, friction=0.3, radius=radius, points=POINTS)
    run = scene.run(duration=0.6, tol=1e-4, integrator=integrator)
    assert run.status == "completed"
    return run["b.position"] - run["b.position"][0]


@pytest.mark.parametrize("shapes, share, integrator", [
    *((FLAT, share, name) for name, share in {"radau": 0.1, "genalpha": 0.2, "explicit": 0.1}.items()),
    *((ROUND, 10.0, name) for name in ("radau", "explicit"))], ids=lambda each: each if isinstance(each, str) else None)
def test_a_body_slides_alike_over_all_surfaces_that_are_flat_there(shapes, share, integrator):
    """Differences relative to tol: rounding between flat surfaces; the slope of 1e-4 over 0.6 s on round ones."""
    plane = slid(fu.Plane(), integrator)
    for name, shape in shapes.items():
        assert np.abs(slid(shape, integrator) - plane).max() < share * 1e-4 * np.abs(plane).max(), name


def test_balls_about_the_points_slide_over_a_box_as_over_a_plane():
    """The first points stick after 0.09 s."""
    plane, box = (slid(shape, radius=0.01) for shape in (fu.Plane(), FLAT["box"]))
    assert np.abs(box - plane).max() < 1e-5 * np.abs(plane).max()


@pytest.mark.parametrize("integrator", ["radau", "genalpha", "explicit"])
@pytest.mark.parametrize("arm", [10.0, 1e4])
def test_a_pendulum_whose_mass_is_drawn_at_the_origin_swings(arm, integrator):
    """The gap of the joint is rounded relative to the arm. The energy is m v^2/2 + J w^2/2 = m g times the fall."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("b", mass=1.0, inertia=(1e-3,) * 3, position=(0, 0, 0))
    scene.joint("spherical", (-.8 * arm, .6 * arm, 0), ("b", (-.8 * arm, .6 * arm, 0)))
    run = scene.run(duration=1.0, tol=1e-6, integrator=integrator)
    x, y, _ = (run["b.position"] - (-.8 * arm, .6 * arm, 0)).T
    assert np.abs(np.hypot(x, y) - arm).max() < 1e-12 * arm
    speed = hypot(*run["b.velocity"][-1][:2])
    assert speed**2 * (1 + 1e-3 / arm**2) == pytest.approx(-2 * 9.81 * run["b.position"][-1][1], rel=1e-5)
