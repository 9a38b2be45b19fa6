"""Contact inside a hollow: balls in pipes, spheres and boxes, a rope in a duct; by penalty and hard."""

from math import cos, pi, sqrt

import funicular as fu
import numpy as np
import pytest
from funicular.results.animation.hollows import hollow_mesh
from scipy.special import ellipk

G, R, RADIUS = 9.81, 0.5, 0.1
ARM = R - RADIUS
PIPES = {"pipe": fu.Cylinder(radius=R, length=4.0, axis=(0, 0, 1)), "sphere": fu.Sphere(radius=R),
         "capsule": fu.Capsule(radius=R, length=1.0, axis=(0, 0, 1))}


def ball(shape, angle=0.9, velocity=(0, 0, 0), gravity=(0, -G, 0), **contact):
    """Return a ball of 2 kg in contact with a hollow about the origin, at an angle from its bottom."""
    scene = fu.Scene(gravity=gravity)
    scene.surface("hollow", shape, inside=True)
    scene.rigid_body("ball", mass=2.0, inertia=(0.4 * 2.0 * RADIUS**2,) * 3, velocity=velocity,
                     position=(ARM * np.sin(angle), -ARM * np.cos(angle), 0))
    scene.contact("ball", "hollow", name="touch", radius=RADIUS, **contact)
    return scene


def swings(angle, factor=1.0):
    """Return the period of a pendulum of the length R - r with an inertia larger by a factor."""
    return 4 * sqrt(factor * ARM / G) * ellipk(np.sin(angle / 2) ** 2)


def turning_time(run):
    """Return the time in s of the first return to the starting side."""
    x, t = run["ball.position"][:, 0], run.time
    k = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))[0]  # three quarters of a period
    return (t[k] - x[k] * (t[k + 1] - t[k]) / (x[k + 1] - x[k])) * 4 / 3


@pytest.mark.parametrize("integrator", ["explicit", "radau", "genalpha", "energy"])
@pytest.mark.parametrize("shape", PIPES)
def test_a_ball_slides_in_a_pipe_as_a_pendulum(shape, integrator):
    run = ball(PIPES[shape], restitution=0.0).run(duration=1.4, output_step=1e-3, tol=1e-6, integrator=integrator)
    assert turning_time(run) == pytest.approx(swings(0.9), rel=2e-5)
    assert np.abs(np.linalg.norm(run["ball.position"], axis=1) - ARM).max() < 1e-9
    force = 2.0 * G * (3 - 2 * cos(0.9))  # at the bottom
    assert run["touch.force"][:, 1].max() == pytest.approx(force, rel=1e-4)


def test_a_ball_rolls_in_a_pipe_with_the_inertia_of_its_spin():
    """Rolling increases the inertia to 7/5 of the mass, in hard contact and a stiff penalty."""
    hard = ball(PIPES["pipe"], 0.5, restitution=0.0, friction=0.6)
    stiff = ball(PIPES["pipe"], 0.5, stiffness=4e6, friction=0.6)
    for scene, tol in (hard, 3e-5), (stiff, 2e-4):
        run = scene.run(duration=1.6, output_step=1e-3, tol=1e-6, integrator="radau")
        assert turning_time(run) == pytest.approx(swings(0.5, 7 / 5), rel=tol)


@pytest.mark.parametrize("integrator", ["explicit", "radau", "genalpha", "energy"])
@pytest.mark.parametrize("shape", [*PIPES.values(), fu.Box(size=(1, 1, 1))])
def test_a_ball_that_bounces_about_keeps_its_energy(shape, integrator):
    """By penalty, through edges and corners of the box: 12 J; the ball ends inside."""
    scene = ball(shape, velocity=(1.0, 0.5, 0.2), stiffness=2e4)
    run = scene.run(duration=1.0, output_step=0.01, integrator=integrator, tol=1e-6)
    total = sum(run[f"energy.{part}"] for part in ("kinetic", "elastic", "potential"))
    assert np.ptp(total) < 2e-4 * np.ptp(run["energy.kinetic"])
    assert np.abs(run["ball.position"][:, :2]).max() < ARM + 0.05
    assert "came into contact" in [event["what"] for event in run.report["events"]] or shape.kind != "box"


