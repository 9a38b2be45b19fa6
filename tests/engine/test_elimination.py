"""Elimination of the border by fronts: the dense solution, with operations in proportion to the number of bodies."""

import bodies
import numpy as np
import pytest
from bodies import chain, ladder, net, tree
from difficult_scenes import SCENES as DIFFICULT
from funicular import Circle, Harmonic, Material, Ramp, Scene
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model import bodies as body_models
from funicular.model import border, elimination
from funicular.model.build import build
from funicular.model.elimination import BorderGraph, eliminated
from funicular.model.redundant_constraints import bridges, joints_in_loops
from linear_cost import SCENES as CABLES
from linear_cost import scene as cables
from shared_scenes import cable_scene

ROPE = {"element": "cable12", "section": Circle(radius=0.01),
        "material": Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000)}


@pytest.fixture
def in_fronts(monkeypatch):
    """Divide every border into all fronts of its graph, at any size."""
    monkeypatch.setattr(border, "MAX_DENSE_BORDER", 0)
    monkeypatch.setattr(elimination, "FRONT_OVERHEAD", 0.0)


def ring() -> Scene:
    """Return eight bodies in a closed ring of universal joints with small rotations, one of them suspended."""
    scene, n = Scene(), 8
    angles = 2 * np.pi * np.arange(n) / n
    for k, angle in enumerate(angles):
        scene.rigid_body(f"A{k}", mass=1.0 + 0.1 * k, inertia=(0.01, 0.02, 0.03),
                         position=(np.cos(angle), np.sin(angle), 0.1 * (-1) ** k))
    for k in range(n):
        middle = angles[k] + np.pi / n
        at = np.array([np.cos(middle), np.sin(middle), 0.0])
        here, there = scene.bodies[f"A{k}"], scene.bodies[f"A{(k + 1) % n}"]
        scene.joint("universal" if k % 2 else "spherical", (here.name, tuple(at - here.position)),
                    (there.name, tuple(at - there.position)), **({"axis": (0, 0, 1), "second_axis": tuple(at)} if k % 2
                                                                 else {}))
    scene.joint("spherical", "A0", tuple(scene.bodies["A0"].position))
    return scene


def four_bar() -> Scene:
    """Return a spatial four-bar linkage with a driven crank, a loop without redundant equations."""
    scene = Scene()
    scene.rigid_body("crank", mass=1.0, inertia=(0.1, 0.1, 0.1), position=(0.1, 0, 0))
    scene.rigid_body("coupler", mass=2.0, inertia=(0.1, 0.2, 0.3), position=(0.6, 0.2, 0))
    scene.rigid_body("rocker", mass=1.5, inertia=(0.1, 0.1, 0.1), position=(1.0, 0.2, 0))
    scene.joint("revolute", (0, 0, 0), ("crank", (-0.1, 0, 0)), axis=(0, 0, 1),
                angle=Ramp(start=0.0, end=0.5, before=0.0, after=1.0))
    scene.joint("spherical", ("crank", (0.1, 0, 0)), ("coupler", (-0.4, -0.2, 0)))
    scene.joint("universal", ("coupler", (0.4, 0.2, 0)), ("rocker", (0, 0.2, 0)), axis=(0, 0, 1),
                second_axis=(0, 1, 0))
    scene.joint("revolute", (1.0, 0, 0), ("rocker", (0, -0.2, 0)), axis=(0, 0, 1))
    return scene


def on_a_cable(kind: str) -> Scene:
    """Return a chain of bodies on a cable, attached by a point, a weld, or a slide with a frame."""
    scene = cable_scene(length=2, pins=(0.0, 2.0), elements=7, **ROPE)
    along = np.array([0.0, -1.0, 0.0])
    end = np.array([0.9, 0.0, 0.0])
    for k in range(12):
        if k:
            end = bodies.rod(scene, f"rod{k}", end, along, (f"rod{k - 1}", tuple(0.05 * along)))
            continue
        scene.rigid_body("rod0", mass=0.1, inertia=(1e-4,) * 3, position=(0.9, -0.05, 0))
        end = end + 0.1 * along
        if kind == "slide":
            scene.slide("rod0", along="wire", s=0.9, at=(0, 0.05, 0), frame="tangent", name="trolley")
        else:
            scene.joint(kind, ("wire", 0.9), ("rod0", (0, 0.05, 0)), **({"up": (0, 1, 0)} if kind == "weld" else {}))
    scene.spring("rod3", "rod7", stiffness=10.0, damping=0.1)
    scene.spring("rod5", ("wire", 1.5), stiffness=10.0, length=0.3)
    scene.force("rod11", value=(1, 0, 2), follower=True, at=(0.1, 0, 0))
    return scene


