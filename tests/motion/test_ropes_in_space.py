"""Ropes in space: fleet angles at rest, agreement with the plane and with a turned scene, energy, and how runs end."""

import funicular as fu
import numpy as np
import pytest
from funicular.base.rotations import rotate, turned_by
from interrupted_runs import killed_and_resumed
from ropes.runs import fleet_at_rest, rope_of
from ropes.swings import on_the_line
from test_ropes import BRIEF, FRICTION, INTEGRATORS, SHEAVES, THIN, near
from turned_scenes import ASKEW, turned_scene

SPATIAL = THIN | {"element": "cable12"}
TURN = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
TURN *= np.sign(np.linalg.det(TURN))


def swing(out: float = 0.1, Q=None, **sheave) -> fu.Scene:
    """Return a load that swings, out of the groove's plane, from a rope with a counterweight, all turned by Q."""
    axes = np.eye(3) if Q is None else Q
    place = lambda *x: tuple(axes @ x)  # noqa: E731
    scene = fu.Scene(gravity=place(0, -9.81, 0))
    scene.rigid_body("C", mass=2.2, inertia=(1, 1, 1), position=place(-0.2, -1.5, out / 2))
    scene.rigid_body("L", mass=2.0, inertia=(1, 1, 1), position=place(0.9, -1.2, out), velocity=place(0.3, 0, 2 * out))
    scene.rope("hoist", route=[fu.Anchor("C"), fu.Sheave("top", at=place(0.01, 0.02, out / 3), axis=place(0, 0, 1),
                                                         radius=0.2, side="right", **sheave), fu.Anchor("L")],
               tension=20.0, **SPATIAL)
    return scene


# ---- at rest

@pytest.mark.parametrize("elements", [2, 8, 32])
def test_a_fleet_angle_at_rest(elements):
    found = fleet_at_rest(elements)
    foot, along, length = on_the_line(0.3, np.array([0.809249, -0.495093, 0.126487]))
    assert found["foot"] == pytest.approx(np.degrees(np.arctan2(foot[1], foot[0])), rel=1e-8)
    assert found["foot from the axis"] == pytest.approx(np.hypot(*foot[:2]), rel=1e-8)
    assert found["fleet angle"] == pytest.approx(np.degrees(np.arcsin(along[2])), rel=1e-8)
    assert found["length"] == pytest.approx(0.3 * np.radians(180 - found["foot"]) + length, rel=1e-8)


@pytest.mark.parametrize("fleet", [2, 15])
@pytest.mark.parametrize("elements", [1, 8, 32])
def test_rest_is_a_minimum_of_the_energy(fleet, elements):
    R, f, scene = 0.3, np.radians(fleet), fu.Scene(gravity=(0, 0, 0))
    foot = R / np.cos(f) * np.array([np.cos(0.7), np.sin(0.7), 0])
    along = np.array([np.cos(f) * np.sin(0.7), -np.cos(f) * np.cos(0.7), np.sin(f)])
    scene.rope("rope", element="cable12", elements=elements, tension=100.0, route=[
        fu.Anchor(at=(-R, -0.5, 0)),
        fu.Sheave("top", at=(0, 0, 0), radius=R, side="right", max_fleet_angle=0.3),
        fu.Anchor(at=tuple(foot + 1.2 * along))], **rope_of(1e5, 1e-3, 0))
    rest = scene.equilibrium()
    assert rest.stable
    assert rest["top.wrap_angle"] == pytest.approx(np.pi - 0.7, rel=1e-8)
    assert rest["top.fleet_angle_off"] == pytest.approx(f, rel=1e-8)
    assert rest["top.fleet_angle_on"] == pytest.approx(0, abs=1e-8)
    pull = -100 * np.array([0, 1, 0]) + 100 * along
    assert rest["top.force"] == pytest.approx(pull, abs=1e-3)


def hanging(element: str, **sheave) -> fu.Scene:
    """Return a load on a rope over a sheave, whose other end is held."""
    scene = fu.Scene()
    scene.rigid_body("L", mass=2.0, inertia=(0.1, 0.2, 0.3), position=(0.2, -1.5, 0))
    scene.rope("hoist", route=[fu.Anchor(at=(-1, -0.8, 0)),
                               fu.Sheave("top", at=(0, 0, 0), radius=0.2, side="right", **sheave),
                               fu.Anchor("L", at=(0, 0.1, 0))], tension=20.0, **THIN | {"element": element})
    return scene


