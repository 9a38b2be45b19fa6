"""Friction of penalty contact acts at the surface of a sphere about a point of a body: rolling, in closed forms."""

import functools
from math import cos, sin, tan

import funicular as fu
import numpy as np
import pytest
from derivatives import at_rest
from expectations import unaccounted
from funicular.base.rotations import rotate
from funicular.engine import Engine
from funicular.model.build import build

INTEGRATORS = ("genalpha", "energy", "explicit", "radau")
MASS, RADIUS, INERTIA, G = 1.0, 0.1, 4e-3, 9.81
"""Of a ball that is 2/5 m r²."""
STIFF = {"stiffness": 2e5}
SUNK = MASS * G / 2e5


def ball(slope=0.0, friction=0.5, law=STIFF, off=0.0, **state):
    """Return a ball on a plane through the origin, its sphere about the centre of mass or another point."""
    normal = np.array([-sin(slope), cos(slope), 0])
    scene = fu.Scene(gravity=(0, -G, 0))
    sunk = SUNK * cos(slope) if law is STIFF else 0.0
    scene.rigid_body("ball", mass=MASS, inertia=(INERTIA,) * 3, position=(RADIUS - sunk) * normal, **state)
    scene.surface("ground", fu.Plane(normal=normal))
    scene.contact("ball", "ground", friction=friction, radius=RADIUS, points=[(off, 0, 0)], **law)
    return scene


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_driven_wheel_rolls(integrator):
    torque, scene = 0.1, ball()
    scene.moment("ball", value=(0, 0, -torque))
    run = scene.run(1.0, output_step=0.25, tol=1e-5, integrator=integrator)
    speed = torque * RADIUS / (INERTIA + MASS * RADIUS**2) * run.time
    assert run["ball.position"][:, 0] == pytest.approx(speed * run.time / 2, abs=5e-5)
    assert run["ball.angular_velocity"][:, 2] == pytest.approx(-speed / RADIUS, abs=0.025)  # it vibrates by this
    assert unaccounted(run) < 1e-4


