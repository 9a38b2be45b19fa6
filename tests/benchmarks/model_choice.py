"""Error of the chosen model over its tolerance, and the cost of the choice: every scene of model_scenes.py, every tol.

    python tests/benchmarks/model_choice.py [--only WORDS] [--cache DIR] [--brute-force none|cached|all] [--full-length]
        [--out FILE.csv]

``error/tol`` is the largest error of a motion, of stations along cables and of bodies at 20 output times, against the
converged motion of the finest model available, over the largest motion and over tol; ``estimate`` is the estimate of
the choice. ``resolved`` is the convergence of the reference itself, over tol: beyond 1 the error has no meaning. ``ms``
is the CPU time of the integration, ``cheapest`` that of the cheapest model within tol, found by brute force over
elements, laws, meshes and integrators, both measured alternately. ``choice`` is the CPU time of the choice over that of
the run, set-up included. References and brute force are computed once and cached; the choice is made anew.

``--full-length`` runs the bundled scenes over the durations of their files. Their errors are against a run on twice as
fine a mesh with a tenth of the time tolerance.
"""

from __future__ import annotations

import statistics
import tempfile
import time
import warnings
from dataclasses import replace
from pathlib import Path

import funicular as fu
from funicular.choice.motion import motion
from funicular.choice.remeshing import remade
from funicular.kernels.elements import built_in
from funicular.results.trajectories import distance, largest_change
from model_cells import CACHE, TIMES, TOLS, Cell, brute_force, drawn, known_cells, models, reference
from model_cells import simulate as run_of_models
from model_scenes import SCENES
from table import few, parser, show

REPETITIONS = 3
BUNDLED = ("paper51", "paper52_rigid", "paper52_modal", "paper52_ancf", "zip_line", "cable_car")
TURNS = 5
"""Runs of the chosen model and of the cheapest one, of which the shortest counts."""
MIN_UNREPEATED_TIME = 0.2
"""CPU seconds from which on a run is not repeated."""


def chosen(name: str, tol: float) -> fu.Choice:
    """Return the choice for a scene with all models free."""
    subject = SCENES[name]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        return subject.make().choose(tol, duration=subject.duration, initial=subject.initial, free="all")


def simulate(name: str, choice: fu.Choice) -> tuple[fu.Run, float, float]:
    """Return a run of the chosen scene, with medians of the CPU times of its integration and of the whole."""
    subject, solve, total = SCENES[name], [], []
    for _ in range(REPETITIONS):
        begin = time.process_time()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", fu.FunicularWarning)
            run = choice.scene.run(output_step=subject.duration / TIMES, initial=subject.initial, progress=False)
        total.append(time.process_time() - begin)
        solve.append(run.report["time_s"]["solve_cpu"])
        if total[-1] > MIN_UNREPEATED_TIME:
            break
    return run, statistics.median(solve), statistics.median(total)


def in_turns(name: str, choice: fu.Choice, best: Cell) -> tuple[float, float]:
    """Return the minimum CPU times of the integrations of the chosen model and of a cell, run alternately."""
    subject, times = SCENES[name], ([], [])
    cell = models(drawn(name, built_in()[best.element].dim), best.element, best.law, best.mesh)
    for _ in range(TURNS):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", fu.FunicularWarning)
            runs = (choice.scene.run(output_step=subject.duration / TIMES, initial=subject.initial, progress=False),
                    run_of_models(name, cell, tol=best.tol, integrator=best.integrator))
        for each, run in zip(times, runs, strict=True):
            each.append(run.report["time_s"]["solve_cpu"])
        if times[0][-1] > MIN_UNREPEATED_TIME:
            break
    return min(times[0]), min(times[1])


def true_error(name: str, run: fu.Run, cache: Path = CACHE) -> float:
    """Return the largest error of a run over the largest motion."""
    exact = reference(name, cache)[0]
    return distance(motion(run.scene, run), exact) / largest_change(exact)


