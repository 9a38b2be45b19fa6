"""Ropes without mass that slip on sheaves: closed forms, stick and slip by events, slackness, belts, momentum and
energy, agreement with a rope with mass, resumed runs.
"""

from math import exp, pi

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from interrupted_runs import kill
from ropes.scenes import GRAVITY, over_one, rope_of, swing, weight
from test_massless_ropes import FORCES, carried

INTEGRATORS = ("radau", "genalpha", "explicit")
STIFF = rope_of(1e7, 1e-5, 0, 1e-3) | {"mass": False}
SOFT = rope_of(6e4, 1e-5, 0, 1e-3) | {"mass": False}
BRIEF = {"tol": 1e-7, "progress": False}


def two_weights(friction: float, loads: tuple[float, ...], side: float = 2.0, given=STIFF, **sheave) -> fu.Scene:
    """Return two weights over a sheave, on a rope drawn with the mean of their tensions."""
    scene = swing(*loads, 0.22, side, side, 0.0)
    over_one(scene, 0.22, ("counterweight", "load"), tension=GRAVITY * sum(loads) / 2, given=given, friction=friction,
             **sheave)
    return scene


def events(run: fu.Run) -> list[tuple[str, str]]:
    return [(event["name"], event["what"]) for event in run.report["events"]]


def balance(run: fu.Run) -> float:
    return np.abs(run.energy_balance().relative).max()


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("coefficient", [0.03, 0.051])
def test_two_weights_on_a_sheave_below_the_least_friction(integrator, coefficient):
    """Below 0.0519118 the rope slips, and T2 = T1 e^(mu pi) determines both accelerations."""
    inertia, R, light, heavy = 0.9, 0.22, 1.0, 1.2
    run = two_weights(coefficient, (light, heavy), inertia=inertia).run(2.0, output_step=0.5, integrator=integrator,
                                                                       **BRIEF)
    ratio = exp(coefficient * pi)
    rate = GRAVITY * (heavy - ratio * light) / (heavy + ratio * light)
    tension = light * (GRAVITY + rate)
    turning = tension * (ratio - 1) * R / inertia
    way = -run["load.position"][:, 1]
    assert way[4] - 2 * way[2] + way[0] == pytest.approx(rate, rel=1e-5)
    assert run["top.tension_off"][1:] / run["top.tension_on"][1:] == pytest.approx(np.full(4, ratio), rel=1e-12)
    assert run["top.tension_on"][-1] == pytest.approx(tension, rel=2e-5)
    assert np.diff(run["top.angle"], 2) == pytest.approx(-turning / 4, rel=1e-3)
    slips = 2 - run.report["events"][0]["time"]
    assert run["top.slip"][-1] == pytest.approx(slips * (rate - R * turning), rel=3e-4)
    assert run["energy.dissipated"][-1] == pytest.approx(
        slips**2 / 2 * (rate - R * turning) * tension * (ratio - 1), rel=6e-4)
    assert events(run) == [("top", "slips")]
    assert balance(run) < 1e-6


@pytest.mark.parametrize(("coefficient", "turns", "ratio"), [(0.1, 0, 1.369108), (0.3, 0, 2.566332),
                                                             (0.3, 1, 16.90202)])
@pytest.mark.parametrize("heavy", ["load", "counterweight"])
def test_a_capstan_slides_at_its_limit(coefficient, turns, ratio, heavy):
    """The ratio of both tensions is e^(mu theta) on a held sheave, in both directions."""
    loads = (1.0, 1.05 * ratio)[:: 1 if heavy == "load" else -1]
    scene = two_weights(coefficient, loads, side=12.0, given=SOFT, turns=turns)
    run = scene.run(0.5, output_step=0.1, initial="equilibrium", **BRIEF)
    names = ("top.tension_off", "top.tension_on")[:: 1 if heavy == "load" else -1]
    assert run[names[0]] / run[names[1]] == pytest.approx(np.full(6, ratio), rel=1e-6)
    assert np.all(np.sign(run["top.slip"][1:]) == (1 if heavy == "load" else -1))
    assert run["top.slip_angle"][1:] == pytest.approx(np.full(5, pi * (1 + 2 * turns)), rel=1e-12)
    assert balance(run) < 1e-7