def driven() -> Scene:
    """Return a chain with joints of every kind, some driven, which hangs from a moving node."""
    scene = cable_scene(length=1, elements=3, **ROPE)
    scene.motion("wire", s=0.0, displacement=("free", Harmonic(amplitude=0.1, frequency=2.0), 0.0))
    kinds = [("revolute", {"axis": (0, 0, 1)}),
             ("revolute", {"axis": (0, 1, 0), "angle": Harmonic(amplitude=0.2, frequency=1)}),
             ("prismatic", {"axis": (1, 0, 0)}), ("cylindrical", {"axis": (1, 0, 0)}), ("weld", {}),
             ("universal", {"axis": (0, 0, 1), "second_axis": (0, 1, 0)}), ("distance", {}),
             ("prismatic", {"axis": (1, 0, 0), "distance": Harmonic(amplitude=0.02, frequency=3)})]
    before = ("wire", 1.0)
    for k, (kind, given) in enumerate([("spherical", {}), *kinds]):
        at = (1.0 + 0.2 * k, 0, 0)
        scene.rigid_body(f"A{k}", mass=0.3, inertia=(0.01, 0.02, 0.03), position=at, angular_velocity=(0, 0, 0))
        end = (f"A{k}", (0, 0, 0) if kind == "distance" or not k else (-0.1, 0, 0))
        scene.joint(kind, before, end, **given)
        before = (f"A{k}", (0.1, 0, 0))
    return scene


def light() -> Scene:
    """Return a chain with nearly massless bodies at every second place, which alone give no pivot."""
    scene, end, along = Scene(), np.zeros(3), np.array([1.0, 0, 0])
    for k in range(16):
        mass = 1.0 if k % 2 else 1e-8
        scene.rigid_body(f"A{k}", mass=mass, inertia=(0.01 * mass,) * 3, position=tuple(end + 0.05 * along))
        scene.joint("revolute" if k % 3 else "spherical", (f"A{k - 1}", (0.05, 0, 0)) if k else (0, 0, 0),
                    (f"A{k}", (-0.05, 0, 0)), **({"axis": (0, 0, 1)} if k % 3 else {}))
        end = end + 0.1 * along
    return scene


SCENES = {"chain": lambda: chain(30), "tree": lambda: tree(30), "ladder": lambda: ladder(20), "net": lambda: net(25),
          "ring": ring, "four-bar": four_bar, "hung": lambda: on_a_cable("spherical"),
          "welded": lambda: on_a_cable("weld"), "riding": lambda: on_a_cable("slide"), "driven": driven, "light": light,
          **DIFFICULT}


def started(model) -> Engine:
    engine = Engine(model)
    engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=GeneralisedAlpha(0.8), first_step=1e-3)
    return engine


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("step", [1e-3, 3e-2])
def test_solution_is_that_of_the_dense_matrix(name, step, in_fronts):
    engine = started(build(SCENES[name]()))
    rng = np.random.default_rng(3)
    _, matrix = engine.linearise(step, 1e-3 * rng.standard_normal(engine.unknowns))
    right = rng.standard_normal(engine.unknowns)
    found, _ = engine.solve(right)
    expected = np.linalg.solve(matrix, right)
    assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
@pytest.mark.parametrize("name", ["tree", "net", "ring", "four-bar", "hung", "welded", "riding", "driven", "loaded"])
def test_motion_is_that_of_the_dense_border(name, integrator, monkeypatch):
    def motion() -> np.ndarray:
        step = 5e-6 if integrator == "explicit" else 5e-4
        run = SCENES[name]().run(duration=8 * step, output_step=8 * step, step=step, integrator=integrator)
        return np.concatenate([run[f"{body}.position"][-1] for body in run.scene.bodies])

    monkeypatch.setattr(border, "MAX_DENSE_BORDER", 10**9)
    dense = motion()
    monkeypatch.setattr(border, "MAX_DENSE_BORDER", 0)
    monkeypatch.setattr(elimination, "FRONT_OVERHEAD", 0.0)
    np.testing.assert_allclose(motion(), dense, rtol=0, atol=1e-12)


