"""Hard cases of hard contact: chatter to rest, grazing, a wedge, a tall box that tips over its edge."""

from math import sqrt

import funicular as fu
import numpy as np
import pytest
from expectations import drift

G = 9.81
WITH_FRICTION = ("explicit", "radau", "genalpha")
INTEGRATORS = (*WITH_FRICTION, "energy")


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("restitution", [0.95, 0.5, 0.05])
def test_chatter_comes_to_rest(integrator, restitution):
    """The bounces of a ball add up to the time t0 (1 + e)/(1 - e), less those that rest_velocity leaves out."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.surface("ground", fu.Plane())
    scene.rigid_body("ball", mass=1e-3, inertia=(1e-8,) * 3, position=(0, 0.1, 0))
    scene.contact("ball", "ground", restitution=restitution, rest_velocity=1e-4)
    run = scene.run(duration=10.0, output_step=0.1, integrator=integrator, tol=1e-4)
    first, e = sqrt(0.2 / G), restitution
    n = int(np.floor(np.log(1e-4 / (G * first)) / np.log(e)))
    events = run.report["events"]
    assert [event["what"] for event in events] == ["struck"] * n + ["came into contact"]
    assert events[-1]["time"] == pytest.approx(first + 2 * first * sum(e**k for k in range(1, n + 1)), abs=1e-9)
    assert np.abs(run["ball.position"][-1]).max() < 1e-12
    assert drift(run) < 1e-15


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("depth", [1e-3, 1e-6, 1e-9, -1e-6])
def test_grazing_contact_is_found_and_a_miss_is_none(integrator, depth):
    peak = 0.5125
    scene = fu.Scene(gravity=(0, G, 0))
    scene.surface("floor", fu.Plane())
    scene.rigid_body("ball", mass=1.0, inertia=(0.01,) * 3, position=(0, G * peak**2 / 2 - depth, 0),
                     velocity=(0, -G * peak, 0))
    scene.contact("ball", "floor", restitution=1.0, rest_velocity=1e-6)
    run = scene.run(duration=1.0, output_step=0.25, integrator=integrator, step=0.25)
    times = [event["time"] for event in run.report["events"] if event["what"] == "struck"]
    assert times == pytest.approx([peak - sqrt(2 * depth / G)] if depth > 0 else [], abs=1e-8)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_ball_falls_into_a_wedge_and_rests_on_both_walls(integrator):
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.surface("left", fu.Plane(normal=(1, 1, 0)))
    scene.surface("right", fu.Plane(normal=(-1, 1, 0)))
    scene.rigid_body("ball", mass=1.0, inertia=(0.01,) * 3, position=(0.05, 0.6, 0))
    for wall in ("left", "right"):
        scene.contact("ball", wall, name=f"on_{wall}", restitution=0.3, radius=0.1)
    run = scene.run(duration=5.0, output_step=0.1, integrator=integrator, tol=1e-6)
    assert run["ball.position"][-1] == pytest.approx([0, 0.1 * sqrt(2), 0], abs=1e-7)
    assert run["on_left.force"][-1] == pytest.approx([G / 2, G / 2, 0], abs=1e-5)
    assert drift(run) < 1e-9


@pytest.mark.parametrize("integrator", WITH_FRICTION)
def test_a_tall_box_on_a_slope_tips_over_its_lower_edge(integrator):
    """Friction holds it, and its weight is beyond the edge: it begins to turn about it."""
    angle = 0.5
    up = np.array([np.cos(angle), np.sin(angle), 0])
    normal = np.array([-np.sin(angle), np.cos(angle), 0])
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.surface("slope", fu.Plane(normal=tuple(normal)))
    half, width = 0.5, 0.1
    scene.rigid_body("box", mass=2.0, inertia=(0.1,) * 3, position=tuple(half * normal),
                     orientation=(np.cos(angle / 2), 0, 0, np.sin(angle / 2)))
    scene.contact("box", "slope", name="foot", restitution=0.0, friction=2.0,
                  points=[(x, -half, z) for x in (-width, width) for z in (-width, width)])
    run = scene.run(duration=0.2, output_step=0.01, integrator=integrator, tol=1e-8)
    moment = 2.0 * G * (half * np.sin(angle) - width * np.cos(angle))
    about_edge = 0.1 + 2.0 * (half**2 + width**2)
    assert run["box.angular_velocity"][1, 2] == pytest.approx(moment / about_edge * 0.01, rel=1e-3)
    edge = half * normal - half * normal - width * up
    lower = run["box.position"] + np.array([
        np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]]) @ np.array([-width, -half, 0])
        for a in 2 * np.arctan2(run["box.orientation"][:, 3], run["box.orientation"][:, 0])])
    assert np.abs(lower - edge).max() < 1e-6
    assert drift(run) < 1e-5
