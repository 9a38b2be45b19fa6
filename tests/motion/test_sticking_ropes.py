"""Friction of ropes on sheaves that sticks: limits, rest, slip that reverses, and what it meets."""

import funicular as fu
import numpy as np
import pytest
from interrupted_runs import killed_and_resumed
from test_ropes import BRIEF, FORCES, INTEGRATORS, THIN, body, carried, momenta, near, row, swing
from turned_scenes import turned_scene

STICK = fu.Friction(coefficient=0.2, model="stick")
SHEAVES = {"held": {"friction": STICK, "zones": 3}, "turning": {"friction": STICK, "zones": 3, "inertia": 0.02}}
G, R = 9.81, 0.2
AREA = np.pi * 1e-12


def string(EA: float, rho: float) -> dict:
    """Return the section and the material of a rope without bending of this stiffness in N and mass in kg/m."""
    return {"section": fu.Circle(radius=1e-6), "elements": 1, "material": fu.Material(
        youngs_modulus=EA / AREA, poisson_ratio=0.3, density=rho / AREA, damping_time=1e-3)}


LIGHT = string(1e5, 0.01)


def stick(mu: float) -> fu.Friction:
    return fu.Friction(coefficient=mu, model="stick")


def two(light: float, heavy: float, gravity=-G, tension=50.0, **sheave) -> fu.Scene:
    """Return two weights on a rope of 10 g/m over a sheave."""
    scene = fu.Scene(gravity=(0, gravity, 0))
    body(scene, "light", -R, -2, light)
    body(scene, "heavy", R, -2, heavy)
    scene.rope("rope", route=[fu.Anchor("light"), fu.Sheave("top", at=(0, 0, 0), radius=R, side="right", **sheave),
                              fu.Anchor("heavy")], tension=tension, **LIGHT)
    return scene


def hung(mu: float) -> fu.Scene:
    """Return a weight on a rope from the ground over a held sheave."""
    scene = fu.Scene(gravity=(0, -G, 0))
    body(scene, "load", R, -2, 10.0)
    scene.rope("rope", route=[fu.Anchor(at=(-R, -2, 0)), fu.Sheave("top", at=(0, 0, 0), radius=R, side="right",
                                                                   friction=stick(mu)), fu.Anchor("load")],
               tension=10 * G, **LIGHT)
    return scene


# ---- the law

@pytest.mark.parametrize("sheave", SHEAVES)
@pytest.mark.slow_cases("held")
def test_energy_and_the_agreement_of_integrators_where_ropes_stick(sheave):
    """Slip that reverses, and sticks between. Differences: 9e-11 m of .05 m; balance off by 2e-9 of the exchange."""
    runs = [swing(**SHEAVES[sheave]).run(**BRIEF, integrator=each) for each in INTEGRATORS]
    for run in runs:
        assert np.abs(run.energy_balance().relative).max() < 2e-8 and (np.diff(run["energy.dissipated"]) > 0).all()
        near(run, runs[-1], 2e-9, "L.position", "C.position", "top.slip_angle")
        near(run, runs[-1], 1e-4, "top.tension_on", "top.tension_off", "top.torque", "hoist.start_force")
    slip = runs[0]["top.slip"]
    assert slip[0] > 0.08 and abs(slip[1]) < 1e-2 and runs[0]["energy.dissipated"][-1] > 1e-5


@pytest.mark.slow
def test_two_weights_without_creep():
    """The mass of the rope is left out by half of it."""
    found = []
    for rho in (1e-3, 5e-4):
        scene = fu.Scene(gravity=(0, -G, 0))
        body(scene, "light", -0.22, -2, 1.0)
        body(scene, "heavy", 0.22, -2, 1.2)
        scene.rope("rope", route=[fu.Anchor("light"), fu.Sheave("top", at=(0, 0, 0), radius=0.22, side="right",
                                                                inertia=0.9, friction=stick(0.1)), fu.Anchor("heavy")],
                   tension=10.7, **string(1e7, rho))
        run = scene.run(2.0, output_step=0.5, tol=1e-6, integrator="radau")
        way = -run["heavy.position"][:, 1]
        found.append(way[4] - 2 * way[2] + way[0])
        assert np.abs(run["top.slip"]).max() < 5e-8  # creep: strain differs by 2e-7 on both sides
    assert 2 * found[1] - found[0] == pytest.approx(0.0943494, rel=1e-5)


