"""Friction of joints that sticks: it holds to rounding, breaks loose and stops as events, against closed forms."""

import funicular as fu
import numpy as np
import pytest
from expectations import refused
from interrupted_runs import check_file_and_resume
from test_friction_of_joints import (
    CLAMP,
    COEFFICIENT,
    INERTIA,
    INTEGRATORS,
    RADIUS,
    arms,
    directions,
    pendulum,
    turns,
    wheel,
)

each_integrator = pytest.mark.parametrize("integrator", INTEGRATORS)
LIMIT = COEFFICIENT * CLAMP * RADIUS
"""Moment that the brake of `wheel` holds, N m."""


def stick(**given) -> fu.Friction:
    return fu.Friction(**{"coefficient": COEFFICIENT, "model": "stick"} | given)


def whats(run: fu.Run) -> list[str]:
    return [event["what"] for event in run.report["events"] if "what" in event]


def angles(run: fu.Run) -> np.ndarray:
    return np.arctan2(run["P.position"][:, 0], -run["P.position"][:, 1])


@each_integrator
@pytest.mark.parametrize("slope", [0.2, 0.6])
def test_a_block_on_a_rail_stays_below_the_angle_of_friction(slope, integrator):
    """Above it, it slides with g (sin α - μ cos α); its weight presses."""
    mu, along = 0.3, np.array([np.cos(slope), -np.sin(slope), 0])
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("B", mass=4.0, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.joint("prismatic", (0, 0, 0), "B", axis=tuple(along), name="rail", friction=stick(coefficient=mu))
    run = scene.run(1.0, output_step=0.1, tol=1e-6, integrator=integrator)
    down = max(9.81 * (np.sin(slope) - mu * np.cos(slope)), 0.0)
    assert run["B.position"] @ along == pytest.approx(down * run.time**2 / 2, abs=1e-12)
    assert run["rail.force"][-1] @ along == pytest.approx(4 * (down - 9.81 * np.sin(slope)), rel=1e-10)
    if not down:
        assert np.abs(run["B.velocity"]).max() < 1e-15


@each_integrator
def test_a_pendulum_comes_to_rest_aside_and_stays(integrator):
    """Within T/(m g L) of the vertical; at the angles of regularised friction in the limit of no velocity."""
    torque = 0.9
    scene = pendulum(0.3, friction=stick(), normal_force=torque / COEFFICIENT / 0.05)
    run = scene.run(5.0, output_step=0.1, tol=1e-6 if integrator != "genalpha" else 1e-4, integrator=integrator)
    assert whats(run) == ["turned round"] * 2 + ["stuck"]
    exact, close = turns(0.3, torque, 3), 1e-3 if integrator == "genalpha" else 1e-6
    held = run.time > run.report["events"][-1]["time"]
    assert angles(run)[held] == pytest.approx(-exact[3], abs=close)
    assert abs(2 * 9.81 * np.sin(exact[3])) < torque
    assert np.ptp(run["P.position"][held], axis=0).max() < 1e-15
    assert np.abs(run["P.velocity"][held]).max() < 1e-12
    assert run["axle.moment"][-1, 2] == pytest.approx(2 * 9.81 * np.sin(angles(run)[-1]), rel=1e-9)
    turned = np.abs(np.diff(np.array(exact) * [1, -1, 1, -1])).sum()
    assert run["energy.dissipated"][-1] == pytest.approx(torque * turned, rel=20 * close)


def test_half_swings_of_small_angles_lose_twice_the_dead_band():
    """By the own force of the pin, which is nearly m g: T = μ m g r."""
    dead = COEFFICIENT * 0.05
    run = pendulum(5.5 * dead, friction=stick()).run(5.0, output_step=0.01, tol=1e-8, integrator="explicit")
    times = [event["time"] for event in run.report["events"]]
    assert whats(run) == ["turned round"] * 2 + ["stuck"]
    period = 2 * np.pi * np.sqrt((2 + 1e-3) / (2 * 9.81))
    assert times == pytest.approx([period / 2, period, 1.5 * period], rel=2e-3)
    assert angles(run)[-1] == pytest.approx(0.5 * dead, abs=0.02 * dead)
    assert np.abs(run.energy_balance().relative).max() < 1e-11


@each_integrator
@pytest.mark.parametrize("dim", [2, 3])
def test_a_brake_holds_a_wheel_and_releases_it(dim, integrator):
    """By an event at 0.4 s at once; by a signal where the falling limit meets the moment, at 0.25 s."""
    scene = wheel(dim, 0.0, stick(until="gate"), normal_force=CLAMP)
    scene.event("gate", function=lambda time, state: time - 0.4)
    scene.moment("W", value=(0, 0, 3.0))
    run = scene.run(1.0, output_step=0.05, tol=1e-6, integrator=integrator)
    assert run["W.angular_velocity"][:, 2] == pytest.approx(3 / INERTIA * np.clip(run.time - 0.4, 0, None), abs=1e-12)
    assert run["axle.moment"][[2, -1], 2] == pytest.approx([-3, 0], abs=1e-12)
    fading = fu.TableSignal(time=[0, 1], value=[1, 0], interpolation="linear")
    scene = wheel(dim, 0.0, stick(scale=fading), normal_force=CLAMP)
    scene.moment("W", value=(0, 0, 3.0))
    run = scene.run(0.9, output_step=0.05, tol=1e-6, integrator=integrator)
    assert run.report["events"][0]["time"] == pytest.approx(0.25, abs=1e-9)
    since = np.clip(run.time - 0.25, 0, None)
    assert run["W.angular_velocity"][:, 2] == pytest.approx(LIMIT / INERTIA * since**2 / 2, abs=1e-8)


@each_integrator
def test_a_brake_takes_its_torque_times_the_angle(integrator):
    """The work to 1e-8; with viscous friction between the plates it breaks loose at the static limit, then has less."""
    run = wheel(3, 10.0, stick(), normal_force=CLAMP).run(2.0, output_step=0.1, tol=1e-7, integrator=integrator)
    (event,) = run.report["events"]
    assert event["what"] == "stuck" and event["time"] == pytest.approx(10 * INERTIA / LIMIT, abs=1e-7)
    assert run["energy.dissipated"][-1] == pytest.approx(LIMIT * 10**2 / (2 * LIMIT / INERTIA), rel=1e-8)
    assert np.abs(run["W.angular_velocity"][-5:]).max() < 1e-14
    rising = fu.TableSignal(time=[0, 1], value=[0, 2 * LIMIT], interpolation="linear")
    scene = wheel(3, 0.0, stick(static_coefficient=1.5 * COEFFICIENT, viscous=5.0), normal_force=CLAMP)
    scene.moment("W", value=(0, 0, 1.0), scale=rising)
    run = scene.run(1.0, output_step=0.05, tol=1e-7, integrator=integrator)
    assert run.report["events"][0]["time"] == pytest.approx(0.75, abs=1e-9)
    c, t = 5.0 * RADIUS**2 / INERTIA, run.time[-1] - 0.75  # ω' + c ω = (LIMIT/2 + 2 LIMIT t)/I
    a, b = LIMIT / INERTIA * 0.5, 2 * LIMIT / INERTIA
    exact = (a / c - b / c**2) * (1 - np.exp(-c * t)) + b * t / c
    assert run["W.angular_velocity"][-1, 2] == pytest.approx(exact, rel=1e-5)


@each_integrator
def test_runs_resume_while_friction_holds(integrator, tmp_path):
    scene = pendulum(0.1, friction=stick(scale=fu.TableSignal(time=[0, 0.1, 0.2], value=[1, 1, 0.5])),
                     normal_force=2.0 / COEFFICIENT / 0.05)
    run = check_file_and_resume(scene, tmp_path, 8, duration=0.2, tol=1e-5, output_step=0.01, integrator=integrator)
    assert whats(run) == ["broke loose"]
    assert not run["P.angular_velocity"][:5].any() or np.abs(run["P.angular_velocity"][:5]).max() < 1e-15


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_pin_of_a_cable_holds_a_beam(integrator):
    """The limit is above the moment of its weight m g L/2, with vibrations, or below it: then it takes its moment times
    the angle.
    """
    weight = 1e-3 * 2000 * 9.81 / 2
    for part in (3.0, 0.3):
        scene = arms(2).replace("pin0", friction=stick(), normal_force=part * weight / COEFFICIENT / 0.1)
        run = scene.run(0.15, output_step=0.01, tol=1e-5, integrator=integrator, progress=False)
        turned = np.abs(directions(run, "arm0", 0)[-1])
        assert whats(run) == ["broke loose"] * (part < 1)
        assert turned > 0.05 if part < 1 else turned < 1e-12
        assert run["energy.dissipated"][-1] == pytest.approx(part * weight * turned, rel=2e-6, abs=1e-12)
        assert np.abs(run.energy_balance().relative).max() < 5e-6


def test_rest_with_friction_that_sticks():
    """Equilibrium and modes leave it out as that of slides; a damped motion to rest stops where it holds."""
    scene = pendulum(0.3, friction=stick(coefficient=0.5), normal_force=80.0)
    rest = scene.relax()
    angle = np.arctan2(rest["P.position"][0], -rest["P.position"][1])
    assert 1e-6 < abs(angle) < 2.0 / (2 * 9.81)
    assert rest["axle.moment"][2] == pytest.approx(2 * 9.81 * np.sin(angle), rel=1e-9)
    assert any('friction of "axle" has part in this state' in message for message in rest.messages)
    run = scene.run(0.5, output_step=0.1, initial=rest, integrator="radau")
    assert not run.report["events"] and np.abs(run["P.velocity"]).max() < 1e-15
    state = scene.equilibrium()
    assert state.messages == ['friction of "axle" is left out: at rest joints move freely']
    assert scene.modes(1, about=state).messages == ['modes leave out the friction of joint "axle"']


def test_friction_that_rigid_bodies_do_not_share_is_refused():
    def door(**second: object) -> fu.Scene:
        scene = fu.Scene(gravity=(0, 0, -9.81))
        scene.rigid_body("D", mass=1, inertia=(1, 1, 1), position=(1, 0, 0), angular_velocity=(0, 0, 1),
                         velocity=(0, 1, 0))
        press = {"radius": 0.1, "normal_force": 50.0}
        for name, z, given in (("low", -1, press | {"friction": stick()}), ("high", 1, second and press | second)):
            scene.joint("revolute", (0, 0, z), ("D", (-1, 0, z)), axis=(0, 0, 1), name=name, **given)
        return scene

    run = door().run(1.5, output_step=0.1, tol=1e-7)
    assert run.report["events"][0]["time"] == pytest.approx(2 / (COEFFICIENT * 5), abs=1e-9)
    with refused('joint "low": has friction that sticks in a loop with joint "high": rigid bodies do not determine '
                 'what each of them holds at rest; take model="regularised" for all but one of them'):
        door(friction=stick()).run(1.0, output_step=0.1)


def test_regularised_friction_that_holds_a_load_says_that_it_creeps():
    """At v0 x/sqrt(1 - x²), x the share of the limit; a wheel that has stopped without a load does not."""
    along, mu = np.array([np.cos(0.2), -np.sin(0.2), 0]), 0.3
    scene = fu.Scene(gravity=(0, -9.81, 0))
    scene.rigid_body("B", mass=4.0, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.joint("prismatic", (0, 0, 0), "B", axis=tuple(along), friction=mu, name="rail")
    run = scene.run(0.5, output_step=0.1, tol=1e-5)
    share = np.tan(0.2) / mu
    speed = 1e-3 * share / np.sqrt(1 - share**2)
    assert run["B.velocity"][-1] @ along == pytest.approx(speed, rel=1e-3)
    assert run.report["messages"] == [
        f'joint "rail": its friction is regularised, and creeps under the load that it holds, at {speed:.3g} m/s '
        'at the end. Take model="stick", which holds it, or a smaller velocity']
    assert not wheel(3, 1.0).run(1.0, output_step=0.1, tol=1e-5).report["messages"]
    run = pendulum(0.01, friction=0.4).run(0.5, output_step=0.1, tol=1e-5)
    (message,) = run.report["messages"]
    assert f"at {0.05 * abs(run['P.angular_velocity'][-1, 2]):.3g} m/s" in message
