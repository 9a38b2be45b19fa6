"""Errors of random scenes by "auto" over tol, and whether the run noted them.

    python tests/benchmarks/notes.py [--scenes 300] [--first 0] [--out FILE.csv]

The scenes are those of tests/random_motions.py. A reference is the explicit method at tol=1e-9, where radau at 1e-9
agrees with it to 0.1 of the tol that is measured; scenes without one (chaotic, or longer than 2 s) are counted apart.
Noted: a message of the run warns of errors, or of a state that makes them. Each run has 40 output times.
"""

from __future__ import annotations

import re
import sys
import time
import warnings
from itertools import pairwise
from pathlib import Path

import funicular as fu
import numpy as np
from hard_cases.case import positions
from table import parser, show

sys.path.insert(0, str(Path(__file__).parents[1]))

from random_motions import Motion, motion

TOLS = (1e-3, 1e-4)
TIMES = 40
MAX_CPU_TIME = 2.0
"""CPU seconds of a run: longer ones are given up."""
NOTE_LIMIT = 3.0
"""tol: an error above it must be noted."""
WARNS = re.compile(r"errors may|energy balance|perfectly straight|beyond the ends|"
                   r"past each other|folded|step is too long|are rounded|turns by|shock|estimated error")
"""What messages say that warn of errors."""


def run(made: Motion, tol: float, integrator: str) -> fu.Run | None:
    """Return a run of a scene; None if it does not end or takes too long."""
    begin = time.process_time()

    def give_up(reached: float) -> None:
        if time.process_time() - begin > MAX_CPU_TIME:
            raise KeyboardInterrupt

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = made.scene.run(made.duration, tol=tol, integrator=integrator, output_step=made.duration / TIMES,
                                   progress=give_up)
    except fu.FunicularError:
        return None
    return found if found.status == "completed" else None


def farthest(one: np.ndarray, other: np.ndarray) -> float:
    """Return the largest distance of two motions, m."""
    return float(np.linalg.norm(one - other, axis=-1).max())


def cells(seed: int) -> list[dict]:
    """Return the rows of a scene; one without an error if there is no reference."""
    made = motion(seed)
    explicit, radau = (run(made, 1e-9, integrator) for integrator in ("explicit", "radau"))
    if explicit is None or radau is None:
        return [{"seed": seed, "scene": made.kind, "tol": tol, "integrator": "", "error/tol": np.nan, "noted": "",
                 "converged/tol": np.nan} for tol in TOLS]
    exact = positions(explicit)
    moved = farthest(exact, exact[:1])
    apart = farthest(exact, positions(radau)) / moved
    found = []
    for tol in TOLS:
        tried = run(made, tol, "auto")
        error = farthest(positions(tried), exact) / moved / tol if tried and apart < 0.1 * tol else np.nan
        messages = tried.report["messages"] if tried else []
        found.append({"seed": seed, "scene": made.kind, "tol": tol,
                      "integrator": tried.report["integrator"] if tried else "failed", "error/tol": error,
                      "noted": next((note[:60] for note in messages if WARNS.search(note)), ""),
                      "converged/tol": apart / tol})
    return found


def summary(rows: list[dict]) -> list[dict]:
    """Counts of runs by error, noted or not; of those with a reference."""
    known = [row for row in rows if np.isfinite(row["error/tol"])]
    edges = [0.0, 1.0, NOTE_LIMIT, 10.0, np.inf]
    return [{"error": f"{low:g} to {high:g} tol", "runs": len(chosen),
             "noted": sum(bool(row["noted"]) for row in chosen),
             "silent": sum(not row["noted"] for row in chosen)}
            for low, high in pairwise(edges)
            for chosen in [[row for row in known if low <= row["error/tol"] < high]]]


def silent_part(rows: list[dict]) -> float:
    """Return the share of the runs with a reference whose error exceeds `NOTE_LIMIT` tol without a note."""
    known = [row for row in rows if np.isfinite(row["error/tol"])]
    return sum(row["error/tol"] > NOTE_LIMIT and not row["noted"] for row in known) / max(len(known), 1)


def main() -> None:
    """Measure and print."""
    options = parser(__doc__, scenes=(300, "number of scenes"), first=(0, "seed of the first one")).parse_args()
    rows = [row for seed in range(options.first, options.first + options.scenes) for row in cells(seed)]
    show([row for row in rows if not row["error/tol"] <= 1.0] or rows[:1], options.out, "beyond")
    show(summary(rows), table="counts")
    known = sum(np.isfinite(row["error/tol"]) for row in rows)
    print(f"{known} of {len(rows)} runs have a reference; {silent_part(rows):.2%} err by more than {NOTE_LIMIT:g} tol "
          "without a note")


if __name__ == "__main__":
    main()
