"""Slides on ropes: riders whose place along the rope is a material coordinate, in motion and at rest."""

import funicular as fu
import numpy as np
import pytest
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from funicular.results.animation.frames import place
from funicular.results.animation.marks import slide_place
from funicular.results.animation.sources import of_run
from interrupted_runs import killed_and_resumed
from ropes.scenes import on_rope_and_cable, rope_of
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from test_grips import ROPE, SETTINGS
from test_ropes import momenta

S = 12.0
pytestmark = pytest.mark.filterwarnings("ignore:.*youngs_modulus|.*density|.*initial velocities:"
                                        "funicular.FunicularWarning")


def hauled(*, elements: int = 8, s: float = S, speed: float = 0.0, along: float = 2.0, holds: str = "slide",
           **slide) -> fu.Scene:
    """Return a carriage on a rope between a drum, which pays out at a speed, and a sheave with a weight beyond.

    along: speed of the carriage, m/s; holds: "slide", "grip", or "" for what holds it to the rope.
    """
    scene = fu.Scene()
    scene.rigid_body("weight", mass=300, inertia=(1, 1, 1), position=(20.3, -10, 0))
    drum = fu.Drum("winch", at=(0, 0.2, 0), radius=0.2, side="left", length_in_store=5,
                   velocity=fu.Ramp(start=0.2, end=1.2, after=speed / 0.2))
    rope = scene.rope("haul", route=[drum, fu.Sheave("top", at=(20, -0.3, 0), radius=0.3, side="right"),
                                     fu.Anchor("weight")], elements=[elements, 2], tension=300 * 9.81, **ROPE)
    x, y, _ = rope.point(scene.holders, s)
    scene.rigid_body("carriage", mass=20, inertia=(1, 1, 1), position=(x, y - 0.5, 0), velocity=(along, 0, 0))
    if holds == "slide":
        scene.slide("carriage", along="haul", s=s, at=(0, 0.5, 0), name="trolley", **slide)
    elif holds:
        scene.joint("spherical", ("haul", s), ("carriage", (0, 0.5, 0)), name="grip")
    return scene


def runs_on_rope_and_cable(end: float, radius: float, **slide) -> list[fu.Run]:
    """Return runs of a mass on a heavy rope of 10 m with a small sheave and a length `end` beside it, and on a cable of
    the same elements.
    """
    rope, cable, line = on_rope_and_cable(end, radius)
    at, runs = 2.0, []
    for scene in (rope, cable):
        scene.rigid_body("load", mass=20, inertia=(1, 1, 1), position=line.point(rope.bodies, at).tolist(),
                         velocity=(4, 0, 0))
        scene.slide("load", along="line", s=at, name="trolley", **slide)
        runs.append(scene.run(0.8, **SETTINGS | {"tol": 1e-6}))
    return runs


@pytest.mark.parametrize(("slide", "force"), [
    ({}, 0.05), pytest.param({"friction": 0.2}, 0.05, marks=pytest.mark.slow),
    pytest.param({"friction": fu.Friction(coefficient=0.2, model="stick")}, 0.05, marks=pytest.mark.slow),
    pytest.param({"velocity": fu.Ramp(start=0, end=0.5, before=4 / 1.00375, after=3)}, 2, marks=pytest.mark.slow)])
def test_agrees_with_a_slide_on_a_cable(slide, force):
    """The difference is in proportion to what the cable leaves out: extrapolated to none of it, places agree to 3e-6 of
    a path of 3 m. The mass passes ends of elements, where the force of a drive jumps.
    """
    (coarse, _), (fine, cable) = (runs_on_rope_and_cable(each, each / 2, **slide) for each in (0.01, 0.005))
    assert np.ptp(cable["trolley.s"]) > 2 and cable.report["element_crossings"] == fine.report["element_crossings"] > 0
    for name in ("load.position", "trolley.s"):
        assert np.abs(2 * fine[name] - coarse[name] - cable[name]).max() < 3e-6, name
    assert np.abs(coarse["load.position"] - cable["load.position"]).max() > 1e-5
    assert np.abs(2 * fine["trolley.force"] - coarse["trolley.force"] - cable["trolley.force"]).max() < force
    assert fine["energy.dissipated"][-1] == pytest.approx(cable["energy.dissipated"][-1], rel=1e-3)


