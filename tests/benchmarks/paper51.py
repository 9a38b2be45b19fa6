"""The first scene against its reference: figures of the benchmarks and of tests/parts/test_first_scene.py."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
from funicular import Run, load_scene

REFERENCE = np.genfromtxt(Path(__file__).parents[1] / "reference" / "paper51.csv", delimiter=",", names=True)

COLUMNS = {
    "x": ("A.position", 0, "x_m"),
    "y": ("A.position", 1, "y_m"),
    "s": ("trolley.s", None, "s_m"),
    "x_acceleration": ("A.acceleration", 0, "ax_m_s2"),
    "y_acceleration": ("A.acceleration", 1, "ay_m_s2"),
    "x_force": ("trolley.force", 0, "force_x_N"),
    "y_force": ("trolley.force", 1, "force_y_N"),
}
"""Result and component, and the reference's column, of what is compared."""


def simulate(**settings) -> Run:
    """Return the scene at the reference's times, with settings of `Scene.run`."""
    return load_scene("paper51").run(1.0, output_step=0.01, **settings)


def deviation(run: Run, quantity: str) -> np.ndarray:
    """Return (time,) a quantity of COLUMNS minus the reference, in its unit."""
    name, component, column = COLUMNS[quantity]
    values = run[name] if component is None else run[name][:, component]
    return values - REFERENCE[column]


def error(run: Run, quantity: str) -> float:
    """Return the largest deviation from the reference over its range."""
    return float(np.abs(deviation(run, quantity)).max() / np.ptp(REFERENCE[COLUMNS[quantity][2]]))


def points(run: Run) -> np.ndarray:
    """Return (time, points, 3) of the rider and the cable's nodes, m."""
    return np.concatenate([run["A.position"][:, None], run["wire.nodal_vectors"][:, :, 0]], axis=1)


def motion_error(run: Run, precise: Run) -> float:
    """Return the error of tol: the largest distance of rider and nodes from a precise run, over the largest motion."""
    exact = points(precise)
    largest = np.linalg.norm(exact - exact[0], axis=-1).max()
    return float(np.linalg.norm(points(run) - exact, axis=-1).max() / largest)


def integrate(*, step=0.0, tol=1e-4, from_rest=False):
    """Return the engine after the integration without set-up and labels, and its CPU seconds.

    from_rest: start the scheme from zero accelerations, which users cannot request.
    """
    from funicular.engine import Engine
    from funicular.integrators import GeneralisedAlpha
    from funicular.model.build import build

    engine = Engine(build(load_scene("paper51")))
    begin = time.process_time()
    engine.start(
        duration=1.0,
        output_step=0.01,
        tol=tol,
        step=step,
        method=GeneralisedAlpha(0.9),
        first_step=1e-3,
        rest_start=from_rest,
    )
    engine.advance(lambda time: None)
    return engine, time.process_time() - begin
