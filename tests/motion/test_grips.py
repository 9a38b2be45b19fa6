"""Joints and springs that hold to a material point of a rope: grips."""

import funicular as fu
import numpy as np
import pytest
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from funicular.results.animation.frames import place
from funicular.results.animation.sources import of_run, of_scene
from interrupted_runs import killed_and_resumed
from ropes.scenes import on_rope_and_cable, rope_of
from scipy.interpolate import CubicSpline
from test_ropes import momenta

ROPE = {"section": fu.Circle(radius=5e-3),
        "material": fu.Material(youngs_modulus=1e10, poisson_ratio=0.3, density=6000, damping_time=5e-3)}
SETTINGS = {"tol": 1e-4, "output_step": 0.05, "integrator": "radau", "progress": False}
S = 12.0
pytestmark = pytest.mark.filterwarnings("ignore:.*youngs_modulus|.*density:funicular.FunicularWarning")


def hauled(*, elements: int = 4, s: float = S, speed: float = 1.0, divided: bool = False) -> fu.Scene:
    """Return a carriage that hangs from a rope, of which a drum pays out and a weight keeps the tension.

    divided: two ropes end at the carriage in the place of one that it grips.
    """
    scene = fu.Scene()
    scene.rigid_body("weight", mass=300, inertia=(1, 1, 1), position=(20.3, -10, 0))
    drum = fu.Drum("winch", at=(0, 0.2, 0), radius=0.2, side="left", length_in_store=5,
                   velocity=fu.Ramp(start=0.2, end=1.2, after=speed / 0.2))
    sheave = fu.Sheave("top", at=(20, -0.3, 0), radius=0.3, side="right")
    made = {"tension": 300 * 9.81, **ROPE}
    whole = scene.rope("haul", route=[drum, sheave, fu.Anchor("weight")], elements=[elements, 2], **made)
    x, y, _ = whole.point(scene.holders, s)
    if divided:
        scene = fu.Scene()
        scene.rigid_body("weight", mass=300, inertia=(1, 1, 1), position=(20.3, -10, 0))
    scene.rigid_body("carriage", mass=20, inertia=(1, 1, 1), position=(x, y - 0.5, 0))
    held = ("carriage", (0, 0.5, 0))
    if divided:
        scene.rope("haul", route=[drum, fu.Anchor(*held)], elements=elements, **made)
        scene.rope("tail", route=[fu.Anchor(*held), sheave, fu.Anchor("weight")], elements=[elements, 2], **made)
    else:
        scene.joint("spherical", ("haul", s), held, name="grip")
    return scene


def spanned(dim: int = 2, *, load: tuple[float, float, float] = (0, -0.5, 0)) -> fu.Scene:
    """Return a rope between two anchors over a sheave, with a body beside its point at 4 m."""
    scene = fu.Scene()
    rope = scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("top", at=(10, -0.3, 0), radius=0.3),
                                     fu.Anchor(at=(10.3, -5, 0))], tension=2e3, elements=3,
                      element="cable8p" if dim == 2 else "cable12", **ROPE)
    scene.rigid_body("load", mass=20, inertia=(1, 1, 1), position=np.add(rope.point(scene.holders, 4.0), load).tolist())
    return scene


@pytest.mark.slow
def test_a_gripped_carriage_agrees_with_ropes_that_end_at_it():
    """The carriage moves by 4.2 m past ends of elements. In an element the kink at the grip is round: the error falls
    with the length of the elements, which here are 5 to 1.25 m.
    """
    exact = hauled(elements=8, divided=True).run(5.0, **SETTINGS)["carriage.position"]
    errors = [np.abs(hauled(elements=n).run(5.0, **SETTINGS)["carriage.position"] - exact).max() for n in (4, 8, 16)]
    assert errors[0] < 0.14
    assert errors[1] < 0.55 * errors[0] and errors[2] < 0.55 * errors[1]  # measured: .130, .066, .031


@pytest.mark.parametrize("end", [0.02, 0.01])
def test_a_gripped_mass_agrees_with_one_on_a_cable(end):
    """A mass on a heavy rope of 10 m falls by .27 m as on a cable; beside it a sheave of 1 cm and a length `end` are
    left out. The difference is in proportion to both.
    """
    radius, at, runs = 0.01, 4.0, []
    rope, cable, line = on_rope_and_cable(end, radius)
    for scene in (rope, cable):
        scene.rigid_body("load", mass=20, inertia=(1, 1, 1), position=line.point(rope.bodies, at).tolist())
        scene.joint("spherical", ("line", at), "load", name="grip")
        runs.append(scene.run(1.0, **SETTINGS))
    position, other = (run["load.position"] for run in runs)
    assert np.ptp(other[:, 1]) > 0.25
    assert np.abs(position - other).max() < 1.5e-2 * (end + radius / 2)  # measured: 2.2e-4 and 1.3e-4 m
    assert np.abs(runs[0]["grip.force"] - runs[1]["grip.force"]).max() < 2e-3 * np.abs(runs[1]["grip.force"]).max()


