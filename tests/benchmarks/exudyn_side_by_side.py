"""Error against time of funicular and Exudyn, interleaved in one run, one thread each.

    pip install '.[bench]' && python tests/benchmarks/exudyn_side_by_side.py [--out FILE.csv] [--plot FILE.png]
        [--cases pendulum] [--elements 8] [--repetitions 3] [--limit 20] [--resume]

Scenes: the flexible pendulum (case D0) and the sliding mass (case S1), with Exudyn's cable, which is cable12 with
strain="engineering", except that it integrates bending by three Gauss points instead of five. The compared path is that
of the tip or the mass; its error is the largest distance from the converged path of the same mesh at 50 times, over the
largest motion. Each code has its own converged path: for funicular the explicit integration (radau for the stiffest
scene) with a small tolerance, for Exudyn the limit of its steps. The second table gives the distance of the two paths,
and the convergence of each: by another tolerance, and by the limit without the finest step.

Exudyn has fixed steps, funicular tolerances and fixed steps. Times are CPU seconds of the solver without set-up,
medians of alternating repetitions. Those of funicular include the 50 outputs, those of Exudyn none. The time to reach
an error is interpolated on the curve; a value in brackets was not reached and is extrapolated from the two finest
points. "setting" and "their steps" are those of the first point that reaches the error. "auto/best" compares
integrator="auto", with the tolerance that reaches the error, to the best of the others, without interpolation between
different integrators.

Each case is printed, and added to FILE.csv and FILE.points.csv (all settings, errors and times), when it is finished.
--resume leaves out the cases in FILE.csv.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import csv
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from statistics import median

import exudyn_models as peer
import numpy as np
from funicular import FunicularError, FunicularWarning, Scene
from funicular.integrators import AUTO, OF_EQUATIONS
from funicular.results.trajectories import distance, largest_change
from pendulum import pendulum
from sliding import sliding_mass
from table import few, parser, show

DURATION, OUTPUTS = 1.0, 50
TARGETS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
TOLS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
AUTO_TOLS = (1e-1, 3e-2, 1e-2, 4e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6)
STEPS = (50, 100, 200, 500, 1000, 2000, 4000, 8000, 16000, 32000, 64000)
REFERENCE_TOLS = (1e-6, 1e-8)


@dataclass
class Case:
    """A scene in both codes; order: of Exudyn's error in the step; reference: integrator of the converged path,
    implicit where an explicit one would take an hour.
    """

    name: str
    elements: int
    ours: Callable[[], Scene]
    theirs: Callable[[], peer.System]
    order: int
    reference: str = "explicit"

    def path(self, run) -> np.ndarray:
        """Return the compared path (time, 3)."""
        return run["A.position"] if "A.position" in run else run["wire.nodal_vectors"][:, -1, 0]


def cases() -> list[Case]:
    """Return all cases."""
    made = [Case(f"pendulum, E {modulus:.0e}", n, partial(pendulum, n, modulus, 7200),
                 partial(peer.pendulum, n, modulus), 2, "radau" if (modulus, n) == (7e8, 128) else "explicit")
            for modulus in (2e6, 7e8) for n in (8, 32, 128)]
    for name, modulus, mass in (("sliding mass", 0.4e9, 1.0), ("sliding mass, flexible", 2e6, 5.0)):
        made += [Case(name, n, partial(sliding_mass, n, strain="engineering", youngs_modulus=modulus, mass=mass),
                      partial(peer.sliding_mass, n, modulus, mass), 1) for n in (3, 12, 48)]
    return made


class TooLongError(Exception):
    """A run took longer than the limit."""


@dataclass
class Point:
    """One setting of one code: its function, times, error and integrator."""

    method: str
    setting: float
    run: Callable[[], tuple[np.ndarray | None, float, str]]
    path: np.ndarray | None = None
    times: list[float] = field(default_factory=list)
    error: float = np.nan
    taken: str = ""

    @property
    def seconds(self) -> float:
        """Return the median of CPU seconds."""
        return median(self.times)


def integrate(case: Case, limit: float, **settings) -> tuple[np.ndarray, float, str]:
    """Return path, CPU seconds and integrator of funicular. Raises TooLongError, FunicularError."""
    begin = time.process_time()

    def watch(reached: float) -> None:
        if time.process_time() - begin > limit:
            raise TooLongError

    run = case.ours().run(DURATION, output_step=DURATION / OUTPUTS, progress=watch, **settings)
    return case.path(run), run.report["time_s"]["solve_cpu"], run.report["integrator"]


def their_turn(case: Case, steps: int) -> tuple[None, float, str]:
    """Return CPU seconds of Exudyn; a separate run records the path, since sensors take time."""
    return None, peer.cpu_seconds(case.theirs, DURATION, steps), "exudyn"


def curve(settings, make: Callable[[float], Point], limit: float) -> list[Point]:
    """Return points of a method from the coarsest setting on, until one exceeds the limit or fails."""
    points = []
    for setting in settings:
        point = make(setting)
        try:
            path, seconds, point.taken = point.run()
        except TooLongError:
            print(f"  {point.method} {setting:g}: over the limit", flush=True)
            break
        except (FunicularError, peer.StoppedError) as stop:
            print(f"  {point.method} {setting:g}: {stop}", flush=True)
            continue
        point.path, point.times = path if path is not None else point.path, [seconds]
        points.append(point)
        if seconds > limit / 2:
            break
    return points


def our_curves(case: Case, limit: float) -> dict[str, list[Point]]:
    """Return work and precision of funicular: each integrator and "auto" by tolerance, generalised-alpha by step as
    well.
    """
    curves = {}
    for integrator in (*OF_EQUATIONS, AUTO):
        curves[integrator] = curve(AUTO_TOLS if integrator == AUTO else TOLS, lambda tol, name=integrator: Point(
            f"{name} tol", tol, partial(integrate, case, limit, integrator=name, tol=tol)), limit)
    curves["genalpha step"] = curve((DURATION / n for n in STEPS), lambda step: Point(
        "genalpha step", step, partial(integrate, case, limit, integrator="genalpha", step=step)), limit)
    return curves


def their_curve(case: Case, limit: float) -> list[Point]:
    """Return work and precision of Exudyn."""
    points = curve(STEPS, lambda n: Point("exudyn", DURATION / n, partial(their_turn, case, n)), limit)
    kept = []
    for point in points:
        try:
            point.path = peer.trajectory(case.theirs, DURATION, round(DURATION / point.setting), OUTPUTS)
        except peer.StoppedError as stop:
            print(f"  exudyn step {point.setting:g}: {stop}", flush=True)
            continue
        kept.append(point)
    return kept


def limit_of(points: list[Point], order: int) -> tuple[np.ndarray, float]:
    """Return the limit of the path for halved steps, and its change without the finest step.

    Raises TooLongError for fewer than three steps within the limit.
    """
    if len(points) < 3:
        raise TooLongError(f"{len(points)} runs there within the limit show no limit of their path")

    def extrapolated(coarse: Point, fine: Point) -> np.ndarray:
        return fine.path + (fine.path - coarse.path) / (2**order - 1)

    last, before = extrapolated(*points[-2:]), extrapolated(*points[-3:-1])
    return last, distance(last, before)


def converged(case: Case) -> tuple[np.ndarray, float]:
    """Return funicular's path, and the agreement of two tolerances."""
    loose, tight = (integrate(case, np.inf, integrator=case.reference, tol=tol)[0] for tol in REFERENCE_TOLS)
    return tight, distance(loose, tight)