def test_a_brake_holds_a_load_lets_it_slip_and_stops_it():
    """A force on the load grows beyond the limit and falls again: the rope slips with m1 (g + a) e = m2 (g - a) + F."""
    light, heavy, coefficient, ratio = 1.0, 2.0, 0.3, exp(0.3 * pi)
    time, force = [0, 1, 1.4, 9], [0, 12, 0, 0]
    scene = two_weights(coefficient, (light, heavy))
    scene.force("load", value=(0, -1, 0), scale=fu.TableSignal(time=time, value=force, interpolation="linear"))
    run = scene.run(2.5, output_step=0.005, initial="equilibrium", integrator="radau", **BRIEF)
    slips, sticks = run.report["events"][0], run.report["events"][-1]
    assert (slips["what"], sticks["what"]) == ("slips", "sticks")
    limit = GRAVITY * (ratio * light - heavy) / 12 + 1e-3  # damping delays the elastic tension, which friction holds
    assert slips["time"] == pytest.approx(limit, abs=1e-4)
    fine = np.linspace(limit, 2.5, 20001)
    rate = ((heavy - ratio * light) * GRAVITY + np.interp(fine, time, force)) / (heavy + ratio * light)
    speed = np.append(0, np.cumsum((rate[1:] + rate[:-1]) / 2 * np.diff(fine)))
    last = int(np.argmax((speed <= 0) & (fine > 1)))
    way = float(np.sum((speed[1:last] + speed[: last - 1]) / 2 * np.diff(fine)[: last - 1]))
    assert sticks["time"] == pytest.approx(fine[last], rel=1e-3)
    assert -2 - run["load.position"][-1, 1] == pytest.approx(way, rel=1e-3)
    assert np.ptp(run["load.position"][run.time > sticks["time"] + 0.05, 1]) < 1e-4
    assert not run["top.slip"][run.time > sticks["time"]].any()
    assert balance(run) < 1e-6


def test_a_sheave_that_turns_below_a_rope_at_rest():
    """Over 40 turns nothing of the rope is lost: the load stays, and friction takes the work of the drive."""
    R, turns, coefficient = 0.2, 40, 0.2
    scene = swing(1.0, 5.0, R, 1.0, 3.0, 0.0).without("counterweight")
    drive = fu.TableSignal(time=[0, 0.5, 9], value=[0, 2 * pi * turns, 2 * pi * turns], interpolation="linear")
    scene.rope("rope", tension=60.0, **SOFT, route=[
        fu.Anchor(at=(-R, -2, 0)), fu.Sheave("top", at=(0, 0, 0), radius=R, side="right", friction=coefficient,
                                              velocity=drive), fu.Anchor("load")])
    run = scene.run(1.5, output_step=0.1, integrator="radau", **BRIEF)
    # it turns counter-clockwise, against the way to the load
    assert run["top.angle"][-1] > 2 * pi * turns
    assert run["top.tension_off"][1:] / run["top.tension_on"][1:] == pytest.approx(np.full(15, exp(coefficient * pi)))
    assert run["top.tension_off"].mean() == pytest.approx(5 * GRAVITY, rel=1e-2)
    assert np.ptp(run["load.position"][5:, 1]) < 2e-3
    taken = 5 * GRAVITY * (1 - exp(-coefficient * pi)) * R * (run["top.angle"][-1] - run["top.angle"][-6])
    assert run["energy.dissipated"][-1] - run["energy.dissipated"][-6] == pytest.approx(taken, rel=1e-2)
    assert balance(run) < 1e-6


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_three_sheaves_on_which_a_rope_slips(integrator):
    """Each ratio is that of its sheave, and the whole chain has one acceleration."""
    scene, coefficients = fu.Scene(gravity=(0, -GRAVITY, 0)), (0.1, 0.15, 0.2)
    weight(scene, "A", 2.0, -0.2, -3)
    weight(scene, "B", 9.0, 2.2, -3)
    sheaves = [fu.Sheave(f"s{k}", at=(k, -0.5 * (k % 2), 0), radius=0.2, side=("right", "left")[k % 2], friction=mu)
               for k, mu in enumerate(coefficients)]
    scene.rope("hoist", route=[fu.Anchor("A"), *sheaves, fu.Anchor("B")], tension=40.0, **STIFF)
    run = scene.run(0.8, output_step=0.2, integrator=integrator, tol=1e-6, progress=False)
    ratio = 1.0
    for sheave, mu in zip(sheaves, coefficients, strict=True):
        own = np.exp(mu * run[f"{sheave.name}.wrap_angle"][1:])
        assert run[f"{sheave.name}.tension_off"][1:] / run[f"{sheave.name}.tension_on"][1:] == pytest.approx(own)
        ratio *= own[-1]
    rate = GRAVITY * (9 - 2 * ratio) / (9 + 2 * ratio)
    fall = run["B.position"][:, 1]
    assert 2 * fall[2] - fall[0] - fall[4] == pytest.approx(rate * 0.16, rel=1e-3)
    assert sorted(events(run)) == [(sheave.name, "slips") for sheave in sheaves]
    assert balance(run) < 2e-6


