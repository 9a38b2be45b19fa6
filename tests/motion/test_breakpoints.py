"""Steps end where a signal is not smooth: relevant breakpoints, and errors of steps across others."""

from types import SimpleNamespace

import numpy as np
import pytest
from expectations import energy_error
from funicular import FunicularWarning, Harmonic, Material, Pulse, Ramp, Rectangle, Scene, TableSignal
from funicular.model.breakpoints import ACCELERATION, HIGHER, RATE, breakpoints
from funicular.model.signals import SignalModel
from funicular.parts.signal import Constant, Integral
from numpy.testing import assert_allclose
from shared_scenes import cable_scene

TIME = 0.1
TIMES = (0, 0.013, 0.05, 0.071, 0.2)
UNEVEN = (0, 0.0051, 0.0131, 0.0502, 0.0713, 0.2)
TWO_PARTS = {"time": (0, 0.5, 1), "value": (0, 1, 0)}
SAMPLES = tuple(np.linspace(0, TIME, 10_001))
SMOOTH = {"time": SAMPLES, "value": tuple(0.05 * (1 - np.cos(2 * np.pi * np.array(SAMPLES) / TIME)))}


def model(*signals, driving=()):
    """Return the part of a model that breakpoints need; driving: numbers of the signals that prescribe a motion."""
    return SimpleNamespace(
        signals=[SignalModel(*each.pieces(), *each.sine) for each in signals],
        motions=[SimpleNamespace(signal=k) for k in driving], couplings=[], drags=[])


def straight(*values, times=TIMES) -> TableSignal:
    return TableSignal(time=times, value=values, interpolation="linear")


@pytest.mark.parametrize(("signal", "drives", "times", "jumps"), [
    (Constant(constant=3.0), True, [], []),
    (Harmonic(amplitude=1, frequency=2), True, [], []),
    (Ramp(start=0.2, end=0.7), False, [0.2, 0.7], [HIGHER, HIGHER]),
    (Ramp(start=0.2, end=0.7), True, [0.2, 0.7], [HIGHER, HIGHER]),
    (Ramp(start=-1, end=3), True, [], []),
    (Pulse(start=0.2, end=0.4), False, [0.2, 0.3, 0.4], [HIGHER] * 3),
    (TableSignal(**TWO_PARTS, interpolation="linear"), False, [0.5, 1], [HIGHER, HIGHER]),
    (TableSignal(**TWO_PARTS, interpolation="linear"), True, [0.5, 1], [RATE, RATE]),
    (Integral(rate=TableSignal(**TWO_PARTS, interpolation="linear")), True, [0.5, 1], [ACCELERATION, ACCELERATION]),
    (TableSignal(time=(0, 0.5, 1, 2), value=(0, 1, 2, 4), interpolation="linear"), True, [], []),
    (TableSignal(time=(0, 1, 2), value=(5, 5, 5)), True, [], []),
    (TableSignal(time=(0, 0.3, 0.6, 1, 3), value=(0, 0.5, 1.5, 2, 3)), True, [0.6], [HIGHER]),
])
def test_knots_are_where_a_signal_is_not_smooth(signal, drives, times, jumps):
    found, kinds = breakpoints(model(signal, driving=[0] if drives else []), 1.5, 1e-4)
    assert_allclose(found, times, rtol=1e-15)
    assert kinds.tolist() == jumps


def test_a_table_of_many_samples_of_a_smooth_function_has_no_knots_but_its_turns():
    cubic, polygon = TableSignal(**SMOOTH), TableSignal(**SMOOTH, interpolation="linear")
    for tol in (1e-3, 1e-6):
        found, alone = (breakpoints(model(cubic, driving=[0]), TIME, tol, turns=turns)[0] for turns in (True, False))
        assert_allclose(found[found < TIME], [TIME / 2])  # at its end its acceleration jumps
        assert len(alone[alone < TIME]) == 0
        assert_allclose(breakpoints(model(polygon), TIME, tol)[0], [TIME / 2])
    assert len(breakpoints(model(polygon, driving=[0]), TIME, 1e-3)[0]) > 9000  # its rate jumps at each
    waves = TableSignal(time=SAMPLES, value=np.sin(1e4 * np.array(SAMPLES)))
    found = breakpoints(model(waves), TIME, 1e-3)[0]
    assert len(found[found < TIME]) == int(1e4 * TIME / np.pi + 0.5)


def test_turns_are_larger_than_tol_and_a_stay_before_one_ends_at_a_knot():
    """Two humps of a smooth table, the second of them 1e-3 of the first."""
    time = np.linspace(0, 2, 4001)
    table = TableSignal(time=time.tolist(), value=(hump(time, 1.0, 0.02) + 1e-3 * hump(time, 1.5, 0.02)).tolist())
    start, top = breakpoints(model(table), 2.0, 2e-3)[0]
    assert 0.94 < start < top == 1.0
    assert_allclose(breakpoints(model(table), 2.0, 1e-4)[0][[1, 4]], [1.0, 1.5])