@pytest.mark.parametrize(("integrator", "bound"), [("radau", 1e-6), ("genalpha", 1e-6)])
@pytest.mark.slow_cases("radau-1e-06")
def test_passing_ends_of_elements_keeps_energy(integrator, bound):
    """A carriage passes several ends of elements of 1.25 m. The joint holds, and energy is explained."""
    run = hauled(elements=16).run(5.0, **SETTINGS | {"integrator": integrator})
    reference = hauled(elements=16).run(5.0, **SETTINGS | {"tol": 1e-6})
    assert np.abs(run["carriage.position"] - reference["carriage.position"]).max() < 5e-5
    assert run["grip.residual"].max() < 1e-9
    assert np.abs(run.energy_balance().relative).max() < bound
    assert [each.partition(":")[2][:15] for each in run.report["messages"]] == [' drum "winch": ']  # it bends


@pytest.mark.parametrize("kind", ["spherical", "distance", "spring"])
@pytest.mark.slow_cases("spherical", "distance")
def test_integrators_agree(kind):
    """Those with Newton's method and the explicit one, whose equations for accelerations differ."""
    scene = spanned(load=(0, -2.0, 0) if kind != "spherical" else (0, -0.5, 0))
    held = ("load", (0, 0.5, 0)) if kind == "spherical" else "load"
    if kind == "spring":
        scene.spring(("line", 4.0), held, stiffness=2e3, damping=20.0, length=1.9)
    else:
        scene.joint(kind, ("line", 4.0), held)
    runs = [scene.run(0.1, **SETTINGS | {"integrator": name, "tol": 1e-6, "output_step": 0.01})
            for name in ("radau", "genalpha", "explicit")]
    places = [run["load.position"] for run in runs]
    moved = np.ptp(places[0], axis=0).max()
    assert moved > 0.01
    for other in places[1:]:
        assert np.abs(other - places[0]).max() < 1e-4 * moved


def test_momentum_is_kept():
    """A rope over a sheave on a free body, with bodies at its ends and one that grips it, under constant forces."""
    scene, free = fu.Scene(gravity=(0, 0, 0)), {}
    for name, mass, start, force in (("A", 2.0, (-0.2, -1.5, 0), (0, -50, 0)), ("B", 2.5, (0.2, -1.5, 0), (0, -50, 0)),
                                     ("C", 3.0, (0, 0, 0), (0, 105, 0)), ("D", 1.0, (0.7, -0.8, 0), (15, 0, 0))):
        scene.rigid_body(name, mass=mass, inertia=(1, 1, 0.1), position=start, velocity=(0.3, -0.2, 0))
        scene.force(name, value=force)
        free[name] = mass, np.array(force)
    rope = scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("top", at="C", radius=0.2, side="right"),
                                     fu.Anchor("B")], tension=50.0, elements=3, **rope_of(2e4, 0.1, 0, 1e-4))
    end = scene.route_of(rope).arc_lengths(0.0)[1]
    scene.joint("distance", ("rope", 0.5 * sum(end)), ("D", (-0.1, 0, 0)), name="grip")
    run = scene.run(0.3, **SETTINGS | {"tol": 1e-7})
    assert np.ptp(run["D.position"][:, 0] - 0.3 * run.time) > 0.1 and np.abs(run["grip.force"]).max() > 1.0
    found = np.array([momenta(scene, run, k) for k in range(len(run.time))])
    total = sum(force for _, force in free.values())[:2]
    assert np.abs(found[:, :2] - found[0, :2] - np.outer(run.time, total)).max() < 1e-9 * np.abs(found).max()
    moment = sum(np.cross(run[f"{name}.position"], force)[:, 2] for name, (_, force) in free.items())
    turned = CubicSpline(run.time, moment).antiderivative()(run.time)
    assert np.abs(found[:, 2] - found[0, 2] - turned).max() < 1e-4 * np.ptp(turned)  # by a spline over the output


