"""Tackles by blocks: falls and sheaves, the force that holds a load, and how far a haul moves it."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused

THIN = {"section": fu.Circle(radius=1e-3), "elements": 1,
        "material": fu.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=700, damping_time=1e-3)}
R, MASS = 0.15, 40.0


def tackle(falls: int, **drum) -> fu.Scene:
    """Return a load on a tackle that a drum on the ground hauls over its upper axle."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("load", mass=MASS, inertia=(1, 1, 1), position=(0, -6, 0))
    end = fu.Anchor(at=(R + 0.02, 0.5, 0)) if falls % 2 == 0 else fu.Anchor("load", at=(-R - 0.02, 0, 0))
    scene.rope("hoist", route=[
        fu.Drum("winch", at=(-3, 0.5, 0), radius=0.2, side="left", length_in_store=2.0, **drum),
        fu.Sheave("lead", at=(-2 * R - 0.02, 0, 0), radius=R, side="right"),
        fu.Block("hook", at="load", upper=(0, 0, 0), falls=falls, radius=R), end],
        tension=MASS * 9.81 / falls, **THIN)
    return scene


@pytest.mark.parametrize("falls", [2, 3, 4, 5, 8])
def test_falls_share_the_load(falls):
    """The tension is the weight over the number of falls, and above a fall the weight of this."""
    scene = tackle(falls)
    names = [sheave.name for sheave in scene.ropes["hoist"].sheaves]
    assert names == ["lead", *(f"hook_{k}" for k in range(1, falls))]
    rest = scene.equilibrium()
    fall = 700 * np.pi * 1e-6 * 9.81 * 6.0
    assert rest["winch.tension"] == pytest.approx(MASS * 9.81 / falls + fall, rel=1e-3)
    assert rest["hook_1.wrap_angle"] == pytest.approx(np.pi, abs=0.03)


def test_a_haul_lifts_by_a_part_of_its_way():
    """A winch that winds .3 m on a tackle of four falls lifts the load by .075 m."""
    haul = fu.TableSignal(time=[0, 0.2, 0.8, 1, 2], value=[0, 1.875, 1.875, 0, 0], interpolation="linear")
    scene = tackle(4, velocity=haul)
    run = scene.run(2.0, output_step=0.5, tol=1e-4, initial="equilibrium")
    assert abs(run["winch.angle"][-1]) == pytest.approx(1.5)
    lifted = run["load.position"][-1, 1] - run["load.position"][0, 1]
    assert lifted == pytest.approx(np.sign(lifted) * 0.3 / 4, rel=2e-2)
    assert np.abs(run.energy_balance().relative).max() < 1e-4


def test_a_scene_file_has_the_sheaves():
    scene = tackle(3)
    again = fu.Scene.from_toml(scene.to_toml())
    assert again.to_toml() == scene.to_toml() and "hook_2" in scene.to_toml() and "block" not in scene.to_toml()
    table = {"kind": "block", "name": "hook", "at": "load", "upper": (0, 0, 0), "falls": 3, "radius": R}
    route = [fu.Anchor(at=(-R - 0.02, 0.5, 0)), table, fu.Anchor("load", at=(-R - 0.02, 0, 0))]
    bare = scene.without("hoist")
    bare.rope("other", route=route, tension=100.0, **THIN)
    assert [sheave.name for sheave in bare.ropes["other"].sheaves] == ["hook_1", "hook_2"]


def test_refused():
    with refused('block "hook": falls must be a whole number from 2 to 100, got 1'):
        fu.Block("hook", at="load", upper=(0, 0, 0), falls=1, radius=R)