def swinging(elements: int) -> fu.Scene:
    """Return a load that slides without friction on a light rope over a sheave, with a counterweight beyond."""
    scene = fu.Scene()
    scene.rigid_body("weight", mass=60, inertia=(1, 1, 1), position=(8.3, -6, 0))
    line = scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)),
                                     fu.Sheave("top", at=(8, -0.3, 0), radius=0.3, side="right"), fu.Anchor("weight")],
                      tension=60 * 9.81, elements=[elements, 1], **rope_of(1e6, 0.02, 1.0, 2e-3))
    scene.rigid_body("load", mass=20, inertia=(1, 1, 1), position=line.point(scene.holders, 4.0), velocity=(1, 0, 0))
    scene.slide("load", along="line", s=4.0, name="trolley")
    return scene


def massless(time: np.ndarray, start: np.ndarray) -> np.ndarray:
    """Return the places (T, 2) of that load on a massless, inextensible rope without bending stiffness."""
    centre, radius, g, load, weight = np.array([8.0, -0.3]), 0.3, np.array([0.0, -9.81]), 20.0, 60.0

    def spans(r: np.ndarray) -> list[tuple[float, np.ndarray]]:
        """Return length and direction towards the load of both straight parts."""
        apart = r - centre
        length = np.sqrt(apart @ apart - radius**2)
        normal = (radius * apart + length * np.array([-apart[1], apart[0]])) / (apart @ apart)
        normal = normal if normal[1] > 0 else (radius * apart - length * np.array([-apart[1], apart[0]])) / (
            apart @ apart)
        return [(np.hypot(*r), r / np.hypot(*r)), (length, (apart - radius * normal) / length)]

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        r, v = y[:2], y[2:]
        pull = sum(u for _, u in spans(r))
        bend = sum((v @ v - (u @ v)**2) / length for length, u in spans(r))
        tension = (pull @ g - g[1] + bend) / (pull @ pull / load + 1 / weight)
        return np.concatenate([v, g - tension / load * pull])

    found = solve_ivp(rates, (0, time[-1]), [*start, 1.0, 0.0], t_eval=time, rtol=1e-10, atol=1e-12)
    return found.y[:2].T


@pytest.mark.slow
def test_refinement():
    """Within an element the kink under the load is round: the error falls with the length of elements, 1 to .25 m."""
    errors = []
    for n in (8, 16, 32):
        run = swinging(n).run(0.8, **SETTINGS)
        exact = massless(run.time, run["load.position"][0, :2])
        errors.append(np.abs(run["load.position"][:, :2] - exact).max())
        assert np.abs(run.energy_balance().relative).max() < 1e-6
    assert np.ptp(exact[:, 1]) > 1
    assert errors[0] < 0.1 and errors[1] < 0.6 * errors[0] and errors[2] < 0.7 * errors[1]


@pytest.mark.parametrize(("slide", "slid"), [({"friction": fu.Friction(coefficient=20.0, model="stick")}, 1e-4),
                                             ({"drive": S}, 1e-8)])
def test_a_carriage_that_does_not_slide_is_gripped(slide, slid):
    """The drum pays out by 1.3 m, and ends of elements pass the carriage. Friction holds it as soon as it hangs on the
    rope, which is straight as drawn.
    """
    made = {"elements": 16, "speed": 1.0, "along": 0.0}
    run, grip = (hauled(**made | more).run(2.0, **SETTINGS) for more in (slide, {"holds": "grip"}))
    assert np.ptp(run["trolley.s"]) < slid and np.ptp(grip["carriage.position"][:, 0]) > 1
    assert np.abs(run["carriage.position"] - grip["carriage.position"]).max() < 3 * slid
    assert np.abs(run["trolley.force"] - grip["grip.force"]).max() < 1e-2 * np.abs(grip["grip.force"]).max()


@pytest.mark.parametrize("integrator", ["radau", "genalpha"])
def test_passing_ends_of_elements_keeps_energy(integrator):
    """A carriage slides by 2 m with friction, past ends of elements of 1.25 m, while rope is paid out."""
    scene = hauled(elements=16, speed=1.0, friction=0.05)
    run = scene.run(2.0, **SETTINGS | {"integrator": integrator})
    assert run.report["element_crossings"] >= 2 and np.ptp(run["trolley.s"]) > 1.5
    assert run["energy.dissipated"][-1] > 10
    assert np.abs(run.energy_balance().relative).max() < 1e-6
    assert run["trolley.residual"].max() < 1e-9


