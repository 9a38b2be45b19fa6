"""Loads that begin with an event, and friction of slides that changes with time: brakes, against closed forms."""

import numpy as np
import pytest
from changing_loads import (
    BRAKING,
    DEFLECTION_RATIO,
    F,
    L,
    beam,
    braked,
    braked_speed,
    by_modes,
    crossing,
    deflection,
    rail,
    speed_of,
)
from expectations import energy_error, largest, refused
from funicular import Friction, Harmonic, Pulse, Ramp, Scene, TableSignal
from funicular.parts.signal import Switched
from interrupted_runs import check_file_and_resume
from shared_scenes import add_cable

EVERY = "genalpha", "radau", "explicit", "energy"


def pushed() -> Scene:
    """Return a mass of 2 kg at 1 m/s that passes a gate at x = 0.5 m, from where forces act."""
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=2.0, inertia=(1, 1, 1), velocity=(1, 0, 0), position=(0, 0, 0))
    scene.force("A", value=(-4.0, 0, 0), when="gate", scale=Pulse(start=0.1, end=0.3, rise=0.05))
    scene.force("A", value=(0, 1.0, 0), when="gate")
    scene.force("A", value=(0, 0, 1.0), when="gate", scale=TableSignal(time=[-1, 1], value=[-1, 1],
                                                                       interpolation="linear"))
    scene.moment("A", value=(0, 0, 1.0), when="gate")
    scene.event("gate", quantity="A.position.x", value=0.5, direction="rising")
    return scene


@pytest.mark.parametrize("integrator", EVERY)
def test_forces_that_begin_with_an_event(integrator):
    """The scale counts its time from the event."""
    run = pushed().run(1.4, output_step=0.1, integrator=integrator, tol=1e-6)
    (event,) = run.report["events"]
    assert abs(event["time"] - 0.5) < 1e-9
    since = np.clip(run.time - 0.5, 0, None)
    np.testing.assert_allclose(run["A.velocity"][-1], (0.7, 0.45, since[-1] ** 2 / 4), atol=1e-6)
    np.testing.assert_allclose(run["A.position"][:, 1], since**2 / 4, atol=1e-9)
    np.testing.assert_allclose(run["A.angular_velocity"][:, 2], since, atol=1e-9)
    assert not run["A.velocity"][run.time < 0.49, 1].any()
    assert energy_error(run) < 1e-5


@pytest.mark.filterwarnings("ignore:the linear model of motion")
@pytest.mark.parametrize("integrator", [*EVERY, "linear"])
def test_a_force_on_a_beam_that_begins_with_an_event(integrator):
    """A force begins where the deflection by another one passes a value: superposition in the linear regime."""
    scene, time = crossing(0.5), L / speed_of(0.5)
    scene.event("rises", quantity="beam.position.y", s=L / 2, value=-0.5 * DEFLECTION_RATIO * L,
                direction="falling")
    scene.force("beam", s=L / 2, value=(0, F, 0), when="rises")
    run = scene.run(time, output_step=time / 50, integrator=integrator, tol=1e-6)
    begin = run.report["events"][0]["time"]
    alone = beam()
    alone.force("beam", s=L / 2, value=(0, F, 0))
    response = alone.run(time, output_step=time / 1000, integrator="radau", tol=1e-6)
    since = run.time - begin
    added = np.interp(since, response.time, deflection(response)) * (since > 0)
    assert 0.1 * time < begin < 0.9 * time
    assert largest(deflection(run) - by_modes(0.5, run.time) - added) < 2e-3
    assert energy_error(run) < 1e-4


@pytest.mark.parametrize("integrator", EVERY)
def test_forces_that_end_with_an_event(integrator):
    """One acts from the start, one between two events, one ends before it begins."""
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=2.0, inertia=(1, 1, 1), velocity=(1, 0, 0), position=(0, 0, 0))
    for name, x in (("first", 0.25), ("second", 0.75)):
        scene.event(name, quantity="A.position.x", value=x, direction="rising")
    rise = TableSignal(time=[0, 1], value=[0, 2], interpolation="linear")
    scene.force("A", value=(0, 4, 0), scale=rise, until="second")
    scene.force("A", value=(0, 0, 4), scale=rise, when="first", until="second")
    scene.force("A", value=(0, 9, 0), when="second", until="first")
    run = scene.run(1.0, output_step=0.05, integrator=integrator, tol=1e-6)
    np.testing.assert_allclose(run["A.velocity"][:, 1], 2 * np.clip(run.time, 0, 0.75) ** 2, atol=1e-5)
    np.testing.assert_allclose(run["A.velocity"][:, 2], 2 * np.clip(run.time - 0.25, 0, 0.5) ** 2, atol=1e-5)
    assert energy_error(run) < 1e-5