@pytest.mark.parametrize("integrator", ["radau", "explicit"])
def test_eleven_sheaves_break_loose_one_by_one(integrator):
    """From both ends to the middle; then the ratio is that of the sum of all wraps."""
    scene, n = fu.Scene(gravity=(0, -GRAVITY, 0)), 11
    weight(scene, "A", 2.0, -0.2, -1)
    weight(scene, "B", 9.0, n - 0.8, -1)
    names = [f"s{k}" for k in range(n)]
    sheaves = [fu.Sheave(name, at=(k, -0.5 * (k % 2), 0), radius=0.2, side=("right", "left")[k % 2], friction=0.01)
               for k, name in enumerate(names)]
    scene.rope("hoist", route=[fu.Anchor("A"), *sheaves, fu.Anchor("B")], tension=30.0, **STIFF)
    run = scene.run(0.2, output_step=0.05, integrator=integrator, tol=1e-6, progress=False)
    assert sorted(events(run)) == sorted((name, "slips") for name in names)
    wraps = sum(run[f"{name}.wrap_angle"] for name in names)
    assert np.log(run["s10.tension_off"] / run["s0.tension_on"])[1:] == pytest.approx(0.01 * wraps[1:], rel=1e-12)
    assert balance(run) < 1e-6


def test_a_belt_that_slips_until_both_pulleys_run_alike():
    """T1 + T2 = 2 T0 of equal spans and T2 = T1 e^(mu pi) give the driven pulley's acceleration, until it sticks."""
    scene, R, inertia, mean, coefficient, top = fu.Scene(gravity=(0, 0, 0)), 0.1, 2.0, 250.0, 0.2, 12.0
    pulley = {"radius": R, "friction": coefficient, "side": "left"}
    scene.rope("belt", closed=True, tension=mean, **rope_of(1e6, 1e-5, 0, 1e-3) | {"mass": False}, route=[
        fu.Sheave("driver", at=(0, 0, 0), **pulley, velocity=top),
        fu.Sheave("driven", at=(1.0, 0, 0), inertia=inertia, **pulley)])
    run = scene.run(2.0, output_step=0.1, integrator="radau", **BRIEF)
    rate = 2 * mean * np.tanh(coefficient * pi / 2) * R / inertia
    angle = run["driven.angle"]
    assert angle[11] - 2 * angle[6] + angle[1] == pytest.approx(rate / 4, rel=1e-5)
    (one, slips), *_, (other, sticks) = events(run)
    assert (one, slips, sticks) == (other, "slips", "sticks")
    assert run.report["events"][-1]["time"] == pytest.approx(top / rate, rel=1e-3)
    assert np.diff(run["driven.angle"])[-3:] == pytest.approx(np.full(3, top * 0.1), rel=1e-3)
    assert np.diff(run["belt.s"][:, 0])[-3:] == pytest.approx(np.full(3, -R * top * 0.1), rel=1e-3)
    assert balance(run) < 1e-6


