"""Ropes without mass in motion: references, wraps that vanish and return, slackness, drums and sheaves that hold them,
energy and momentum, agreement with ropes with mass, files, and how runs end.
"""

from math import cos, exp, pi, sin, sqrt

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from interrupted_runs import kill
from ropes import CASES
from ropes.massless_runs import RUNS
from ropes.scenes import GRAVITY, over_one, rope_of, swing, weight

BY_KEY = {case.key: case for case in CASES}
STIFF = rope_of(1e7, 1e-5, 0, 1e-3) | {"mass": False}
SOFT = rope_of(6e4, 1e-5, 0, 1e-3) | {"mass": False}
HOLDS = fu.Friction(coefficient=0.5)
BRIEF = {"tol": 1e-7, "progress": False}


@pytest.mark.parametrize("key", RUNS)
def test_a_run_keeps_the_bars(key):
    case, found = BY_KEY[key], RUNS[key]()
    checked = [(quantity, found[quantity.name], reference) for quantity, reference
               in zip(case.quantities, case.reference(), strict=True) if quantity.name in found]
    assert len(checked) == len(found)
    errors = {quantity.name: abs(value - reference) / (1.0 if quantity.absolute else abs(reference)) / quantity.bar
              for quantity, value, reference in checked}
    assert {name: error for name, error in errors.items() if error > 1} == {}


def near(one, other, bound, *names):
    for name in names:
        assert np.abs(one[name] - other[name]).max() < bound, name


# ---- wraps

def circling(turns: float) -> fu.Run:
    """Return a load that circles a peg, without gravity, and winds its rope up by some turns."""
    R, free, v = 0.1, 3.0, 2.0
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("load", mass=2.0, inertia=(1, 1, 1), position=(R, free, 0), velocity=(-v, 0, 0))
    scene.rope("rope", route=[fu.Anchor(at=(R, -1, 0)), fu.Sheave("peg", at=(0, 0, 0), radius=R, side="left"),
                              fu.Anchor("load")], tension=2.0 * v**2 / free, **STIFF)
    # l l' = -R v: the free length of an involute is sqrt(free² - 2 R v t), and the wrap (free - l)/R
    last = free - 2 * pi * R * turns
    return scene.run((free**2 - last**2) / (2 * R * v), output_step=0.1, integrator="radau", **BRIEF)


def test_a_wrap_grows_beyond_turns():
    """The free length of an involute; the wrap passes 180, 360 and 720 deg."""
    run = circling(3.5)
    free = np.sqrt(9.0 - 2 * 0.1 * 2.0 * run.time)
    assert np.abs(run["peg.wrap_angle"] - (3.0 - free) / 0.1).max() < 1e-4
    assert run["peg.wrap_angle"][-1] > 6.9 * pi
    assert np.abs(np.linalg.norm(run["load.velocity"], axis=1) - 2.0).max() < 1e-5


def test_a_wrap_that_vanishes_and_returns_is_an_event():
    """Energy is kept over both, and the states are those of a rope that swings freely between."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "load", 1.0, -2 * sin(0.7), -2 * cos(0.7))
    peg = fu.Sheave("peg", at=(0.3, -1, 0), radius=0.1, side="left")
    scene.rope("rope", route=[fu.Anchor(at=(0, 0, 0)), peg, fu.Anchor("load")], tension=5.0, **STIFF)
    run = scene.run(4.5, output_step=0.1, **BRIEF)
    assert [each["what"] for each in run.report["events"]] == ["returned", "left the sheave"] * 2
    first, lost = (each["time"] for each in run.report["events"][:2])
    wrapped = (run.time > first) & (run.time < lost)
    assert (run["peg.wrap_angle"][wrapped] > 0).all() and np.abs(run["peg.wrap_angle"][run.time < first]).max() == 0
    assert (run["peg.normal_force"][wrapped] > 0).all() and np.abs(run["peg.force"][run.time < first]).max() == 0
    assert np.abs(run.energy_balance().relative).max() < 1e-8
    # the results show the rope from the anchor to the load, over the peg
    places = run["rope.position"]
    assert np.abs(places[:, 0]).max() < 1e-14 and np.abs(places[:, -1] - run["load.position"]).max() < 1e-14
    lengths = np.linalg.norm(np.diff(places, axis=1), axis=2).sum(axis=1)
    assert np.abs(lengths - 2.0).max() < 2e-4  # chords in the place of the arc
    assert np.abs(run["rope.s"][:, -1] - run["rope.s"][0, -1]).max() < 1e-12


def test_a_sheave_is_met_from_its_other_side():
    """A rope whose end passes above a peg, and which is then paid out, meets the peg from behind as it swings back."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "load", 1.0, 0.1 - 0.9 * sin(0.7), -0.9 * cos(0.7))
    pays = fu.TableSignal(time=[0, 0.6, 0.7, 1.4, 1.5, 9], value=[0, 0, -12, -12, 0, 0], interpolation="linear")
    winch = fu.Drum("winch", at=(0, 0, 0), radius=0.1, side="right", length_in_store=4, velocity=pays)
    scene.rope("rope", route=[winch, fu.Sheave("peg", at=(0.3, -1.1, 0), radius=0.1, side="left"), fu.Anchor("load")],
               tension=5.0, **STIFF)
    with pytest.raises(fu.RopeLeftError, match='meets sheave "peg" from its other side'):
        scene.run(4.0, output_step=0.1, **BRIEF)