def test_rest_and_modes_are_those_in_the_plane():
    """The wrap differs by 1e-5 rad: the chord has the sag of a parabola."""
    states = {element: hanging(element).equilibrium() for element in ("cable8p", "cable12")}
    plane, space = states.values()
    for name, bound in (("L.position", 1e-9), ("top.tension_on", 1e-6), ("top.force", 1e-4), ("top.wrap_angle", 3e-5)):
        assert np.abs(plane[name] - space[name]).max() < bound, name
    frequencies = {element: hanging(element).modes(6, about=state).frequency for element, state in states.items()}
    for frequency in frequencies["cable8p"][:3]:
        assert np.abs(frequencies["cable12"] / frequency - 1).min() < 1e-6
    free = hanging("cable12").modes(6, about=space)
    across = np.flatnonzero(np.abs(free["L.displacement"][:, 2]) > 0.5)
    assert len(across), "the load swings across the plane"


@pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")
def test_modes_of_a_rope_that_sticks():
    """Those in the plane are among them; the axes do not count."""
    plane, space = (hanging(element, friction=0.2, zones=3) for element in ("cable8p", "cable12"))
    one, other, turned = (scene.modes(8, about=scene.equilibrium(seek_stable=False), wraps="stick").frequency
                          for scene in (plane, space, turned_scene(space, *ASKEW)))
    assert turned == pytest.approx(other, abs=1e-5)
    for frequency in one[:4]:
        assert np.abs(other / frequency - 1).min() < 1e-5


def test_a_heavy_rope_about_a_vertical_axis():
    """The height of the groove counts: a rope that is pulled up over a level sheave weighs on both sides alike."""
    scene = fu.Scene()
    heavy = rope_of(1e6, 0.5, 0)
    scene.rope("rope", element="cable12", elements=8, tension=400.0, route=[
        fu.Anchor(at=(-2, 3.0, 0.3)), fu.Sheave("level", at=(0, 3.0, 0), axis=(0, 1, 0), radius=0.3),
        fu.Anchor(at=(0.3, 3.4, -2))], **heavy)
    rest = scene.equilibrium()
    assert rest.stable
    assert rest["level.tension_on"] == pytest.approx(rest["level.tension_off"], rel=1e-4)
    low, high = (np.linalg.norm(rest[f"rope.{end}_force"]) for end in ("start", "end"))
    assert high - low == pytest.approx(0.5 * 9.81 * 0.4, rel=2e-3), "T - rho g y is constant along the rope"


# ---- in motion