def test_knots_at_one_instant_are_one_and_the_most_that_jumps_counts():
    ramp, table = Ramp(start=0.5, end=0.8), TableSignal(**TWO_PARTS, interpolation="linear")
    times, jumps = breakpoints(model(ramp, table, driving=[1]), 1.2, 1e-4)
    assert_allclose(times, [0.5, 0.8, 1.0], rtol=1e-15)
    assert jumps.tolist() == [RATE, HIGHER, RATE]


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit", "energy"])
def test_a_pulse_much_shorter_than_the_steps_before_it_is_not_missed(integrator):
    """A body at rest takes long steps, which must not pass over the pulse."""
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=2.0, inertia=(1, 1, 1), position=(0, 0, 0))
    scene.force("A", value=(100, 0, 0), scale=Pulse(start=0.5031, end=0.5041))
    run = scene.run(1.0, integrator=integrator, output_step=0.1, progress=False)
    assert_allclose(run["A.velocity"][-1, 0], 100 * 0.5e-3 / 2, rtol=1e-4)


def hump(time, middle, width=1e-3):
    """Return a smooth pulse of a width in s."""
    return np.exp(-(((time - middle) / width) ** 2))


def pushed(signal) -> Scene:
    """Return a free body of 2 kg at rest."""
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=2.0, inertia=(1, 1, 1), position=(1, 0, 0))
    scene.force("A", value=(100, 0, 0), scale=signal)
    return scene


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit", "energy"])
def test_a_smooth_pulse_of_a_table_of_many_samples_is_not_missed(integrator):
    """None of its samples is a breakpoint."""
    time = np.linspace(0, 1, 20_001)
    run = pushed(TableSignal(time=time.tolist(), value=hump(time, 0.5531).tolist())).run(
        1.0, integrator=integrator, output_step=0.1, tol=1e-3, progress=False)
    assert_allclose(run["A.velocity"][-1, 0], 50 * np.sqrt(np.pi) * 1e-3, rtol=1e-4)


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit", "energy"])
def test_a_pulse_shorter_than_a_fixed_step_gives_its_whole_impulse(integrator):
    """By any integrator, without a change of the energy."""
    run = pushed(Pulse(start=0.5031, end=0.5041)).run(1.0, integrator=integrator, step=0.01, progress=False)
    assert_allclose(run["A.velocity"][-1, 0], 100 * 0.5e-3 / 2, rtol=1e-9)


@pytest.mark.parametrize(("signal", "said"), [
    (Harmonic(amplitude=1, frequency=100.0), "sine has a period of 0.01 s, and the fixed step is 0.01 s"),
    (TableSignal(time=np.linspace(0, 1, 20_001).tolist(), value=hump(np.linspace(0, 1, 20_001), 0.5531).tolist()),
     "the fixed step of 0.01 s is too long for its signal"),
])
def test_a_signal_that_a_fixed_step_cannot_follow_is_named(signal, said):
    """A sine whose period is the step would be no load at all."""
    with pytest.warns(FunicularWarning, match=f'force "force_1": .*{said}'):
        run = pushed(signal).run(1.0, step=0.01, progress=False)
    assert said in run.report["messages"][0]
    fine = Harmonic(amplitude=1, frequency=5.0) if isinstance(signal, Harmonic) else Pulse(start=0.5, end=0.6)
    assert "fixed step" not in str(pushed(fine).run(1.0, step=0.01, progress=False).report["messages"])


def hung(elements=6) -> Scene:
    return cable_scene("rope", length=3, pins=(0.0,), elements=elements, element="cable12",
                       section=Rectangle(height=0.02, width=0.02),
                       material=Material(youngs_modulus=2e7, poisson_ratio=0.0, density=2000, damping_time=2e-3))


def turned(**drive) -> Scene:
    scene = hung()
    scene.pin("rope", s=3.0)
    scene.rigid_body("A", mass=2.0, inertia=(0.02, 0.03, 0.04), position=(1.5, -0.3, 0))
    scene.joint("revolute", (1.5, 0, 0), ("A", (0, 0.3, 0)), name="drive", axis=(0, 0, 1), **drive)
    return scene


def carried(**drive) -> Scene:
    scene = hung()
    scene.pin("rope", s=3.0)
    scene.rigid_body("A", mass=2.0, inertia=(0.02, 0.03, 0.04), position=(0.6, 0, 0))
    scene.slide("A", along="rope", s=0.6, name="drive", **drive)
    return scene


def moved(signal) -> Scene:
    scene = hung()
    scene.motion("rope", s=3.0, displacement=(0, signal, 0))
    return scene


DRIVEN = {
    "joint, angle": lambda: turned(angle=straight(0, 0, 0.2, 0.2, 0.1)),
    "joint, velocity": lambda: turned(velocity=straight(0, 3, 1, 4, 4)),
    "motion": lambda: moved(straight(0, 0, 0.02, 0.02, 0.01)),
    "slide, s": lambda: carried(drive=straight(0.6, 0.6, 0.7, 0.7, 0.75)),
    "slide, velocity": lambda: carried(velocity=straight(0, 0, 3, 3, 1)),
}
"""Their rates or accelerations jump, at breakpoints within steps."""


