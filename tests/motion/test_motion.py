"""Bodies and cables without slides: closed forms, Euler's equations, conservation.

Bounds without another reason are about twice the measured value, which a comment gives.
"""

import numpy as np
import pytest
from expectations import largest
from funicular import Material, Scene
from funicular.base.rotations import rotate
from scipy.integrate import solve_ivp
from shared_scenes import TABLE_1, add_cable

J = np.array([1e-3, 2e-3, 3e-3])
SPIN = np.array([0.05, 5.0, 0.02])


def spinning_body(step):
    """Return a thrown body that rotates about its middle axis and tumbles."""
    scene = Scene()
    scene.rigid_body("A", mass=0.7, inertia=J, position=(0, 0, 0), velocity=(1, 2, 3), angular_velocity=SPIN)
    return scene.run(4.0, step=step, output_step=0.04)


@pytest.fixture(scope="module")
def spins():
    return [spinning_body(h) for h in (4e-3, 2e-3, 1e-3)]


@pytest.fixture(scope="module")
def euler():
    """Return quaternion (w, x, y, z) and body-axis angular velocity by Euler's equations, at the times of the runs."""

    def rate(t, y):
        a, b, c, d, w = *y[:4], y[4:]
        product = [-b, -c, -d], [a, -d, c], [d, a, -b], [-c, b, a]
        return [*0.5 * np.array(product) @ w, *(-np.cross(w, J * w) / J)]

    solved = solve_ivp(rate, (0, 4), [1, 0, 0, 0, *SPIN], rtol=1e-12, atol=1e-13, t_eval=np.linspace(0, 4, 101))
    return solved.y.T


def test_a_free_body_tips_over_as_euler_says(spins, euler):
    assert euler[:, 5].min() < -4.99  # the middle axis is unstable: it does turn over
    errors = [
        (largest(run["A.orientation"] - euler[:, :4]), largest(run["A.angular_velocity"] - euler[:, 4:]))
        for run in spins
    ]
    ratios = np.array(errors[:-1]) / errors[1:]
    assert np.all(np.abs(ratios - 4) < 0.1)  # measured 4.00 to 4.00
    assert errors[-1][0] < 1e-5  # measured 4.3e-6


def test_a_free_body_keeps_energy_and_momentum(spins):
    run = spins[-1]
    momentum = rotate(run["A.orientation"], J * run["A.angular_velocity"])
    assert largest(momentum - momentum[0]) < 5e-6 * np.linalg.norm(momentum[0])  # measured 2.1e-6
    assert largest(run.energy_balance().residual) < 1e-7  # measured 5.3e-8 J, of 0.025 J of rotation
    assert largest(np.linalg.norm(run["A.orientation"], axis=1) - 1) < 1e-15


def test_a_thrown_body_flies_a_parabola(spins):
    for run in spins:
        t = run.time[:, None]
        exact = t * [1, 2, 3] + 0.5 * t**2 * [0, -9.81, 0]
        np.testing.assert_allclose(run["A.position"], exact, atol=5e-11)  # round-off; measured 7e-12
        np.testing.assert_allclose(run["A.acceleration"], np.tile([0, -9.81, 0], (101, 1)), atol=1e-13)


def test_a_free_cable_falls_without_strain():
    scene = Scene(gravity=(1, -9.81, 2))
    add_cable(scene, pins=(), start=(1, 2, 3), end=(2, 1, 2.5), up=(0, 0, 1))
    run = scene.run(1.0, step=1e-2)
    moved = run["wire.nodal_vectors"] - run["wire.nodal_vectors"][0]
    moved[:, :, 0] -= 0.5 * (run.time**2)[:, None, None] * [1, -9.81, 2]
    assert largest(moved) < 1e-12  # measured 2e-14
    assert run["energy.elastic"].max() < 1e-20


@pytest.mark.parametrize("step", [2e-3, 1e-3])
def test_a_damped_cable_comes_to_rest_and_the_energy_balances(step):
    """Kelvin-Voigt damping dissipates the energy of the fall; at rest the pins carry the weight."""
    scene = Scene()
    material = Material(youngs_modulus=0.4e9, poisson_ratio=0.0, density=4200, damping_time=0.02)
    add_cable(scene, material=material)
    run = scene.run(2.0, step=step)
    balance = run.energy_balance()
    assert balance.exchanged > 2.7
    assert largest(balance.residual) < 430 * step**2  # measured 214 step^2, of second order
    assert np.all(np.diff(run["energy.dissipated"]) >= 0)
    assert run["energy.kinetic"][-1] < 1e-13
    weight = 1.5 * 10.5 * 9.81
    np.testing.assert_allclose(run["wire@0.force"][-1] + run["wire@1.5.force"][-1], [0, weight, 0], atol=1e-5)
    sag = -run["wire.nodal_vectors"][-1, :, 0, 1]
    np.testing.assert_allclose(sag, sag[::-1], atol=1e-12)
    assert sag[1] > 0.01


def test_damping_of_a_mode_has_its_closed_form():
    """Axial vibration of a cable between fixed ends: a mode of frequency w decays with w^2 tau / 2.

    Axial gravity, applied suddenly, excites it; the first mode has 32/pi^3 of the static deflection.
    """
    tau = 2e-4
    material = TABLE_1.model_copy(update={"damping_time": tau})
    scene = Scene(gravity=(9.81, 0, 0))
    add_cable(scene, elements=8, material=material)
    run = scene.run(0.04, step=1e-5, output_step=1e-5)
    speed = np.sqrt(0.4e9 / 4200)
    w = np.pi * speed / 1.5
    middle = run["wire.nodal_vectors"][:, 4, 0, 0] - 0.75
    static = 4200 * 9.81 * 1.5**2 / (8 * 0.4e9)
    first = static * 32 / np.pi**3  # of the first mode in a parabola
    t = run.time
    damped = w * np.sqrt(1 - (w * tau / 2) ** 2)
    exact = static - first * np.exp(-(w**2) * tau / 2 * t) * (
        np.cos(damped * t) + w**2 * tau / (2 * damped) * np.sin(damped * t)
    )
    late = t > 5e-3  # the third mode has decayed
    assert largest((middle - exact)[late]) < 0.01 * static  # measured 0.0058


def test_a_cable_at_rest_stays_at_rest():
    scene = Scene(gravity=(0, 0, 0))
    add_cable(scene, pins=())
    assert largest(scene.run(1.0)["wire.nodal_velocity"]) < 1e-15