@pytest.mark.parametrize("made", [chain, tree])
def test_operations_and_memory_are_linear_in_the_bodies(made):
    models = [build(made(n)) for n in (63, 127, 255)]
    engines = [Engine(model) for model in models]
    for numbers in ([model.newton.operations for model in models], [model.accelerations.operations for model in models],
                    [float(engine.memory) for engine in engines]):
        assert numbers[2] / numbers[1] == pytest.approx(255 / 127, rel=0.06)
    assert max(models[-1].newton.sizes) < 40


@pytest.mark.parametrize("integrator", ["genalpha", "radau"])
def test_least_memory_changes_no_bit(integrator, monkeypatch):
    """Without memory for delayed pivots, Schur complements are moved together where they leave gaps."""
    def positions() -> bytes:
        return net(100).run(0.01, output_step=0.01, step=1e-3 if integrator == "genalpha" else None,
                            integrator=integrator)["breakpoint9_9.position"].tobytes()

    found, memory = positions(), Engine(build(net(100))).memory
    monkeypatch.setattr(elimination, "MAX_DELAYED", 0)
    assert positions() == found
    assert Engine(build(net(100))).memory < memory


def test_a_costly_matrix_serves_more_steps():
    """A factorisation of a net takes as many multiplications as tens of solves, of a chain as four: its matrix is kept
    over more steps, within a part of the error of steps of 1e-6 m."""
    assert build(chain(100)).newton.solves == pytest.approx(4.2, rel=0.01)
    model = build(net(144))
    assert model.newton.solves > 20  # and of 1,024 bodies 64
    ends, factorisations = [], []
    for solves in (0.0, 64.0):
        model.newton.__dict__["solves"] = solves
        engine, _ = bodies.run(model, 40, 1e-3)
        ends.append(np.asarray(engine.state()["q"]).copy())
        factorisations.append(engine.statistics["factorisations"])
    assert factorisations[1] < 0.7 * factorisations[0]
    assert np.abs(ends[1] - ends[0]).max() < 1e-10


def test_few_bodies_stay_dense():
    assert build(chain(6)).newton.n == 1
    assert build(chain(20)).newton.n > 10


def test_an_entry_without_a_place_is_refused(in_fronts):
    """An incomplete graph of the border leads to an error and not to a number."""
    model = build(chain(3))
    lacking = BorderGraph()
    for body in range(3):
        lacking.group(range(6 * body, 6 * body + 6))
    for joint in range(3):
        lacking.group(range(18 + 3 * joint, 21 + 3 * joint), waits=())
    model.newton = lacking.eliminate()
    engine = started(model)
    engine.linearise(1e-3, np.zeros(engine.unknowns))
    with pytest.raises(ArithmeticError):
        engine.solve(np.ones(engine.unknowns))


def test_a_singular_border_is_refused(in_fronts):
    """Bodies without mass rotate about joints at no cost, so that no front has a pivot for them."""
    model = build(chain(8))
    for body in model.bodies:
        body.mass, body.inertia = 0.0, 0.0 * body.inertia
    engine = started(model)
    engine.linearise(1e-3, np.zeros(engine.unknowns))
    with pytest.raises(ArithmeticError):
        engine.solve(np.ones(engine.unknowns))


def doors(n: int) -> Scene:
    """Return a chain of doors on two hinges each; the equations of the second hinge depend on the first."""
    scene = Scene()
    for k in range(n):
        scene.rigid_body(f"door{k}", mass=1.0, inertia=(0.1, 0.1, 0.1), position=(k + 0.5, 0, 0))
        for height in (-0.3, 0.3):
            scene.joint("revolute", (f"door{k - 1}", (0.5, height, 0)) if k else (0, height, 0),
                        (f"door{k}", (-0.5, height, 0)), axis=(0, 1, 0))
    return scene


def test_bodies_held_at_their_mass_centres_turn_alone():
    """Springs, joints of axes and moments on a body, and points beside the mass centre, involve its rotations."""
    made = net(36)
    assert all(body.turns_alone for body in build(made).bodies)
    made.spring("breakpoint0_0", (0, 1, 0), stiffness=1.0)
    made.spring(("breakpoint1_1", (0, 1e-3, 0)), (0, 1, 0), stiffness=1.0)
    made.joint("universal", "breakpoint2_2", (0.2, 0, 0.2), axis=(1, 0, 0), second_axis=(0, 1, 0))
    made.moment("breakpoint3_3", value=(0, 1, 0))
    held = {body.name for body in build(made).bodies if not body.turns_alone}
    assert held == {"breakpoint1_1", "breakpoint2_2", "breakpoint3_3"}


