"""Boxes as surfaces: distances, a ball and a rope over an edge, planar scenes, pictures, refusals."""

from math import atan2, cos, hypot, pi, sin, sqrt

import funicular as fu
import numpy as np
import pytest
from turned_scenes import turned_scene

G = 9.81
SIZE = (0.4, 0.2, 0.3)
TURNED = {"along": (1, 1, 0.3), "up": (-1, 1, 0)}


def lone(**more):
    return fu.Scene().surface("box", fu.Box(size=SIZE, at=(0.1, -0.2, 0.3), **more))


@pytest.mark.parametrize("axes", [{}, TURNED])
def test_distances_are_those_of_the_nearest_of_many_points_on_its_faces(axes):
    surface, random = lone(**axes), np.random.default_rng(2)
    n = 81
    own = np.array([[a, b, s] for a in np.linspace(-0.5, 0.5, n) for b in np.linspace(-0.5, 0.5, n)
                    for s in (-0.5, 0.5)])
    faces = np.concatenate([np.roll(own, k, axis=1) for k in range(3)]) * SIZE
    drawn = faces @ surface.shape.axes.T + surface.shape.at
    places = random.uniform(-0.6, 0.6, (60, 3)) * np.array(SIZE) * 2
    found = surface.distance(None, places @ surface.shape.axes.T + surface.shape.at)
    nearest = np.array([np.linalg.norm(faces - place, axis=1).min() for place in places])
    inside = np.all(np.abs(places) < np.array(SIZE) / 2, axis=1)
    assert 2 < inside.sum() < 50 and np.abs(surface.distance(None, drawn)).max() < 1e-15
    assert np.array_equal(found < 0, inside) and np.abs(np.abs(found) - nearest).max() < 5e-4