def test_the_pulley_on_which_a_belt_slips_changes():
    """As two pulleys of different radii part, the limit of the large one falls below that of the small one."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("cart", mass=1e4, inertia=(1e4,) * 3, position=(0.5, 0, 0), velocity=(1, 0, 0))
    scene.rope("belt", closed=True, tension=300.0, **rope_of(1e4, 1e-5, 0, 1e-5) | {"mass": False}, route=[
        fu.Sheave("large", at=(0, 0, 0), radius=0.2, side="left", friction=0.2, velocity=60.0),
        fu.Sheave("small", at="cart", radius=0.1, side="left", friction=0.252, inertia=10.0)])
    run = scene.run(0.1, output_step=1e-3, **BRIEF)
    assert events(run) == [("small", "slips"), ("large", "slips")]
    assert run["small.slip"][1] != 0 == run["large.slip"][1]
    assert run["small.slip"][-1] == 0 != run["large.slip"][-1]
    ratio = run["large.tension_on"] / run["large.tension_off"]
    limits = np.minimum(0.2 * run["large.wrap_angle"], 0.252 * run["small.wrap_angle"])
    assert np.log(ratio)[1:] == pytest.approx(limits[1:], rel=1e-9)
    assert balance(run) < 1e-6


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_rope_that_slips_becomes_slack_and_taut_again(integrator):
    """A light weight is thrown up by a rope that slips, and falls into it again."""
    scene = swing(1.0, 20.0, 0.2, 12.0, 12.0, 0.0)
    over_one(scene, 0.2, ("counterweight", "load"), tension=GRAVITY * 20, given=SOFT, friction=0.3, turns=1)
    run = scene.run(0.6, output_step=2e-3, integrator=integrator, tol=1e-6, progress=False)
    assert [what for _, what in events(run)] == ["became slack", "slips", "became slack", "taut again", "became slack"]
    first, last = run.report["events"][2]["time"], run.report["events"][3]["time"]
    free = (run.time > first) & (run.time < last)
    assert not run["top.tension_on"][free].any() and not run["top.torque"][free].any()
    fall = run["load.position"][:, 1][free]
    assert np.diff(fall, 2) == pytest.approx(-GRAVITY * 4e-6, rel=1e-6)
    assert balance(run) < 2e-6


@pytest.mark.parametrize("wheel", [{}, {"inertia": 0.3}])
def test_momentum_with_a_sheave_on_a_body(wheel):
    """The momentum of bodies is kept, and its moment is that of loads, with a rope that slips on a sheave of a body."""
    run = carried(friction=0.01, **wheel).run(0.2, output_step=2e-4, integrator="radau", **BRIEF | {"tol": 1e-9})
    assert run["top.slip"][1:].any()
    masses = {"A": 2.0, "B": 3.0, "S": 5.0}
    momentum = sum(mass * run[f"{name}.velocity"] for name, mass in masses.items())
    moment = sum(mass * np.cross(run[f"{name}.position"], run[f"{name}.velocity"])[:, 2]
                 + 0.1 * run[f"{name}.angular_velocity"][:, 2] for name, mass in masses.items())
    if wheel:
        spin = np.gradient(run["top.angle"], run.time, edge_order=2) + run["S.angular_velocity"][:, 2]
        moment += wheel["inertia"] * spin
    loads = sum(run[f"{name}.position"][:, 0] * force for name, force in FORCES.items())
    by_loads = np.append(0, np.cumsum((loads[1:] + loads[:-1]) * 1e-4))
    assert np.abs(momentum - momentum[0]).max() < 1e-12
    assert np.abs(moment - moment[0] - by_loads)[2:-2].max() < (1e-3 if wheel else 1e-5)
    assert balance(run) < 1e-7


@pytest.mark.slow
def test_a_rope_of_little_mass_slips_alike():
    """A swinging load, beside a rope of 1e-5 kg/m whose friction sticks."""
    def run(mass):
        scene = swing(2.0, 3.0, 0.2, 3.0, 4.0, 0.5)
        given = rope_of(1e5, 1e-5, 0, 1e-3) | {"mass": mass}
        over_one(scene, 0.2, ("counterweight", "load"), elements=1, tension=22.0, given=given,
                 friction=fu.Friction(coefficient=0.1, model="stick"))
        return scene.run(0.5, output_step=0.05, integrator="radau", **BRIEF)

    without, light = run(False), run(True)
    for name in ("counterweight.position", "load.position"):  # the arc stretches in one of them alone
        assert np.abs(without[name] - light[name]).max() < 2e-4
    assert without["top.slip"][-1] == pytest.approx(light["top.slip"][-1], rel=5e-3)
    assert without["top.wrap_angle"] == pytest.approx(light["top.wrap_angle"], abs=1e-5)
    assert without["energy.dissipated"][-1] == pytest.approx(light["energy.dissipated"][-1], rel=1e-2)


# ---- files and states

@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_resumed_bit_for_bit(tmp_path, integrator):
    """The rope slips before and after the run is interrupted."""
    def scene():
        return two_weights(0.04, (1.0, 1.2), inertia=0.9, given=SOFT)

    settings = {"duration": 1.0, "output_step": 0.05, "tol": 1e-5, "integrator": integrator}
    kill(scene(), tmp_path / "run.nc", 10, **settings, progress=False)
    resumed = scene().run(**settings, save=tmp_path / "run.nc", resume=True, progress=False)
    whole = scene().run(**settings, progress=False)
    assert events(whole) == [("top", "slips")]
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_a_state_of_a_rope_that_has_slipped_is_refused():
    scene = two_weights(0.03, (1.0, 1.2), inertia=0.9)
    run = scene.run(0.2, output_step=0.1, **BRIEF)
    with refused('initial: a rope without mass had slipped on sheave "top" until then, and a state does not tell how '
                 "far; continue that run by save and resume=True"):
        scene.run(0.1, initial=run.at(0.2), **BRIEF)
    assert scene.run(0.1, initial=run.at(0.0), **BRIEF).status == "completed"


def test_too_many_sheaves_with_friction_are_refused():
    sheaves = [fu.Sheave(f"s{k}", at=(k, -0.5 * (k % 2), 0), radius=0.2, friction=0.1) for k in range(128)]
    with refused('rope "rope": has no mass, and 128 sheaves with friction, more than 127; let two ropes end at a body '
                 "between them, or leave friction out"):
        fu.Scene().rope("rope", route=[fu.Anchor(at=(-1, 0, 0)), *sheaves, fu.Anchor(at=(129, 0, 0))], tension=40.0,
                        **STIFF)


def test_friction_that_holds_is_not_touched_by_slip():
    """A rope that sticks all the time has no events, and no slip."""
    run = two_weights(0.06, (1.0, 1.2), inertia=0.9).run(0.5, output_step=0.1, **BRIEF)
    assert not events(run) and not run["top.slip"].any() and not run["top.slip_angle"].any()