CAPSTANS = [(0.1, 0, 1), (0.1, 0, -1), *(pytest.param(*each, marks=pytest.mark.slow) for each in
                                         ((0.3, 0, 1), (0.3, 0, -1), (0.3, 1, 1), (0.3, 1, -1)))]


@pytest.mark.parametrize(("mu", "turns", "way"), CAPSTANS)
@pytest.mark.slow_cases("0.1-0--1")
def test_capstans_hold_below_the_limit_and_slide_above(mu, turns, way):
    """A force that rises to exp(mu theta) times the other one, 1e-5 less or more."""
    theta, T, times = np.pi * (1 + 2 * turns), 100.0, np.linspace(0, 1, 201)
    ramp = times**3 * (10 - 15 * times + 6 * times**2)
    for part in (1 - 1e-5, 1 + 1e-5):
        rising = T * (1 + (part * np.exp(mu * theta) - 1) * ramp)
        signal = fu.TableSignal(time=np.r_[times, 9.0], value=np.r_[rising, rising[-1]], interpolation="linear")
        scene = two(1.0, 1.0, 0.0, T, friction=stick(mu), turns=turns)
        pulled, other = ("light", "heavy")[::way]
        scene.force(other, value=(0, -1, 0), scale=signal)
        scene.force(pulled, value=(0, -T, 0))
        run = scene.run(2.0, output_step=0.1, tol=1e-5, integrator="radau")
        moved = run[f"{pulled}.position"][-1, 1] - run[f"{pulled}.position"][12, 1]
        tensions = sorted((run["top.tension_on"][-1], run["top.tension_off"][-1]))
        assert tensions[1] / tensions[0] == pytest.approx(min(part, 1) * np.exp(mu * theta), rel=2e-6)
        assert (abs(moved) < 1e-7) if part < 1 else (moved > 1e-4)
        assert run["top.slip_angle"][-1] == pytest.approx(theta, rel=1e-6) or part < 1


@pytest.mark.parametrize("duration", [2.0, pytest.param(100.0, marks=pytest.mark.slow)])
def test_a_load_at_rest_does_not_creep(duration):
    """A counterweight of half the load: the rope slides as it stretches, and then holds; regularised, it moves 1 mm/s.

    After the first half the load moves by 2e-9 m within 50 s: its vibrations decay.
    """
    scene = two(5.0, 10.0, tension=5 * G, friction=stick(0.3))
    run = scene.run(duration, output_step=duration / 100, tol=1e-5, integrator="radau")
    assert 1e-3 < -2 - run["heavy.position"][-1, 1] < 2e-3
    assert np.abs(run["heavy.position"][50:, 1] - run["heavy.position"][-1, 1]).max() < (1e-4 if duration < 9 else 1e-8)


@pytest.mark.parametrize("impending", [None, "hoisting", "lowering"])
def test_runs_from_rest_begin_stuck(impending):
    """Also at the limit of friction: 1e-14 m in 1 s."""
    rest = hung(0.3).equilibrium(impending=impending)
    for integrator in ("radau", "genalpha"):
        run = hung(0.3).run(1.0, output_step=0.1, tol=1e-5, integrator=integrator, initial=rest)
        assert np.abs(run["load.position"] - run["load.position"][0]).max() < 1e-12
        assert run["top.slip_angle"].max() == 0 and np.abs(run["top.slip"]).max() < 1e-12
        assert run["top.tension_on"][-1] == pytest.approx(rest["top.tension_on"], rel=1e-9)


