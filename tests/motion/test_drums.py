"""Ropes on drums in motion: energy and momentum, integrators, both ends, drums on bodies, empty drums, files."""

import funicular as fu
import numpy as np
import pytest
from funicular.model.build import build
from funicular.model.rope_states import rope_state
from interrupted_runs import killed_and_resumed
from test_ropes import INTEGRATORS, THIN, body, momenta, near

RAMP = fu.TableSignal(time=[0, 0.1, 1], value=[0, 3, 3], interpolation="linear")
DRIVES = {"held": {}, "torque": {"inertia": 0.05, "torque": 9.0}, "velocity": {"velocity": RAMP},
          "brake": {"inertia": 0.05, "damping": 2.0}}
BRIEF = {"duration": 0.2, "output_step": 0.05, "tol": 1e-6}


def hoist(*, side="right", store=3.0, **drive) -> fu.Scene:
    """Return a load that swings from a rope over a sheave, which a drum on the ground hauls in or pays out."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    body(scene, "load", 2.5, -1.2, 3.0, velocity=(0.4, 0, 0))
    scene.rope("hoist", route=[fu.Drum("winch", at=(0, -0.5, 0), radius=0.2, side=side, length_in_store=store, **drive),
                               fu.Sheave("top", at=(2, 1, 0), radius=0.3, side="right"), fu.Anchor("load")],
               tension=35.0, **THIN)
    return scene


def deck(**drive) -> fu.Scene:
    """Return a drum on a body that moves and turns, off its centre, with a load; the sum of all loads is zero."""
    scene = fu.Scene(gravity=(0, 0, 0))
    body(scene, "deck", 0.1, 0.05, 5.0, angular_velocity=(0, 0, 0.4), velocity=(0, 0.1, 0))
    body(scene, "load", 0.2, -2.0, 3.0, velocity=(0.3, -0.1, 0))
    winch = fu.Drum("winch", at=("deck", (-0.1, -0.05, 0)), radius=0.2, side="right", length_in_store=3.0, **drive)
    scene.rope("hoist", route=[winch, fu.Anchor("load", at=(0, 0.1, 0))], tension=60.0, **THIN)
    scene.force("deck", value=(0, 60, 0))
    scene.force("load", value=(0, -60, 0))
    return scene


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("scene", [hoist, deck])
@pytest.mark.slow_cases("hoist-velocity", "hoist-brake", "hoist-held")
def test_energy_and_the_agreement_of_integrators(scene, drive):
    runs = [scene(**DRIVES[drive]).run(**BRIEF, integrator=each) for each in INTEGRATORS]
    for run in runs:
        assert np.abs(run.energy_balance().relative).max() < 5e-6
        near(run, runs[1], 1e-7, "load.position", "winch.length_in_store")
        near(run, runs[1], 2e-2, "winch.tension", "winch.torque", "winch.force")
        assert (run["winch.residual"] < 1e-12).all() and (run["winch.normal_force"] > 0).all()
    assert abs(runs[0]["winch.length_in_store"][-1] - 3.0) > (1e-3 if drive != "held" or scene is deck else 1e-6)


@pytest.mark.parametrize("drive", ["torque", "brake", "held"])
def test_momentum_of_a_drum_on_a_body(drive):
    """What is wound takes part: momentum is kept to rounding, its moment changes by that of the loads."""
    scene = deck(**DRIVES[drive])
    run = scene.run(0.1, output_step=0.002, tol=1e-6, integrator="explicit")
    change = momenta(scene, run, -1) - momenta(scene, run, 0)
    moment = 60 * (run["deck.position"][:, 0] - run["load.position"][:, 0])
    assert np.abs(change[:2]).max() < 1e-9
    assert change[2] == pytest.approx(np.sum(moment[1:] + moment[:-1]) * 0.001, abs=2e-6)  # of the trapezoidal rule


def test_drive_and_tension():
    """The torque of a drum that holds a load is that of the tension on the arm of the tangent point, R + EI/(2 T R),
    and of the weight that is lifted to the centre, the mean height of the wound rope. What is wound, as stretched, is
    the way of the rim past the tangent point.
    """
    run, held = hoist(velocity=RAMP).run(**BRIEF), hoist().run(**BRIEF)
    T = held["winch.tension"]
    arm = 0.2 + 6e8 * np.pi / 4 * 1e-12 / (2 * T * 0.2)
    lifted = 7000 * np.pi * 1e-6 * 9.81 * (-0.5 - held["hoist.position"][:, 0, 1]) / (1 + T / (6e8 * np.pi * 1e-6))
    assert held["winch.torque"] == pytest.approx(arm * T + 0.2 * lifted, rel=2e-5)
    foot = run["hoist.position"][:, 0, :2] - (0, -0.5)
    way = 0.2 * (run["winch.angle"] - np.unwrap(np.arctan2(*foot.T[::-1])))
    stretch = 1 + np.mean(run["winch.tension"][[0, -1]]) / (6e8 * np.pi * 1e-6)
    assert (run["winch.length_in_store"][-1] - 3.0) * stretch == pytest.approx(way[-1] - way[0], rel=5e-3)
    rate = np.interp(run.time, (0, 0.1, 1), (0, 3, 3))  # RAMP
    assert run["winch.power"] == pytest.approx(run["winch.torque"] * rate)


def test_a_drum_at_the_last_end():
    """A rope drawn from the other end, its drum on the other side, moves the same."""
    run = hoist(velocity=RAMP).run(**BRIEF)
    scene = fu.Scene(gravity=(0, -9.81, 0))
    body(scene, "load", 2.5, -1.2, 3.0, velocity=(0.4, 0, 0))
    winch = fu.Drum("winch", at=(0, -0.5, 0), radius=0.2, side="left", length_in_store=3.0, velocity=RAMP)
    scene.rope("hoist", route=[fu.Anchor("load"), fu.Sheave("top", at=(2, 1, 0), radius=0.3, side="left"), winch],
               tension=35.0, **THIN)
    other = scene.run(**BRIEF)
    near(run, other, 1e-9, "load.position", "winch.length_in_store")
    near(run, other, 1e-5, "winch.torque", "winch.tension", "winch.force")


def test_a_store_of_any_length_is_the_same():
    """The rope does not know what is in store, but for its inertia and weight: none of a drum that is held."""
    runs = [hoist(store=store).run(**BRIEF) for store in (3.0, 300.0)]
    near(*runs, 1e-7, "load.position")


def test_an_empty_drum_ends_the_run():
    paying = fu.TableSignal(time=[0, 0.1, 1], value=[0, -3, -3], interpolation="linear")
    with pytest.raises(fu.RopeLeftError, match='drum "winch" has run empty') as caught:
        hoist(store=0.05, velocity=paying).run(0.5, output_step=0.1)
    assert caught.value.run["winch.length_in_store"][-1] == pytest.approx(0.0, abs=1e-6)
    assert 0.1 < caught.value.run.time[-1] < 0.3
    stopped = hoist(store=0.05, velocity=paying, at_end="stop").run(0.5, output_step=0.1)
    assert stopped.status == "event" and 'drum "winch", which has run empty,' in stopped.report["message"]
    assert stopped.time[-1] == caught.value.run.time[-1]


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_resumed_bit_for_bit(tmp_path, integrator):
    """What is in store has a history, which a resumed run continues."""
    scene = hoist(velocity=fu.TableSignal(time=[0, 0.05, 0.1, 1], value=[0, 3, -3, -3], interpolation="linear"))
    settings = {"duration": 0.2, "output_step": 0.01, "tol": 1e-5, "integrator": integrator}
    whole = scene.run(**settings, progress=False)
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 15, **settings, progress=False)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_states_of_no_instant():
    """A file of a run that stopped before its first row has no states."""
    model = build(hoist())
    state = rope_state(model, model.ropes[0], np.empty((0, len(model.q))))
    assert state["position"].shape[0] == 0 and state["position"].shape[1] == state["s"].shape[1] > 0


def test_a_scene_file():
    scene = hoist(velocity=RAMP)
    again = fu.Scene.from_toml(scene.to_toml())
    near(scene.run(**BRIEF), again.run(**BRIEF), 1e-15, "load.position", "winch.torque")


def test_statics_and_modes():
    """Two drums hold a rope over a sheave: the torques are R times the tension, which is that of the weight."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("block", mass=8.0, inertia=(1, 1, 0.1), position=(0, -2, 0))
    scene.rope("hoist", route=[fu.Drum("one", at=(-1.4, 0, 0), radius=0.2, side="left", length_in_store=2.0),
                               fu.Sheave("low", at="block", radius=0.3, side="left"),
                               fu.Drum("two", at=(1.4, 0, 0), radius=0.2, side="left", length_in_store=5.0)],
               tension=45.0, **THIN)
    rest = scene.equilibrium()
    assert rest["one.torque"] == pytest.approx(-rest["two.torque"], rel=1e-9)
    assert -rest["one.torque"] == pytest.approx(0.2 * rest["one.tension"], rel=1e-3)
    length = rest["hoist.s"][-1] + rest["two.length_in_store"]  # s is 0 where the rope ends on the first drum
    total = rest["one.force"] + rest["two.force"]
    assert total[1] == pytest.approx(-9.81 * (8.0 + 7000 * np.pi * 1e-6 * length), rel=1e-9)
    assert scene.modes(3, about=rest).frequency[1] > 0  # the block may turn in its rope


@pytest.mark.parametrize(("changes", "complaint"), [
    ({"length_in_store": 0.0}, "length_in_store"), ({"radius": 1e-4}, "radius"),
    ({"torque": 1.0}, "has torque, but no inertia"), ({"torque": 1.0, "angle": 2.0, "inertia": 1.0}, "two drives"),
])
def test_refused(changes, complaint):
    with pytest.raises(fu.SceneError, match=complaint):
        hoist(**changes) if "radius" not in changes and "length_in_store" not in changes else fu.Scene().rope(
            "hoist", tension=1.0, **THIN, route=[
                fu.Drum("winch", at=(0, 0, 0), side="left", **{"radius": 0.2, "length_in_store": 1.0} | changes),
                fu.Anchor(at=(3, 0, 0))])