@pytest.mark.parametrize("friction", [None, 0.1, fu.Friction(coefficient=0.1, model="stick")])
def test_integrators_agree(friction):
    """Those with Newton's method and the explicit one, whose equations for accelerations differ."""
    scene = hauled(elements=2, friction=friction)
    runs = [scene.run(0.1, **SETTINGS | {"integrator": name, "tol": 1e-6, "output_step": 0.01})
            for name in ("radau", "genalpha", "explicit")]
    for name in ("carriage.position", "trolley.s"):
        moved = np.ptp(runs[0][name], axis=0).max()
        assert moved > 0.1
        for other in runs[1:]:
            assert np.abs(other[name] - runs[0][name]).max() < 1e-5 * moved


@pytest.mark.parametrize("friction", [None, 0.3])
def test_momentum_is_kept(friction):
    """A rope over a sheave on a free body, with bodies at its ends and one that slides, under constant forces."""
    scene, free = fu.Scene(gravity=(0, 0, 0)), {}
    for name, mass, start, force in (("A", 2.0, (-0.2, -1.5, 0), (0, -50, 0)), ("B", 2.5, (0.2, -1.5, 0), (0, -50, 0)),
                                     ("C", 3.0, (0, 0, 0), (0, 105, 0)), ("D", 1.0, (0.2, -1.0, 0), (15, 20, 0))):
        scene.rigid_body(name, mass=mass, inertia=(1, 1, 0.1), position=start, velocity=(0.3, -0.2, 0))
        scene.force(name, value=force)
        free[name] = mass, np.array(force)
    scene.rope("rope", route=[fu.Anchor("A"), fu.Sheave("top", at="C", radius=0.2, side="right"), fu.Anchor("B")],
               tension=50.0, elements=3, **rope_of(2e4, 0.1, 0, 1e-4))
    scene.slide("D", along="rope", name="trolley", friction=friction)
    run = scene.run(0.2, **SETTINGS | {"tol": 1e-7})
    assert np.ptp(run["trolley.s"]) > 0.2 and np.abs(run["trolley.force"]).max() > 20
    found = np.array([momenta(scene, run, k) for k in range(len(run.time))])
    total = sum(force for _, force in free.values())[:2]
    assert np.abs(found[:, :2] - found[0, :2] - np.outer(run.time, total)).max() < 1e-8 * np.abs(found).max()
    moment = sum(np.cross(run[f"{name}.position"], force)[:, 2] for name, (_, force) in free.items())
    turned = CubicSpline(run.time, moment).antiderivative()(run.time)
    assert np.abs(found[:, 2] - found[0, 2] - turned).max() < 1e-4 * np.ptp(turned)  # by a spline over the output


@pytest.mark.parametrize("integrator", ["radau", "genalpha", pytest.param("explicit", marks=pytest.mark.slow)])
@pytest.mark.parametrize(("along", "end"), [(8.0, 'sheave "top"'), (-8.0, 'drum "winch"')])
def test_a_slide_that_reaches_a_tangent_point_ends_the_run(integrator, along, end):
    scene = hauled(elements=2, along=along, s=19.0 if along > 0 else 10.0)
    words = f'slide "trolley" on rope "haul" reaches {end}, at t = '
    with pytest.raises(fu.RopeLeftError, match=words) as caught:
        scene.run(2.0, **SETTINGS | {"integrator": integrator, "tol": 1e-3})
    run = caught.value.run
    assert run.status == "rope_left" and 0.5 < run.time[-1] < 1.0
    rim = 20 if along > 0 else 0
    assert np.abs(run["carriage.position"][-1, 0] - rim) < 0.5


def test_a_body_on_two_slides():
    """Both run along one span, one behind the other."""
    scene = fu.Scene()
    rope = scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("top", at=(10, -0.3, 0), radius=0.3),
                                     fu.Anchor(at=(10.3, -5, 0))], tension=2e3, elements=4, **ROPE)
    wheels = np.array([rope.point(scene.holders, s) for s in (4.0, 4.6)])
    middle = wheels.mean(axis=0)
    scene.rigid_body("load", mass=20, inertia=(1, 1, 1), position=middle, velocity=(1, 0, 0))
    for k, wheel in enumerate(wheels):
        scene.slide("load", along="line", s=(4.0, 4.6)[k], at=wheel - middle, name=f"wheel_{k}")
    run = scene.run(0.5, **SETTINGS)
    front, rear = run["wheel_1.s"], run["wheel_0.s"]
    assert front[-1] > 5 and front - rear == pytest.approx(0.6, abs=1e-2)
    assert np.abs(run.energy_balance().relative).max() < 1e-6


