"""Friction springs within long steps: dissipation and reversals follow from the path within the step."""

import functools
import warnings

import funicular as fu
import numpy as np
import pytest


@functools.cache
def grazed(integrator: str, tol: float) -> fu.Run:
    """Return a run of a ball that strikes another off its centre: it slides, sticks and slides again on its surface."""
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.rigid_body("A", mass=1, inertia=(0.01,) * 3, position=(-0.5, 0.05, 0), velocity=(1, 0, 0))
    scene.rigid_body("B", mass=2, inertia=(0.02,) * 3, position=(0, 0, 0))
    scene.surface("round", fu.Sphere(radius=0.1), on="B")
    scene.contact("A", "round", radius=0.1, stiffness=1e4, exponent=1.5, friction=0.3, tangential_stiffness=1e4)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        return scene.run(0.8, output_step=0.05, tol=tol, integrator=integrator, progress=False)


@pytest.mark.parametrize(("integrator", "tol", "error"), [
    ("explicit", 1e-4, 3e-4), ("explicit", 1e-6, 4e-5), ("radau", 1e-6, 2e-5), ("radau", 1e-8, 1e-6)])
def test_the_energy_that_friction_takes(integrator, tol, error):
    """By the ends of steps alone, the errors are 3e-3, 1e-3, 4e-4 and 2e-5 of the exchanged energy."""
    balance = grazed(integrator, tol).energy_balance()
    assert np.abs(balance.residual).max() < error * balance.exchanged


@pytest.mark.parametrize(("integrator", "tol", "error"), [
    ("explicit", 1e-6, 1e-5), ("radau", 1e-6, 2e-5), ("radau", 1e-8, 1e-6)])
def test_a_point_that_turns_round_while_it_slides(integrator, tol, error):
    """Without the search for reversals the velocity, in m/s, has errors of 3e-4, 1.6e-4 and 2e-5."""
    exact = grazed("radau", 1e-10)["A.velocity"][-1]
    assert grazed(integrator, tol)["A.velocity"][-1] == pytest.approx(exact, abs=error)


@functools.cache
def bounced(integrator: str, tol: float) -> fu.Run:
    """Return a run of a bar that bounces on a taut wire, and slides and sticks along it."""
    scene = fu.Scene(gravity=(0, 0, 0))
    wire = scene.cable("wire", start=(-1, 0, 0), end=(1, 0, 0), elements=4, element="cable12", rest_length=1.99,
                       section=fu.Circle(radius=0.005),
                       material=fu.Material(youngs_modulus=1e7, density=1000, poisson_ratio=0.3))
    scene.pin(wire, s=0)
    scene.pin(wire, s=wire.length)
    scene.rigid_body("bar", mass=0.2, inertia=(0.01,) * 3, position=(0.1, 0, -0.05), velocity=(0.3, 0, 0.5))
    scene.crossing(wire, "bar", axis=(0, 1, 0), length=1.0, stiffness=2e4, radius=0.01, tangential_stiffness=2e4,
                   friction=fu.Friction(coefficient=0.3, model="stick"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        return scene.run(0.25, output_step=0.01, tol=tol, integrator=integrator, progress=False)


@pytest.mark.parametrize(("integrator", "tol", "error"), [
    ("explicit", 1e-4, 5e-4), ("explicit", 1e-6, 2e-4), ("radau", 1e-4, 5e-4), ("radau", 1e-6, 1e-5)])
def test_the_energy_that_friction_of_lines_takes(integrator, tol, error):
    """By the ends of steps alone, the errors are 9e-3, 3e-3, 1.3e-3 and 6e-5 of the exchanged energy."""
    balance = bounced(integrator, tol).energy_balance()
    assert np.abs(balance.residual).max() < error * balance.exchanged


@pytest.mark.parametrize("integrator", ["explicit", "radau"])
@pytest.mark.parametrize("tol", [1e-4, 1e-6])
def test_a_bar_that_slides_and_sticks_on_a_wire_is_within_tol(integrator, tol):
    """By the ends of steps alone, the error with explicit steps is 24 tol at 1e-6."""
    reference = bounced("explicit", 1e-10)["bar.position"]
    error = np.abs(bounced(integrator, tol)["bar.position"] - reference).max()
    assert error < 3 * tol * np.abs(reference - reference[0]).max()
