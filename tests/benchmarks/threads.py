"""Wall time of a step with one thread and with two, at the same bits.

    python tests/benchmarks/threads.py [--out FILE.csv] [--repetitions 20] [--elements 100 300 1000 2000]

Scenes of linear_cost.py, by generalised-alpha: with steps of 20 µs, which use one matrix, and with steps for tol =
1e-3, which use new matrices. Milliseconds are the minimum of alternating repetitions. Both runs must have the same
bits, or this fails: the error is that of one thread.

Two processors must be free: on a busy machine a second thread waits. On Linux, as root, `chrt -f 1 python ...` reserves
them.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time

import numpy as np
from funicular.engine import Engine
from funicular.integrators import GeneralisedAlpha
from funicular.model.build import build
from linear_cost import STEP, scene
from table import few, parser, show

NAMES = ("pendulum", "three riders", "three cables", "ladder")
STEPS, DURATION, TOL = 600, 2e-2, 1e-3
CASES = {"20 µs": {"duration": STEPS * STEP, "step": STEP}, "tol 1e-3": {"duration": DURATION, "step": 0.0}}


def measure(model: object, case: dict, threads: int) -> tuple[float, dict, np.ndarray]:
    """Return seconds of a run, its counts, and its last state."""
    engine = Engine(model)
    engine.use_threads(threads)
    engine.start(duration=case["duration"], output_step=case["duration"], tol=TOL, step=case["step"],
                 method=GeneralisedAlpha(0.8), first_step=STEP)
    begin = time.perf_counter()
    status = engine.advance(lambda _: None)
    taken = time.perf_counter() - begin
    if status != "completed":
        raise RuntimeError(status)
    return taken, engine.statistics, engine.rows()["q"]


def compare(name: str, elements: int, case: str, repetitions: int) -> dict:
    """A row of the table."""
    model = build(scene(name, elements))
    best, ends = {}, {}
    for _ in range(repetitions):
        for threads in (1, 2):
            taken, counts, ends[threads] = measure(model, CASES[case], threads)
            best[threads] = min(taken, best.get(threads, taken))
        assert ends[1].tobytes() == ends[2].tobytes(), "two threads have other results than one"
    steps = counts["steps"] + counts["rejected_steps"]
    return {"scene": name, "elements": elements, "steps": case, "matrices_per_step": counts["factorisations"] / steps,
            "ms_per_step": 1e3 * best[1] / steps, "ms_with_two": 1e3 * best[2] / steps, "ratio": best[1] / best[2]}


def main() -> None:
    """Measure and print."""
    made = parser(__doc__, repetitions=(20, "of every run"))
    made.add_argument("--elements", type=int, nargs="+", default=[100, 300, 1000, 2000])
    options = made.parse_args()
    show([compare(name, elements, case, options.repetitions)
          for case in few(CASES) for name in few(NAMES) for elements in few(options.elements)], options.out)


if __name__ == "__main__":
    main()