@pytest.mark.parametrize("restitution", [0.0, 0.9])
def test_a_ball_in_hard_contact_with_a_box_from_within(restitution):
    """It rests on the floor and at the wall on the side of gravity, or bounces off them: one constraint per wall."""
    lean = (3.0, -9.0, 0.0)
    scene = ball(fu.Box(size=(1, 1, 1)), 0.0, gravity=lean, restitution=restitution)
    run = scene.run(duration=2.0, output_step=0.01, tol=1e-6)
    assert np.abs(run["ball.position"]).max() < ARM + 1e-8
    if restitution == 0.0:
        assert run["ball.position"][-1] == pytest.approx((ARM, -ARM, 0), abs=1e-8)
        assert run["touch.force"][-1] == pytest.approx((-6, 18, 0), abs=1e-6)
    else:
        assert np.isclose(run["ball.position"][:, 0].max(), ARM, atol=0.02)


def test_a_corner_by_penalty_bears_as_its_walls_do():
    scene = ball(fu.Box(size=(1, 1, 1)), 0.0, gravity=(3.0, -9.0, 0.0), stiffness=1e4)
    rest = scene.equilibrium()
    assert rest["ball.position"] == pytest.approx((ARM + 6 / 1e4, -ARM - 18 / 1e4, 0), abs=1e-9)