def test_a_brake_that_an_event_opens():
    """It closes at s = 2 m and opens at 2.5 m."""
    scene = rail(Friction(coefficient=0.2, model="stick", when="closes", until="opens"))
    for name, s in (("closes", 2.0), ("opens", 2.5)):
        scene.event(name, quantity="wheels.s", value=s, direction="rising")
    run = scene.run(1.5, output_step=0.05, integrator="radau", tol=1e-6)
    assert abs(run["wheels.s_rate"][-1] - np.sqrt(9 - 2 * 0.2 * 9.81 * 0.5)) < 1e-6


@pytest.mark.parametrize("integrator", BRAKING)
def test_a_rider_that_stands_breaks_loose_where_its_brake_opens(integrator):
    scene = Scene()
    wire = add_cable(scene, start=(0, 0, 0), end=(4, 3, 0), pins=(), elements=2)
    for s in wire.node_s:
        scene.clamp(wire, s=s, fix="all")
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(3.2, 2.4, 0))
    scene.rigid_body("B", mass=1.0, inertia=(1, 1, 1), position=(0, 9, 0), velocity=(1, 0, 0))
    scene.slide("A", along=wire, s=4.0, name="brake", friction=Friction(coefficient=1.0, model="stick", until="gate"))
    scene.event("gate", quantity="B.position.x", value=0.25, direction="rising")
    run = scene.run(0.6, output_step=0.05, integrator=integrator, tol=1e-6)
    _, loose = run.report["events"]
    assert loose["what"] == "broke loose" and abs(loose["time"] - 0.25) < 1e-9
    np.testing.assert_allclose(run["brake.s_rate"], -9.81 * 0.6 * np.clip(run.time - 0.25, 0, None), atol=1e-9)


@pytest.mark.parametrize(("begin", "end"), [(None, None), (2.0, None), (2.0, 4.3), (-np.inf, 4.3), (2.0, 1.0),
                                            (-np.inf, -5.0), (3.0, 3.1)])
def test_a_switched_signal(begin, end):
    signal = TableSignal(time=[-1.5, 0.5, 1.0, 2.5], value=[1.0, 3.0, -1.0, 2.0])
    found, t = Switched(signal=signal, begin=begin, end=end), np.linspace(-8, 8, 1601) + 1e-5
    inside = np.zeros(len(t), dtype=bool) if begin is None else (t >= begin) & (t < (np.inf if end is None else end))
    since = t - (begin if begin is not None and np.isfinite(begin) else 0.0)
    np.testing.assert_allclose(found.value(t), np.where(inside, signal.value(since), 0.0), atol=1e-12)
    assert (np.diff(found.pieces()[0]) > 0).all()


def test_section_forces_and_arrows_begin_with_the_event():
    scene = beam()
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(0, 1, 0), velocity=(1, 0, 0))
    scene.event("gate", quantity="A.position.x", value=0.5, direction="rising")
    scene.force("beam", s=L / 2, value=(0, -F, 0), when="gate", scale=Ramp(start=0, end=50.0), name="push")
    run = scene.run(100.0, output_step=10.0, integrator="genalpha", step=0.1, spectral_radius=0.0)
    moment = run.section_forces("beam", np.array([L / 2]))["moment"].values[:, 0, 2]
    assert not moment[0] and abs(moment[-1] / (F * L / 4) - 1) < 1e-3
    (arrow,) = [each for each in run.animation().clips[0].segments if each.name == "push"]
    sizes = np.linalg.norm(arrow.end - arrow.start, axis=1)
    assert not sizes[0] and sizes[-1] > 0


@pytest.mark.parametrize("model", ["stick", "regularised"])
@pytest.mark.parametrize("by", ["signal", "event"])
@pytest.mark.parametrize("integrator", BRAKING)
def test_a_brake(integrator, by, model):
    """It decelerates a slide until it stands."""
    run = braked(by, model).run(2.4, output_step=0.01, integrator=integrator, tol=1e-6)
    exact = braked_speed(by, run.time)
    assert exact[-1] == 0 < exact[-60]
    assert largest(run["wheels.s_rate"] - exact) < 3e-5
    assert energy_error(run) < 1e-5
    if model == "stick":
        assert [each["what"] for each in run.report["events"] if "what" in each] == ["stuck"]


