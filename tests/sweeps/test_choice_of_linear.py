"""The linear model as a candidate of the choice of a model: where it is taken, and that the tolerance is kept."""

import warnings

import funicular as fu
import pytest
from funicular.choice.motion import motion
from funicular.results.trajectories import distance, largest_change
from shared_scenes import add_cable, add_rider

THIN = fu.Rectangle(height=0.01, width=0.01)
SOFT = fu.Material(youngs_modulus=2e8, poisson_ratio=0.0, density=1100, damping_time=1e-3, mass_damping=0.3)
SETTINGS = {"duration": 6.0, "initial": "equilibrium"}


def taut(size):
    """Return a taut wire between two pins under a force in N that oscillates."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    add_cable(scene, pins="ends", end=(4, 0, 0), rest_length=3.9, elements=None, material=SOFT, section=THIN)
    scene.force("wire", s=1.4, value=(0, size, 0), scale=fu.Harmonic(amplitude=1.0, frequency=3.0))
    return scene


def test_it_is_taken_for_a_small_motion_and_errs_no_more_than_the_scene():
    """Its error is that of the generalised-alpha method, in time, on the same mesh."""
    scene = taut(0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        run = scene.run(**SETTINGS, tol=1e-2, model="auto")
        tol = run.report["tol"]
        damped = run.scene.run(**SETTINGS, integrator="genalpha", tol=tol)
        exact = run.scene.run(**SETTINGS, integrator="radau", tol=1e-4)
    assert run.report["integrator"] == "linear"
    assert any("integrator linear" in reason and "of genalpha" in reason for reason in run.report["choice"]["reasons"])
    reference = motion(exact.scene, exact)
    linear, other = (distance(motion(each.scene, each), reference) for each in (run, damped))
    assert abs(linear - other) < 0.1 * 1e-2 * largest_change(reference)
    assert linear < 2e-2 * largest_change(reference)


@pytest.mark.parametrize("change", ["large", "slide", "short", "asked"])
def test_it_is_not_taken(change):
    """For a motion that is not small, with a slide by constraints, for few steps, and against the caller's choice."""
    scene = taut(100.0 if change == "large" else 0.1)
    if change == "slide":
        add_rider(scene, 0.2, 0.0)
    settings = SETTINGS | ({"duration": 0.05} if change == "short" else {"duration": 2.0})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        choice = scene.choose(1e-2, **settings, **({"integrator": "genalpha"} if change == "asked" else {}))
    assert choice.integrator != "linear"
