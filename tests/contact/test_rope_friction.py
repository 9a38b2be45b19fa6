"""Friction of ropes on surfaces, and surfaces of bodies below ropes."""

import funicular as fu
import numpy as np
import pytest
from derivatives import of_a_step
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from interrupted_runs import check_file_and_resume
from ropes.scenes import on_rope_and_cable, rope_of
from test_grips import SETTINGS
from test_ropes import momenta

pytestmark = pytest.mark.filterwarnings("ignore:.*youngs_modulus|.*density|contact:funicular.FunicularWarning")
ELEMENT = {2: "cable8p", 3: "cable12"}
ROPE = rope_of(2e4, 0.5, 0, 1e-3)
BED = {"radius": 0.02, "stiffness": 2e4, "name": "bed"}


def on_sled(dim: int = 2, *, friction: float = 0.3, velocity: float = 1e-3, damping: float = 0.5, mass: float = 5.0,
            shape: fu.Surface | None = None, move=(0.3, 0.5, 0.2), flat: bool = False) -> fu.Scene:
    """Return a rope over two sheaves, hauled by a weight, and a sled that flies against it from below.

    flat: along the plane of the rope.
    """
    scene, spatial = fu.Scene(), float(dim == 3 and not flat)
    scene.rigid_body("weight", mass=8.0, inertia=(1, 1, 1), position=(6.6, 2, 0))
    scene.rigid_body("sled", mass=mass, inertia=(1, 2, 3), position=(2.5, -0.4, 0.1 * spatial),
                     velocity=(*move[:2], move[2] * spatial), angular_velocity=(0.2 * spatial, 0.1 * spatial, 0.1))
    scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("foot", at=(6, 0.2, 0), radius=0.2, side="left"),
                              fu.Sheave("top", at=(6.4, 3, 0), radius=0.2, side="right"), fu.Anchor("weight")],
               tension=60.0, elements=[12, 3, 2], element=ELEMENT[dim], **ROPE)
    scene.surface("deck", shape or fu.Plane(point=(0, 0.385, 0)), on="sled")
    scene.contact("line", "deck", friction=fu.Friction(coefficient=friction, velocity=velocity), damping=damping, **BED)
    return scene


@pytest.mark.parametrize("shape", [None, fu.Sphere(0.42)])
@pytest.mark.parametrize(("friction", "damping"), [(0.0, 0.0), (0.0, 0.5), (0.3, 0.0), (0.3, 0.5)])
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.slow_cases("3-0.3-0.5-None", "3-0.3-0.0-None", "3-0.0-0.0-None", "3-0.0-0.5-None")
def test_tangent(dim, friction, damping, shape):
    """Derivatives by the rope, by the body of the surface, and of the reaction on it."""
    scene = on_sled(dim, friction=friction, damping=damping, velocity=0.1, shape=shape)
    engine = Engine(build(scene))
    engine.start(duration=1.0, output_step=1.0, tol=1e-6, step=0.02, first_step=0.02, method=GeneralisedAlpha(0.8))
    at = 1e-4 * np.random.default_rng(1).standard_normal(engine.unknowns)
    matrix = engine.linearise(0.02, at)[1]
    without = Engine(build(scene.without("bed")))
    without.start(duration=1.0, output_step=1.0, tol=1e-6, step=0.02, first_step=0.02, method=GeneralisedAlpha(0.8))
    contact = np.abs(matrix - without.linearise(0.02, at)[1]).max()
    assert contact > 1e-3 * np.abs(matrix).max()  # it is in contact
    assert np.abs(of_a_step(engine, 0.02, at, 1e-7) - matrix).max() < 1e-7 * np.abs(matrix).max()