def envelope(points: list[Point]) -> list[Point]:
    """Return the points that no other one beats in time and error, from the fastest on."""
    best: list[Point] = []
    for point in sorted(points, key=lambda p: p.seconds):
        if not best or point.error < best[-1].error:
            best.append(point)
    return best


def time_to(points: list[Point], target: float) -> tuple[float, bool]:
    """Return CPU seconds to reach an error, on the lower envelope of points, and whether it was reached."""
    best = envelope(points)
    there = next((k for k, point in enumerate(best) if point.error <= target), None)
    if there == 0 or (there is not None and best[there].taken != best[there - 1].taken):
        return best[there].seconds, True
    if len(best) < 2:
        return np.nan, False
    before, after = best[-2:] if there is None else best[there - 1 : there + 1]
    part = np.log(before.error / target) / np.log(before.error / after.error)
    return float(before.seconds * (after.seconds / before.seconds) ** part), there is not None


def setting_to(points: list[Point], target: float) -> float:
    """Return the setting of the fastest point with at most this error, NaN if there is none."""
    return next((point.setting for point in envelope(points) if point.error <= target), np.nan)


def row_of(case: Case, target: float, ours: dict[str, list[Point]], theirs: list[Point]) -> dict:
    """Return times to reach an error, of all curves."""
    found = {name: time_to(points, target) for name, points in ours.items()}
    reached = {name: seconds for name, (seconds, there) in found.items() if there and name != AUTO}
    peer_seconds, there = time_to(theirs, target)
    best = min(reached, key=lambda name: reached[name], default="")
    seconds = reached.get(best, np.nan)
    own, own_there = found[AUTO]
    return {"case": case.name, "elements": case.elements, "error": target,
            **{f"{name} / s": _bracketed(*found[name]) for name in found},
            "exudyn / s": _bracketed(peer_seconds, there), "best": best, "best / s": seconds,
            "setting": setting_to(ours[best], target) if best else np.nan,
            "their steps": DURATION / setting_to(theirs, target),
            "times faster": peer_seconds / seconds, "auto/best": own / seconds if own_there else np.nan}