def row(name: str, tol: float, cache: Path, brute: str) -> dict:
    """Return one row of the table; brute: "none", "cached" or "all" runs by brute force."""
    choice = chosen(name, tol)
    run, solve, total = simulate(name, choice)
    found = {"none": lambda: (), "cached": lambda: known_cells(name, cache).values(),
             "all": lambda: brute_force(name, cache)}[brute]()
    keeping = [cell for cell in found if cell.tol == tol and cell.error <= tol]
    best = min(keeping, key=lambda cell: cell.cpu, default=None)
    label = "; ".join(dict.fromkeys(map(str, choice.models.values())))
    solve, cheapest = in_turns(name, choice, best) if best else (solve, float("nan"))
    return {"scene": name, "tol": tol, "error/tol": true_error(name, run, cache) / tol, "estimate": choice.error / tol,
            "kept": choice.kept, "resolved": reference(name, cache)[1] / tol, "ms": 1e3 * solve,
            "cheapest": 1e3 * cheapest, "ratio": solve / cheapest,
            "choice": choice.seconds / total, "probes": choice.probes, "model": f"{label}, {choice.integrator}",
            "best": f"{best.mesh} {best.element}, {best.law}, {best.integrator}" if best else "none"}


def full_length(name: str, tol: float) -> dict:
    """Return one row of the table of bundled scenes at full length."""
    scene = fu.load_scene(name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        choice = scene.choose(tol, free="all")
        duration = choice.scene.run_settings["duration"]
        begin = time.process_time()
        run = choice.scene.run(output_step=duration / TIMES, progress=False)
        total = time.process_time() - begin
        finer = remade(choice.scene, {cable: replace(model, elements=2 * model.elements)
                                      for cable, model in choice.models.items()})
        exact = finer.run(output_step=duration / TIMES, tol=choice.time_tol / 10, progress=False)
    reference = motion(finer, exact)
    return {"scene": name, "s": duration, "tol": tol, "choice": choice.seconds / total, "run ms": 1e3 * total,
            "error/tol": distance(motion(run.scene, run), reference) / largest_change(reference) / tol,
            "estimate": choice.error / tol, "probes": choice.probes, "chosen": choice.heading.partition(": ")[2]}


def summary(rows: list[dict]) -> list[str]:
    """Return how many cells meet each goal."""
    true = [one for one in rows if one["resolved"] <= 1]
    within = sum(one["error/tol"] <= 3 or (not one["kept"] and one["best"] == "none") for one in true)
    priced = [one for one in true if one["best"] != "none"]
    cheap = sum(one["ratio"] <= 2 for one in priced)
    quick = sum(one["choice"] <= 0.2 for one in rows)
    return [f"{within} of {len(true)} cells whose reference is converged within 3 tol, or said that no model keeps it",
            f"{cheap} of {len(priced)} cells at most twice as dear as the cheapest model by brute force",
            f"{quick} of {len(rows)} choices in at most a fifth of the run's time"]


def main() -> None:
    """Measure and print."""
    options = parser(__doc__)
    options.add_argument("--only", default="", help="scenes whose name holds this")
    options.add_argument("--cache", type=Path, default=CACHE, help="folder of references and runs by brute force")
    options.add_argument("--brute-force", choices=("none", "cached", "all"), default="all",
                         help="runs of the cheapest model: none, those in the cache, all")
    options.add_argument("--full-length", action="store_true", help="the bundled scenes at full length")
    options = options.parse_args()
    if options.smallest:  # with a reference that is none
        options.cache, options.brute_force = Path(tempfile.mkdtemp(prefix="funicular-")), "none"
    if options.full_length:
        rows = [full_length(name, tol) for name in BUNDLED if options.only in name for tol in TOLS[:2]]
        show(rows, options.out, "full length")
        return
    rows = []
    for name in few(name for name in SCENES if options.only in name):
        for tol in few(TOLS):
            rows.append(row(name, tol, options.cache, options.brute_force))
            print(f"{name}, {tol:g}: {rows[-1]['error/tol']:.2f} tol", flush=True)
    show(rows, options.out)
    print("\n".join(summary(rows)))


if __name__ == "__main__":
    main()
