"""D7 of CASES.md: the kernels of a planar modal body against the published numbers of a flexible slider-crank."""

import numpy as np
import pytest
from slider_crank import ACCELERATIONS, END, START, Rod


def test_accelerations_at_the_start_are_the_published_ones():
    """As far as the nine digits of the published velocities determine them."""
    found = Rod().accelerations(0.0, np.array(START["q"]), np.array(START["v"]))
    np.testing.assert_allclose(found, ACCELERATIONS, rtol=1e-6, atol=5e-8)


def test_the_end_is_carried_as_published_only_with_the_published_mass():
    """The right mass of the axial modes is told apart at the start already: it decides their accelerations."""
    right = Rod(axial_mass=1.0).accelerations(0.0, np.array(START["q"]), np.array(START["v"]))
    assert abs(right[4] / ACCELERATIONS[4] - 1) > 0.1


@pytest.mark.slow
def test_the_motion_is_the_published_one():
    """At 0.1 s, after two and a half turns. Converged: angle off by 3e-11, slider 3e-11 m; modal coordinates by 3e-7,
    2e-7, 2e-6, 4e-6 of theirs, as the start is given to nine digits, which vibrate on."""
    found = Rod().run(tol=1e-6)
    assert abs(found["angle"] - END["angle"]) < 1e-9
    assert abs(found["slider"] - END["slider"]) < 1e-9
    assert abs(found["off"]) < 1e-11
    np.testing.assert_allclose(found["modes"], END["modes"], rtol=2e-5)