@pytest.mark.parametrize("scene", DRIVEN.values(), ids=DRIVEN)
def test_energy_is_explained_where_the_rate_or_the_acceleration_of_a_drive_jumps(scene):
    """Runs once ended with unexplained energy, or had errors of up to 3 %."""
    works = []
    for integrator in ("genalpha", "radau"):
        run = scene().run(TIME, integrator=integrator, tol=1e-6, output_step=1e-3, progress=False)
        assert energy_error(run) < 1e-5
        works.append(run["energy.external"][-1])
    assert abs(works[0]) > 1e-3
    assert_allclose(works[0], works[1], rtol=1e-5)


@pytest.mark.parametrize("velocity", [0.0, 0.4])
def test_a_jump_of_a_drives_rate_gives_the_impulse_and_its_work(velocity):
    """The body changes its angular velocity at once: its kinetic energy, without dissipation."""
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=2.0, inertia=(0.02, 0.03, 0.04), position=(0, -0.3, 0),
                     velocity=(0.3 * velocity, 0, 0), angular_velocity=(0, 0, velocity))
    table = straight(0, 0.1 * velocity, 0.1 * velocity + 0.15, times=(0, 0.1, 0.2))
    scene.joint("revolute", (0, 0, 0), ("A", (0, 0.3, 0)), axis=(0, 0, 1), angle=table, name="drive")
    inertia = 0.04 + 2.0 * 0.09
    for settings in ({"integrator": "radau"}, {"integrator": "genalpha"}, {"integrator": "genalpha", "step": 1e-3}):
        run = scene.run(0.2, output_step=0.03, progress=False, **settings)
        assert_allclose(run["energy.external"][-1], 0.5 * inertia * (1.5**2 - velocity**2), rtol=1e-5)
        assert_allclose(run["energy.dissipated"], 0, atol=1e-12)
        assert_allclose(run["A.angular_velocity"][-1, 2], 1.5, rtol=1e-5)


@pytest.mark.parametrize("interpolation", ["cubic", "linear"])
def test_a_table_of_many_samples_costs_no_steps(interpolation):
    """The number of steps equals that of the sampled function, which the moved end follows."""
    smooth = {"cubic": TableSignal(**SMOOTH), "linear": TableSignal(**SMOOTH, interpolation="linear")}[interpolation]
    steps = []
    for signal in (Harmonic(amplitude=-0.05, frequency=1 / TIME, phase=np.pi / 2, offset=0.05), smooth):
        scene = hung()
        if interpolation == "linear":
            scene.force("rope", s=3.0, value=(0, 50, 0), scale=signal)
        else:
            scene.motion("rope", s=3.0, displacement=(0, signal, 0))
        steps.append(scene.run(TIME, tol=1e-4, integrator="genalpha", output_step=TIME / 10,
                               progress=False).report["steps"])
    assert abs(steps[1] - steps[0]) <= 2 < steps[0]


def test_fixed_steps_end_at_knots_but_not_where_a_smooth_table_turns():
    load, drive, smooth = hung(), moved(straight(0, 0, 0.013, 0.05, 0.072, 0.2, times=UNEVEN)), hung()
    load.force("rope", s=3.0, value=(0, 50, 0), scale=straight(0, 1, -1, 1, 0, 1, times=UNEVEN))
    smooth.force("rope", s=3.0, value=(0, 50, 0), scale=TableSignal(**SMOOTH))
    settings = {"integrator": "radau", "step": 1e-3, "output_step": 1e-2, "progress": False}
    for scene in (load, drive):
        assert 100 < scene.run(TIME, **settings).report["steps"] <= 108
    assert smooth.run(TIME, **settings).report["steps"] == 100


@pytest.mark.parametrize("integrator", ["radau", "explicit", "genalpha"])
@pytest.mark.parametrize("value", [(0, 0, 0.3, 0), (0, 0, 0.3, 0.3), (0, 0, 0.3)], ids=["turns back", "stops", "ends"])
def test_the_last_row_of_a_run_that_ends_on_a_corner_is_of_the_instant_before(integrator, value):
    """Rates and energies of the last row are consistent and do not depend on the table after the end."""
    scene = Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=2.0, inertia=(0.1, 0.2, 0.3), position=(0.5, 0, 0))
    scene.joint("revolute", (0, 0, 0), ("A", (-0.5, 0, 0)), axis=(0, 0, 1), name="j",
                angle=straight(*value, times=(0, 0.25, 0.5, 0.75)[: len(value)]))
    run = scene.run(0.5, tol=1e-6, integrator=integrator, output_step=0.05, progress=False)
    assert run.time[-1] == 0.5
    kinetic = 0.5 * (0.3 + 2.0 * 0.25) * 1.2**2
    assert_allclose(run["A.angular_velocity"][-1], (0, 0, 1.2), atol=1e-6)
    assert_allclose(run["energy.kinetic"][-1], kinetic, rtol=1e-3)  # genalpha does not control errors of rates
    assert abs(run.energy_balance().residual).max() < 2e-3 * kinetic
    assert "energy balance" not in str(run.report["messages"])
