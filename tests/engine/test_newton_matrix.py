"""The engine's Newton matrix is the derivative of its residual; its condition does not depend on the step."""

import numpy as np
import pytest
from derivatives import at_rest, of_a_step
from difficult_scenes import SCENES
from funicular import Material, Rectangle, Scene
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build


@pytest.fixture(params=list(SCENES))
def engine(request) -> Engine:
    engine = Engine(build(SCENES[request.param]()))
    status, _ = engine.start(duration=1.0, output_step=0.1, tol=1e-4, step=0.0, method=GeneralisedAlpha(0.8),
                             first_step=1e-3)
    assert status is None
    return engine


@pytest.mark.parametrize("h", [1e-2, 1e-3, 1e-4])
@pytest.mark.slow_cases("tied-0.0001", "tied-0.001", "modal_in_joints-0.0001", "modal_in_joints-0.001", "resisted-0.01",
                        "jointed-0.001", "star-0.001", "jointed-0.0001", "resisted-0.001")
def test_matrix_is_the_derivative_of_the_residual(engine, h):
    n = engine.unknowns
    rng = np.random.default_rng(1)
    at = 1e-3 * rng.standard_normal(n)
    residual, matrix = engine.linearise(h, at)
    assert np.isfinite(residual).all()
    worst = []
    for step in (1e-5, 1e-6, 1e-7):
        worst.append(np.abs(of_a_step(engine, h, at, step) - matrix).max() / np.abs(matrix).max())
    assert min(worst) < 1e-9  # measured: 6e-12 to 7e-11


def test_conditioning_does_not_depend_on_the_step(engine):
    """At small steps the condition is that of the mass matrix with joints; unscaled rows would add (1/h)^2."""
    n = engine.unknowns
    numbers = [np.linalg.cond(engine.linearise(h, np.zeros(n))[1]) for h in (3e-3, 1e-5, 1e-6, 1e-7)]
    assert max(numbers[1:]) < 1.5 * min(numbers[1:])  # measured: 1.1 at most
    assert numbers[0] < 4 * numbers[-1]  # measured: 2.6; beyond that step stiffness outweighs the mass, scene by scene


def welded() -> Scene:
    """Return cables welded to one another, and tied to the section on which one rides."""
    scene = Scene()
    made = {"section": Rectangle(height=0.05, width=0.05), "elements": 2,
            "material": Material(youngs_modulus=0.4e9, poisson_ratio=0.3, density=4200)}
    scene.cable("beam", start=(0, 0, 0), end=(1.5, 0, 0), **made)
    scene.pin("beam", s=0.0)
    scene.cable("cross", start=(0.5, 0, -0.5), end=(0.5, 0, 0.5), element="cable12", **made)
    scene.joint("weld", ("beam", 0.5), ("cross", 0.5), up=(1, 0, 0))
    scene.cable("link", start=(1, 0, 0), end=(1, -1, 0), up=(1, 0, 0), **made)
    scene.slide(("link", 0.0), along="beam", s=1.0, frame="section")
    return scene


def moved(engine, forces: float) -> dict:
    """Return a static state away from the drawn one, with multipliers and forces of the given size."""
    rng = np.random.default_rng(2)
    engine.set_state(0.3)
    engine.move(1e-3 * rng.standard_normal(engine.unknowns))
    kept = engine.state()
    for name in [key for key in kept if key not in ("q", "s")]:
        kept[name] = forces * rng.standard_normal(kept[name].shape)
    return kept


@pytest.mark.parametrize("scene", [*SCENES.values(), welded])
def test_static_matrix_is_the_derivative_of_the_static_residual(scene):
    engine = Engine(build(scene()))
    kept = moved(engine, 1e3)
    engine.set_state(0.3, **kept)
    matrix = engine.matrix(0.0, 0.0, 1.0).toarray()
    # unit changes of the unknowns change the residuals by very different amounts
    worst = []
    for step in (1e-5, 1e-6, 1e-7):
        error = np.abs(at_rest(engine, 0.3, kept, step) - matrix)
        worst.append((error / np.abs(matrix).max(axis=0).clip(1.0)).max())
    assert min(worst) < 1e-7  # measured: 4e-8, of 1e-3 N/m in rows of 1e4; without what is between two cables 3e-3
