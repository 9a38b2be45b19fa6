"""Ropes in space on drums, at the ground and on bodies that rotate: planar twins, momenta, energy, files."""

import funicular as fu
import numpy as np
import pytest
from funicular.base.rotations import rotate
from interrupted_runs import killed_and_resumed
from test_ropes import BRIEF, INTEGRATORS, THIN, near
from test_turning_sheaves import momenta
from turned_scenes import ASKEW, differences, turned_scene

RAMP = fu.TableSignal(time=[0, 0.1, 1], value=[0, 3, 3], interpolation="linear")
DRIVES = {"held": {}, "winds": {"velocity": RAMP}, "pays out": {"velocity": -2.0},
          "torque": {"inertia": 0.05, "torque": 4.0, "damping": 0.2}}


def hoist(element: str, out: float = 0.0, **drum) -> fu.Scene:
    """Return a load on a rope from a winch over a sheave, which swings out of the plane."""
    scene = fu.Scene()
    scene.rigid_body("load", mass=3.0, inertia=(0.1, 0.1, 0.1), position=(2.5, -1.2, out), velocity=(0.4, 0, 2 * out))
    winch = fu.Drum("winch", at=(0, -0.5, 0), radius=0.2, side="right", length_in_store=3.0, **drum)
    top = fu.Sheave("top", at=(2, 1, out / 2), radius=0.3, side="right", max_fleet_angle=0.5)
    scene.rope("hoist", route=[winch, top, fu.Anchor("load")], tension=35.0, **THIN | {"element": element})
    return scene


def deck(gravity=(0, 0, 0), density=7e4, **drum) -> fu.Scene:
    """Return a free body with a winch and a sheave, and a load on the rope."""
    scene = fu.Scene(gravity=gravity)
    scene.rigid_body("deck", mass=5.0, inertia=(0.2, 0.25, 0.3), position=(0, 0, 0), velocity=(0.1, 0, 0.05),
                     angular_velocity=(0.8, 0.6, 0.4))
    scene.rigid_body("load", mass=2.0, inertia=(0.1, 0.15, 0.12), position=(1.5, -1.2, 0.1), velocity=(0.5, -0.3, 0.2),
                     angular_velocity=(0.1, 0.3, 0.2))
    winch = fu.Drum("winch", at=("deck", (0.05, -0.1, 0.03)), axis=(0.1, 0.05, 1), radius=0.2, side="right",
                    length_in_store=3.0, max_fleet_angle=0.5, **drum)
    top = fu.Sheave("top", at=("deck", (0.8, 0.5, 0.08)), axis=(0, 0.1, 1), radius=0.15, side="right",
                    max_fleet_angle=0.5)
    given = THIN | {"element": "cable12", "material": fu.Material(youngs_modulus=6e8, poisson_ratio=0.3,
                                                                   density=density, damping_time=1e-4)}
    scene.rope("hoist", route=[winch, top, fu.Anchor("load", at=(0, 0.05, 0))], tension=30.0, **given)
    return scene


@pytest.mark.parametrize("drive", DRIVES)
def test_a_planar_scene_and_its_spatial_twin(drive):
    """The load agrees within 2e-8 m; what is wound by the sag of a chord."""
    plane, space = (hoist(element, **DRIVES[drive]).run(**BRIEF, integrator="radau")
                    for element in ("cable8p", "cable12"))
    near(plane, space, 1e-7, "load.position")
    near(plane, space, 2e-4, "winch.length_in_store", "winch.torque")
    near(plane, space, 2e-3, "winch.tension", "winch.force")
    assert np.abs(space["winch.fleet_angle"]).max() < 1e-12


@pytest.mark.parametrize("drive", DRIVES)
def test_energy_and_the_agreement_of_integrators(drive):
    runs = [hoist("cable12", 0.1, **DRIVES[drive]).run(**BRIEF, integrator=each) for each in INTEGRATORS]
    for run in runs:
        assert np.abs(run.energy_balance().relative).max() < 3e-6
        assert run["winch.residual"].max() < 1e-12
        near(run, runs[-1], 5e-8, "load.position", "winch.length_in_store", "winch.fleet_angle")
    assert np.abs(runs[0]["winch.fleet_angle"]).min() > 0.01


@pytest.mark.parametrize("drum", [{}, {"inertia": 0.05, "torque": 2.0}, {"inertia": 0.05, "damping": 0.5}])
def test_momenta_of_free_bodies(drum):
    """What is wound takes part. Corrections of the wound length over steps change momenta by 1e-7."""
    scene, runs = deck(**drum), []
    for integrator in ("genalpha", "explicit"):
        run = scene.run(0.04, output_step=0.02, tol=1e-7, integrator=integrator, progress=False)
        found = np.array([momenta(scene, run, k) for k in range(3)])
        assert np.abs(found[0]).min() > 0.1
        assert np.abs(found - found[0]).max() < 3e-7
        assert np.abs(run.energy_balance().relative).max() < 2e-6
        runs.append(run)
    near(*runs, 1e-7, "load.position", "deck.orientation", "winch.length_in_store")
    assert np.ptp(run["winch.length_in_store"]) > 1e-3


