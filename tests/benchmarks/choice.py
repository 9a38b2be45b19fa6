"""Whether integrator="auto" takes the cheaper one: every scene, tol and integrator, with error and CPU time.

    python tests/benchmarks/choice.py [--out FILE.csv] [--repetitions N]

``evaluations`` is what the choice reckons for each, in evaluations of eq 38 per second of motion: the explicit method
by stability, the implicit one by tol. Errors are of positions, over the largest motion, against the explicit method at
tol = 1e-9.
"""

from __future__ import annotations

import statistics
import time
import warnings

import funicular as fu
import numpy as np
from funicular.integrators import COST_OF_IMPLICIT, STABLE, fastest_rates, slowest_rate
from funicular.model import build
from pendulum import pendulum
from table import arguments, show

TOLS = (1e-3, 1e-4, 1e-5, 1e-6)
INTEGRATORS = ("explicit", "radau", "genalpha")


def rider() -> fu.Scene:
    """A body that turns and slides over nodes of a soft rope, damped."""
    scene = fu.Scene()
    scene.cable("rope", start=(0, 0, 0), end=(10, 0, 0), elements=6, element="cable12",
                section=fu.Rectangle(height=0.05, width=0.05),
                material=fu.Material(youngs_modulus=2e6, poisson_ratio=0.0, density=1000, damping_time=1e-3))
    scene.pin("rope", s=0.0)
    scene.pin("rope", s=10.0)
    scene.rigid_body("A", mass=5, inertia=(0.1, 0.2, 0.3), position=(2, -0.3, 0.1), velocity=(4, 0, 0),
                     angular_velocity=(1, 2, 3))
    scene.slide("A", along="rope", s=2.0, at=(0, 0.3, -0.1), name="trolley")
    return scene


SCENES = {
    "pendulum, 8, E 2e6": (lambda: pendulum(8, 2e6, 1000), 0.3),
    "pendulum, 32, E 2e6": (lambda: pendulum(32, 2e6, 1000), 0.3),
    "pendulum, 8, E 7e8": (lambda: pendulum(8, 7e8, 1000), 0.1),
    "pendulum, 8, steel": (lambda: pendulum(8, 2.1e11, 1000), 0.05),
    "rider on a soft rope": (rider, 1.0),
    "first scene": (lambda: fu.load_scene("paper51"), 0.3),
}


def positions(run: fu.Run) -> np.ndarray:
    """(time, all): of nodes and bodies."""
    return np.concatenate([run[k][:, :, 0].reshape(len(run.time), -1) if k.endswith("nodal_vectors") else run[k]
                           for k in run.keys() if k.endswith(("nodal_vectors", ".position"))], axis=1)


def main() -> None:
    """Measure and print."""
    options = arguments(__doc__, repetitions=(3, "runs of each, of which the median counts"))
    warnings.simplefilter("ignore", fu.FunicularWarning)
    rows = []
    for name, (scene, duration) in SCENES.items():
        settings = {"duration": duration, "output_step": duration / 5}
        reference = scene().run(integrator="explicit", tol=1e-9, **settings)
        truth, motion = positions(reference), reference.report["largest_motion_m"]
        model = build(scene())
        from funicular.engine import Engine

        by_stability = 12 * fastest_rates(model, Engine(model))[0] / STABLE
        for tol in TOLS:
            auto = scene().run(tol=tol, **settings).report["integrator"]
            seconds: dict[str, list[float]] = {i: [] for i in INTEGRATORS}
            errors = {}
            for _ in range(options.repetitions):
                for integrator in INTEGRATORS:
                    begin = time.process_time()
                    run = scene().run(integrator=integrator, tol=tol, **settings)
                    seconds[integrator].append(time.process_time() - begin)
                    errors[integrator] = float(np.abs(positions(run) - truth).max() / motion)
            by_tol = COST_OF_IMPLICIT * slowest_rate(scene(), model, duration) * (1e-4 / tol) ** (1 / 3)
            row: dict = {"scene": name, "tol": tol, "auto": auto, "evaluations": f"{by_stability:.2g} / {by_tol:.2g}"}
            for integrator in INTEGRATORS:
                row |= {f"{integrator} s": statistics.median(seconds[integrator]), f"{integrator} error":
                        errors[integrator]}
            rows.append(row)
    show(rows, options.out)


if __name__ == "__main__":
    main()
