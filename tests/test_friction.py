"""Friction of slides: a block on a straight inclined wire against closed forms, by every integrator.

Where nothing else is said a tolerance is what the wire's own motion leaves (see wires.py) or rounding.
"""

import numpy as np
import pytest
from funicular import Friction, SceneError, Table
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model import build
from scenery import add_cable, add_rider, largest
from funicular import Scene
from wires import LENGTH, MASS, G, block, told, unbalanced, wire

SLOPE = 0.5
DOWN, ACROSS = G * np.sin(SLOPE), G * np.cos(SLOPE)
INTEGRATORS = ("genalpha", "radau", "explicit")
every_integrator = pytest.mark.parametrize("integrator", INTEGRATORS)


@every_integrator
@pytest.mark.parametrize("dim", [2, 3])
def test_a_block_slides_down(integrator, dim):
    run = block(0.3, dim=dim, friction=Friction(coefficient=0.2, model="stick")).run(1.0, integrator=integrator)
    t = run.time
    np.testing.assert_allclose(run["trolley.s"], 0.3 + (DOWN - 0.2 * ACROSS) * t**2 / 2, atol=1e-10)
    np.testing.assert_allclose(run["trolley.force"], np.outer(np.ones_like(t), MASS * ACROSS * np.array([-0.2, 1, 0])),
                               atol=1e-5)  # measured 3e-6: with the 2 N m of ...
    np.testing.assert_allclose(run["trolley.traction"], -0.2 * MASS * ACROSS, atol=1e-5)
    np.testing.assert_allclose(run["energy.dissipated"], 0.2 * MASS * ACROSS * (run["trolley.s"] - 0.3), atol=1e-9)
    assert unbalanced(run) < 1e-12 and told(run) == []
