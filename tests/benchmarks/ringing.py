"""Cost of steps in scenes with free vibrations: error, steps and CPU time, beside the best fixed step.

    python tests/benchmarks/ringing.py [--only WORDS] [--out FILE.csv] [--repetitions N]

Errors are those of the nodes of a cable at 50 output times, of the relevant axes, over their largest motion; the
reference is the explicit method at a thousandth of the scene's smallest tolerance (1e-7 has an error of 5e-9 of the
motion). Beside each tolerance is the cheapest of the fixed steps of radau and genalpha with at most this error, or
"none" if the finest of them has a larger one. "limit" is tol plus the share of absolute_tol.
"""

from __future__ import annotations

import statistics
import warnings
from functools import cache

import funicular as fu
import numpy as np
from ringing_scenes import SCENES, Ringing
from table import few, parser, show

OUTPUTS = 50
FIXED = ("radau", "genalpha")


def run_of(subject: Ringing, **settings) -> fu.Run:
    """Return a run of a scene with free vibrations."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        return subject.make().run(subject.duration, output_step=subject.duration / OUTPUTS, progress=False, **settings)


def path_of(subject: Ringing, run: fu.Run) -> np.ndarray:
    """Return relevant positions (time, node, axis), m."""
    return run[f"{subject.cable}.position"][..., list(subject.axes)]


@cache
def reference(name: str) -> np.ndarray:
    """Return the converged relevant motion (time, node, axis), m."""
    return path_of(SCENES[name], run_of(SCENES[name], integrator="explicit", tol=1e-3 * min(SCENES[name].tols)))


def error_of(name: str, run: fu.Run) -> float:
    """Return the largest error of the relevant positions, over their largest motion."""
    exact = reference(name)
    motion = np.linalg.norm(exact - exact[:1], axis=-1).max()
    return float(np.linalg.norm(path_of(SCENES[name], run) - exact, axis=-1).max() / motion)


def limit_of(name: str, tol: float) -> float:
    """Return the permitted error of a scene's settings at a tolerance, over the largest relevant motion."""
    exact = reference(name)
    motion = np.linalg.norm(exact - exact[:1], axis=-1).max()
    return float(tol + SCENES[name].settings.get("absolute_tol", 0.0) / motion)


def cells(name: str, repetitions: int) -> list[dict]:
    """Return the rows of a scene."""
    subject = SCENES[name]
    fixed = [timed(name, repetitions, step=step, integrator=method) for method in FIXED for step in subject.steps]
    rows = []
    for tol in subject.tols:
        error, run, seconds = timed(name, repetitions, tol=tol, **subject.settings)
        enough = [one for one in fixed if one[0] <= max(error, 0.0)]
        best = min(enough, key=lambda one: one[2]) if enough else None
        rows.append({"scene": name, "tol": tol, "limit": limit_of(name, tol), "error": error,
                     "integrator": run.report["integrator"], "steps": run.report["steps"],
                     "rejected": run.report["rejected_steps"], "CPU s": seconds,
                     "best fixed": f"{best[1].report['integrator']} {best[1].report['step']:g}" if best else "none",
                     "its error": best[0] if best else np.nan, "its CPU s": best[2] if best else np.nan,
                     "ratio": seconds / best[2] if best else np.nan})
    return rows


def timed(name: str, repetitions: int, **settings) -> tuple[float, fu.Run, float]:
    """Return error, run, and the median of its CPU seconds."""
    runs = [run_of(SCENES[name], **settings) for _ in range(repetitions)]
    return (error_of(name, runs[0]), runs[0],
            statistics.median(run.report["time_s"]["solve_cpu"] for run in runs))


def main() -> None:
    """Measure and print."""
    options = parser(__doc__, repetitions=(1, "runs of each, of which the median of the CPU time counts"))
    options.add_argument("--only", default="", help="scenes whose name holds this")
    options = options.parse_args()
    show([row for name in few(name for name in SCENES if options.only in name)
          for row in cells(name, options.repetitions)], options.out)


if __name__ == "__main__":
    main()