@pytest.mark.parametrize("integrator", ["radau", "genalpha", "explicit"])
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.slow_cases("3-explicit", "3-radau", "2-genalpha")
def test_energy_on_a_moving_body(dim, integrator):
    """The sled is thrown back by the rope, which drags it along."""
    run = on_sled(dim, velocity=0.02).run(0.3, **SETTINGS | {"integrator": integrator, "tol": 1e-5,
                                                            "output_step": 0.01})
    assert np.abs(run["bed.friction_force"][:, 0]).max() > 100 and run["bed.touching"].max() > 1
    assert run["energy.dissipated"][-1] > 0.5
    assert np.abs(run.energy_balance().relative).max() < 2e-5


def hauled(mu: float, *, elements: int = 12, dim: int = 2, weights=(20.0, 12.0), velocity: float = 1e-3,
           speed: float = 2.0, mass: float = 0.5) -> fu.Scene:
    """Return a rope that two bodies pull up from below two sheaves, between which it runs 4 m along the ground."""
    scene = fu.Scene()
    for name, x, m, v in (("A", 4.1, weights[0], speed), ("B", -0.1, weights[1], -speed)):
        scene.rigid_body(name, mass=m, inertia=(1, 1, 1), position=(x, 4, 0), velocity=(0, v, 0))
        scene.force(name, value=(0, 2 * 9.81 * m, 0))
    scene.rope("line", route=[fu.Anchor("B"), fu.Sheave("left", at=(0, 0.1, 0), radius=0.1, side="left"),
                              fu.Sheave("right", at=(4, 0.1, 0), radius=0.1, side="left"), fu.Anchor("A")],
               tension=150.0, elements=[2, elements, 2], element=ELEMENT[dim], **rope_of(2e6, mass, 0, 1e-3))
    scene.surface("ground", fu.Plane(point=(0, -0.02, 0)))
    scene.contact("line", "ground", stiffness=2e4, radius=0.02, damping=1.0, name="bed",
                  friction=fu.Friction(coefficient=mu, velocity=velocity))
    return scene


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.slow_cases("3")
def test_a_hauled_rope_has_the_friction_of_its_weight(dim):
    """The material moves past the nodes, which stay. Two weights then accelerate by the difference of their weights, of
    the ropes beside them, and mu times the force on the ground.
    """
    mu, m = 0.4, (20.0, 12.0)
    run = hauled(mu, dim=dim).run(0.3, **SETTINGS | {"tol": 1e-6, "output_step": 0.01})
    normal, friction = run["bed.force"][:, 1], run["bed.friction_force"][:, 0]
    late = run.time > 0.15
    assert normal[late].mean() == pytest.approx(0.5 * 9.81 * 4, rel=0.1)
    assert friction[late] == pytest.approx(-mu * normal[late], rel=1e-5)
    fell = np.polynomial.Polynomial.fit(run.time[late], run["A.position"][late, 1], 2).deriv(2)(0)
    y = run["A.position"][late, 1].mean() - run["B.position"][late, 1].mean()
    pull = 9.81 * (m[0] - m[1] - 0.5 * y) - mu * normal[late].mean()
    whole = sum(m) + 0.5 * 12.0
    assert fell == pytest.approx(pull / whole, rel=0.02)
    assert np.abs(run.energy_balance().relative).max() < 1e-5


@pytest.mark.parametrize("along", [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0)])
@pytest.mark.slow_cases("along0")
def test_agrees_with_a_cable(along):
    """A sled decelerates below a rope, whose tension friction changes. The difference from a cable is in proportion to
    the length beside the sheave, into which the rope slides.
    """
    errors = []
    for end in (0.02, 0.01):
        runs = []
        for scene in on_rope_and_cable(end)[:2]:
            scene.rigid_body("sled", mass=5.0, inertia=(1, 1, 1), position=(5, -1, 0), velocity=along)
            scene.joint("prismatic", (5, -1, 0), "sled", axis=(1, 0, 0))
            scene.surface("deck", fu.Plane(point=(0, 0.975, 0)), on="sled")
            scene.contact("line", "deck", stiffness=1e4, radius=0.02, damping=0.5, name="bed", friction=fu.Friction(
                coefficient=0.4, velocity=1e-3) if scene.ropes else 0.4)
            runs.append(scene.run(0.25, **SETTINGS | {"tol": 1e-5}))
        rope, cable = runs
        assert cable["sled.velocity"][-1, 0] * along[0] < 0.5
        assert np.abs(rope.energy_balance().relative).max() < 1e-4
        errors.append(np.abs(rope["sled.velocity"] - cable["sled.velocity"]).max())
    assert errors[0] < 1e-2 and errors[1] < 1e-3