def rope(shape, element="cable12", elements=12, stiffness=1e4):
    """Return a rope of 4 m with its ends on the axis of a duct along x, and its weight per metre."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.surface("duct", shape, inside=True)
    section = fu.Circle(radius=0.02)
    scene.cable("rope", start=(-2, 0, 0), end=(2, 0, 0), elements=elements, element=element, section=section,
                rest_length=4.02, material=fu.Material(youngs_modulus=1e6, poisson_ratio=0.3, density=1500))
    for s in (0, 4.02):
        scene.pin("rope", s=s)
    scene.contact("rope", "duct", stiffness=stiffness, name="touch")
    return scene, 1500 * pi * 0.02**2 * G


DUCTS = {"tube": fu.Cylinder(radius=0.1, length=4.2, axis=(1, 0, 0)),
         "box": fu.Box(size=(4.2, 0.2, 0.3)), "capsule": fu.Capsule(radius=0.1, length=4.2, axis=(1, 0, 0))}


@pytest.mark.parametrize("element", ["cable12", "cable8p"])
@pytest.mark.parametrize("duct", DUCTS)
def test_a_rope_rests_on_the_bottom_of_its_duct(duct, element):
    """It is drawn along the axis, where a tube has no normal. Its middle rests at the penetration of its weight."""
    scene, weight = rope(DUCTS[duct], element)
    rest = scene.equilibrium()
    middle = rest["rope.position"][5:8, 1]
    assert middle == pytest.approx(-(0.1 - 0.02) - weight / 1e4, abs=2e-5)
    held = [rest[f"{name}.force"][1] for name in ("rope@0", "rope@4.02", "touch")]
    assert held[2] > 0.8 * weight * 4.02
    assert sum(held) == pytest.approx(weight * 4.02, rel=1e-6)
    assert not [message for message in rest.messages if "undetected" in message or "beyond" in message]


@pytest.mark.parametrize("integrator", ["radau", "genalpha", "energy"])
def test_a_rope_falls_in_its_duct_with_its_energy_in_balance(integrator):
    scene, _ = rope(DUCTS["tube"], elements=6)
    run = scene.run(duration=0.3, output_step=0.01, tol=1e-4, integrator=integrator)
    total = sum(run[f"energy.{part}"] for part in ("kinetic", "elastic", "potential"))
    assert np.ptp(total) < 5e-3 * np.ptp(run["energy.potential"])
    assert -0.1 < run["rope.position"][..., 1].min() < -0.07
    assert "came into contact" in [event["what"] for event in run.report["events"]]


def test_a_cart_carries_a_hollow():
    """A ball in a pipe on a free cart: the horizontal momentum is constant, and the ball oscillates with the reduced
    mass.
    """
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.rigid_body("cart", mass=3.0, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.joint("prismatic", (0, 0, 0), "cart", axis=(1, 0, 0))
    scene.surface("pipe", PIPES["pipe"], on="cart", inside=True)
    angle = 0.05
    scene.rigid_body("ball", mass=2.0, inertia=(0.4 * 2.0 * RADIUS**2,) * 3,
                     position=(ARM * np.sin(angle), -ARM * np.cos(angle), 0))
    scene.contact("ball", "pipe", restitution=0.0, radius=RADIUS)
    run = scene.run(duration=1.4, output_step=1e-3, tol=1e-7, integrator="radau")
    assert np.abs(3.0 * run["cart.velocity"][:, 0] + 2.0 * run["ball.velocity"][:, 0]).max() < 1e-9
    x = run["ball.position"][:, 0] - run["cart.position"][:, 0]
    k = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))[0]
    period = 4 / 3 * (run.time[k] - x[k] * 1e-3 / (x[k + 1] - x[k]))
    assert period == pytest.approx(2 * pi * sqrt(ARM / G * 3.0 / 5.0) * (1 + 3e-4), rel=5e-4)


def test_a_pipe_is_felt_beyond_its_end_and_a_message_says_so():
    short = fu.Cylinder(radius=R, length=0.4, axis=(0, 0, 1))
    run = ball(short, 0.1, velocity=(0, 0, 1.0), restitution=0.0).run(duration=0.5, tol=1e-4)
    [note] = [message for message in run.report["messages"] if "beyond the end" in message]
    assert '"hollow"' in note and "0.3 m" in note


@pytest.mark.parametrize(("make", "said"), [
    (lambda: fu.Scene().surface("s", fu.Plane(), inside=True), "a plane has no inside"),
    (lambda: fu.Scene().surface("s", fu.HeightField(x=[0, 1], heights=[0, 0]), inside=True), "has no inside"),
    (lambda: ball(fu.Sphere(radius=0.09), stiffness=1e4), r'"ball" does not fit into "hollow": its radius is 0.1 m'),
    (lambda: ball(fu.Box(size=(1, 0.2, 1)), restitution=0.0), r"that of the hollow 0.1 m"),
    (lambda: ball(fu.Sphere(radius=0.3), restitution=0.0), r'"ball" starts 0.2 m below the surface "hollow"'),
])
def test_what_cannot_be_is_refused(make, said):
    with pytest.raises(fu.SceneError, match=said):
        make()


def test_a_hollow_is_in_a_scene_file():
    scene = ball(PIPES["sphere"], stiffness=1e4)
    again = fu.Scene.from_toml(scene.to_toml())
    assert again.surfaces["hollow"].inside and again.surfaces == scene.surfaces


@pytest.mark.parametrize("shape", [*PIPES.values(), fu.Box(size=(1, 2, 3), along=(0.6, 0.8, 0), up=(-0.8, 0.6, 0))])
def test_pictures_show_what_is_inside_of_a_hollow(shape):
    """The mesh lies on the surface, to its corners, and leaves most of it open."""
    vertices, triangles = hollow_mesh(surface := fu.Scene().surface("s", shape, at=(1, 2, 3), inside=True).geometry)
    assert np.abs(surface.distance(vertices + surface.origin)).max() < 0.02 * R
    corners = vertices[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 4
    whole = {"cylinder": 2 * pi * R * 4, "sphere": 4 * pi * R**2, "capsule": 2 * pi * R + 4 * pi * R**2, "box": 22.0}
    assert 0.1 < area / whole[shape.kind] < 0.55
    run = ball(PIPES["pipe"], restitution=0.0).run(duration=0.1, tol=1e-3)
    [drawn] = [body for body in run.animation("falls").clips[0].bodies if body.name == "hollow"]
    assert drawn.shape["kind"] == "mesh"


def catheter(elements):
    """Return a rod of 1.003 m, clamped at both ends 1 m apart, in a tube with 4 mm of clearance."""
    scene = fu.Scene(gravity=(0, -G, 0))
    scene.cable("rod", start=(0, 0, 0), end=(1, 0, 0), rest_length=1.003, elements=elements, element="cable12",
                section=fu.Circle(radius=0.002),
                material=fu.Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1500))
    scene.clamp("rod", s=0.0)
    scene.clamp("rod", s=1.003)
    scene.surface("tube", fu.Cylinder(radius=0.006, length=1.2, axis=(1, 0, 0), at=(0.5, 0, 0)), inside=True)
    scene.contact("rod", "tube", stiffness=1e5, name="wall")
    return scene


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_a_rod_that_buckles_in_its_tube_stays_in_it():
    """Also between its contact points, with long elements, which a note reports."""
    for elements, told in (5, True), (24, False):
        rest = catheter(elements).equilibrium()
        l, u = 1.003 / elements, np.linspace(0, 1, 50)[:, None, None]
        (r, slope), (r_end, slope_end) = (rest["rod.nodal_vectors"][part].transpose(1, 0, 2)
                                          for part in (slice(None, -1), slice(1, None)))
        axis = (r * (1 - 3 * u**2 + 2 * u**3) + l * slope * (u - 2 * u**2 + u**3)
                + r_end * (3 * u**2 - 2 * u**3) + l * slope_end * (u**3 - u**2))
        off = np.linalg.norm(axis[..., 1:], axis=-1)
        assert 0.004 < off.max() < 0.004 + 2 * rest["wall.penetration"]
        assert any("too long" in message for message in rest.messages) == told
        assert -rest["rod@1.003.force"][0] == pytest.approx(rest["rod@0.force"][0], rel=1e-6)