def test_a_sheave_with_friction_must_be_touched():
    with pytest.raises(fu.SceneError, match='the rope does not touch sheave "peg"'):
        fu.Scene().rope("rope", tension=5.0, **STIFF, route=[
            fu.Anchor(at=(0, 0, 0)), fu.Sheave("peg", at=(1, -0.1, 0), radius=0.1, side="right", friction=0.3),
            fu.Anchor(at=(2, 0, 0))])


# ---- slackness

def test_a_rope_becomes_slack_and_taut_again():
    """A load thrown up flies freely; the instants are those of its parabola. Energy that damping kept is lost."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    scene.rigid_body("load", mass=5.0, inertia=(5, 5, 5), position=(0.3, -3, 0), velocity=(0, 3, 0))
    scene.rope("rope", route=[fu.Anchor(at=(-0.3, -2, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right"),
                              fu.Anchor("load")], tension=1.0, **SOFT)
    run = scene.run(1.0, output_step=0.05, **BRIEF)
    first, after = run.report["events"][:2]
    assert (first["what"], after["what"]) == ("taut again", "became slack")
    length = 5 + 0.3 * pi
    drop = length - length / (1 + 1.0 / 6e4)  # below the place at which the rope has no stretch
    assert 3 * first["time"] - GRAVITY / 2 * first["time"] ** 2 == pytest.approx(drop, abs=1e-8)
    slack = run.time < first["time"]
    assert not run["top.tension_on"][slack].any() and not run["top.force"][slack].any()
    assert np.abs(run.energy_balance().relative).max() < 1e-7
    assert run["energy.dissipated"][-1] > 0.1


# ---- wheels that hold the rope

def on_a_held_sheave(friction: float, loads: tuple[float, float], **sheave) -> fu.Scene:
    """Return two weights on a sheave that is held."""
    scene = swing(*loads, 0.2, 2.0, 2.0, 0.0)
    over_one(scene, 0.2, ("counterweight", "load"), tension=GRAVITY * max(loads), given=SOFT, friction=friction,
             **sheave)
    return scene


@pytest.mark.parametrize(("coefficient", "turns"), [(0.1, 0), (0.3, 0), (0.3, 1)])
def test_a_capstan_holds_up_to_its_limit(coefficient, turns):
    """At rest the ratio of both tensions is that of the weights; e^(mu theta) is the limit, 1e-5 to either side, beyond
    which the rope slips from the start.
    """
    limit = exp(coefficient * pi * (1 + 2 * turns))
    rests = [on_a_held_sheave(coefficient, (1.0, limit * factor), turns=turns) for factor in (1 - 1e-5, 1 + 1e-5)]
    held = rests[0].run(0.5, output_step=0.1, initial="equilibrium", **BRIEF)
    assert held["top.tension_off"] / held["top.tension_on"] == pytest.approx(limit * (1 - 1e-5), rel=1e-7)
    assert not held["top.slip"].any()
    slides = rests[1].run(0.5, output_step=0.1, initial="equilibrium", **BRIEF)
    assert slides["top.tension_off"] / slides["top.tension_on"] == pytest.approx(limit, rel=1e-9)
    assert (slides["top.slip"][1:] > 0).all()


def test_a_held_sheave_takes_the_difference_of_tensions():
    scene = on_a_held_sheave(5.0, (2.0, 1.0)).replace("load", velocity=(0.2, 0, 0))
    run = scene.run(1.0, output_step=0.1, initial="equilibrium", **BRIEF)
    difference = run["top.tension_off"] - run["top.tension_on"]
    assert run["top.torque"] == pytest.approx(-0.2 * difference, rel=1e-12)  # side="right": clockwise in its order
    assert run["top.tension_on"] == pytest.approx(np.full(11, 2 * GRAVITY), rel=1e-6)
    assert np.ptp(run["load.position"][:, 0]) > 0.05 and np.ptp(run["counterweight.position"]) < 3
    assert np.abs(run.energy_balance().relative).max() < 1e-7


FORCES = {"A": -300.0, "B": -300.0, "S": 600.0}


def carried(**sheave) -> fu.Scene:
    """Return a rope over a body that moves and turns, between two bodies; the sum of all loads is zero."""
    scene = fu.Scene(gravity=(0, 0, 0))
    for name, mass, at, motion in (("A", 2.0, (-0.2, -1, 0), {"velocity": (0, -0.1, 0)}),
                                   ("B", 3.0, (0.3, -1.2, 0), {"velocity": (0.2, -0.1, 0)}),
                                   ("S", 5.0, (0, 0.1, 0), {"velocity": (0, 0.1, 0), "angular_velocity": (0, 0, 0.1)})):
        scene.rigid_body(name, mass=mass, inertia=(1, 1, 0.1), position=at, **motion)
    scene.rope("hoist", route=[fu.Anchor("A", at=(0, 0.1, 0)),
                               fu.Sheave("top", at=("S", (0.02, -0.05, 0)), radius=0.2, **sheave), fu.Anchor("B")],
               tension=300.0, **SOFT)
    for name, force in FORCES.items():
        scene.force(name, value=(0, force, 0))
    return scene


WHEELS = {"smooth": {}, "held": {"friction": 2.0}, "turning": {"friction": 2.0, "inertia": 0.02},
          "driven": {"friction": 2.0, "inertia": 0.02, "torque": 0.7, "damping": 0.1}}


@pytest.mark.parametrize("wheel", WHEELS)
def test_momentum_and_energy_with_a_sheave_on_a_body(wheel):
    """Momentum is kept, and its moment changes by that of loads: a body with a sheave takes the moment of a rope that
    it holds.
    """
    run = carried(**WHEELS[wheel]).run(0.2, output_step=2e-4, integrator="radau", **BRIEF | {"tol": 1e-10})
    masses = {"A": 2.0, "B": 3.0, "S": 5.0}
    momentum = sum(mass * run[f"{name}.velocity"] for name, mass in masses.items())
    moment = sum(mass * np.cross(run[f"{name}.position"], run[f"{name}.velocity"])[:, 2]
                 + 0.1 * run[f"{name}.angular_velocity"][:, 2] for name, mass in masses.items())
    if wheel in ("turning", "driven"):
        spin = np.gradient(run["top.angle"], run.time, edge_order=2) + run["S.angular_velocity"][:, 2]
        moment += 0.02 * spin
    loads = sum(run[f"{name}.position"][:, 0] * force for name, force in FORCES.items())
    by_loads = np.append(0, np.cumsum((loads[1:] + loads[:-1]) * 1e-4))
    assert np.abs(momentum - momentum[0]).max() < 1e-9
    assert np.abs(moment - moment[0] - by_loads)[2:-2].max() < (1e-5 if wheel in ("smooth", "held") else 1e-3)
    assert np.abs(run.energy_balance().relative).max() < 1e-8
    assert np.ptp(run["S.angular_velocity"][:, 2]) > 0.01


@pytest.mark.parametrize("wheel", WHEELS)
def test_integrators_agree(wheel):
    runs = [carried(**WHEELS[wheel]).run(0.2, output_step=0.05, integrator=each, **BRIEF)
            for each in ("radau", "genalpha", "explicit")]
    for run in runs:
        near(run, runs[-1], 2e-6, "A.position", "B.position", "S.position", "hoist.position")
        assert np.abs(run.energy_balance().relative).max() < 1e-5


def test_the_energy_scheme_is_refused():
    with refused('rope "hoist": integrator "energy" does not support ropes without mass; take another integrator'):
        carried().run(0.1, integrator="energy", progress=False)


def test_a_drum_under_a_torque_lifts_a_load():
    """The drum's inertia and the load: I w' = M - T R, m (g + R w') = T, stretch aside."""
    R, inertia, m, torque = 0.25, 0.8, 20.0, 60.0
    scene = swing(1.0, m, R, 1.0, 8.0, 0.0).without("counterweight")
    winch = fu.Drum("winch", at=(0, 0, 0), radius=R, side="right", length_in_store=3.0, inertia=inertia, torque=torque)
    scene.rope("rope", route=[winch, fu.Anchor("load")], tension=m * GRAVITY, **STIFF)
    run = scene.run(1.0, output_step=0.25, integrator="radau", **BRIEF)
    rate = (torque - m * GRAVITY * R) / (inertia + m * R**2)
    assert run["winch.angle"][-1] == pytest.approx(rate / 2, rel=1e-4)
    assert run["winch.tension"][-1] == pytest.approx(m * (GRAVITY + R * rate), rel=1e-4)
    assert run["winch.torque"] == pytest.approx(torque, rel=1e-6)
    assert run["winch.power"][-1] == pytest.approx(torque * rate, rel=1e-4)
    assert run["winch.length_in_store"][-1] == pytest.approx(3 + R * rate / 2, rel=1e-4)
    assert run["winch.material_speed"][-1] == pytest.approx(-R * rate, rel=1e-4)
    assert np.abs(run.energy_balance().relative).max() < 1e-7


def test_a_drum_on_a_body_that_turns():
    """A drum that is held on a hub turns with it, by more than a turn: the same as one with the hub's inertia."""
    R, inertia, m, torque = 0.1, 0.8, 20.0, 60.0
    scene = swing(1.0, m, R, 1.0, 8.0, 0.0).without("counterweight")
    scene.rigid_body("hub", mass=3.0, inertia=(1, 1, inertia), position=(0, 0, 0))
    scene.joint("revolute", "hub", (0, 0, 0), axis=(0, 0, 1), name="bearing")
    scene.moment("hub", value=(0, 0, torque))
    winch = fu.Drum("winch", at="hub", radius=R, side="right", length_in_store=3.0)
    scene.rope("rope", route=[winch, fu.Anchor("load")], tension=m * GRAVITY, **STIFF)
    run = scene.run(0.8, output_step=0.2, integrator="radau", **BRIEF)
    rate = (torque - m * GRAVITY * R) / (inertia + m * R**2)
    assert rate * 0.8**2 / 2 > 2 * pi
    assert run["hub.angular_velocity"][-1, 2] == pytest.approx(0.8 * rate, rel=1e-4)
    assert run["winch.length_in_store"][-1] == pytest.approx(3 + R * rate * 0.8**2 / 2, rel=1e-4)
    assert run["load.position"][-1, 1] == pytest.approx(-8 + R * rate * 0.8**2 / 2, rel=1e-4)
    assert run["winch.torque"][-1] == pytest.approx(m * (GRAVITY + R * rate) * R, rel=1e-4)
    assert np.abs(run.energy_balance().relative).max() < 1e-6


def test_a_drum_runs_empty():
    scene = swing(1.0, 20.0, 0.25, 1.0, 2.0, 0.0).without("counterweight")
    given = {"at": (0, 0, 0), "radius": 0.25, "side": "right", "length_in_store": 0.5, "velocity": -2.0}
    scene.rope("rope", route=[fu.Drum("winch", **given), fu.Anchor("load")], tension=200.0, **STIFF)
    with pytest.raises(fu.RopeLeftError, match='drum "winch" has run empty') as caught:
        scene.run(2.0, output_step=0.1, **BRIEF)
    assert caught.value.run["winch.length_in_store"][-1] == pytest.approx(0.0, abs=1e-9)
    stopped = scene.replace("rope", route=[fu.Drum("winch", at_end="stop", **given), fu.Anchor("load")])
    assert stopped.run(2.0, output_step=0.1, **BRIEF).time[-1] == pytest.approx(1.0, rel=1e-4)


def test_a_belt_that_does_not_slip():
    """A driven pulley turns the other one by a closed rope; both angles are equal but for the stretch."""
    scene, R = fu.Scene(gravity=(0, 0, 0)), 0.1
    pulley = {"radius": R, "inertia": 0.05, "friction": 3.0, "side": "left"}
    scene.rope("belt", closed=True, tension=500.0, **rope_of(1e5, 1e-5, 0, 1e-3) | {"mass": False}, route=[
        fu.Sheave("driver", at=(0, 0, 0), **pulley | {"inertia": 0.0}, velocity=fu.Ramp(start=0, end=0.5, after=10.0)),
        fu.Sheave("driven", at=(1.0, 0, 0), **pulley)])
    run = scene.run(2.0, output_step=0.1, integrator="radau", **BRIEF)
    assert run["driven.angle"][-1] == pytest.approx(run["driver.angle"][-1], rel=1e-4)
    assert run["driver.wrap_angle"] == pytest.approx(np.full(len(run.time), pi))
    assert run["driver.material_speed"][-1] == pytest.approx(R * 10 / (1 + 500 / 1e5), rel=1e-4)
    assert (run["belt.s"][-1] - run["belt.s"][0])[:5] == pytest.approx(
        np.full(5, -R * run["driver.angle"][-1] / (1 + 500 / 1e5)), rel=1e-3)
    assert np.abs(run.energy_balance().relative).max() < 2e-6


def test_energy_of_a_drum_that_winds_a_rope_whose_strain_changes():
    """The store takes up the energy of what is wound: the work of the drive is explained, at a strain of 1 %."""
    scene = swing(1.0, 50.0, 0.25, 1.0, 8.0, 0.5).without("counterweight")
    haul = fu.TableSignal(time=[0, 0.5, 1.5, 2, 9], value=[0, 8, 8, -8, -8], interpolation="linear")
    winch = fu.Drum("winch", at=(0, 0, 0), radius=0.25, side="right", length_in_store=3.0, velocity=haul)
    scene.rope("rope", route=[winch, fu.Anchor("load")], tension=430.0, **SOFT)
    run = scene.run(3.0, output_step=0.1, integrator="radau", **BRIEF)
    assert np.ptp(run["winch.tension"]) > 300 and np.ptp(run["winch.length_in_store"]) > 1.5
    assert np.abs(run.energy_balance().relative).max() < 1e-5


def test_forty_one_sheaves():
    """The wraps and the tension of a row of sheaves, which the rope passes above and below."""
    scene, n = fu.Scene(gravity=(0, -GRAVITY, 0)), 41
    weight(scene, "A", 2.0, -0.2, -1)
    weight(scene, "B", 2.2, n - 0.8, -1)
    sheaves = [fu.Sheave(f"s{k}", at=(k, -0.5 * (k % 2), 0), radius=0.2, side=("right", "left")[k % 2])
               for k in range(n)]
    scene.rope("hoist", route=[fu.Anchor("A"), *sheaves, fu.Anchor("B")], tension=20.0, **STIFF)
    runs = [scene.run(0.2, output_step=0.1, integrator=each, **BRIEF) for each in ("radau", "genalpha")]
    near(*runs, 1e-6, "A.position", "B.position")
    for sheave in sheaves:
        assert runs[0][f"{sheave.name}.tension_on"] == pytest.approx(runs[0]["s0.tension_off"], rel=1e-12)
    assert runs[0]["s0.tension_on"][-1] == pytest.approx(2 * 2.0 * 2.2 * GRAVITY / 4.2, rel=1e-2)


# ---- beside ropes with mass

@pytest.mark.parametrize("kind", ["smooth", "drum"])
@pytest.mark.slow_cases("smooth")
def test_a_rope_of_little_mass_tends_to_none(kind):
    """Ropes of 1e-5 kg/m over a sheave without friction, and hauled in by a drum."""
    def run(mass):
        scene = swing(5.5, 5.0, 0.3, 3.0, 4.0, 0.5)
        given = rope_of(1e5, 1e-5, 0, 1e-3) | {"mass": mass, "elements": 1}
        if kind == "smooth":
            scene.rope("rope", tension=50.0, **given, route=[
                fu.Anchor("counterweight"), fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right"),
                fu.Anchor("load")])
        else:
            haul = fu.Ramp(start=0, end=0.2, after=1.0)
            scene = scene.without("counterweight")
            scene.rope("rope", tension=50.0, **given, route=[
                fu.Drum("top", at=(0, 0, 0), radius=0.3, side="right", length_in_store=2.0, velocity=haul),
                fu.Anchor("load")])
        return scene.run(0.5, output_step=0.1, tol=1e-7, integrator="radau", progress=False)

    without, light = run(False), run(True)
    near(without, light, 2e-5, "load.position")
    assert np.abs(without["top.force"] - light["top.force"])[2:].max() < 0.05  # waves of the light rope have gone
    assert np.abs(without["rope.end_force"] - light["rope.end_force"])[2:].max() < 0.05
    assert np.abs(without["top.material_speed"] - light["top.material_speed"])[2:].max() < 2e-3


# ---- statics, modes

def hanging() -> fu.Scene:
    """Return a load that hangs on a rope from an anchor over a smooth sheave."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "load", 5.0, 0.3, -3)
    scene.rope("rope", route=[fu.Anchor(at=(-0.3, -2, 0)), fu.Sheave("top", at=(0, 0, 0), radius=0.3, side="right"),
                              fu.Anchor("load")], tension=40.0, **SOFT)
    return scene


def test_rest_and_modes():
    """A pendulum whose foot moves along the sheave, and a load on a spring of the whole rope."""
    scene = hanging()
    rest = scene.equilibrium()
    assert rest["top.tension_on"] == pytest.approx(5 * GRAVITY, rel=1e-9)
    free = (5 + 0.3 * pi) / (1 + 40 / 6e4)
    drop = free * (1 + 5 * GRAVITY / 6e4) - 5 - 0.3 * pi
    assert rest["load.position"] == pytest.approx([0.3, -3 - drop, 0], abs=1e-8)
    modes = scene.modes(3, about=rest)
    assert modes.frequency[1] == pytest.approx(sqrt(GRAVITY / (3 + drop)) / (2 * pi), rel=1e-6)
    assert modes.frequency[2] == pytest.approx(sqrt(6e4 / free / 5) / (2 * pi), rel=1e-6)
    moved = modes["rope.displacement"]
    assert moved[:, -1] == pytest.approx(modes["load.displacement"], abs=1e-6)
    assert np.abs(moved[:, 0]).max() < 1e-9
    run = scene.run(0.5, output_step=0.1, initial=rest, **BRIEF)
    assert np.abs(run["load.position"] - rest["load.position"]).max() < 1e-9


def test_rest_finds_which_pegs_a_rope_touches():
    """A load drawn aside hangs over a peg that its rope does not touch as drawn; its angle balances the tension."""
    scene = fu.Scene(gravity=(0, -GRAVITY, 0))
    weight(scene, "load", 5.0, -1.0, -2)
    peg = fu.Sheave("peg", at=(0.05, -1, 0), radius=0.1, side="left")
    scene.rope("rope", route=[fu.Anchor(at=(0, 0, 0)), peg, fu.Anchor("load")], tension=49.0, **SOFT)
    assert not scene.run(1e-3, output_step=1e-3, **BRIEF)["peg.wrap_angle"][0]
    rest = scene.equilibrium()
    assert rest["load.position"][0] == pytest.approx(-0.05, abs=1e-9)  # straight down from the left of the peg
    leaning = np.arcsin(0.05 / np.hypot(0.05, 1)) + np.arcsin(-0.1 / np.hypot(0.05, 1))
    assert rest["peg.wrap_angle"] == pytest.approx(-leaning, abs=1e-9)
    assert rest["peg.force"][0] == pytest.approx(5 * GRAVITY * sin(-leaning), rel=1e-6)


# ---- files

def test_files(tmp_path):
    scene = carried(**WHEELS["turning"])
    run = scene.run(0.1, output_step=0.05, **BRIEF)
    run.save(tmp_path / "run.nc")
    copy = fu.Scene.from_toml(scene.to_toml())
    for other in (fu.load_run(tmp_path / "run.nc"), copy.run(0.1, output_step=0.05, **BRIEF)):
        assert all(np.array_equal(run[name], other[name]) for name in run)


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit"])
def test_resumed_bit_for_bit(tmp_path, integrator):
    """The peg is met before the run is interrupted and left after it."""
    def scene():
        made = fu.Scene(gravity=(0, -GRAVITY, 0))
        weight(made, "load", 1.0, -2 * sin(0.7), -2 * cos(0.7))
        winch = fu.Drum("winch", at=(0, 0, 0), radius=0.01, side="right", length_in_store=1.0, velocity=0.1)
        made.rope("rope", route=[winch, fu.Sheave("peg", at=(0.3, -1, 0), radius=0.1, side="left"), fu.Anchor("load")],
                  tension=5.0, **SOFT)
        return made

    settings = {"duration": 2.0, "output_step": 0.05, "tol": 1e-5, "integrator": integrator}
    kill(scene(), tmp_path / "run.nc", 25, **settings, progress=False)
    resumed = scene().run(**settings, save=tmp_path / "run.nc", resume=True, progress=False)
    whole = scene().run(**settings, progress=False)
    assert {each["what"] for each in whole.report["events"]} == {"returned", "left the sheave"}
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_a_run_from_a_state_of_another():
    scene = hanging().replace("load", velocity=(0.3, 0, 0))
    run = scene.run(0.4, output_step=0.1, **BRIEF)
    later = scene.run(0.2, output_step=0.1, initial=run.at(0.2), **BRIEF)
    assert np.abs(later["load.position"][-1] - run["load.position"][-1]).max() < 1e-7
    wound = circling(1.0)
    with pytest.raises(fu.RopeLeftError, match="so that its turns are not known"):
        wound.scene.run(0.1, initial=wound.at(wound.time[-1]), **BRIEF)


# ---- refusals

@pytest.mark.parametrize(("given", "message"), [
    ({"route": [fu.Sheave("a", at=(0, 0, 0), radius=0.1, side="left"), fu.Sheave("b", at=(1, 0, 0), radius=0.1,
                                                                                 side="left")],
      "closed": True, "tension": 10.0}, 'rope "rope": has no mass, is closed, and no sheave holds it: how far it has '
     "run is then not known; give friction of a sheave")])
def test_refusals(given, message):
    with refused(message):
        fu.Scene().rope("rope", **STIFF | given)


def test_a_straight_part_becomes_too_short():
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("load", mass=1.0, inertia=(1, 1, 1), position=(1, 0, 0), velocity=(-1, 0, 0))
    scene.rope("rope", route=[fu.Anchor(at=(-1, -1, 0)), fu.Sheave("top", at=(0, -0.1, 0), radius=0.1, side="right"),
                              fu.Anchor("load")], tension=1e-3, **SOFT)
    with pytest.raises(fu.RopeLeftError, match='a span of rope "rope" becomes too short to be modelled'):
        scene.run(2.0, output_step=0.1, **BRIEF)


def around(wrap: float) -> fu.Scene:
    """Return a rope between two anchors over the top of a sheave whose side is given."""
    on, off = (0.1 * np.array([cos(a), sin(a), 0]) + 2.0 * way * np.array([sin(a), -cos(a), 0])
               for a, way in (((pi + wrap) / 2, -1), ((pi - wrap) / 2, 1)))
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rope("rope", tension=10.0, **SOFT, route=[fu.Anchor(at=tuple(on)), fu.Sheave(
        "top", at=(0, 0, 0), radius=0.1, side="right"), fu.Anchor(at=tuple(off))])
    return scene


@pytest.mark.parametrize("wrap", [0.3, 1.0, pi, 3.2])
def test_a_side_that_is_given_changes_nothing_where_the_rope_turns_to_it(wrap):
    """Half a turn is not that of a rope that passes on the other side."""
    run = around(wrap).run(0.01, output_step=0.01, **BRIEF)
    assert np.abs(run["top.wrap_angle"] - wrap).max() < 1e-3
    assert np.abs(run["top.tension_on"] - 10.0).max() < 1e-3


def test_a_sheave_far_from_the_line_between_the_ends_is_passed_with_a_note():
    with pytest.warns(fu.FunicularWarning, match=r'"rope": sheave "top": the rope passes it without touching it as '
                                                 r"drawn; a rope with mass would run around it by 3\.5 rad: give"):
        scene = around(3.5)
    assert np.all(scene.run(0.01, output_step=0.01, **BRIEF)["top.wrap_angle"] == 0)


def test_a_belt_over_equal_sheaves_with_sides():
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rope("belt", closed=True, tension=10.0, **SOFT, route=[
        fu.Sheave("one", at=(0, 0, 0), radius=0.1, side="left", friction=0.1),
        fu.Sheave("other", at=(1, 0, 0), radius=0.1, side="left")])
    run = scene.run(0.01, output_step=0.01, **BRIEF)
    for name in ("one", "other"):
        assert np.abs(run[f"{name}.wrap_angle"] - pi).max() < 1e-9