@pytest.mark.parametrize("sheave", SHEAVES)
def test_a_planar_scene_and_its_spatial_twin(sheave):
    """The load is 4e-9 m off, with friction 4e-8 m; the wrap is that of a chord with the sag of rest."""
    runs = []
    for element in ("cable8p", "cable12"):
        scene = fu.Scene()
        scene.rigid_body("C", mass=2.2, inertia=(1, 1, 0.1), position=(-0.2, -1.5, 0))
        scene.rigid_body("L", mass=2.0, inertia=(1, 1, 0.1), position=(0.9, -1.2, 0))
        scene.rope("hoist", route=[fu.Anchor("C", at=(0, 0.1, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.2, **SHEAVES[
            sheave]), fu.Anchor("L")], tension=20.0, **THIN | {"element": element})
        runs.append(scene.run(**BRIEF, integrator="radau"))
    near(*runs, 2e-7, "L.position", "C.position")
    near(*runs, 2e-3, "top.tension_on", "top.tension_off", "top.wrap_angle")
    assert np.abs(runs[1]["hoist.position"][..., 2]).max() < 1e-12


@pytest.mark.parametrize("sheave", SHEAVES)
def test_energy_and_the_agreement_of_integrators(sheave):
    runs = [swing(**SHEAVES[sheave]).run(**BRIEF, integrator=each) for each in INTEGRATORS]
    for run in runs:
        assert np.abs(run.energy_balance().relative).max() < 1e-7
        assert run["top.residual"].max() < 1e-8
        near(run, runs[-1], 5e-8, "L.position", "C.position")
        near(run, runs[-1], 5e-3, "top.tension_on", "top.tension_off", "hoist.start_force", "top.force")


@pytest.mark.parametrize("sheave", SHEAVES)
def test_a_turned_scene_gives_the_same(sheave):
    as_drawn, turned = (swing(Q=Q, **SHEAVES[sheave]).run(**BRIEF, integrator="genalpha") for Q in (None, TURN))
    for name, bound in (("L.position", 1e-8), ("hoist.position", 1e-8), ("top.force", 1e-4)):
        assert np.abs(as_drawn[name] - turned[name] @ TURN).max() < bound, name
    near(as_drawn, turned, 1e-7, "top.wrap_angle", "top.fleet_angle_on", "top.fleet_angle_off")
    near(as_drawn, turned, 1e-4, "top.normal_force", "top.torque")


def three() -> fu.Scene:
    """Return a rope between two weights over three sheaves with axes in three directions."""
    given = {"friction": FRICTION, "zones": 3, "inertia": 0.01}
    scene = fu.Scene()
    scene.rigid_body("L", mass=2.0, inertia=(1, 1, 1), position=(-0.2, -1.5, 0.02))
    scene.rigid_body("C", mass=2.1, inertia=(1, 1, 1), position=(2.15, -1.2, 1.7))
    scene.rope("hoist", route=[
        fu.Anchor("L"), fu.Sheave("a", at=(0, 0, 0), radius=0.2, side="right", **given),
        fu.Sheave("b", at=(2, 0.2, 0.2), radius=0.15, axis=(0, 1, 0), **given),
        fu.Sheave("c", at=(2.15, 0, 1.5), radius=0.2, axis=(1, 0, 0), **given), fu.Anchor("C")], tension=20.0,
        **SPATIAL)
    return scene


def crane(element: str, axis=(1, 0, 0), speed: float = 0.0, out: float = 0.0, **sheave) -> fu.Scene:
    """Return a trolley on a rail along an axis, with a sheave over which a load hangs from a counterweight."""
    scene = fu.Scene()
    scene.rigid_body("T", mass=3.0, inertia=(1, 1, 1), position=(0, 0, 0), velocity=speed * np.array(axis))
    scene.rigid_body("C", mass=2.2, inertia=(1, 1, 1), position=(-0.2, -1.5, 0))
    scene.rigid_body("L", mass=2.0, inertia=(1, 1, 1), position=(0.9, -1.2, out), velocity=(0, 0, 2 * out))
    scene.joint("prismatic", (0, 0, 0), "T", axis=axis, name="rail")
    scene.rope("hoist", route=[fu.Anchor("C"), fu.Sheave("top", at=("T", (0, 0.05, 0)), radius=0.2, side="right",
                                                         **sheave), fu.Anchor("L")], tension=20.0,
               **THIN | {"element": element})
    return scene


def test_a_sheave_on_a_trolley_is_that_in_the_plane():
    for name, bound in (("smooth", 2e-8), ("turning", 1e-7)):
        one, other = (crane(element, **SHEAVES[name]).run(**BRIEF, integrator="radau")
                      for element in ("cable8p", "cable12"))
        near(one, other, bound, "L.position", "T.position")
        near(one, other, 1e-3, "top.force", "top.tension_on")


@pytest.mark.parametrize("sheave", [SHEAVES["rough"], SHEAVES["turning"] | {"torque": 2.0, "damping": 0.5}])
def test_the_moment_on_a_trolley_is_that_in_the_plane(sheave):
    """Of friction on a held sheave, of the motor and the bearing on one that turns, between them and the rail.

    The moment differs by 2e-5 N m with the sag of chords.
    """
    plane, space = (crane(element, **sheave).run(**BRIEF, integrator="radau") for element in ("cable8p", "cable12"))
    assert np.abs(plane["rail.moment"][-1, 2]) > 0.5
    near(plane, space, 5e-5, "rail.moment", "top.angle")
    run = crane("cable12", out=0.1, **sheave).run(**BRIEF, integrator="radau")
    turned = turned_scene(crane("cable12", out=0.1, **sheave), *ASKEW).run(**BRIEF, integrator="radau")
    axes = rotate(turned_by(np.array(ASKEW[0])), np.eye(3))
    assert np.abs(turned["rail.moment"] - run["rail.moment"] @ axes).max() < 1e-6
    near(run, turned, 1e-7, "top.angle")


@pytest.mark.parametrize("sheave", ["smooth", "turning"])
def test_a_sheave_moves_along_its_axis(sheave):
    """The wrap goes along: the balance is off by 1e-10 with the explicit integrator."""
    runs = [crane("cable12", axis=(0.3, 0, 1), speed=0.5, out=0.1, **SHEAVES[sheave]).run(**BRIEF, integrator=each)
            for each in INTEGRATORS]
    for run in runs:
        assert np.abs(run.energy_balance().relative).max() < 1e-7
        near(run, runs[-1], 5e-8, "L.position", "T.position")
        near(run, runs[-1], 5e-3, "top.force", "top.tension_on")
    assert np.abs(runs[-1].energy_balance().relative).max() < 1e-9


def test_a_sheave_on_a_trolley_at_rest():
    """Along the rail the rope pulls the trolley against a spring."""
    scene = fu.Scene()
    scene.rigid_body("T", mass=3.0, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.rigid_body("L", mass=2.0, inertia=(1, 1, 1), position=(0.2, -1.2, 0))
    scene.joint("prismatic", (0, 0, 0), "T", axis=(1, 0, 0.2), name="rail")
    scene.spring("T", (1.0, 0, 0.2), stiffness=500.0, length=1.0, name="stop")
    scene.rope("hoist", route=[fu.Anchor(at=(-1.5, 0.3, 0)), fu.Sheave("top", at="T", radius=0.2, side="right"),
                               fu.Anchor("L")], tension=20.0, **SPATIAL)
    rest = scene.equilibrium()
    assert rest.stable
    rail = np.array([1, 0, 0.2]) / np.hypot(1, 0.2)
    arm = np.array([1.0, 0, 0.2]) - rest["T.position"]
    pull = 500.0 * (np.linalg.norm(arm) - 1.0) * arm / np.linalg.norm(arm)
    assert abs(pull @ rail) > 5 and (rest["top.force"] + pull) @ rail == pytest.approx(0, abs=1e-5)
    assert rest["L.position"][0] == pytest.approx(rest["T.position"][0] + 0.2, abs=1e-3)
    load = 2.0 * 9.81
    assert rest["top.tension_off"] == pytest.approx(load, rel=0.02)
    assert rest["hoist.end_force"] == pytest.approx([0, load, 0], abs=1e-6)


def test_axes_in_three_directions():
    one, other = (three().run(**BRIEF, integrator=each) for each in ("genalpha", "radau"))
    near(one, other, 1e-8, "L.position", "C.position")
    near(one, other, 1e-5, "b.fleet_angle_on", "b.fleet_angle_off", "b.wrap_angle")
    assert np.abs(one.energy_balance().relative).max() < 1e-7
    assert max(one[f"{sheave}.residual"].max() for sheave in "abc") < 1e-12


def test_it_starts_with_its_bodies():
    """Drawn with velocities, with them as a state, and about rest; rates that do not fit are told."""
    drawn, still = swing(), swing().replace("L", velocity=(0, 0, 0))
    settings = {"duration": 1e-3, "output_step": 1e-3, "integrator": "radau"}
    state = {"L.velocity": drawn.bodies["L"].velocity}
    run, given = drawn.run(**settings), still.run(**settings, initial=state)
    rates = run["hoist.coordinate_rates"][0]
    assert np.abs(rates).max() > 0.1
    assert given["hoist.coordinate_rates"][0] == pytest.approx(rates, abs=1e-9)
    assert np.abs(still.run(**settings)["hoist.coordinate_rates"][0]).max() == 0
    rest = hanging("cable12").equilibrium()
    pulled = hanging("cable12").replace("L", velocity=(0, 0, 0.1)).run(**settings, initial=rest)
    assert pulled["hoist.coordinate_rates"][0] != pytest.approx(0, abs=0.05)
    for each in (run, given, pulled):
        assert not any("velocities" in message for message in each.report["messages"])
    with pytest.warns(fu.FunicularWarning, match="broke a joint"):
        drawn.run(**settings, initial={"hoist.coordinate_rates": 0 * rates})


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_resumed_bit_for_bit(tmp_path, integrator):
    scene = swing(**SHEAVES["turning"])
    settings = {"duration": 0.02, "output_step": 0.002, "tol": 1e-5, "integrator": integrator}
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 15, **settings, progress=False)
    whole = scene.run(**settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_a_fleet_angle_above_its_limit_is_reported():
    with pytest.warns(fu.FunicularWarning, match='sheave "top": its fleet angle reached .* at t = .* s, above '
                                                 "max_fleet_angle, 0.05 rad: the rope may leave its groove"):
        swing(max_fleet_angle=0.05).run(**BRIEF, integrator="genalpha")
    swing(max_fleet_angle=0.2).run(**BRIEF, integrator="genalpha")  # without a warning
    with pytest.warns(fu.FunicularWarning, match='sheave "top": its fleet angle is .* rad, above max_fleet_angle'):
        held = fu.Scene(gravity=(0, 0, 0))
        held.rope("rope", route=[fu.Anchor(at=(-0.2, -1, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.2, side="right"),
                                 fu.Anchor(at=(0.2, -1, 0.1))], tension=20.0, **SPATIAL)
        held.equilibrium()


@pytest.mark.parametrize("elements", [1, 4])
def test_a_span_that_becomes_too_short_for_its_fleet_angle_ends_the_run(elements):
    """Hoisted to the sheave a load beside the groove pulls the rope out of it; up to there energy is explained."""
    scene = fu.Scene()
    scene.rigid_body("C", mass=3.0, inertia=(1, 1, 1), position=(-0.2, -0.5, 0))
    scene.rigid_body("L", mass=1.0, inertia=(1, 1, 1), position=(0.2, -2.0, 0.05))
    scene.rope("rope", element="cable12", elements=elements, tension=15.0, route=[
        fu.Anchor("C"), fu.Sheave("top", at=(0, 0, 0), radius=0.2, side="right"), fu.Anchor("L")],
        **rope_of(1e5, 0.05, 0, 1e-3))
    with pytest.raises(fu.RopeLeftError, match='leaves the groove of sheave "top", as a span is too short') as caught:
        scene.run(1.0, output_step=0.05, tol=1e-5, integrator="radau", progress=False)
    run = caught.value.run
    assert 0.8 < run.time[-1] < 0.92
    assert np.abs(run.energy_balance().relative).max() < 1e-6


@pytest.mark.parametrize("elements", [1, 4])
@pytest.mark.slow_cases("4")
def test_fleet_angles_up_to_18_degrees_in_motion(elements):
    """Meshes of 1, 4 and 16 elements agree within 2e-7 m."""
    scene = fu.Scene()
    scene.rigid_body("C", mass=5.5, inertia=(1, 1, 1), position=(-0.3, -2, 0), velocity=(0, -0.07, 0))
    scene.rigid_body("L", mass=5.0, inertia=(1, 1, 1), position=(0.9, -1, 0.35), velocity=(0, 0, -0.3))
    top = fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right", max_fleet_angle=0.5)
    scene.rope("rope", element="cable12", elements=elements, tension=50.0,
               route=[fu.Anchor("C"), top, fu.Anchor("L")], **rope_of(1e6, 0.01, 0, 1e-3))
    run = scene.run(1.0, output_step=0.1, tol=1e-5, integrator="radau", progress=False)
    assert np.degrees(run["top.fleet_angle_off"]).min() < -18
    assert run["L.position"][-1] == pytest.approx([-0.2515, -0.9249, -0.3051], abs=2e-3)
    assert np.abs(run.energy_balance().relative).max() < 1e-6


def test_a_quarter_turn_belt():
    """A belt between a level and an upright axis: speeds are equal but for creep, and the belt stays on both."""
    pulley = {"radius": 0.1, "side": "left", "inertia": 0.02, "zones": 4,
              "friction": fu.Friction(coefficient=0.4, velocity=1e-2)}
    turning = fu.TableSignal(time=[0, 0.1, 1], value=[0, 5, 5], interpolation="linear")
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rope("belt", closed=True, tension=200.0, element="cable12", elements=1, route=[
        fu.Sheave("one", at=(0, 0, 0), velocity=turning, **pulley),
        fu.Sheave("two", at=(1.5, -0.1, 0.1), axis=(0, 1, 0), **pulley)], **rope_of(1e5, 0.1, 0, 1e-3))
    run = scene.run(0.3, output_step=0.1, tol=1e-4, integrator="radau", progress=False)
    assert run["two.angle"][-1] - run["two.angle"][-2] == pytest.approx(0.5, rel=2e-3)
    assert np.degrees(run["two.wrap_angle"]) == pytest.approx(187.663, abs=0.01)
