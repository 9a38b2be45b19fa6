"""Driven slides whose riders are drawn at another rate: the note at the start of a run."""

import funicular as fu
import numpy as np
import pytest

DECK = {"element": "beam12p", "law": "structural", "section": fu.Rectangle(height=0.2, width=0.3),
        "material": fu.Material(youngs_modulus=1.2e10, poisson_ratio=0.3, density=8000, damping_time=1e-3)}


def footbridge(moving=(0, 0, 0), turn=0.0, **slide):
    """Return a walker on a deck of 12 m, whose feet are driven along it."""
    scene = fu.Scene(gravity=(0, -9.81, 0))
    deck = scene.cable("deck", start=(0, 0, 0), end=(12, 0, 0), elements=4, **DECK)
    scene.pin(deck, s=0)
    scene.pin(deck, s=12)
    scene.rigid_body("walker", mass=75, inertia=(1, 1, 1), position=(1, 1, 0), velocity=moving,
                     angular_velocity=(0, 0, turn))
    scene.slide("walker", along=deck, at=(0, -1, 0), name="feet", **{"s": 1.0, "velocity": 1.5} | slide)
    return scene


def jumps(scene, **settings):
    run = scene.run(duration=0.01, output_step=0.01, integrator="radau", tol=1e-2, **settings)
    return [message for message in run.report["messages"] if "slide" in message]


@pytest.mark.parametrize("initial", ["drawn", "equilibrium"])
def test_a_rider_drawn_at_rest_is_told_with_both_rates(initial):
    """A run from equilibrium also starts with the velocities of the scene."""
    assert jumps(footbridge(), initial=initial) == [
        'slide "feet": moves along cable "deck" at 1.5 m/s from t = 0, but body "walker" is drawn at 0 m/s along it; '
        'this jump is a blow to rider and cable, which depends on the mesh. Start body "walker" at velocity '
        "(1.5, 0, 0) m/s, or let the rate begin at 0 m/s, as that of a Ramp does"]


@pytest.mark.parametrize(("velocity", "turn"), [((1.5, 0, 0), 0), ((1.5, 0.3, 0), 0), ((1.0, 0, 0), 0.5)])
def test_a_rider_at_the_rate_of_its_slide_is_not(velocity, turn):
    assert jumps(footbridge(velocity, turn)) == []


@pytest.mark.parametrize("signal", [{"velocity": fu.Ramp(start=0, end=1, before=0, after=1.5)},
                                    {"velocity": None, "drive": fu.Ramp(start=0, end=1, before=1, after=2)}])
def test_a_rate_that_begins_at_zero_is_not(signal):
    assert jumps(footbridge(**{"s": 1.0} | signal)) == []


def test_the_remedy_holds_on_a_sloped_and_stretched_cable():
    """With the advised velocity there is no note, and the start changes nothing along the cable."""
    scene = fu.Scene(gravity=(0, 0, 0))
    wire = scene.cable("wire", start=(0, 0, 0), end=(4, 3, 0), rest_length=4.9, elements=4, element="cable8p",
                       velocity=(0.2, 0.1, 0), section=fu.Circle(radius=0.01),
                       material=fu.Material(youngs_modulus=1e9, poisson_ratio=0, density=8000))
    scene.rigid_body("car", mass=1, inertia=(1, 1, 1), position=wire.point(2.0))
    scene.slide("car", along=wire, velocity=1.5)
    note, = jumps(scene)
    velocity = [float(part) for part in note.split("velocity (")[1].split(")")[0].split(", ")]
    slope = 5 / 4.9 * np.array([0.8, 0.6, 0])
    assert (np.array(velocity) - (0.2, 0.1, 0)) @ slope / (slope @ slope) == pytest.approx(1.5, rel=1e-5)
    assert jumps(scene.replace("car", velocity=velocity)) == []


def test_later_jumps_of_the_rate_are_told():
    table = fu.TableSignal(time=(0, 0.002, 0.01), value=(1.0, 1.0, 1.004), interpolation="linear")
    note, = jumps(footbridge(velocity=None, drive=table))
    assert note.startswith('slide "feet": the rate of s jumps by 0.5 m/s at t = 0.002 s; each jump sends a shock')


def test_a_start_with_velocities_of_its_own_is_not_as_drawn():
    state = fu.InitialState({"walker.velocity": [1.5, 0, 0]})
    assert jumps(footbridge(), initial=state) == []


@pytest.mark.parametrize("tol", [1e-2, 1e-3])
def test_heat_of_modes_at_the_limit_of_stability(tol):
    """The fastest modes limit explicit steps, and vibrate within tol; the dissipation equals that of radau.

    The squares of the stages' velocities are many times the energy of such modes.
    """
    run, reference = (footbridge().run(duration=0.1, tol=tol, output_step=0.01, integrator=integrator)
                      for integrator, tol in (("explicit", tol), ("radau", 1e-6)))
    np.testing.assert_allclose(run["energy.dissipated"], reference["energy.dissipated"], atol=0.05)
    assert not any("energy" in message for message in run.report["messages"])


def test_a_run_that_ends_in_energy_of_the_blow_names_it():
    """An explicit run at a very loose tolerance: the note names the impulse beside the growth of energy."""
    with pytest.raises(fu.ConvergenceError, match=r"energy grew without a source .*; slide \"feet\": moves along .* "
                                                  r"Start body \"walker\" at velocity \(1\.5, 0, 0\) m/s"):
        footbridge().run(duration=0.03, tol=100.0, output_step=0.01, integrator="explicit")