@pytest.mark.parametrize("integrator", ["genalpha", "energy", "radau"])
def test_rotations_by_themselves_change_nothing_but_rounding_and_the_number_of_operations(integrator, monkeypatch):
    made = net(36)
    for name in made.bodies:
        made = made.replace(name, angular_velocity=(1.0, 2.0, 3.0))

    def motion() -> np.ndarray:
        run = made.run(duration=0.05, output_step=0.05, step=5e-3, integrator=integrator)
        return np.array([run[f"{name}.{what}"][-1, :3] for name in made.bodies for what in ("position", "orientation")])

    apart, operations = motion(), build(made).newton.operations
    monkeypatch.setattr(body_models, "_held_in_rotation", lambda scene: set(scene.bodies))
    together = motion()
    assert build(made).newton.operations > 2 * operations
    assert not np.array_equal(apart, together)
    np.testing.assert_allclose(apart, together, rtol=0, atol=1e-11)


def test_redundant_equations_are_left_out_as_of_few_bodies():
    few, many = (doors(n).run(duration=0.02, output_step=0.01, step=1e-3, integrator="genalpha") for n in (2, 12))
    said = few.report["messages"]
    assert len(said) == 2
    assert many.report["messages"][:2] == said
    assert len(many.report["messages"]) == 12
    assert max(many[f"{name}.residual"].max() for name in many.scene.joints) < 1e-12


def test_a_hundred_bodies_keep_their_energy():
    """A tree of 127 bodies and a chain of 100, without numerical damping."""
    for made, n in ((chain, 100), (tree, 127)):
        run = made(n).run(duration=0.05, output_step=0.01, step=1e-3, integrator="genalpha", spectral_radius=1.0)
        total = run["energy.kinetic"] + run["energy.potential"]
        assert np.ptp(total) < 1e-4 * run["energy.kinetic"].max()


@pytest.mark.slow
@pytest.mark.parametrize("name", bodies.SCENES)
def test_a_thousand_bodies_keep_their_energy(name):
    run = bodies.SCENES[name](1000).run(duration=0.05, output_step=0.01, step=1e-3, integrator="genalpha")
    total = run["energy.kinetic"] + run["energy.potential"]
    assert np.ptp(total) < 1e-4 * run["energy.kinetic"].max()


def test_bridges_are_the_edges_without_which_a_graph_falls_apart():
    def parts(n, edges):
        at = list(range(n))
        for a, b in edges:
            at = [at[a] if k == at[b] else k for k in at]
        return len(set(at))

    rng = np.random.default_rng(5)
    for _ in range(60):
        n = int(rng.integers(1, 9))
        edges = [tuple(map(int, pair)) for pair in rng.integers(0, n, (int(rng.integers(0, 11)), 2))]
        expected = [parts(n, edges[:k] + edges[k + 1 :]) > parts(n, edges) for k in range(len(edges))]
        assert bridges(n, edges) == expected


def test_joints_in_loops():
    assert not any(joints_in_loops(build(chain(5))))
    assert joints_in_loops(build(four_bar())) == [True] * 4
    assert joints_in_loops(build(ring())) == [True] * 8 + [False]


@pytest.mark.parametrize("name", CABLES)
def test_cables_alone_have_the_border_that_they_had(name):
    """The riders and ties of a few cables form one front."""
    assert build(cables(name, 60)).newton.n == 1


def test_scenes_of_one_topology_share_the_analysis():
    """The topology does not depend on values; another body or joint changes it."""
    scene = chain(30)
    first, other, longer = build(scene), build(scene.replace(next(iter(scene.bodies)), mass=7.0)), build(chain(31))
    assert first.newton is other.newton and first.accelerations is other.accelerations
    assert longer.newton is not first.newton
    eliminated.cache_clear()
    anew = build(chain(30)).newton
    assert anew is not first.newton
    for name, values in vars(anew).items():
        assert np.array_equal(values, getattr(first.newton, name)), name
