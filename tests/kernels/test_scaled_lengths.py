"""Contact is independent of scale: lengths times a factor, masses times its cube, stresses times the factor."""

import funicular as fu
import numpy as np
import pytest

G = 9.81
SIZES = pytest.mark.parametrize("size", [1e-3, 1e4])
pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


def rope(scene, L, start, end, **more):
    scene.cable("rope", start=np.multiply(start, L).tolist(), end=np.multiply(end, L).tolist(), elements=6,
                section=fu.Circle(radius=0.02 * L),
                material=fu.Material(youngs_modulus=1e7 * L, poisson_ratio=0.3, density=1500), **more)
    return scene


def on_a_bed(L, element="cable18"):
    scene = rope(fu.Scene(gravity=(0, -G, 0)), L, (0, 0.05, 0), (3, 1, 0), element=element, rest_length=3.3 * L)
    scene.pin("rope", s=0.0)
    scene.pin("rope", s=3.3 * L)
    scene.surface("bed", fu.Plane())
    scene.contact("rope", "bed", stiffness=1e4 * L, friction=0.3)
    return scene


def in_a_tube(L):
    scene = rope(fu.Scene(gravity=(0, -G, 0)), L, (0, 0, 0), (3, 0, 0), element="cable12", rest_length=3.01 * L)
    scene.pin("rope", s=0.0)
    scene.pin("rope", s=3.01 * L)
    scene.surface("tube", fu.Cylinder(radius=0.1 * L, length=4 * L, axis=(1, 0, 0)), inside=True)
    scene.contact("rope", "tube", stiffness=1e4 * L)
    return scene


def over_a_bar(L):
    scene = rope(fu.Scene(gravity=(0, -G, 0)), L, (0, 0, 0), (3, 0, 0), element="cable8p", rest_length=3.01 * L)
    scene.pin("rope", s=0.0)
    scene.pin("rope", s=3.01 * L)
    scene.crossing("rope", at=(1.3 * L, -0.05 * L, 0), radius=0.03 * L, stiffness=1e4 * L**2, side=(0, 1, 0))
    return scene


def box_on(L, shape=None, **contact):
    """Return a box that falls on its corners and slides."""
    scene = fu.Scene(gravity=(0, -G, 0))
    mass = 4.0 * L**3
    scene.rigid_body("box", mass=mass, inertia=(7e-3 * L**5, 7e-3 * L**5, 8e-3 * L**5),
                     position=(0.1 * L, 0.1 * L, 0.05 * L), velocity=(0.3 * L**0.5, 0, 0.1 * L**0.5),
                     orientation=(0.98, 0.1, 0.1, 0.1386))
    scene.surface("ground", fu.Box(size=(10 * L, 10 * L, 10 * L), at=(0, -5 * L, 0)))
    corners = [(x * L, -0.05 * L, z * L) for x, z in ((-0.05, -0.05), (0.05, -0.05), (0, 0.05))]
    scene.contact("box", "ground", points=corners, **contact)
    return scene


def hard(L):
    return box_on(L, restitution=0.3, friction=0.3, rest_velocity=1e-3 * L**0.5)


def soft(L):
    return box_on(L, stiffness=1e4 * L**2, damping=0.1 / L**0.5, friction=0.3)


MOVING = {"bed": (on_a_bed, "rope"), "tube": (in_a_tube, "rope"), "bar": (over_a_bar, "rope"), "hard": (hard, "box"),
          "soft": (soft, "box")}


@SIZES
@pytest.mark.parametrize("kind", MOVING)
def test_motions_of_scaled_scenes_are_scaled(kind, size):
    """Times scale with the square root of lengths. The steps are equal up to rounding."""
    make, part = MOVING[kind]
    integrator = "explicit" if kind == "hard" else "radau"
    runs = [make(L).run(duration=0.2 * L**0.5, output_step=0.01 * L**0.5, tol=1e-5, integrator=integrator)
            for L in (1.0, size)]
    ways = [(run[f"{part}.position"] - run[f"{part}.position"][0]) / L for run, L in zip(runs, (1, size), strict=True)]
    assert np.abs(ways[1] - ways[0]).max() < 2e-5 * np.abs(ways[0]).max()
    assert len(runs[1].report["events"]) == len(runs[0].report["events"])
    said = [len([each for each in run.report["messages"] if "density" not in each]) for run in runs]
    assert said[0] == said[1]


@SIZES
@pytest.mark.parametrize("kind", ["bed", "tube", "bar"])
def test_states_of_rest_of_scaled_scenes_are_scaled(kind, size):
    make, _ = MOVING[kind]
    one, other = (make(L).equilibrium()["rope.position"] / L for L in (1.0, size))
    assert np.abs(one - other).max() < 1e-7


@SIZES
def test_a_box_in_hard_contact_rests_alike(size):
    """Three points share the weight of the box."""
    def forces(L):
        scene = fu.Scene(gravity=(0, -G, 0))
        scene.rigid_body("box", mass=4.0 * L**3, inertia=(7e-3 * L**5,) * 3, position=(0, 0.05 * L, 0))
        scene.surface("ground", fu.Plane())
        corners = [(x * L, -0.05 * L, z * L) for x, z in ((-0.05, -0.05), (0.05, -0.05), (0, 0.05))]
        scene.contact("box", "ground", name="feet", points=corners, restitution=0.0, friction=0.3)
        scene.spring("box", (0, 1.0 * L, 0), stiffness=10.0 * L**2, length=0.95 * L)
        rest = scene.equilibrium()
        return np.array([*rest["feet.force"] / L**3, *rest["box.position"] / L])
    assert np.abs(forces(size) - forces(1.0)).max() < 1e-6


@SIZES
def test_a_start_of_hard_contact_may_be_below_by_rounding_alone(size):
    for below, allowed in (1e-12, True), (1e-6, False):
        scene = fu.Scene(gravity=(0, -G, 0))
        scene.rigid_body("b", mass=1.0, inertia=(1, 1, 1), position=(0, size * (0.1 - below), 0))
        scene.surface("ground", fu.Plane())
        try:
            scene.contact("b", "ground", restitution=0.5, radius=0.1 * size)
        except fu.SceneError:
            assert not allowed
        else:
            assert allowed