def test_friction_stops_a_carriage():
    """It sticks at the same instant by both methods, and stays."""
    found = []
    for integrator in ("radau", "genalpha"):
        scene = hauled(elements=4, friction=fu.Friction(coefficient=0.3, model="stick"))
        run = scene.run(1.0, **SETTINGS | {"integrator": integrator})
        event, = run.events
        assert (event["name"], event["what"]) == ("trolley", "stuck")
        assert run["trolley.s"][-1] == pytest.approx(event["s"], abs=1e-12)
        assert np.abs(run.energy_balance().relative).max() < 1e-5
        found.append((event["time"], event["s"]))
    assert found[0] == pytest.approx(found[1], abs=1e-4)


def test_at_rest():
    """Without friction the carriage slides to where the rope is lowest, and stays there."""
    scene = hauled(along=0.0, elements=4)
    rest = scene.equilibrium()
    assert rest["trolley.force"] == pytest.approx([0, 20 * 9.81, 0], abs=1e-9)
    assert abs(rest["trolley.s"] - S) > 1 and rest["carriage.position"][1] < -0.8
    run = scene.run(1.0, **SETTINGS, initial=rest)
    assert np.abs(run["carriage.position"] - rest["carriage.position"]).max() < 1e-9
    forces = rest.section_forces("haul", "trolley", method="constitutive")
    assert forces["tension"].item() == pytest.approx(300 * 9.81, rel=0.1)
    assert forces["s"].item() == rest["trolley.s"]


def test_a_kink_that_elements_cannot_follow_is_reported():
    """A heavy carriage turns the rope by 38 degrees within 4 cm; a light one by 4 degrees, without an effect."""
    heavy, light = (hauled(along=0.0, elements=4).replace("carriage", mass=mass).equilibrium() for mass in (200, 20))
    note, = (message for message in heavy.messages if "cannot follow" in message)
    assert note.startswith('slide "trolley": rope "haul" turns there by 35 degrees within sqrt(EI/N) = 0.039 m')
    assert note.endswith("Take elements of at most 0.039 m where it slides")
    assert not any("cannot follow" in message for message in light.messages)


@pytest.mark.parametrize("given", [{"integrator": "radau"}, {"integrator": "genalpha", "spectral_radius": 0.9}],
                         ids=["radau", "genalpha"])
def test_a_point_of_a_rope_slides_along_a_cable(given):
    """It rides as a point of a cable does."""
    scene = fu.Scene()
    rope = scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("top", at=(10, -0.3, 0), radius=0.3),
                                     fu.Anchor(at=(10.3, -5, 0))], tension=2e3, elements=4, **ROPE)
    x, y, _ = rope.point(scene.holders, 4.1)
    scene.cable("guide", start=(x, y - 1, 0), end=(x, y + 1, 0), elements=3, element="cable8p", **ROPE)
    for end in (0, 2.0):
        scene.pin("guide", s=end)
    scene.slide(("line", 4.1), along="guide", name="ring", friction=0.1)
    run = scene.run(0.1, **SETTINGS | given)
    assert np.ptp(run["ring.s"]) > 0.03
    assert run["ring.residual"].max() < 1e-9
    assert np.abs(run.energy_balance().relative).max() < 1e-6


def test_an_eyelet():
    """A rope runs through a point of the ground that pushes it out of its line."""
    scene = hauled(along=0.0, holds="", speed=1.0)
    scene.slide(scene.ropes["haul"].point(scene.holders, 15.0).tolist(), along="haul", name="eye")
    run = scene.run(1.0, **SETTINGS)
    assert run.scene.slides["eye"].s == pytest.approx(15.0, abs=1e-9)
    assert 0.2 < np.ptp(run["eye.s"]) and 10 < np.abs(run["eye.force"][:, 1]).max()
    assert np.abs(run["eye.traction"]).max() < 1e-9
    assert np.abs(run.energy_balance().relative).max() < 1e-6


