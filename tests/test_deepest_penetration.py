"""The penetration that a run tells, of its rows, is what the energy allows."""

import re

import funicular as fu
import numpy as np
import pytest


@pytest.mark.parametrize("integrator", ["genalpha", "radau", "explicit", "energy"])
@pytest.mark.parametrize(("speed", "stiffness"), [(2.0, 1e3), (0.7, 50.0)])
def test_the_penetration_at_rows_is_what_the_energy_allows(integrator, speed, stiffness):
    """A linear penalty stores all the energy where the ball turns round: m v^2/2 = k d^2/2. A row is there."""
    mass, radius = 3.0, 0.1
    scene = fu.Scene(gravity=(0, 0, 0))
    scene.surface("ground", fu.Plane())
    scene.rigid_body("ball", mass=mass, inertia=(1, 1, 1), position=(0, 0.5, 0), velocity=(0, -speed, 0))
    scene.contact("ball", "ground", radius=radius, stiffness=stiffness)
    duration = 0.8 / speed + np.pi * np.sqrt(mass / stiffness)  # down, half a cycle, up: deepest half-way
    with pytest.warns(fu.FunicularWarning, match="below its surface"):
        run = scene.run(duration, output_step=duration / 2, integrator=integrator, tol=1e-5, progress=False)
    (told,) = [message for message in run.report["messages"] if "below its surface" in message]
    deepest = speed * np.sqrt(mass / stiffness)
    assert run["contact_1.penetration"][1] == pytest.approx(deepest, rel=1e-4)
    assert float(re.search(r"up to ([0-9.]+) m below", told)[1]) == pytest.approx(deepest, rel=1e-2)
