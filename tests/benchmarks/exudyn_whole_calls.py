"""Whole calls of funicular and Exudyn beside their solvers, at equal errors, interleaved in one run, one thread each.

    pip install '.[bench]' && python tests/benchmarks/exudyn_whole_calls.py [--out FILE.csv] [--repetitions 30]
        [--limit 1]

The scenes, errors and converged paths of exudyn_side_by_side.py, with few elements and at loose errors, where set-up
counts. Of the settings of a code that reach an error the fastest one counts, without interpolation; `integrator="auto"`
is among those of funicular. A whole call is the description of the scene, its set-up, the run, and in funicular the
labelled results at 51 times with the notes on them; in Exudyn the description, the assembly and the run, without
outputs. Times: CPU ms, the least of alternating repetitions, after the imports and a first call.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
import warnings
from collections.abc import Callable
from functools import partial

import exudyn_models as peer
from exudyn_side_by_side import DURATION, OUTPUTS, Case, Point, cases, compare
from funicular import FunicularWarning
from table import few, parser, show

SCENES = ("pendulum, E 2e+06", 8), ("pendulum, E 2e+06", 32), ("sliding mass", 3), ("sliding mass, flexible", 3)
TARGETS = (1e-2, 1e-3)
Times = Callable[[], tuple[float, float]]
"""Returns CPU seconds of the solver and of the whole call."""


def settings_of(point: Point) -> dict:
    """Return the settings of a run of funicular."""
    integrator, kind = point.method.split()
    return {"integrator": integrator, kind: point.setting}


def ours(case: Case, point: Point) -> tuple[float, float]:
    """Return the times of a call of funicular."""
    begin = time.process_time()
    run = case.ours().run(DURATION, output_step=DURATION / OUTPUTS, progress=False, **settings_of(point))
    assert len(case.path(run)) == OUTPUTS + 1
    return run.report["time_s"]["solve_cpu"], time.process_time() - begin


def theirs(case: Case, point: Point) -> tuple[float, float]:
    """Return the times of a call of Exudyn."""
    begin = time.process_time()
    made = case.theirs()
    described = time.process_time()
    peer.last_position(made, DURATION, round(DURATION / point.setting))
    end = time.process_time()
    return end - described, end - begin


def fastest(points: list[Point], target: float) -> Point:
    """Return the fastest point with at most this error."""
    return min((point for point in points if point.error <= target), key=lambda point: point.seconds)


def measured(case: Case, limit: float) -> list[tuple[dict, Times, Times]]:
    """Return the settings and errors of both codes for each target, with the functions that measure them."""
    _, _, curves = compare(case, 5, limit)
    found = []
    for target in TARGETS:
        own = fastest([point for name, points in curves.items() if name != "exudyn" for point in points], target)
        other = fastest(curves["exudyn"], target)
        kind, value = list(settings_of(own).items())[1]
        row = {"case": case.name, "elements": case.elements, "error": target,
               "setting": f"{settings_of(own)['integrator']}, {kind} {value:.3g}", "our error": own.error,
               "their steps": round(DURATION / other.setting), "their error": other.error}
        found.append((row, partial(ours, case, own), partial(theirs, case, other)))
    return found


def main() -> None:
    """Measure and print."""
    options = parser(__doc__, repetitions=(30, "of each call"), limit=(1, "CPU seconds that a run may take"))
    options = options.parse_args()
    warnings.simplefilter("ignore", FunicularWarning)  # coarse steps are meant
    wanted = [case for case in cases() if (case.name, case.elements) in SCENES]
    rows = []
    for row, own, other in (call for case in few(wanted) for call in measured(case, options.limit)):
        pairs = [(own(), other()) for _ in range(options.repetitions + 1)][1:]
        (solver, whole), (their_solver, their_whole) = (
            (1e3 * min(part) for part in zip(*times, strict=True)) for times in zip(*pairs, strict=True))
        rows.append(row | {"our solver / ms": solver, "our call / ms": whole, "their solver / ms": their_solver,
                           "their call / ms": their_whole, "times faster, solver": their_solver / solver,
                           "times faster, call": their_whole / whole})
    show(rows, options.out)


if __name__ == "__main__":
    main()