def test_a_planar_scene_and_its_twin_in_space():
    """In space tangent points take the sag of the rope into account, 1e-4 m here."""
    found = []
    for dim in (2, 3):
        scene = fu.Scene()
        rope = scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("top", at=(10, -0.3, 0), radius=0.3),
                                         fu.Anchor(at=(10.3, -5, 0))], tension=2e3, elements=3,
                          element="cable8p" if dim == 2 else "cable12", **ROPE)
        position = np.add(rope.point(scene.holders, 4.0), (0, -0.5, 0))
        scene.rigid_body("load", mass=20, inertia=(1, 1, 1), position=position, velocity=(2, 0, 0))
        scene.slide("load", along="line", s=4.0, at=(0, 0.5, 0), name="trolley", friction=0.1)
        found.append(scene.run(1.0, **SETTINGS))
    planar, spatial = found
    assert np.ptp(planar["trolley.s"]) > 1.5
    assert np.abs(planar["load.position"] - spatial["load.position"]).max() < 5e-4
    assert np.abs(planar["trolley.s"] - spatial["trolley.s"]).max() < 5e-4
    assert np.abs(spatial.energy_balance().relative).max() < 1e-5


def test_out_of_the_plane():
    """A load swings across the rope, too."""
    scene = fu.Scene()
    rope = scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("top", at=(10, -0.3, 0), radius=0.3),
                                     fu.Anchor(at=(10.3, -5, 0))], tension=2e3, elements=8, element="cable12", **ROPE)
    scene.rigid_body("load", mass=20, inertia=(1, 1, 1), position=rope.point(scene.holders, 4.0), velocity=(2, 0, 1))
    scene.slide("load", along="line", s=4.0, name="trolley")
    runs = [scene.run(0.5, **SETTINGS | {"integrator": name}) for name in ("radau", "genalpha")]
    assert np.ptp(runs[0]["load.position"][:, 2]) > 0.2
    assert np.abs(runs[0]["load.position"] - runs[1]["load.position"]).max() < 1e-4
    assert max(np.abs(run.energy_balance().relative).max() for run in runs) < 1e-5


def test_resumed_bit_for_bit(tmp_path):
    """A run is paused where the carriage has passed the end of an element."""
    scene, settings = hauled(elements=16, friction=0.05), SETTINGS | {"duration": 1.5}
    whole = scene.run(**settings)
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 25, **settings)
    assert whole.report["element_crossings"] > 1
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_from_a_file(tmp_path):
    scene = hauled(friction=fu.Friction(coefficient=0.05, model="stick"))
    (tmp_path / "scene.toml").write_text(scene.to_toml(), encoding="utf-8")
    again = fu.load_scene(tmp_path / "scene.toml")
    assert (again.slides["trolley"].along, again.slides["trolley"].s) == ("haul", S)
    runs = [each.run(0.3, **SETTINGS) for each in (scene, again)]
    assert np.array_equal(*(run["trolley.s"] for run in runs))


def slide(**more):
    return lambda scene: scene.slide("carriage", **{"along": "haul", "s": S, "at": (0, 0.5, 0)} | more)


@pytest.mark.parametrize(("add", "words"), [
    (slide(s=4.0), 's of rope "haul" must lie within a span'),
    (slide(s=25.2), 's of rope "haul" lies on sheave "top"'),
    (slide(s=15.0), "m away from rope \"haul\" at s = 15 m; start the body at position"),
    (slide(s=None, at=(0, 3, 0)), ", the nearest place; draw the rope through that point"),
    (slide(along="top"), '"top" is a sheave of rope "haul"'),
    (slide(along="houl"), 'there is no cable or rope "houl"; did you mean "haul"?'),
    (slide(frame="section"), 'frame "section" needs section axes, but rope "haul" has a tangent only'),
    (slide(at_end=fu.HardStop(restitution=0.5)), 'at_end: the span of rope "haul" ends at sheave "top", where the '
     'material runs past a stop; let the rider strike a surface there by a contact, or take "error"'),
    (slide(at_start=fu.Buffer(length=1, stiffness=1e3)), 'at_start: the span of rope "haul" ends at drum "winch"'),
    (slide(drive=S + 0.1), "drive is 12.1 m at t = 0, but the slide starts at s = 12 m"),
    (lambda scene: scene.slide("haul", along="haul"), 'rope "haul" rides and needs the arc-length of its point'),
    (lambda scene: scene.slide(("haul", 7.0), along="haul", s=S), 'rope "haul" rides itself'),
])
def test_refused(add, words):
    with pytest.raises(fu.SceneError) as caught:
        add(hauled(holds=""))
    assert words in str(caught.value)