def test_hard_contact_rolls_alike():
    torque, found = (0.03, 0.02, -0.1), []
    for law in (STIFF, {"restitution": 0.0}):
        scene = ball(law=law, angular_velocity=(0, 3, 0))
        scene.moment("ball", value=torque)
        run = scene.run(0.5, output_step=0.1, tol=1e-7, integrator="radau")
        found.append((run["ball.position"][:, [0, 2]], run["ball.orientation"]))
    for soft, hard in zip(*found, strict=True):
        assert np.abs(hard).max() > 0.05 and np.abs(soft - hard).max() < 5e-5


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_ball_slides_and_ends_rolling_at_five_sevenths(integrator):
    speed, friction = 1.0, 0.2
    run = ball(friction=friction, velocity=(speed, 0, 0)).run(0.4, output_step=0.02, tol=1e-6, integrator=integrator)
    rolls = 2 * speed / (7 * friction * G)  # the time when it stops sliding
    exact = np.where(run.time < rolls, speed - friction * G * run.time, 5 / 7 * speed)
    vibrates = friction * G / np.sqrt(STIFF["stiffness"] * (1 / MASS + RADIUS**2 / INERTIA))
    assert run["ball.velocity"][:, 0] == pytest.approx(exact, abs=1.1 * vibrates)
    assert -RADIUS * run["ball.angular_velocity"][-1, 2] == pytest.approx(5 / 7 * speed, abs=2.5 * 1.1 * vibrates)
    lost = MASS * speed**2 / 7
    assert run["energy.dissipated"][-1] == pytest.approx(lost, rel=2e-3)
    assert unaccounted(run) < 1e-4


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_ball_rolls_down_a_slope_or_slides(integrator):
    slope = 0.3
    for friction in (0.2, 0.05):  # it rolls above 2/7 tan(slope) = 0.088
        run = ball(slope, friction).run(0.5, output_step=0.1, tol=1e-6, integrator=integrator)
        rolls = friction > 2 / 7 * tan(slope)
        acceleration = 5 / 7 * G * sin(slope) if rolls else G * (sin(slope) - friction * cos(slope))
        turn = acceleration / RADIUS if rolls else friction * MASS * G * cos(slope) * RADIUS / INERTIA
        down = -run["ball.position"] @ [cos(slope), sin(slope), 0]
        # until friction has stretched its spring, the ball slides with less friction and is 4e-4 m/s faster
        assert down == pytest.approx(acceleration * run.time**2 / 2, abs=3e-4)
        assert run["ball.angular_velocity"][:, 2] == pytest.approx(turn * run.time, abs=3e-2)  # it vibrates


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_momentum_stays_of_a_ball_that_rolls_on_a_free_plank(integrator):
    """A spinning ball is pressed on a floating plank: friction changes neither momentum nor angular momentum."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("plank", mass=3.0, inertia=(0.2, 0.3, 0.4), position=(0, -0.05, 0), velocity=(0, 0.3, 0))
    scene.rigid_body("ball", mass=MASS, inertia=(INERTIA,) * 3, position=(0.1, RADIUS, 0.02), velocity=(0.2, 0, 0.1),
                     angular_velocity=(5, 2, -10))
    scene.surface("top", fu.Box(size=(2, 0.1, 1)), on="plank")
    scene.contact("ball", "top", friction=0.4, radius=RADIUS, stiffness=2e4)
    run = scene.run(0.1, output_step=0.01, tol=1e-6, integrator=integrator)
    momentum, moment = np.zeros((len(run.time), 3)), np.zeros((len(run.time), 3))
    for body, mass, inertia in (("plank", 3.0, (0.2, 0.3, 0.4)), ("ball", MASS, (INERTIA,) * 3)):
        momentum += mass * run[f"{body}.velocity"]
        moment += mass * np.cross(run[f"{body}.position"], run[f"{body}.velocity"])
        turned = np.array([rotate(a, np.array(inertia) * w) for a, w in
                           zip(run[f"{body}.orientation"], run[f"{body}.angular_velocity"], strict=True)])
        moment += turned
    assert np.abs(run["contact_1.friction_force"]).max() > 1.0
    assert np.ptp(momentum, axis=0).max() < 1e-8 and np.ptp(moment, axis=0).max() < 1e-5
    assert unaccounted(run) < (1e-9 if integrator == "energy" else 1e-3)


@functools.cache
def held(moment):
    """Return the equilibrium of a wheel whose axle a spring holds."""
    scene = ball()
    scene.spring("ball", (-1, RADIUS - SUNK, 0), stiffness=100.0)
    scene.moment("ball", value=(0, 0, -moment))
    return scene.equilibrium()


@pytest.mark.parametrize("moment", [0.02, 0.1])
def test_a_cylinder_is_held_by_friction_at_its_rim(moment):
    rest = held(moment)
    force = moment / RADIUS
    assert rest["ball.position"][0] == pytest.approx(force / 100.0 , abs=1e-6)
    assert rest["contact_1.friction_force"][0] == pytest.approx(force, rel=1e-6)


@pytest.mark.parametrize("friction", [0.5, 0.01])
@pytest.mark.parametrize("shape", ["plane", "sphere", "cylinder", "sphere on a body"])
def test_the_static_matrix_is_the_derivative_of_the_residual(shape, friction):
    """At a state near the drawn one, with sticking or sliding friction."""
    surface = {"plane": fu.Plane(normal=(0.1, 1, 0.05)), "sphere": fu.Sphere(radius=0.3, at=(0.02, -0.3, 0.03)),
               "cylinder": fu.Cylinder(radius=0.3, length=1, at=(0.02, -0.3, 0)),
               "sphere on a body": fu.Sphere(radius=0.3, at=(0.02, -0.1, 0.03))}[shape]
    scene = fu.Scene()
    scene.rigid_body("B", mass=2, inertia=(1, 2, 3), position=(0.1, -0.2, 0), orientation=(0.7, 0.1, 0.5, 0.5))
    scene.surface("s", surface, on="B" if shape.endswith("body") else None)
    scene.rigid_body("ball", mass=MASS, inertia=(INERTIA,) * 3, position=(0, 0.095, 0))
    scene.contact("ball", "s", stiffness=1e4, friction=friction, radius=RADIUS, points=[(0.003, 0, 0.001)])
    engine = Engine(build(scene))
    engine.set_state(0.0)
    engine.move((1e-6 if friction > 0.1 else 1e-3) * np.random.default_rng(3).standard_normal(engine.unknowns))
    kept, matrix = engine.state(), engine.dense_matrix(0, 0, 1)
    error = at_rest(engine, 0.0, kept, 1e-6) - matrix
    assert np.abs(engine.static_outputs("contact")[0, 6]) > 0
    assert np.abs(error).max() < 2e-6 * np.abs(matrix).max()