def test_rest_and_modes_are_those_of_regularised_friction():
    scenes = hung(0.3), hung(0.3).replace("rope", route=[fu.Anchor(at=(-R, -2, 0)), fu.Sheave(
        "top", at=(0, 0, 0), radius=R, side="right", friction=0.3), fu.Anchor("load")])
    one, other = (scene.equilibrium(impending="hoisting") for scene in scenes)
    for name in ("tension_on", "tension_off", "torque", "force", "slip", "slip_angle"):
        assert one[f"top.{name}"] == pytest.approx(other[f"top.{name}"], rel=1e-9, abs=1e-7)
    for wraps in ("slip", "stick"):
        one, other = (scene.modes(4, about=scene.equilibrium(), wraps=wraps).frequency for scene in scenes)
        # the state of rest is found to 1e-9 of the scene, with the tension on which the pendulum's stiffness depends
        assert one**2 == pytest.approx(other**2, rel=1e-9, abs=1e-9 * other[-1] ** 2)


def test_a_sheave_stopped_at_once_and_reversed():
    """The rope slides on, sticks, and is taken back: genalpha beside radau, and the energy."""
    drive = fu.TableSignal(time=[0, 0.1, 0.1001, 0.15, 0.2, 1], value=[0, -3, 0, 0, 3, 3], interpolation="linear")
    runs = [two(5.0, 5.0, friction=stick(0.3), velocity=drive).run(0.3, output_step=0.025, tol=1e-5, integrator=each)
            for each in ("radau", "genalpha")]
    near(*runs, 2e-5, "heavy.position")
    for run in runs:
        assert run["top.slip"].max() > 0.1 and run["top.slip"].min() < -0.1 and holds(run, "top", 0.3)
        assert np.abs(run.energy_balance().relative).max() < 1e-5


def test_a_belt_that_sticks_and_creeps():
    """The belt of the issue, to its start at full speed, beside regularised friction of a small velocity."""
    def found(friction: fu.Friction) -> fu.Run:
        pulley = {"radius": 0.1, "side": "left", "inertia": 0.25, "friction": friction, "zones": 4}
        drive = fu.TableSignal(time=[0, 0.05, 0.6, 3], value=[0, 0, 12, 12], interpolation="linear")
        scene = fu.Scene(gravity=(0, 0, 0))
        scene.rope("belt", closed=True, length=1.1938052, route=[
            fu.Sheave("driver", at=(0, 0, 0), velocity=drive, **pulley),
            fu.Sheave("driven", at=(0.1 * np.pi, 0, 0), damping=2.0, **pulley)], **string(7600.0, 0.872421))
        return scene.run(0.8, output_step=0.1, tol=1e-4, integrator="radau")

    one, other = found(fu.Friction(coefficient=0.5, model="stick")), found(fu.Friction(coefficient=0.5, velocity=1e-5))
    near(one, other, 2e-4, "driven.angle")
    near(one, other, 0.1, "driver.tension_on", "driver.tension_off")
    assert np.abs(one.energy_balance().relative).max() < 1e-4


def holds(run: fu.Run, name: str, mu: float) -> bool:
    """Return whether tensions beside a sheave never differ by more than friction can hold, but for the weight."""
    on, off = (run[f"{name}.tension_{side}"] for side in ("on", "off"))
    return bool((np.abs(np.log(on / off)) < mu * run[f"{name}.wrap_angle"] + 0.01).all())


@pytest.mark.slow
@pytest.mark.parametrize("output_step", [0.05, 0.5])
def test_a_winch_starts_over_held_sheaves(output_step):
    """The installed crane with friction on its sheaves, which all break loose as the winch starts at 2 s."""
    scene = fu.load_scene("tower_crane")
    rope = next(iter(scene.ropes.values()))
    runs = []
    for friction in (STICK, fu.Friction(coefficient=0.2, velocity=1e-3)):
        route = [item.model_copy(update={"friction": friction}) if isinstance(item, fu.Sheave) else item
                 for item in rope.route]
        runs.append(scene.replace(rope.name, route=route).run(3.0, output_step=output_step, integrator="radau"))
        assert all(holds(runs[-1], sheave.name, 0.2) for sheave in rope.sheaves)
        assert (np.diff(runs[-1]["energy.dissipated"]) > -1e-3).all()
    near(*runs, 2e-3, "load.position")  # regularised, the rope creeps by 1 mm/s


# ---- what it meets

