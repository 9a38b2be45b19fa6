"""Derivatives of the engine's residuals by central differences, the references of its matrices."""

from collections.abc import Callable

import numpy as np
from funicular import Scene
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build


def differenced(residual: Callable[[np.ndarray], np.ndarray], at: np.ndarray, step: float) -> np.ndarray:
    """Return the derivative of a residual, (residuals, unknowns), at given unknowns, by steps of a given size."""
    columns = [(residual(at + d) - residual(at - d)) / (2 * step) for d in step * np.eye(len(at))]
    return np.array(columns).T


def of_a_step(engine: Engine, h: float, at: np.ndarray, step: float) -> np.ndarray:
    """Return the derivative of the residual of a step of h seconds by its unknowns."""
    return differenced(lambda unknowns: engine.linearise(h, unknowns)[0], at, step)


def at_rest(engine: Engine, time: float, kept: dict, step: float) -> np.ndarray:
    """Return the derivative of the static residual at a time in s and a stored state, by displacements from it."""
    def residual(move: np.ndarray) -> np.ndarray:
        engine.set_state(time, **kept)
        engine.move(move)
        return engine.static_residual()

    return differenced(residual, np.zeros(engine.unknowns), step)


def error_by_drags(scene: Scene, h: float = 0.02) -> float:
    """Return the error of the drags' contribution to the matrix of a step, relative to its largest entry.

    The difference of two matrices, with and without drags, isolates the contribution.
    """
    found = []
    for each in (scene, scene.without(*scene.drags)):
        engine = Engine(build(each))
        engine.start(duration=1.0, output_step=1.0, tol=1e-6, step=h, first_step=h, method=GeneralisedAlpha(0.8))
        at = np.zeros(engine.unknowns)
        matrix = engine.linearise(h, at)[1]
        found.append((of_a_step(engine, h, at, 1e-6) - matrix, matrix))
    (with_drag, both), (without, other) = found
    return float(np.abs(with_drag - without).max() / np.abs(both - other).max())
