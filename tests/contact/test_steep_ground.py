"""A body falls on a steep flank: contact is searched above the highest point of the ground, too."""

import funicular as fu
import numpy as np
import pytest
from expectations import unaccounted
from scipy.optimize import brentq

RADIUS = 0.5


def ridge() -> fu.HeightField:
    return fu.HeightField.of(lambda x: 2 * np.exp(-(x / 0.5)**2), np.linspace(-3, 3, 121))


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit", "energy"])
def test_a_flank_is_touched_where_its_distance_says_so(integrator):
    """The distance is that of the tangent plane: 0.5 m from it is 1.45 m above the flank, 1.16 m above the ridge."""
    scene = fu.Scene(gravity=(0, 0, 0))
    surface = scene.surface("ground", ridge())
    scene.rigid_body("ball", mass=1.0, inertia=(1, 1, 1), position=(0.2, 5.0, 0), velocity=(0, -1, 0))
    scene.contact("ball", "ground", radius=RADIUS, stiffness=1e3)
    touch = brentq(lambda y: surface.distance(None, np.array([[0.2, y, 0.0]]))[0] - RADIUS, 2.0, 5.0)
    assert touch > 2.0 + RADIUS + 0.1
    run = scene.run(3.0, output_step=0.1, integrator=integrator, tol=1e-4, progress=False)
    assert unaccounted(run) < 1e-3 * run["energy.kinetic"][0]
    assert run.report["events"][0]["what"] == "came into contact"
    assert run.report["events"][0]["time"] == pytest.approx(5.0 - touch, abs=1e-8)