def compare(case: Case, repetitions: int, limit: float) -> tuple[list[dict], dict, dict[str, list[Point]]]:
    """Return rows of times to reach errors, the convergence, and all curves."""
    ours, theirs = our_curves(case, limit), their_curve(case, limit)
    everything = [*theirs, *(point for points in ours.values() for point in points)]
    for _ in range(repetitions - 1):
        for point in everything:
            if point.seconds < limit / 10:
                point.times.append(point.run()[1])
    exact, agreement = converged(case)
    their_exact, their_agreement = limit_of(theirs, case.order)
    motion = largest_change(exact)
    for points in ours.values():
        for point in points:
            point.error = distance(point.path, exact) / motion
    for point in theirs:
        point.error = distance(point.path, their_exact) / motion
    rows = [row_of(case, target, ours, theirs) for target in TARGETS]
    check = {"case": case.name, "elements": case.elements, "theirs from ours": distance(exact, their_exact) / motion,
             "theirs uncertain by": their_agreement / motion, "ours uncertain by": agreement / motion}
    return rows, check, ours | {"exudyn": theirs}


def _bracketed(seconds: float, reached: bool) -> str:
    text = f"{seconds:.2g}"
    return text if reached or np.isnan(seconds) else f"({text})"


def draw(curves: dict[tuple[str, int], dict[str, list[Point]]], path: Path) -> None:
    """A panel a case: error over CPU seconds."""
    from funicular.view.plot import STYLE
    from matplotlib import pyplot, rc_context

    columns = 3
    lines = -(-len(curves) // columns)
    names = list(dict.fromkeys(name for each in curves.values() for name in each))
    with rc_context(STYLE):
        figure, panels = pyplot.subplots(lines, columns, figsize=(10, 2.6 * lines), sharey=True, squeeze=False)
        for axes, ((case, elements), each) in zip(panels.flat, curves.items(), strict=False):
            for name, points in each.items():
                theirs = name == "exudyn"
                axes.loglog([p.seconds for p in points], [p.error for p in points], marker="s" if theirs else "o",
                            markersize=3.5, color="0.25" if theirs else f"C{names.index(name)}", label=name)
            axes.set_title(f"{case}, {elements} elements", fontsize=9)
            axes.set_ylim(1e-8, 0.2)
            axes.margins(x=0.06)
        for axes in panels[:, 0]:
            axes.set_ylabel("error / largest motion")
        for axes in panels.flat[max(len(curves) - columns, 0) : len(curves)]:
            axes.set_xlabel("CPU time / s")
        for axes in panels.flat[len(curves) :]:
            axes.set_visible(False)
        handles = {label: handle for axes in panels.flat for handle, label in
                   zip(*axes.get_legend_handles_labels(), strict=True)}
        figure.legend(handles.values(), handles.keys(), loc="outside upper center", ncols=len(names))
        figure.savefig(path, dpi=110)


def append(rows: list[dict], out: Path) -> None:
    """Add rows of equal keys to a table, with a header in a new file."""
    new = not out.exists()
    with out.open("a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0])
        if new:
            writer.writeheader()
        writer.writerows(rows)


def points_of(case: Case, curves: dict[str, list[Point]]) -> list[dict]:
    """All points of a case as rows."""
    return [{"case": case.name, "elements": case.elements, "curve": name, "setting": point.setting,
             "taken": point.taken, "error": point.error, "seconds": point.seconds}
            for name, points in curves.items() for point in points]


def done(out: Path | None) -> set[tuple[str, int]]:
    """Return the cases in a table."""
    if out is None or not out.exists():
        return set()
    with out.open(newline="", encoding="utf-8") as file:
        return {(row["case"], int(row["elements"])) for row in csv.DictReader(file)}


def main() -> None:
    """Measure, print, draw."""
    options = parser(__doc__, repetitions=(3, "of each run, but for those that take longer than a tenth of the limit"),
                     limit=(20, "CPU seconds that a run may take"))
    options.add_argument("--cases", default="", metavar="TEXT", help="only those with TEXT in their name")
    options.add_argument("--elements", type=int, help="only this number of elements")
    options.add_argument("--resume", action="store_true", help="leave out the cases that FILE.csv of --out has")
    options.add_argument("--plot", type=Path, metavar="FILE.png", help="draw the picture")
    options = options.parse_args()
    if options.resume and options.json:
        raise SystemExit("--json takes a whole run: give it without --resume")
    warnings.simplefilter("ignore", FunicularWarning)  # coarse steps are meant
    before = done(options.out) if options.resume else set()
    if options.out is not None and not options.resume:
        for old in (options.out, options.out.with_suffix(".points.csv")):
            old.unlink(missing_ok=True)
    curves = {}
    for case in few(cases()):
        if (options.cases in case.name and options.elements in (None, case.elements)
                and (case.name, case.elements) not in before):
            print(f"{case.name}, {case.elements} elements", flush=True)
            try:
                rows, check, each = compare(case, options.repetitions, options.limit)
            except TooLongError as error:
                print(f"  left out: {error}; give a larger --limit", flush=True)
                continue
            curves[case.name, case.elements] = each
            show(rows, table="times")
            show([check], table="convergence")
            if options.out is not None:
                append(rows, options.out)
                append(points_of(case, each), options.out.with_suffix(".points.csv"))
    if options.plot:
        draw(curves, options.plot)
        print(f"written: {options.plot}")


if __name__ == "__main__":
    main()