@pytest.mark.parametrize("friction", [
    fu.Friction(coefficient=0.0, velocity=1e-2), fu.Friction(coefficient=0.3, velocity=1e-2),
    fu.Friction(coefficient=0.3, model="stick")], ids=["smooth", "regularised", "sticking"])
def test_momentum_with_a_free_body(friction):
    """A rope between free bodies, over a sheave on one of them, meets a free sled: both momenta and their moment are
    kept to rounding.
    """
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, at, v in (("A", (0, 0, 0), (-0.1, 0, 0)), ("carrier", (4, 0.1, 0), (0, 0, 0)),
                        ("B", (4.1, 3, 0), (0, 0.1, 0))):
        scene.rigid_body(name, mass=200.0, inertia=(5, 5, 5), position=at, velocity=v)
    scene.rigid_body("sled", mass=4.0, inertia=(0.5, 0.5, 0.5), position=(2, -0.4, 0), velocity=(0.7, 1.0, 0),
                     angular_velocity=(0, 0, 0.2))
    scene.rope("line", route=[fu.Anchor("A"), fu.Sheave("top", at="carrier", radius=0.1, side="left"), fu.Anchor("B")],
               tension=100.0, elements=[8, 4], **ROPE)
    scene.surface("deck", fu.Cylinder(0.3, 1.0), on="sled")
    scene.contact("line", "deck", friction=friction, damping=0.1, **BED)
    run = scene.run(0.25, **SETTINGS | {"tol": 1e-6, "integrator": "explicit"})
    assert run["bed.force"][:, 1].max() > 5 and (run["bed.friction_force"].any() == (friction.coefficient > 0))
    before, after = (momenta(scene, run, k) for k in (0, -1))
    assert np.ptp(run["sled.velocity"][:, 1]) > 0.2
    assert np.abs(after - before).max() < 1e-11


@pytest.mark.slow
def test_a_planar_scene_and_its_twin_in_space():
    runs = [on_sled(dim, flat=True).run(0.3, **SETTINGS | {"tol": 1e-6}) for dim in (2, 3)]
    assert runs[0]["bed.touching"].max() > 1
    assert np.abs(runs[0]["sled.position"] - runs[1]["sled.position"])[:, :2].max() < 1e-3


def test_resumed_bit_for_bit_and_from_a_file(tmp_path):
    scene = on_sled()
    assert scene.contacts["bed"].friction.model == "regularised"
    check_file_and_resume(scene, tmp_path, 8, **SETTINGS | {"duration": 0.4})


def test_at_rest_there_is_none():
    scene = hauled(0.4, weights=(12.0, 12.0))
    with pytest.warns(fu.FunicularWarning, match='friction of contact "bed" is left out: at rest contacts move freely'):
        rest = scene.equilibrium()
    assert np.abs(rest["bed.friction_force"]).max() == 0 and rest["bed.force"][1] > 10
    with pytest.raises(fu.SceneError, match='contact "bed": its friction is regularised, so that the rope creeps'):
        scene.relax()


@pytest.mark.parametrize(("a", "given", "words"), [
    ("line", {"friction": 0.3, "tangential_stiffness": 1e4}, "takes no tangential_stiffness"),
    ("weight", {"friction": fu.Friction(coefficient=0.3, model="regularised")}, "has no regularised friction"),
])
def test_refused(a, given, words):
    scene = on_sled().without("bed")
    with pytest.raises(fu.SceneError) as caught:
        scene.contact(a, "deck", stiffness=2e4, radius=0.02, **given)
    assert words in str(caught.value)