def off_the_edge(hard, radius=0.1, speed=0.3):
    """Return a frictionless ball that slides off the edge x = 0 of a box with its top at y = 0."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.surface("table", fu.Box(size=(1, 0.5, 0.8), at=(-0.5, -0.25, 0)))
    stiffness = 1e6
    sunk = 0 if hard else G / stiffness
    scene.rigid_body("ball", mass=1.0, inertia=(4e-3,) * 3, position=(-0.05, radius - sunk, 0.1),
                     velocity=(speed, 0, 0))
    law = {"restitution": 0.0} if hard else {"stiffness": stiffness, "damping": 1.0}
    scene.contact("ball", "table", radius=radius, name="foot", **law)
    return scene


@pytest.mark.parametrize("hard", [True, False])
def test_a_ball_leaves_an_edge_where_its_weight_turns_it_no_longer(hard):
    """About the edge the ball is a pendulum: v^2/r = g cos a, so that cos a = 2/3 + v0^2/(3 g r)."""
    radius, speed = 0.1, 0.3
    run = off_the_edge(hard, radius, speed).run(0.5, output_step=0.001, tol=1e-7, integrator="radau")
    left = next(event for event in run.report["events"] if event["what"] == "lost contact")
    leaves = 2 / 3 + speed**2 / (3 * G * radius)
    row = int(np.searchsorted(run.time, left["time"]))
    vx = run["ball.velocity"][row + 1, 0]  # of free flight
    exact = sqrt(G * radius * leaves) * leaves
    assert abs(vx / exact - 1) < (1e-6 if hard else 1e-3)
    x = np.interp(left["time"], run.time, run["ball.position"][:, 0])
    assert not hard or abs(x / (radius * sqrt(1 - leaves**2)) - 1) < 1e-5  # a spring lets go where it is unloaded
    assert np.abs(run["ball.position"][:, 2] - 0.1).max() < 1e-12


TENSION, ROUND, PIN, PULL = 50.0, 0.05, np.array([-0.8, 0.25]), np.array([0.6, -0.8])


def over_the_edge(elements=120, stiffness=1e7, element="cable8p"):
    """Return a rope from a pin over the edge x = y = 0 of a box, to a force at its end."""
    scene = fu.Scene(gravity=(0, 0, 0))
    reach = hypot(*PIN)
    first = atan2(-PIN[1], -PIN[0]) + np.arcsin(ROUND / reach)  # of the tangent from the pin over the edge
    normals = np.linspace(first, atan2(PULL[1], PULL[0]), 12) + pi / 2
    arc = ROUND * np.column_stack([np.cos(normals), np.sin(normals)])
    lines = [PIN + t * (arc[0] - PIN) for t in np.linspace(0, 1, 20)[:-1]]
    points = [(*p, 0) for p in [*lines, *arc, *(arc[-1] + t * 0.8 * PULL for t in np.linspace(0, 1, 20)[1:])]]
    rope = scene.cable("rope", points=points, elements=elements, element=element, rest="straight",
                       section=fu.Circle(radius=0.001),
                       material=fu.Material(youngs_modulus=1e9, poisson_ratio=0, density=1000))
    scene.pin(rope, s=0)
    scene.surface("box", fu.Box(size=(0.3, 0.4, 0.5), at=(-0.15, -0.2, 0)))
    scene.contact(rope, "box", stiffness=stiffness, radius=ROUND)
    scene.force(rope, s=rope.length, value=(*(TENSION * PULL), 0))
    return scene, first


def edge_error(**more):
    """Return the error of the force on the rope, relative to its tension: T times the change of its direction."""
    scene, first = over_the_edge(**more)
    found = scene.equilibrium()["contact_1.force"]
    exact = TENSION * (np.array([cos(first), sin(first)]) - PULL)
    turn = first - atan2(PULL[1], PULL[0])
    assert abs(np.linalg.norm(exact) - 2 * TENSION * sin(turn / 2)) < 1e-9
    return float(np.linalg.norm(found[:2] - exact)) / TENSION


@pytest.mark.slow
def test_the_force_of_an_edge_on_a_rope_is_its_tension_times_its_turn():
    soft, meant = edge_error(stiffness=1e6), edge_error()
    assert meant < 1e-3 and meant < 0.5 * soft  # what is left is bending
    assert edge_error(element="cable12") < 1e-3


@pytest.mark.slow
def test_in_a_planar_scene_a_box_is_a_rectangle():
    scene, _ = over_the_edge(elements=30)
    here = scene.equilibrium()
    thin = fu.Box(size=(0.001, 0.3, 0.4), along=(0, 0, 1), up=(1, 0, 0), at=(-0.15, -0.2, 0))  # the same rectangle
    other, _ = over_the_edge(elements=30)
    alike = other.replace("box", shape=thin).equilibrium()
    assert np.abs(alike["rope.position"] - here["rope.position"]).max() < 1e-12


@pytest.mark.slow
def test_a_turned_scene_has_the_same_forces():
    scene, _ = over_the_edge(elements=60)
    here = scene.equilibrium()["contact_1.force"]
    there = turned_scene(scene, (0, -pi / 2, 0), (3, 0, 0)).equilibrium()["contact_1.force"]  # x to z
    assert np.abs(there - here[[2, 1, 0]]).max() < 1e-8 * TENSION


REFUSED = {
    "size": (lambda s: s.surface("box", fu.Box(size=(1, 0, 1))), "size must be three positive lengths"),
    "few": (lambda s: s.surface("box", fu.Box(size=(1, 1))), "size must be"),
    "axes": (lambda s: s.surface("box", fu.Box(size=(1, 1, 1), up=(1, 1, 0))), "along must be square to up"),
    "deep": (lambda s: (s.surface("box", fu.Box(size=(1, 1, 0.001))), rope(s), s.contact("rope", "box")),
             r'"rope" starts 0\.31 m below the surface "box"'),
    "turned": (lambda s: (rope(s), s.surface("box", fu.Box(size=(1, 1, 1), up=(0, 1, 1)))), "leaves the plane z = 0"),
    "aside": (lambda s: (rope(s), s.surface("box", fu.Box(size=(1, 1, 1), at=(0, 0, 0.6)))), "leaves the plane z = 0"),
}


def rope(scene):
    scene.cable("rope", start=(-1, 0.2, 0), end=(1, 0.2, 0), elements=4, element="cable8p",
                section=fu.Circle(radius=0.01),
                material=fu.Material(youngs_modulus=1e7, poisson_ratio=0, density=1000))


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_is_refused(case):
    build_scene, message = REFUSED[case]
    with pytest.raises(fu.SceneError, match=message):
        build_scene(fu.Scene())


def test_pictures_and_files_have_its_axes(tmp_path):
    scene = off_the_edge(True)
    scene.surface("other", fu.Box(size=SIZE, at=(1, -2, 0), **TURNED))
    (tmp_path / "box.toml").write_text(scene.to_toml(), encoding="utf-8")
    assert fu.load_scene(tmp_path / "box.toml").surfaces == scene.surfaces
    drawn = {body.name: body for body in scene.run(0.01, output_step=0.01).animation("it").clips[0].bodies}
    assert drawn["table"].shape["kind"] == "box" and list(drawn["table"].shape["size"]) == [1, 0.5, 0.8]
    corners = np.array(drawn["other"].shape["vertices"]) + drawn["other"].position[0]
    assert np.abs(scene.surfaces["other"].distance(None, corners)).max() < 1e-12