def test_a_heavy_rope_under_gravity_that_is_turned():
    scene = deck(gravity=(1.0, -9.81, 3.0), density=7e5, inertia=0.05, torque=2.0)
    one, other = (each.run(0.03, output_step=0.03, tol=1e-6, integrator="radau")
                  for each in (scene, turned_scene(scene, *ASKEW)))
    near(one, other, 1e-7, "winch.angle", "winch.length_in_store", "winch.fleet_angle", "top.wrap_angle")
    assert np.abs(one.energy_balance().relative).max() < 1e-5


def test_a_winch_at_rest_on_a_body():
    """A hanging body with a winch, whose rope lifts it: forces and moments balance."""
    scene = fu.Scene()
    scene.rigid_body("climber", mass=4.0, inertia=(0.05, 0.05, 0.05), position=(0.2, -1.0, 0.01), centre=(0, -0.3, 0))
    winch = fu.Drum("winch", at="climber", radius=0.15, side="right", length_in_store=2.0, max_fleet_angle=0.5)
    scene.rope("hoist", route=[winch, fu.Anchor(at=(0.3, 0.5, 0))], tension=39.0, **THIN | {"element": "cable12"})
    rest = scene.equilibrium()
    assert rest.stable
    assert rest["winch.force"] == pytest.approx([0, 39.24, 0], abs=2e-4)
    assert rest["winch.fleet_angle"] == pytest.approx(0, abs=1e-3)
    assert rest["winch.torque"] == pytest.approx(-0.15 * rest["winch.tension"], rel=2e-2) or (
        rest["winch.torque"] == pytest.approx(0.15 * rest["winch.tension"], rel=2e-2))
    run = scene.run(0.2, initial=rest, output_step=0.1, tol=1e-6, integrator="radau", progress=False)
    assert np.abs(run["climber.position"] - rest["climber.position"]).max() < 1e-6


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_resumed_bit_for_bit(tmp_path, integrator):
    scene = deck(inertia=0.05, torque=2.0)
    settings = {"duration": 0.02, "output_step": 0.002, "tol": 1e-5, "integrator": integrator}
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 15, **settings, progress=False)
    whole = scene.run(**settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)


def test_a_file_and_a_drum_that_runs_empty():
    scene = deck(inertia=0.05, torque=2.0)
    one, other = (each.run(0.02, output_step=0.01, tol=1e-5, integrator="radau")
                  for each in (scene, fu.Scene.from_toml(scene.to_toml())))
    assert max(differences(one, other).values()) == 0
    paying = hoist("cable12", 0.05, velocity=-30.0).replace("hoist", route=[
        fu.Drum("winch", at=(0, -0.5, 0), radius=0.2, side="right", length_in_store=0.05, velocity=fu.TableSignal(
            time=[0, 0.1, 1], value=[0, -3, -3], interpolation="linear")),
        *hoist("cable12", 0.05).ropes["hoist"].route[1:]])
    with pytest.raises(fu.RopeLeftError, match='drum "winch" has run empty'):
        paying.run(0.5, output_step=0.1, progress=False)


def test_a_picture_turns_wheels_and_wraps_with_their_body():
    """Of a free deck: stations of the wrap lie in its groove, at its radius; the drum's axis is that of its body."""
    run = deck(inertia=0.05, torque=2.0).run(0.02, output_step=0.01, tol=1e-5, integrator="radau", progress=False)
    made = run.animation()
    turned = rotate(run["deck.orientation"], np.array([0.1, 0.05, 1]) / np.linalg.norm([0.1, 0.05, 1]))
    shape = next(body for body in made.clips[0].bodies if body.name == "winch")
    assert np.abs(rotate(shape.orientation, np.array([0.0, 0.0, 1.0])) - turned).max() < 1e-12
    wrap = run["hoist.position"][:, 9:19]
    centre = run["deck.position"] + rotate(run["deck.orientation"], np.array([0.8, 0.5, 0.08]))
    axis = rotate(run["deck.orientation"], np.array([0, 0.1, 1]) / np.linalg.norm([0, 0.1, 1]))
    arm = wrap - centre[:, None]
    assert np.abs(np.einsum("tnd,td->tn", arm, axis)).max() < 1e-12
    assert np.linalg.norm(arm, axis=-1) == pytest.approx(np.full(arm.shape[:2], 0.15), rel=1e-6)
