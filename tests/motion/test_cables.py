"""Cables in motion, against two independent formulations (cases S1, D0; tests/reference)."""

from functools import partial
from pathlib import Path

import numpy as np
import pytest
import sliding
from expectations import energy_error
from funicular import Material, Rectangle, Scene, SceneError
from shared_scenes import cable_scene

REFERENCE = Path(__file__).parents[1] / "reference"


def read(name: str) -> np.ndarray:
    return np.genfromtxt(REFERENCE / name, delimiter=",", names=True)


sliding_mass = partial(sliding.sliding_mass, strain="engineering")  # S1, and its flexible variant


def pendulum(strain: str, damping_time=0.0) -> Scene:
    """D0."""
    return cable_scene("rope", pins=(0.0,), elements=8, element="cable12", strain=strain,
                       section=Rectangle(height=0.02, width=0.02),
                       material=Material(youngs_modulus=2e6, poisson_ratio=0.0, density=7200,
                                         damping_time=damping_time))


def test_sliding_mass_follows_the_reference():
    """S1: measured 1.6e-8 m in x, 2.3e-7 m in y; force and acceleration 3e-3 of their range."""
    expected = read("paper51_cable12_engineering.csv")
    run = sliding_mass().run(1.0, tol=1e-6, output_step=0.01)
    assert np.abs(run["A.position"][:, 0] - expected["x_m"]).max() < 1e-7
    assert np.abs(run["A.position"][:, 1] - expected["y_m"]).max() < 1e-6
    assert np.abs(run["trolley.s"] - expected["s_m"]).max() < 1e-7
    for ours, theirs in ((run["A.acceleration"], "ay_m_s2"), (run["trolley.force"], "force_y_N")):
        assert np.abs(ours[:, 1] - expected[theirs]).max() < 1e-2 * np.ptp(expected[theirs])
    assert run["trolley.residual"].max() < 1e-9


@pytest.mark.parametrize(("elements", "x", "y"), [(6, 1.32457683, -0.00619614), (12, 1.32487172, -0.00613117)])
def test_sliding_mass_on_finer_meshes(elements, x, y):
    run = sliding_mass(elements).run(1.0, tol=1e-6, output_step=0.1)
    np.testing.assert_allclose(run["A.position"][-1], [x, y, 0], atol=1e-6)


@pytest.mark.slow
def test_cubic_and_quintic_cable_go_to_one_limit():
    """Flexible S1, s at t = 1: 1.3559, 1.3039, 1.3028, 1.3021 m with 3, 12, 24, 48 cubic elements, and 1.3024 with 12
    quintic ones. 1.30395346 is the other formulations' converged value for 12 cubic elements."""
    def s_end(**scene):
        return sliding_mass(youngs_modulus=2e6, mass=5.0, **scene).run(1.0, tol=1e-5, output_step=0.1)["trolley.s"][-1]

    assert s_end(elements=12) == pytest.approx(1.30395346, abs=1e-4)
    assert s_end(elements=12, element="cable18") == pytest.approx(s_end(elements=48), abs=1e-3)


@pytest.mark.parametrize(("strain", "tip"), [("green", (-0.93776968, -0.0932186)),
                                             ("engineering", (-0.908654017, 0.000592346))])
def test_pendulum_tip(strain, tip):
    """D0 at t = 1; the remaining error is the quadrature of the exact curvature (laws/cable/cable.py), not time."""
    run = pendulum(strain).run(1.0, tol=1e-6, output_step=0.1)
    np.testing.assert_allclose(run["rope.nodal_vectors"][-1, -1, 0], [*tip, 0], atol=2e-5)
    assert energy_error(run) < 1e-4


def test_pendulum_follows_the_reference():
    expected = read("pendulum_cable12_green.csv")
    r = pendulum("green").run(1.0, tol=1e-6, output_step=0.01)["rope.nodal_vectors"][:, -1, 0]
    assert np.hypot(r[:, 0] - expected["tip_x_m"], r[:, 1] - expected["tip_y_m"]).max() < 2e-5


def test_damped_pendulum_balances_its_energy():
    run = pendulum("green", damping_time=2e-3).run(1.0, tol=1e-5)
    assert run["energy.dissipated"][-1] > 0.1  # J, of 14 J exchanged
    assert np.all(np.diff(run["energy.dissipated"]) >= 0)
    assert energy_error(run) < 1e-4


@pytest.mark.parametrize(("change", "message"), [
    ({"section": Rectangle(height=0.05, width=0.02)}, "cable12 has one bending stiffness"),
    ({"element": "beam24"}, "strain, curvature and membrane are for cable elements"),
    ({"strain": "grean"}, 'strain "grean" is not known'),
    ({"curvature": "flat"}, 'curvature "flat" is not known'),
    ({"element": "cable18", "curvature": "linear"},
     'law "green_linear" is not possible for cable18; possible: green_exact, engineering_exact, green_exact_assumed, '
     "engineering_exact_assumed, green_exact_reduced, engineering_exact_reduced"),
])
def test_what_a_cable_cannot_be(change, message):
    good = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 2, "element": "cable12", "strain": "green",
            "section": Rectangle(height=0.05, width=0.05),
            "material": Material(youngs_modulus=1e9, poisson_ratio=0.3, density=1000)}
    with pytest.raises(SceneError) as refused:
        Scene().cable("wire", **good | change)
    assert message in str(refused.value)
