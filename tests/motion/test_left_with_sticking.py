"""Ropes that leave sheaves with friction that sticks, and touch them again, in the plane and in space."""

import funicular as fu
import numpy as np
import pytest
from interrupted_runs import killed_and_resumed
from ropes.scenes import over_a_peg, rope_of, weight
from test_left_and_touched import LIGHT, TWICE, whats
from test_left_in_space import TURN, thrown
from test_left_in_space import pendulum as pendulum_in_space
from test_left_with_friction import MU, pendulum, rough, run_of, sticky
from test_ropes import pulled_off

BRIEF = {"duration": 0.2, "output_step": 0.02, "tol": 1e-6, "progress": False}


@pytest.fixture(scope="module")
def swing() -> fu.Run:
    return run_of(pendulum(zones=2, friction=sticky), 1.8)


# ---- the law

@pytest.mark.slow
def test_friction_vanishes_with_its_coefficient():
    smooth, nearly = (run_of(scene, 1.8) for scene in (over_a_peg(*LIGHT), pendulum(1e-7, 1, friction=sticky)))
    assert whats(smooth) == whats(nearly) == TWICE[:2]
    assert nearly["load.position"] == pytest.approx(smooth["load.position"], abs=2e-7)


@pytest.mark.parametrize("zones", [1, 8])
def test_regularised_friction_converges(zones):
    """A load that is pulled off: 1e-5, 7e-7, 1e-7 m."""
    sticks = pulled_off(**sticky(0.1, zones)).run(integrator="radau", **BRIEF)
    assert whats(sticks) == ["left the sheave"]
    assert np.abs(sticks.energy_balance().relative).max() < 1e-8
    errors = [np.abs(pulled_off(**rough(0.1, zones, velocity)).run(integrator="radau", **BRIEF)["L.position"]
                     - sticks["L.position"]).max() for velocity in (1e-2, 1e-3, 1e-4)]
    assert errors[0] > 5 * errors[1] > 25 * errors[2] and errors[2] < 2e-7


@pytest.mark.slow
def test_a_held_rope_swings_as_without_friction(swing):
    """A rope without mass and stretch does not slide on the peg: friction does not change its motion."""
    smooth = run_of(over_a_peg(*LIGHT), 1.8)
    assert whats(swing) == TWICE[:2]
    assert swing["load.position"] == pytest.approx(smooth["load.position"], abs=1e-3)  # 2 % of its mass
    assert np.abs(swing.energy_balance().relative).max() < 1e-6
    assert swing["peg.residual"].max() < 1e-10


def test_results_beside_and_on_the_peg(swing):
    pressed = swing["peg.wrap_angle"] > 0
    for name in ("torque", "slip", "slip_angle"):
        assert np.array_equal(swing[f"peg.{name}"][~pressed], np.zeros((~pressed).sum()))
    assert (swing["peg.normal_force"][pressed] > 0).all() and (swing["peg.gap"][~pressed] > 0).all()
    slip_angle = swing["peg.slip_angle"][pressed]
    assert (slip_angle < 1e-12).any() and (slip_angle > 0.1).any()  # it sticks and slides


@pytest.mark.parametrize(("integrator", "zones"), [("genalpha", 8), ("explicit", 1)])
def test_integrators_agree(integrator, zones):
    one, other = (pulled_off(**sticky(0.1, zones)).run(integrator=each, **BRIEF) for each in ("radau", integrator))
    assert whats(one) == whats(other) == ["left the sheave"]
    assert np.abs(one["L.position"] - other["L.position"]).max() < 1e-8


def test_a_method_that_conserves_energy_ends_there():
    with pytest.raises(fu.RopeLeftError, match='leaves sheave "top"'):
        pulled_off(**sticky(0.1, 1)).run(integrator="energy", **BRIEF)


def test_resumed_bit_for_bit(tmp_path):
    scene = pendulum(zones=1, friction=sticky)
    settings = {"duration": 1.0, "output_step": 0.02, "tol": 1e-4, "integrator": "radau", "progress": False}
    resumed = killed_and_resumed(scene, tmp_path / "run.nc", 46, **settings)  # in contact
    whole = scene.run(**settings)
    assert all(np.array_equal(whole[name], resumed[name]) for name in whole)
    assert whats(whole) == whats(resumed) == TWICE[:1]


# ---- in space

@pytest.mark.slow
def test_motion_in_the_plane_of_the_groove_is_that_in_the_plane():
    plane, space = (run_of(pendulum_in_space(**given, **sticky(zones=1)), 1.2) for given in (
        {"element": "cable8p"}, {"axes": TURN}))
    assert whats(space) == whats(plane) == TWICE[:1]
    assert space["load.position"] @ TURN == pytest.approx(plane["load.position"], abs=1e-8)


@pytest.mark.slow
def test_a_pendulum_beside_the_plane_of_the_groove():
    run = run_of(pendulum_in_space(aside=0.02, **sticky(zones=2)))
    assert whats(run) == TWICE[:2] and np.abs(run.energy_balance().relative).max() < 1e-6


@pytest.mark.slow
def test_regularised_friction_converges_in_space():
    """A load that is thrown off."""
    run, *others = (run_of(thrown(friction, 0.01), 0.1, tol=1e-7) for friction in (
        fu.Friction(coefficient=0.1, model="stick"),
        *(fu.Friction(coefficient=0.1, velocity=velocity) for velocity in (1e-2, 1e-3, 1e-4))))
    assert whats(run) == TWICE[1:2] and np.abs(run.energy_balance().relative).max() < 1e-6
    errors = [np.abs(other["load.position"] - run["load.position"]).max() for other in others]
    assert errors[0] > 5 * errors[1] > 25 * errors[2]


# ---- rest

def held(force: float) -> fu.Scene:
    """Return a load that a force pulls on a rope over a sheave, with a wrap of 4e-3 rad."""
    low = -np.sin(2e-3)
    scene = fu.Scene(gravity=(0, 0, 0))
    weight(scene, "load", 1.0, 1.0, low)
    scene.joint("prismatic", (1.0, low, 0), "load", axis=(1, 0, 0))
    scene.force("load", value=(force, 0, 0))
    scene.rope("rope", route=[fu.Anchor(at=(-1, low, 0)), fu.Sheave("top", at=(0, -0.2, 0), radius=0.2, side="right",
                                                                    **sticky(zones=8)), fu.Anchor("load")],
               elements=1, tension=100.0, **rope_of(1e5, 0.1, 0, 1e-3))
    return scene


def test_a_short_wrap_holds_a_load_at_rest():
    """Up to the limit of friction, at which the rope slides until the anchor holds the rest."""
    limit = 100 * np.expm1(MU * 4e-3)
    stuck, slid = (held(100 + part * limit).equilibrium(wraps="stick") for part in (0.9, 1.1))
    assert stuck["top.tension_off"] - stuck["top.tension_on"] == pytest.approx(0.9 * limit, abs=3e-4)
    assert np.log(slid["top.tension_off"] / slid["top.tension_on"]) == pytest.approx(
        MU * slid["top.wrap_angle"], rel=1e-4)
    assert slid["top.tension_on"] > 100 + 0.09 * limit


def test_rest_beside_a_peg():
    """Nothing sticks to a peg that the rope does not touch."""
    peg = fu.Sheave("peg", at=(0.3, -1, 0), radius=0.1, side="left", contact=False, **sticky())
    assert over_a_peg(*LIGHT, start=-0.15, pegs=(peg,)).equilibrium()["peg.gap"] == pytest.approx(0.2, abs=1e-6)