def test_refused_on_a_rope_without_mass():
    scene = hauled(holds="").replace("haul", mass=False)
    with pytest.raises(fu.SceneError, match='along: acts on rope "haul", which has mass=False'):
        scene.slide("carriage", along="haul", s=S, at=(0, 0.5, 0))


def test_refused_where_a_change_moves_the_rope_off_the_rider():
    with pytest.raises(fu.SceneError, match='m away from rope "haul" at s = 12 m'):
        hauled().replace("haul", tension=2e5)


def test_a_drive_whose_rate_jumps_is_reported():
    scene = hauled(along=0.0, drive=fu.TableSignal(time=[0, 1, 2], value=[S, S, S + 1], interpolation="linear"))
    with pytest.warns(fu.FunicularWarning, match='slide "trolley": the rate of s jumps by'):
        scene.run(1.5, **SETTINGS)


def test_a_drive_that_starts_with_a_jump_is_reported():
    """The rope is at rest as drawn, and so is its rider."""
    scene = fu.Scene()
    rope = scene.rope("line", route=[fu.Anchor(at=(0, 0, 0)), fu.Sheave("top", at=(10, -0.3, 0), radius=0.3),
                                     fu.Anchor(at=(10.3, -5, 0))], tension=2e3, elements=4, **ROPE)
    scene.rigid_body("load", mass=2, inertia=(1, 1, 1), position=rope.point(scene.holders, 4.0))
    scene.slide("load", along="line", s=4.0, name="trolley", velocity=1.0)
    with pytest.warns(fu.FunicularWarning, match='slide "trolley": moves along rope "line" at 1 m/s from t = 0, but '
                      r'body "load" is drawn at 0 m/s along it; .* Start body "load" at velocity \(1.00'):
        scene.run(0.05, **SETTINGS)


def test_drawn_on_the_rope():
    """In pictures the slide is on the line of the rope, which is drawn through points of it, at its rider."""
    run = hauled().run(1.0, **SETTINGS)
    frames = of_run(run, np.arange(len(run.time)))
    on_rope, rider = slide_place(frames, "trolley"), place(frames, run.scene.slides["trolley"].rider)
    assert np.ptp(on_rope[:, 0]) > 1
    assert np.abs(on_rope - rider).max() < 0.02  # chords of 0.2 m
    assert run.plot("slide").axes[0].lines
    tension = run.section_forces("haul", "trolley", method="constitutive")["tension"]
    assert tension.dims == ("time",) and np.isfinite(tension.values).all()
    with pytest.raises(fu.FunicularError, match='or a slide on it, got "trolly"; did you mean "trolley"'):
        run.section_forces("haul", "trolly", method="constitutive")


def test_errors_are_estimated_for_it():
    run = hauled().run(0.2, **SETTINGS, quantities=["trolley.s"])
    assert run.report["steps"] < hauled().run(0.2, **SETTINGS).report["steps"] * 1.5
    assert run["trolley.s"][-1] > S


@pytest.mark.parametrize("system", ["newton", "accelerations"])
def test_cost_is_in_proportion_to_the_elements(system):
    """The slide may be in any element of its span: their nodes are not coupled to each other by that."""
    costs = [getattr(build(hauled(elements=n)), system).cost for n in (16, 32, 64)]
    assert costs[2] - costs[1] < 2.1 * (costs[1] - costs[0])


@pytest.mark.parametrize("friction", [None, 0.2])
def test_the_tangent_is_the_derivative_of_the_residual(friction):
    """With a border in fronts, its solution is that of the matrix."""
    engine = Engine(build(hauled(elements=32, friction=friction)))
    status, _ = engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=GeneralisedAlpha(0.8),
                             first_step=1e-3)
    assert status is None
    rng = np.random.default_rng(3)
    change, along = (1e-4 * rng.standard_normal(engine.unknowns) for _ in range(2))
    _, matrix = engine.linearise(1e-3, change)
    right = rng.standard_normal(engine.unknowns)
    found, _ = engine.solve(right)
    assert found == pytest.approx(np.linalg.solve(matrix, right), rel=1e-6, abs=1e-9 * np.abs(found).max())
    before, after = (engine.linearise(1e-3, change + step * along)[0] for step in (-1e-3, 1e-3))
    difference = (after - before) / 2e-3
    assert np.abs(np.abs(difference) - np.abs(matrix @ along)).max() < 1e-6 * np.abs(difference).max()
