"""Friction by springs: errors of runs in tol and in fixed steps, with their cost.

    python tests/benchmarks/friction_springs.py [--out FILE.csv] [--scenes 6]

A bar falls on two points on rough ground, and on smooth ground; a rope of one and of four elements is thrown on it; a
bar bounces, slides and sticks on a wire (test_friction_springs.py, test_friction_paths.py). References have explicit
steps at tol=1e-10; the column `references` has the distance of those of radau at 1e-8. Errors are the largest ones of
positions, over the largest motion. Steps and CPU time are those of the smallest tol. With fewer scenes there are no
fixed steps.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import sys
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from time import process_time

import numpy as np
from funicular import FunicularError, Run, Scene

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[1] / "contact"))

from table import arguments, show
from test_friction_paths import bounced
from test_friction_springs import bar, rope

TOLS = (1e-3, 1e-4, 1e-5, 1e-6)
STEPS = (4e-4, 2e-4, 1e-4, 5e-5, 2.5e-5)


def thrown(make: Callable[[], tuple[Scene, str]], **settings: object) -> tuple[np.ndarray, Run]:
    """Return the positions of a run, and the run."""
    scene, key = make()
    run = scene.run(0.6, output_step=0.012, progress=False, **settings)
    return (run[key] if run[key].ndim == 2 else run[key][:, :, 0]), run


def free() -> tuple[Scene, str]:
    """Return the bar without friction."""
    scene, key = bar()
    return scene.replace("contact_1", friction=None), key


def touched(**settings: object) -> tuple[np.ndarray, Run]:
    """Return the positions of the bar on a wire."""
    run = bounced.__wrapped__(**settings)
    return run["bar.position"], run


SCENES: dict[str, Callable[..., tuple[np.ndarray, Run]]] = {
    "bar on two points": partial(thrown, bar), "the same without friction": partial(thrown, free),
    "rope, 1 element": partial(thrown, rope), "rope, 4 elements": partial(thrown, partial(rope, 4)),
    "the same, less damping": partial(thrown, partial(rope, 4, damping=0.2)), "bar on a wire": touched}


def error(found: np.ndarray, reference: np.ndarray) -> float:
    """Return the error relative to the motion."""
    return float(np.abs(found - reference).max() / np.abs(reference - reference[0]).max())


def in_tol(name: str) -> list[dict[str, object]]:
    """Return a row per integrator: errors in tol, steps and CPU seconds at the smallest tol."""
    reference, _ = SCENES[name](integrator="explicit", tol=1e-10)
    other, _ = SCENES[name](integrator="radau", tol=1e-8)
    rows = []
    for integrator in ("auto", "radau", "explicit") if SCENES[name] is not touched else ("radau", "explicit"):
        row: dict[str, object] = {"scene": name, "integrator": integrator}
        row["references"] = f"{error(other, reference):.0e}"
        for tol in TOLS:
            begin = process_time()
            found, run = SCENES[name](integrator=integrator, tol=tol)
            row[f"tol {tol:.0e}"] = f"{error(found, reference) / tol:.1f}"
        rows.append(row | {"steps": run.report["steps"], "CPU, s": f"{process_time() - begin:.2f}"})
    return rows


def in_fixed_steps(integrator: str) -> dict[str, object]:
    """Return the errors of the rope of one element by the step."""
    reference, _ = thrown(rope, integrator="explicit", tol=1e-10)
    row: dict[str, object] = {"integrator": integrator}
    for step in STEPS:
        try:
            row[f"step {step:g} s"] = f"{error(thrown(rope, integrator=integrator, step=step)[0], reference):.1e}"
        except FunicularError:
            row[f"step {step:g} s"] = "fails"
    return row


def main() -> None:
    """Print the tables."""
    given = arguments(__doc__ or "", scenes=(len(SCENES), "the first of the scenes"))
    warnings.simplefilter("ignore")
    show([row for name in list(SCENES)[: given.scenes] for row in in_tol(name)], given.out,
         "tolerances")
    if given.scenes == len(SCENES):
        show([in_fixed_steps(integrator) for integrator in ("radau", "genalpha", "explicit", "energy")], table="steps")


if __name__ == "__main__":
    main()
