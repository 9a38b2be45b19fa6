"""The search for rest of ropes that lie on something round as drawn: held by friction below the capstan's limit."""

import numpy as np
import pytest
from funicular import EquilibriumError, load_scene
from test_contact import LIGHT, capstan, heaviest

G = 9.81


def weight(scene):
    rope = scene.cables["rope"]
    return 1000 * np.pi * 1e-6 * rope.length * G


@pytest.mark.parametrize(("mu", "part"), [pytest.param(0.1, 0.7, marks=pytest.mark.slow), (0.1, 0.95), (0.3, 0.9)])
@pytest.mark.slow_cases("0.3-0.9")
def test_friction_holds_a_rope_on_its_drum_below_the_capstans_limit(mu, part):
    """With 40 elements it fell off, and the state was said to be stable."""
    scene = capstan(part * heaviest(mu), mu)
    rest = scene.equilibrium()
    (name,) = scene.contacts
    assert rest.stable and rest.messages == []
    assert rest[f"{name}.touching"] == pytest.approx(np.pi * 0.051, rel=0.15)
    np.testing.assert_allclose(rest[f"{name}.force"], (0, weight(scene), 0), atol=1e-6 * weight(scene))
    assert abs(rest["rope.position"][0, 1] + LIGHT) < 1e-3  # the rope stretches by 0.4 mm
    run = scene.run(0.05, output_step=0.05, tol=1e-4, initial=rest)
    assert np.abs(run["rope.position"][-1] - rest["rope.position"]).max() < 1e-5


@pytest.mark.slow
def test_the_bundled_drum_holds_its_rope():
    rest = load_scene("rope_over_drum").equilibrium()
    assert rest.stable and rest["held.touching"] > 0.13


@pytest.mark.slow
def test_a_rope_that_slides_off_is_named_in_the_error():
    scene = capstan(1.1 * heaviest(0.1), 0.1)
    with pytest.raises(EquilibriumError, match=r'"rope" lies on "drum" as drawn, from s = .* and may slide off it'):
        scene.equilibrium()
