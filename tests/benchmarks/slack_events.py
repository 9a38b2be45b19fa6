"""Steps, events and errors of a wire under nine droppers that become slack and taut, by integrator and tolerance.

The bundled scene overhead_span from its rest; errors against radau with a tolerance of 1e-8. Passed: events that steps
went over, and did not end on.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
import warnings

import funicular as fu
import numpy as np
from table import parser, show

WIRES = ("contact", "messenger")


def row(scene: fu.Scene, rest: fu.Equilibrium, reference: fu.Run, settings: dict) -> dict:
    """Return what is measured of a run with these settings."""
    begin = time.process_time()
    run = scene.run(initial=rest, progress=False, **settings)
    taken = time.process_time() - begin
    positions = [f"{wire}.position" for wire in WIRES]
    motion = max(np.linalg.norm(reference[key] - reference[key][0], axis=-1).max() for key in positions)
    off = max(np.linalg.norm(run[key] - reference[key], axis=-1).max() for key in positions)
    size = settings.get("tol", settings.get("step"))
    balance = run.energy_balance()
    return {"integrator": settings["integrator"], "tol" if "tol" in settings else "step_s": size,
            "steps": run.report["steps"], "iterations": run.report["newton_iterations"],
            "factorisations": run.report["factorisations"], "events": len(run.events),
            "passed": sum(event.get("passed", False) for event in run.events), "seconds": taken, "error": off / motion,
            "balance": float(np.abs(balance.residual).max() / balance.exchanged)}


def main() -> None:
    """Measure and print."""
    options = parser(__doc__)
    options.add_argument("--tol", type=float, nargs="+", default=[1e-2, 1e-3, 1e-4, 1e-5])
    options = options.parse_args()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        rest = fu.load_scene("overhead_span").equilibrium()
        scene = rest.scene
        reference = scene.run(initial=rest, progress=False, integrator="radau", tol=1e-8)
        show([row(scene, rest, reference, {"integrator": integrator, "tol": tol})
              for integrator in ("genalpha", "radau", "explicit") for tol in options.tol], options.out)
        show([row(scene, rest, reference, {"integrator": integrator, "step": step})
              for integrator in ("genalpha", "energy") for step in (1e-3, 5e-4)])


if __name__ == "__main__":
    main()