def test_viscous_friction_by_a_signal():
    """v' = -c scale v/m."""
    scale = Ramp(start=0.2, end=1.2, before=0.5)
    scene = rail(Friction(viscous=4.0, scale=scale))
    run = scene.run(1.5, output_step=0.05, integrator="radau", tol=1e-7)
    t = np.linspace(0, 1.5, 3001)
    over = np.concatenate([[0], np.cumsum((scale.value(t)[1:] + scale.value(t)[:-1]) / 2 * np.diff(t))])
    np.testing.assert_allclose(run["wheels.s_rate"], 3 * np.exp(-2 * np.interp(run.time, t, over)), rtol=1e-6)


def test_a_brake_that_opens():
    """A rider on a slope of 3 in 4 stands until friction falls below the slope, then slides."""
    scene = Scene()
    wire = add_cable(scene, start=(0, 0, 0), end=(4, 3, 0), pins=(), elements=2)
    for s in wire.node_s:
        scene.clamp(wire, s=s, fix="all")
    scene.rigid_body("A", mass=1.0, inertia=(1, 1, 1), position=(3.2, 2.4, 0))
    fading = TableSignal(time=[0, 1], value=[1, 0], interpolation="linear")
    scene.slide("A", along=wire, s=4.0, name="brake", friction=Friction(coefficient=1.0, model="stick", scale=fading))
    for integrator in BRAKING:
        run = scene.run(0.8, output_step=0.05, integrator=integrator, tol=1e-6)
        (loose,) = run.report["events"]
        assert abs(loose["time"] - 0.25) < 1e-6, integrator
        since = np.clip(run.time - 0.25, 0, None)
        np.testing.assert_allclose(run["brake.s_rate"], -9.81 * 0.8 * since**2 / 2, atol=1e-5)


def test_a_constant_scale_multiplies_all_coefficients():
    whole = rail(Friction(coefficient=0.2, viscous=1.0)).run(0.5, output_step=0.1, tol=1e-6, integrator="radau")
    half = rail(Friction(coefficient=0.4, viscous=2.0, scale=0.5)).run(0.5, output_step=0.1, tol=1e-6,
                                                                      integrator="radau")
    np.testing.assert_allclose(half["wheels.s_rate"], whole["wheels.s_rate"], rtol=1e-12)


@pytest.mark.parametrize("integrator", EVERY)
def test_a_file_and_a_resumed_run(tmp_path, integrator):
    """Killed after the event."""
    run = check_file_and_resume(pushed(), tmp_path, 40, duration=1.0, output_step=0.02, tol=1e-4,
                                integrator=integrator)
    assert run["A.velocity"][-1, 1] > 0.2


@pytest.mark.parametrize("by", ["signal", "event"])
def test_a_resumed_run_with_a_brake(tmp_path, by):
    check_file_and_resume(braked(by), tmp_path, 40, duration=2.4, output_step=0.05, tol=1e-5, integrator="radau")


def test_what_is_refused():
    scene = pushed()
    with refused('force "f": scale is a sine, which cannot begin or end with an event; take a TableSignal of its '
                 "values"):
        scene.force("A", value=(1, 0, 0), when="gate", scale=Harmonic(amplitude=1, frequency=1), name="f")
    scene.force("A", value=(1, 0, 0), when="gat", name="f")
    with refused('force "f": when: there is no event "gat"; did you mean "gate"?'):
        scene.run(1.0)
    scene = pushed()
    scene.event("end", quantity="A.position.x", value=0.8, action="stop")
    scene.force("A", value=(1, 0, 0), when="end", name="f")
    with refused('force "f": when: event "end" ends the run; give it action="record"'):
        scene.run(1.0)
    with refused("Friction: scale must not be negative; friction opposes the motion"):
        Friction(coefficient=0.1, scale=Ramp(start=0, end=1, after=-1))
    with refused('slide "wheels": when: there is no event "gate"; the scene has none yet'):
        rail(Friction(coefficient=0.1, when="gate")).run(0.1)
