"""A run that stops, or is worth little, says when, where, why and what to do; what was computed is kept."""

import re

import numpy as np
import pytest
from funicular import Circle, ConvergenceError, EndOfCableError, FunicularWarning, Material, Ramp, Scene
from hard_cases.crossings import rider
from hard_cases.steps import soft


def kept(stopped) -> np.ndarray:
    """Times of the partial run; all finite, from the start to where it stopped."""
    run = stopped.value.run
    assert run.status in ("no_convergence", "end_of_cable")
    assert run.report["message"] == str(stopped.value)
    assert np.all(np.isfinite(run["A.position"])) and run.time[0] == 0
    return run.time


@pytest.mark.parametrize("step", [0.1, 0.02, 2e-3])
def test_an_explicit_step_beyond_its_limit(step):
    """It used to tell of a rider that ran off its cable."""
    with pytest.raises(ConvergenceError) as stopped:
        rider(0.25, 1.0, elements=3).run(1.0, step=step, integrator="explicit", progress=False)
    message = str(stopped.value)
    print(message)
    for part in ("energy grew without a source at t = ", "of 1 s", "J were exchanged; fastest is ", ' m/s)',
                 "results up to that time are kept",
                 f'The step {step:g} s is too large for integrator "explicit": take a smaller one',
                 'integrator="genalpha"'):
        assert part in message
    assert 'cable "wire" at s = ' in message or 'body "A"' in message
    assert kept(stopped)[-1] <= 0.1


def test_the_end_of_a_cable():
    says = 'slide "A_on_wire": ran off the end of cable "wire" at t = 0.014 s'
    with pytest.raises(EndOfCableError, match=says) as stopped:
        rider(0.1, 100.0, gravity=(0, 0, 0)).run(0.1, progress=False)
    assert kept(stopped)[-1] == pytest.approx(0.014, abs=1e-12)


def test_a_cable_that_is_pushed_through_itself():
    """Straight, without a side to give way to, its end pushed to its start and beyond: no cable does that."""
    scene = Scene(gravity=(0, 0, 0))
    scene.cable("strip", start=(0, 0, 0), end=(1, 0, 0), elements=2, element="cable8p", section=Circle(radius=5e-3),
                material=Material(youngs_modulus=1e7, poisson_ratio=0.3, density=1000))
    scene.pin("strip", s=0.0)
    scene.motion("strip", s=1.0, displacement=(Ramp(start=0.0, end=0.1, after=-2.0), 0, 0))
    with pytest.raises(ConvergenceError) as stopped:
        scene.run(0.1, step=1e-3, progress=False)
    message = str(stopped.value)
    print(message)
    assert 'cable "strip" at s = ' in message
    assert "times their length at rest" in message
    assert stopped.value.run.report["rejected_steps"] < 30_000  # it does not struggle on for a minute
    assert stopped.value.run.time[-1] > 0.02


@pytest.mark.parametrize(("settings", "says"), [
    ({"step": 0.1}, r"the estimated errors of the steps sum up to 0.0\d+ of the largest motion: take a smaller step"),
    ({"step": 0.1}, r"\d+ times no step of 0.1 s was possible: it was divided, down to 0.0\d+ s"),
    ({"step": 0.02, "spectral_radius": 0.0},
     r"the energy balance is off by up to [\d.]+ J, 0.\d+ of the [\d.]+ J exchanged: energy went that neither .*: "
     r"take a smaller step, or none, so that tol chooses it, or a spectral_radius nearer to 1")])
def test_coarse_results_are_reported(settings, says):
    with pytest.warns(FunicularWarning, match=says):
        run = rider(0.25, 1.0, elements=3).run(1.0, output_step=0.1, progress=False, **settings)
    assert any(re.search(says, note) for note in run.report["messages"])


@pytest.mark.parametrize("settings", [{}, {"step": 1e-3}, {"integrator": "explicit"}, {"spectral_radius": 0.0}])
def test_good_results_need_no_note(settings, recwarn):
    run = soft().run(1.0, progress=False, **settings)
    assert run.report["messages"] == []
    assert not [w for w in recwarn if issubclass(w.category, FunicularWarning)]


def test_a_scene_at_rest_has_no_energy_balance_to_break():
    """Rounding is all that is exchanged there."""
    for integrator in ("genalpha", "explicit"):
        run = rider(0.75, 0.0, gravity=(0, 0, 0), elements=2).run(0.1, integrator=integrator, progress=False)
        assert run.status == "completed" and run.report["messages"] == []
    run = soft().run(0.1, initial="equilibrium", progress=False)
    assert run.status == "completed" and run.report["messages"] == []
