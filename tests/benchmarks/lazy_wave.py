"""Error against time of a lazy-wave cable in water whose hang-off heaves: its tension over 36 s from rest.

The cable in 80 m of water of slack_lines.py (bare, buoyant, bare, on a bed; 150 elements), with drag, without and with
added mass. Its hang-off heaves by 3 m in 12 s, after a quintic ramp of 12 s. Compared is the tension at the hang-off in
the last period, every 0.1 s: its error is the largest one over its range, that of its mean, minimum and maximum beside
it, each from a converged run. Two programs that agree have 9322.09, 5677.7 and 13032.3 N without added mass; one
program has 9336.88, 5655.2 and 13084.4 N with it, as a force on accelerations (Morison), and here it is the kinetic
energy of the water.

CPU seconds are the least of alternating repetitions: of the run from a state of rest on, and with the scene and its
state of rest.

    python tests/benchmarks/lazy_wave.py [--out FILE.csv] [--repetitions 3]
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
import warnings
from functools import cache

import funicular as fu
import numpy as np
from slack_lines import LAZY_WAVES, lazy_wave
from table import few, parser, show

AMPLITUDE, PERIOD, RAMP, DURATION, OUTPUT = 3.0, 12.0, 12.0, 36.0, 0.1
MESH = (60, 44, 46)
"""Elements of the three parts."""
PUBLISHED = {"none": (9322.09, 5677.7, 13032.3), "1.0": (9336.88, 5655.2, 13084.4)}
"""By the coefficient of added mass: mean, minimum and maximum of the tension in the last period by others, N."""
SETTINGS: list[dict] = [*({"integrator": one, "tol": tol} for tol in (1e-2, 1e-3) for one in ("genalpha", "auto")),
                        *({"integrator": "genalpha", "step": h} for h in (0.05, 0.03, 0.01))]
Found = tuple[np.ndarray, float, float, dict]
"""Tension (times,) of the last period in N; CPU seconds of the run, and of all; the report."""


def heave() -> fu.TableSignal:
    """Return the motion of the hang-off, a spline whose error is below 3e-6 m."""
    t = np.arange(0.0, DURATION + 0.26, 0.25)
    x = np.clip(t / RAMP, 0.0, 1.0)
    ramp = x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
    return fu.TableSignal(time=t, value=AMPLITUDE * ramp * np.sin(2 * np.pi * t / PERIOD))


def found(added: str, mesh: tuple[int, ...], **settings) -> Found:
    """Run the scene from its state of rest."""
    begin = time.process_time()
    scene = lazy_wave(LAZY_WAVES["80 m"], mesh, added_mass=None if added == "none" else float(added), heave=heave())
    rest = scene.equilibrium()
    ready = time.process_time()
    run = scene.run(duration=DURATION, output_step=OUTPUT, initial=rest, progress=False, **settings)
    tension = np.linalg.norm(run["upper@0.force"], axis=1)[round((DURATION - PERIOD) / OUTPUT):]
    end = time.process_time()
    return tension, end - ready, end - begin, run.report


@cache
def converged(added: str, elements: int) -> np.ndarray:
    """Return the tension of the last period with this number of elements and a small tolerance, N."""
    mesh = tuple(max(2, round(n * elements / sum(MESH))) for n in MESH)
    return found(added, mesh, integrator="radau", tol=1e-4)[0]


def period(tension: np.ndarray) -> np.ndarray:
    """Return mean, minimum and maximum of the samples of a period, whose first one is that of the period before."""
    return np.array([tension[1:].mean(), tension.min(), tension.max()])


def row(added: str, settings: dict, taken: list[Found], reference: np.ndarray) -> dict:
    """Return a line of the table of errors and times."""
    tension, _, _, report = taken[0]
    size = np.ptp(reference)
    off = (period(tension) - period(reference)) / size
    said = ", ".join(f"{key} {value}" if key != "integrator" else value for key, value in settings.items())
    return {"added mass": added, "setting": said, "integrator": report["integrator"], "steps": report["steps"],
            "error": float(np.abs(tension - reference).max() / size),
            **{f"error of {of}": float(abs(one)) for of, one in zip(("mean", "min", "max"), off, strict=True)},
            "run, CPU s": min(each[1] for each in taken), "whole call, CPU s": min(each[2] for each in taken)}


def main() -> None:
    """Measure and print."""
    options = parser(__doc__, repetitions=(3, "runs of each setting, the least time of which counts"),
                     elements=(300, "of the converged mesh", 6)).parse_args()
    warnings.simplefilter("ignore")
    cases = [(added, settings) for added in few(PUBLISHED) for settings in few(SETTINGS)]
    mesh = MESH if options.elements > sum(MESH) else (2, 2, 2)
    taken: list[list[Found]] = [[] for _ in cases]
    for _ in range(options.repetitions):
        for each, (added, settings) in zip(taken, cases, strict=True):
            each.append(found(added, mesh, **settings))
    show([row(added, settings, each, converged(added, options.elements))
          for each, (added, settings) in zip(taken, cases, strict=True)], options.out)
    print()
    rows = []
    for added in few(PUBLISHED):
        ours = period(converged(added, options.elements))
        rows.append({"added mass": added} | {
            key: f"{x:.1f}" for name, one in zip(("mean", "min", "max"), zip(ours, PUBLISHED[added], strict=True),
                                               strict=True)
            for key, x in zip((f"{name}, N", f"others' {name}, N"), one, strict=True)})
    show(rows, table="converged")


if __name__ == "__main__":
    main()
