"""Sweeps: points per second by the length of batches, and the cost of a task and a point for scheduler and writer.

    python tests/benchmarks/sweep.py [--out FILE.csv] [--tasks 200] [--points 4000] [--workers 2]

Points without work, with the results of the first scene at 101 output times (position and force: 606 numbers), in
worker processes of one thread. Scheduler, writer and file are in this process, as in a sweep on one machine: its CPU
time, apart from start and end, is their cost. The fit a + b times the batch's length gives the cost of a task (a) and
of a point (b). Then the same with points of the first scene at tol 1e-3.

Last, by extrapolation from one machine, the number of cores that one scheduler can keep busy, by batch and cost of a
point, and the requirements of 10^6 points.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import tempfile
import time
from pathlib import Path

import funicular as fu
import numpy as np
from funicular.results.netcdf import File
from funicular.sweeps.workers import local_cluster
from table import parser, show

BATCHES = (1, 3, 10, 30, 100, 300)
MILLION = 1_000_000


def nothing(x: float) -> dict:
    """Return results of the size of a run's at once."""
    return {"position": np.full((101, 3), x), "force": np.full((101, 3), x)}


class Stopwatch:
    """A progress function that records the arrival of points: wall time, CPU time of this process, points done."""

    def __init__(self) -> None:
        self.seen: list[tuple[float, float, int]] = []

    def __call__(self, done: int, failed: int) -> None:
        """Record the points done."""
        self.seen.append((time.perf_counter(), time.process_time(), done))

    def between(self) -> tuple[float, float, int, int]:
        """Wall and CPU seconds, points and tasks from the first tenth of the tasks on."""
        first, last = self.seen[len(self.seen) // 10], self.seen[-1]
        return last[0] - first[0], last[1] - first[1], last[2] - first[2], len(self.seen) - 1 - len(self.seen) // 10


def measured(cluster: str, workers: int, batch: int, tasks: int, most: int, path: Path) -> dict:
    """Return one row: points without work, in batches of one length."""
    points = min(tasks * batch, max(most, 20 * batch))
    watch = Stopwatch()
    fu.sweep(nothing, {"x": fu.Uniform(0, 1)}, method="random", samples=points, cluster=cluster, batch=batch, save=path,
             progress=watch)
    wall, cpu, done, seen = watch.between()
    return {"batch": batch, "tasks": seen, "points a second": done / wall,
            "ms a task and worker": 1e3 * wall / seen * workers, "CPU ms a task, here": 1e3 * cpu / seen}


def of_scene(cluster: str, batch: int, points: int, path: Path) -> dict:
    """Return points per second of the first scene at tol 1e-3 on the cluster, and the share of runs in the workers'
    time.
    """
    watch = Stopwatch()
    found = fu.sweep(fu.load_scene("paper51"), {"A.mass": fu.Uniform(0.5, 1.5)}, method="random", samples=points,
                     keep=["A.position", "trolley.force"], cluster=cluster, batch=batch, save=path, progress=watch,
                     tol=1e-3, output_step=0.01)
    wall, cpu, done, seen = watch.between()
    return {"batch": batch, "points": done, "points a second": done / wall,
            "ms a point": 1e3 * float(found.seconds.mean()), "CPU ms a task, here": 1e3 * cpu / seen}


def main() -> None:
    """Measure, print and write."""
    reads = parser(__doc__.split("\n\n")[0], tasks=(200, "tasks of each length", 30),
                   points=(4000, "most points of a row", 4000), workers=(2, "worker processes"),
                   scenes=(120, "points of the first scene", 60))
    given = reads.parse_args()
    with tempfile.TemporaryDirectory() as folder, local_cluster(given.workers) as cluster:
        measured(cluster, given.workers, 10, 20, 200, Path(folder) / "warm.nc")
        rows = [measured(cluster, given.workers, batch, given.tasks, given.points, Path(folder) / f"{batch}.nc")
                for batch in BATCHES]
        row_bytes = File(Path(folder) / "1.nc").row_bytes
        begin = time.process_time()
        size = os.path.getsize(Path(folder) / "300.nc")
        fu.load_sweep(Path(folder) / "300.nc")
        opening = time.process_time() - begin
        scenes = [of_scene(cluster, batch, given.scenes, Path(folder) / f"scene{batch}.nc") for batch in (1, 5, 15)]
    print("\nPoints that take no time:")
    show(rows, given.out, "empty points")
    cpu = np.array([row["CPU ms a task, here"] for row in rows])
    a, b = np.polynomial.polynomial.polyfit([row["batch"] for row in rows], cpu, 1, w=1 / cpu)
    print(f"\nscheduler and writer: {a:.2f} ms a task and {1e3 * b:.0f} µs a point; {row_bytes} bytes a point; "
          f"opening with all checksums: {1e-9 * size / opening:.2g} GB a CPU second")
    print("\nFirst scene, tol 1e-3:")
    show(scenes, table="first scene")
    print(f"\n{MILLION:,} points, extrapolated: file {MILLION * row_bytes / 1e9:.2f} GB; cores that one scheduler and "
          "one writer keep busy:")
    show([{"batch": batch, "s of scheduler and writer": 1e-3 * MILLION * (a / batch + b),
           **{f"cores at {ms:g} ms a point": round(ms / (a / batch + b)) for ms in (5.0, 20.0, 200.0)}}
          for batch in (1, 10, 25, 100)], table="million points")


if __name__ == "__main__":
    main()
