"""Ropes in space leave their drums, at the ground and on bodies that rotate: planar twins, momenta, energy, resumed."""

import funicular as fu
import numpy as np
import pytest
from interrupted_runs import killed_and_resumed
from test_left_drums import BRIEF, FALLING, paying
from test_ropes import INTEGRATORS, THIN, near
from test_turning_sheaves import momenta
from turned_scenes import ASKEW, turned_scene

DRIVES = {"damped": {"inertia": 0.05, "damping": 0.05},
          "driven": {"velocity": fu.TableSignal(time=[0, 0.05, 1], value=[0, -1, -1], interpolation="linear")}}
SHORT = {"duration": 0.04, "output_step": 0.005}


def hanging(element: str, out: float = 0.0, at_first: bool = True) -> fu.Scene:
    """Return a load that hangs from a drum at an end of its rope, which swings out of the plane."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("load", mass=3.0, inertia=(0.1, 0.1, 0.1), position=(0.2, -1.5, out), velocity=(0.1, 0, 2 * out))
    winch = fu.Drum("winch", at=(0, 0, 0), radius=0.2, side="right" if at_first else "left", length_in_store=0.1,
                    at_end="leave", velocity=paying(-3))
    route = [winch, fu.Anchor("load")]
    scene.rope("hoist", route=route if at_first else route[::-1], tension=3 * 9.81, **THIN | {"element": element})
    return scene


def deck(gravity=(0, 0, 0), density=7e3, **drum) -> fu.Scene:
    """Return a free body that turns, with a drum from which a load unwinds its rope as it flies around."""
    scene = fu.Scene(gravity=gravity)
    scene.rigid_body("deck", mass=50.0, inertia=(4, 5, 6), position=(0, 0, 0), velocity=(0.1, 0, 0.05),
                     angular_velocity=(0.8, 0.6, -0.4))
    scene.rigid_body("load", mass=2.0, inertia=(0.1, 0.15, 0.12), position=(0.3, -1.2, 0.1), velocity=(5, 1.1, 0.1),
                     angular_velocity=(0.1, 0.3, 0.2))
    winch = fu.Drum("winch", at=("deck", (0.05, -0.1, 0.03)), axis=(0.1, 0.05, 1), radius=0.2, side="right",
                    length_in_store=0.02, max_fleet_angle=0.5, at_end="leave", **drum)
    material = fu.Material(youngs_modulus=6e8, poisson_ratio=0.3, density=density, damping_time=1e-4)
    scene.rope("hoist", route=[winch, fu.Anchor("load", at=(0, 0.05, 0))], tension=40.0,
               **THIN | {"element": "cable12", "material": material})
    return scene


def test_a_planar_scene_and_its_spatial_twin():
    """The instant differs with what is wound by the sag of a chord."""
    plane, space = (hanging(element).run(**BRIEF, integrator="radau") for element in ("cable8p", "cable12"))
    assert space.events[0]["time"] == pytest.approx(plane.events[0]["time"], abs=1e-4)
    near(plane, space, 1e-4, "load.position")


@pytest.mark.slow
def test_integrators_and_ends_of_the_rope():
    """A rope out of the plane, whose drum is at the first or the last end of its route."""
    runs = [hanging("cable12", 0.05).run(**BRIEF, integrator=each) for each in INTEGRATORS]
    for run in [*runs, hanging("cable12", 0.05, at_first=False).run(**BRIEF, integrator="radau")]:
        assert [event["what"] for event in run.events] == ["left the drum"]
        assert np.abs(run.energy_balance().relative).max() < 1e-7
        near(run, runs[-1], 1e-6, "load.position", "winch.length_in_store", "winch.fleet_angle")
    assert run["winch.fleet_angle"][0] > 0.03
    assert [run[f"winch.{name}"][-1] for name in ("fleet_angle", "tension", "normal_force")] == pytest.approx([0, 0, 0])


@pytest.mark.parametrize("drive", DRIVES)
def test_momenta_of_free_bodies(drive):
    """They stay as the rope leaves. Not counted is the prescribed spin of what is wound, 2e-6 kg m²/s."""
    scene, runs = deck(**DRIVES[drive]), []
    for integrator in INTEGRATORS:
        run = scene.run(**SHORT, tol=1e-7, integrator=integrator, progress=False)
        assert [event["what"] for event in run.events] == ["left the drum"]
        found = np.array([momenta(scene, run, k) for k in range(len(run.time))])
        assert np.abs(found - found[0]).max() < 3e-6
        assert np.abs(found[-1] - found[0]).max() < 1e-7
        assert np.abs(run.energy_balance().relative).max() < 1e-6
        runs.append(run)
        near(run, runs[0], 1e-7, "load.position", "deck.orientation", "winch.angle")


def test_a_heavy_rope_under_gravity_that_is_turned():
    scene = deck(gravity=(1.0, -9.81, 3.0), density=2e4, **DRIVES["damped"])
    one, other = (each.run(**SHORT, tol=1e-6, integrator="radau") for each in (scene, turned_scene(scene, *ASKEW)))
    assert len(one.events) == len(other.events) == 1
    near(one, other, 1e-7, "winch.angle", "winch.length_in_store", "winch.fleet_angle", "winch.torque")
    assert np.abs(one.energy_balance().relative).max() < 1e-7


def test_goes_on_from_a_state_after_it_left():
    scene = hanging("cable12", 0.05)
    whole = scene.run(**BRIEF, integrator="radau")
    rest = scene.run(0.15, output_step=0.05, tol=1e-6, integrator="radau", initial=whole.at(FALLING))
    assert not rest.events
    assert rest["load.position"][-1] == pytest.approx(whole["load.position"][-1], abs=1e-6)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("writes", [10, 20])
def test_resumed_bit_for_bit(tmp_path, integrator, writes):
    """After interruptions before and after the rope has left."""
    scene, settings = deck(**DRIVES["damped"]), SHORT | {"tol": 1e-6, "integrator": integrator, "progress": False}
    whole = scene.run(**settings)
    assert whole.time[2] < whole.events[0]["time"] < whole.time[5]
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", writes, **settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_a_picture_of_a_rope_that_has_left():
    run = deck(**DRIVES["damped"]).run(**SHORT, tol=1e-5, integrator="radau")
    assert np.isfinite(run["hoist.position"]).all()
    assert run.animation() is not None
