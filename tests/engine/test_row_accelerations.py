"""Accelerations and forces of supports in rows: eq 38, by refinement where a Newton method ends at the row."""

import funicular as fu
import numpy as np
import pytest
from shared_scenes import cable_scene

pytestmark = pytest.mark.filterwarnings("ignore::funicular.FunicularWarning")


def falling(**settings) -> fu.Scene:
    """Return a cable pinned at one end, released from the horizontal."""
    return cable_scene("one", pins=(0.0,), elements=4, element="cable12", section=fu.Rectangle(height=0.02, width=0.02),
                       material=fu.Material(youngs_modulus=2e6, poisson_ratio=0.0, density=1500), **settings)


def in_water() -> fu.Scene:
    """Return the same with added mass, which changes as it turns."""
    scene = falling()
    scene.fluid("sea", density=1025)
    scene.drag("one", normal=1.2, tangential=0.1, diameter=0.02, added_mass=1.0)
    return scene


def tied() -> fu.Scene:
    """Return two cables, tied to each other, and a body on a spring."""
    scene = falling()
    first = scene.cables["one"]
    scene.cable("two", start=(1, 0, 0), end=(1.6, 0, 0), elements=3, element=first.element, section=first.section,
                material=first.material)
    scene.tie("one", s=1.0, to="two", at=0.0, rotation="free")
    scene.rigid_body("A", mass=0.3, inertia=(1e-4, 2e-4, 3e-4), position=(1.7, 0, 0), angular_velocity=(3, 2, 1))
    scene.spring(("A", (0.05, 0, 0)), ("two", 0.6), stiffness=500, length=0.05)
    return scene


@pytest.mark.parametrize("tol", [1e-2, 1e-4])
@pytest.mark.parametrize("make", [falling, in_water, tied])
def test_rows_satisfy_the_equations_of_motion(make, tol):
    """The first row of a run is by eq 38 with all forces and a matrix of its own."""
    scene = make()
    run = scene.run(0.4, output_step=0.01, tol=tol, integrator="genalpha", progress=False)
    for k in (1, 17, 40):
        anew = scene.run(1e-4, initial=run.at(run.time[k]), integrator="genalpha", progress=False)
        for key in run.keys():
            if key.endswith(("force", ".moment", "acceleration")):
                size = np.abs(run[key]).max()
                assert np.abs(run[key][k] - anew[key][0]).max() <= 1e-8 * max(size, 1.0), key