@pytest.mark.parametrize("integrator", ["radau", "genalpha"])
@pytest.mark.parametrize(("s", "speed", "end"), [(7.0, -1.0, 'drum "winch"'), (22.5, 1.0, 'sheave "top"')])
def test_a_grip_that_reaches_a_tangent_point_ends_the_run(integrator, s, speed, end):
    scene = hauled(s=s, speed=speed)
    with pytest.raises(fu.RopeLeftError, match=rf'joint "grip" holds rope "haul" at s = {s:g} m, which reaches {end}') \
            as caught:
        scene.run(5.0, **SETTINGS | {"integrator": integrator})
    run = caught.value.run
    assert 2.5 < run.time[-1] < 4.0
    if speed < 0:
        assert run["winch.length_in_store"][-1] == pytest.approx(s, abs=1e-9)
    assert np.abs(run["carriage.position"][-1, 0] - (20 if speed > 0 else 0)) < 0.5


def test_at_rest():
    """A gripped carriage at rest pulls by its weight, and stays where it is."""
    scene = hauled(speed=0.0)
    rest = scene.equilibrium()
    assert rest["grip.force"] == pytest.approx([0, 20 * 9.81, 0], abs=1e-9)
    assert rest["carriage.position"][1] < -0.8
    run = scene.run(1.0, **SETTINGS, initial=rest)
    assert np.abs(run["carriage.position"] - rest["carriage.position"]).max() < 1e-9


def test_at_rest_on_a_sheave_is_refused():
    """The rope as drawn has too little tension, so that 7 cm of it run over the sheave, and with them the grip. Whether
    the search ends with the grip at the sheave or with the rope off it depends on the rounding of the machine.
    """
    scene = fu.Scene()
    scene.rigid_body("weight", mass=300, inertia=(1, 1, 1), position=(20.3, -10, 0))
    scene.rigid_body("load", mass=1, inertia=(1, 1, 1), position=(19.9, -1, 0))
    rope = scene.rope("haul", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("top", at=(20, -0.3, 0), radius=0.3),
                                     fu.Anchor("weight")], tension=100.0, elements=2, **ROPE)
    drawn = scene.route_of(rope)
    scene = scene.replace("haul", length=drawn.free_length)
    end = drawn.arc_lengths(0.0)[0][1]
    scene.spring(("haul", end - 0.03), "load", stiffness=100.0, name="hanger")
    with pytest.raises(fu.EquilibriumError, match=r'spring "hanger" holds rope "haul" at s = .*, which '
                       r'reaches sheave "top"|the rope leaves sheave "top"'):
        scene.equilibrium()


def test_modes_are_those_of_small_vibrations():
    """The sway of the carriage and the vibrations of the rope: a run from a state displaced by a mode repeats it."""
    scene = spanned()
    scene.joint("spherical", ("line", 4.0), ("load", (0, 0.5, 0)), name="grip")
    rest = scene.equilibrium()
    modes = scene.modes(2, rest)
    k = int(np.argmax(np.abs(modes["load.displacement"][:, 1])))
    shape, amplitude = modes["load.displacement"][k, 1], 1e-4
    start = {"load.position": rest["load.position"] + amplitude * modes["load.displacement"][k],
             "line.coordinates": rest["line.coordinates"]}
    duration = 2 / modes.frequency[k]
    run = scene.run(duration, initial=fu.InitialState(start), **SETTINGS | {"tol": 1e-6, "output_step": duration / 100})
    moved = run["load.position"][:, 1] - rest["load.position"][1]
    period = np.fft.rfftfreq(101, duration / 100)[1:][np.argmax(np.abs(np.fft.rfft(moved - moved.mean()))[1:])]
    assert period == pytest.approx(modes.frequency[k], rel=0.05) and shape


def test_a_planar_scene_and_its_twin_in_space():
    """A force pulls the load from rest. In space tangent points take the sag of the rope into account, 1e-4 m here."""
    places = []
    for dim in (2, 3):
        scene = spanned(dim)
        scene.joint("spherical", ("line", 4.0), ("load", (0, 0.5, 0)), name="grip")
        scene.force("load", value=(50, -200, 0), scale=fu.Pulse(start=0.0, end=0.3))
        places.append(scene.run(1.0, initial="equilibrium", **SETTINGS)["load.position"])
    assert np.ptp(places[0][:, 1]) > 0.1
    assert np.abs(places[0] - places[1]).max() < 5e-4


@pytest.mark.parametrize("integrator", ["radau", "genalpha"])
def test_resumed_bit_for_bit(tmp_path, integrator):
    """A run is paused where the carriage has passed the end of an element."""
    scene, settings = hauled(elements=8), SETTINGS | {"duration": 3.0, "integrator": integrator}
    whole = scene.run(**settings)
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 45, **settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_from_a_file(tmp_path):
    scene = hauled()
    (tmp_path / "scene.toml").write_text(scene.to_toml(), encoding="utf-8")
    again = fu.load_scene(tmp_path / "scene.toml")
    assert again.joints["grip"].a.as_given() == ["haul", S]
    settings = SETTINGS | {"output_step": 0.1}
    assert np.array_equal(scene.run(0.5, **settings)["grip.force"], again.run(0.5, **settings)["grip.force"])