def test_momentum_of_a_sticking_rope_over_a_moving_body():
    scene = carried(**SHEAVES["turning"] | {"torque": 0.7, "damping": 0.1})
    run = scene.run(duration=0.1, output_step=0.002, tol=1e-6, integrator="explicit")
    change = momenta(scene, run, -1) - momenta(scene, run, 0)
    moment = sum(run[f"{name}.position"][:, 0] * force for name, force in FORCES.items())
    assert np.abs(change[:2]).max() < 1e-12
    assert change[2] == pytest.approx(np.sum(moment[1:] + moment[:-1]) * 0.001, abs=2e-6)  # of the trapezoidal rule
    assert np.abs(run.energy_balance().relative).max() < 1e-9


def test_three_sticking_sheaves_and_a_block():
    runs = [row(3, **SHEAVES["turning"]).run(**BRIEF, integrator=each) for each in ("radau", "explicit")]
    near(*runs, 1e-9, "B.position", "s1.angle")
    block = fu.Block("hook", at="A", upper=(0, 0, 0), falls=2, radius=R, friction=STICK, inertia=0.1)
    assert [sheave.sticks for sheave in block.sheaves] == [True]


@pytest.mark.slow
def test_space_mirror_axes_and_the_route_backwards():
    def scene(mirror=1, backwards=1, element="cable8p"):
        found = fu.Scene(gravity=(0, -G, 0))
        body(found, "C", -0.2 * mirror, -1.5, 2.2)
        body(found, "L", 0.9 * mirror, -1.2, 2.0, velocity=(0.3 * mirror, 0, 0))
        route = [fu.Anchor("C", at=(0, 0.1, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.2, **SHEAVES["turning"]),
                 fu.Anchor("L")]
        found.rope("hoist", element=element, route=route[::backwards], tension=20.0, **THIN)
        return found

    run, mirrored, reverse, spatial = (each.run(**BRIEF, integrator="radau") for each in (
        scene(), scene(mirror=-1), scene(backwards=-1), scene(element="cable12")))
    place = run["L.position"]
    assert np.abs(mirrored["L.position"] * (-1, 1, 1) - place).max() < 1e-12
    near(reverse, run, 1e-12, "L.position", "top.slip_angle")
    near(spatial, run, 1e-7, "L.position")
    turned = turned_scene(scene(), (0, 0, 0.7), (3.0, -2.0, 0)).run(**BRIEF, integrator="radau")
    near(turned, run, 1e-8, "top.angle", "top.slip_angle")


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_sticking_ropes_resume_bit_for_bit(tmp_path, integrator):
    scene = swing(**SHEAVES["turning"])
    settings = {"duration": 0.02, "output_step": 0.002, "tol": 1e-5, "integrator": integrator}
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 15, **settings, progress=False)
    whole = fu.Scene.from_toml(scene.to_toml()).run(**settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_a_sticking_rope_from_a_state_of_a_run_and_with_estimates():
    scene = swing(**SHEAVES["turning"])
    run = scene.run(**BRIEF, integrator="radau")
    later = scene.run(0.05, output_step=0.05, tol=1e-6, integrator="radau", initial=run.at(0.05))
    near({"p": later["L.position"][-1]}, {"p": run["L.position"][-1]}, 1e-7, "p")
    errors = scene.run(0.02, output_step=0.01, tol=1e-4, estimate=True).report["errors"]
    assert 0 < errors["mesh"] < 1e-2


def test_a_rope_without_mass_takes_sticking_friction():
    """It holds there with either model."""
    def run(friction):
        scene = two(1.0, 1.2, tension=10.7, inertia=0.9, friction=friction)
        return scene.replace("rope", mass=False).run(0.2, output_step=0.1, tol=1e-6)

    near(run(stick(0.1)), run(fu.Friction(coefficient=0.1)), 1e-14, "heavy.position")


def test_what_sticking_ropes_are_refused_in():
    with pytest.raises(fu.SceneError, match="has no tensions of ropes that stick; leave friction out"):
        hung(0.3).relax()
    with pytest.raises(fu.SceneError, match="has rolling friction, which only slides have"):
        fu.Sheave("top", at=(0, 0, 0), radius=R, friction=fu.Friction(coefficient=0.1, rolling=0.1, model="stick"))