@pytest.mark.parametrize(("add", "words"), [
    (lambda scene: scene.joint("spherical", ("haul", 4.0), "carriage"), "a: s of rope \"haul\" must lie within a span"),
    (lambda scene: scene.joint("spherical", ("haul", 5.0), "carriage"), "spans have 5 to 24.9"),
    (lambda scene: scene.joint("spherical", ("haul", 99.0), "carriage"), "off the ends and what is wound, got 99 m"),
    (lambda scene: scene.spring("carriage", ("haul", 25.2), stiffness=1.0), 'b: s of rope "haul" lies on sheave "top"'),
    (lambda scene: scene.joint("spherical", "haul", "carriage"), "needs the stress-free arc-length s there"),
    (lambda scene: scene.joint("spherical", ("haul", (1, 0, 0)), "carriage"), "not a point at"),
    (lambda scene: scene.joint("weld", ("haul", 7.0), "carriage"), 'a weld joint needs axes, and rope "haul" has none'),
    (lambda scene: scene.joint("revolute", ("haul", 7.0), "carriage", angle=0.1), "driven revolute joint needs axes"),
    (lambda scene: scene.joint("spherical", ("haul", 7.0), ("haul", 7.0)), 'joins rope "haul" at s = 7 m to itself'),
    (lambda scene: scene.joint("spherical", ("winch", 7.0), "carriage"), '"winch" is a drum of rope "haul"'),
    (lambda scene: scene.joint("spherical", ("haul", 20.0), "carriage"), "m apart at the start"),
    (lambda scene: scene.pin("haul", s=7.0), "only joints, springs, slides, loads, drags and contacts"),
    (lambda scene: scene.pin("haul", s=7.0), "or that a joint to (\"haul\", s) holds"),
    (lambda scene: scene.replace("haul", tension=2e5), "apart at the start"),
])
def test_refused(add, words):
    with pytest.raises(fu.SceneError) as caught:
        add(hauled())
    assert words in str(caught.value)


def test_refused_where_a_change_moves_a_sheave_over_the_grip():
    """The rope as drawn is longer with more tension in it, so that the grip of a spring comes to lie on the sheave."""
    scene = spanned()
    end = scene.route_of(scene.ropes["line"]).arc_lengths(0.0)[0][1]
    scene.spring(("line", end - 1e-3), "load", stiffness=10.0)
    with pytest.raises(fu.SceneError, match='spring "spring_1": a: s of rope "line" lies on sheave "top"'):
        scene.replace("line", tension=2e4)


def test_drawn_where_it_holds():
    """In pictures the grip is on the line of the rope, which is drawn through points of it, at the carriage."""
    run = hauled().run(3.0, **SETTINGS)
    frames = of_run(run, np.arange(len(run.time)))
    grip = run.scene.joints["grip"]
    on_rope, on_body = place(frames, grip.a), place(frames, grip.b)
    assert np.ptp(on_rope[:, 0]) > 2
    assert np.abs(on_rope - on_body).max() < 0.02  # chords of 1.25 m
    drawn = place(of_scene(run.scene), grip.a)[0]
    assert drawn == pytest.approx(run.scene.ropes["haul"].point(run.scene.holders, S), abs=1e-12)


@pytest.mark.parametrize("system", ["newton", "accelerations"])
def test_cost_is_in_proportion_to_the_elements(system):
    """The grip may be in any element of its span: their nodes are not coupled to each other by that."""
    costs = [getattr(build(hauled(elements=n)), system).cost for n in (16, 32, 64)]
    assert costs[2] - costs[1] < 2.1 * (costs[1] - costs[0])


def test_a_system_in_fronts_is_solved():
    engine = Engine(build(hauled(elements=32)))
    status, _ = engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=GeneralisedAlpha(0.8),
                             first_step=1e-3)
    assert status is None
    rng = np.random.default_rng(3)
    _, matrix = engine.linearise(1e-3, 1e-4 * rng.standard_normal(engine.unknowns))
    right = rng.standard_normal(engine.unknowns)
    found, _ = engine.solve(right)
    assert found == pytest.approx(np.linalg.solve(matrix, right), rel=1e-6, abs=1e-9 * np.abs(found).max())
