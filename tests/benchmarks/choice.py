"""Error of integrator="auto" over tol, and its cost: every scene of choice_scenes.py with every tol.

    python tests/benchmarks/choice.py [--only WORDS] [--every] [--repetitions N] [--out FILE.csv]
    python tests/benchmarks/choice.py --references

``error/tol`` is the largest error of a position, of nodes and bodies at 20 output times, over the largest motion and
over tol. References are in tests/reference/choice.npz, by the explicit method at tol = 1e-10; ``converged`` is the
distance of radau at tol = 1e-8 from them, over the largest motion. --references makes them anew (with --only, some).
Steps, evaluations of accelerations, Newton iterations and factorisations do not depend on the machine; CPU seconds
are the least of the repetitions, in which integrators take turns. --every adds the cost and the error of each
integrator, whether or not "auto" takes it, and the cost of "auto" over that of the cheapest one which keeps tol.
"""

from __future__ import annotations

import statistics
import warnings
from functools import cache
from pathlib import Path

import funicular as fu
import numpy as np
from choice_scenes import SCENES
from hard_cases.case import positions
from table import few, parser, show

TOLS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
INTEGRATORS = ("explicit", "radau", "genalpha")
REFERENCES = Path(__file__).parents[1] / "reference" / "choice.npz"
TIMES = 20


def simulate(name: str, **settings) -> fu.Run:
    """Return a run of a scene of the table with 20 output times after the start."""
    scene = SCENES[name]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        return scene.make().run(scene.duration, output_step=scene.duration / TIMES, initial=scene.initial,
                                progress=False, **settings)


@cache
def references() -> dict[str, np.ndarray]:
    """Return by scene positions (time, point, 3) in m, and as "scene, converged" the distance to another method's."""
    return dict(np.load(REFERENCES))


def make_references(only: str = "") -> None:
    """Compute and write the references of scenes whose name contains `only`; the others stay."""
    made = references() if only else {}
    for name in (name for name in SCENES if only in name):
        exact, other = (positions(simulate(name, integrator=method, tol=tol))
                        for method, tol in (("explicit", 1e-10), ("radau", 1e-8)))
        made |= {name: exact, f"{name}, converged": farthest(exact, other) / motion(exact)}
        print(f"{name}: converged to {made[f'{name}, converged']:.1e} of {motion(exact):.3g} m")
    np.savez_compressed(REFERENCES, **made)


def farthest(one: np.ndarray, other: np.ndarray) -> float:
    """Return the largest distance of two motions, m."""
    return float(np.linalg.norm(one - other, axis=-1).max())


def motion(exact: np.ndarray) -> float:
    """Return the largest displacement of a point from its start, m, the scale of ``tol``."""
    return farthest(exact, exact[:1])


def cell(name: str, tol: float, integrator: str = "auto") -> dict:
    """Return one row of the table."""
    exact = references()[name]
    run = simulate(name, tol=tol, integrator=integrator)
    report = run.report
    return {"scene": name, "tol": tol, "integrator": report["integrator"],
            "error/tol": farthest(positions(run), exact) / motion(exact) / tol,
            "converged": float(references()[f"{name}, converged"]), "steps": report["steps"],
            "rejected": report["rejected_steps"], "evaluations": report["evaluations"],
            "newton": report["newton_iterations"], "factored": report["factorisations"],
            "CPU s": report["time_s"]["solve_cpu"]}


def in_turns(name: str, tol: float, integrators: tuple[str, ...], repetitions: int) -> dict[str, dict]:
    """Return the rows of integrators, which take turns, with the least CPU time of each."""
    turns = [{each: cell(name, tol, each) for each in integrators} for _ in range(repetitions)]
    return {each: turns[0][each] | {"CPU s": min(turn[each]["CPU s"] for turn in turns)} for each in integrators}


def by_tolerance(rows: list[dict]) -> list[dict]:
    """Return the number of runs within a tolerance, and the largest error."""
    found = []
    for tol in {row["tol"]: 0 for row in rows}:
        of = [row for row in rows if row["tol"] == tol]
        worst = max(of, key=lambda row: row["error/tol"])
        found.append({"tol": tol, "runs": len(of), "within tol": sum(row["error/tol"] <= 1 for row in of),
                      "median error/tol": statistics.median(row["error/tol"] for row in of),
                      "largest error/tol": worst["error/tol"], "of": f"{worst['scene']}, {worst['integrator']}"})
    return found


def by_best(rows: list[dict]) -> list[dict]:
    """Return by tolerance the distribution of the cost of "auto" over the best one's that keeps tol, or of all."""
    found = []
    for tol in {row["tol"]: 0 for row in rows}:
        ratios = []
        for row in (row for row in rows if row["tol"] == tol):
            cost = {name: row[f"{name} CPU s"] for name in INTEGRATORS}
            kept = [cost[name] for name in INTEGRATORS if row[f"{name} error/tol"] <= 1]
            ratios.append((row["CPU s"] / min(kept or cost.values()), row["scene"]))
        values = np.array([ratio for ratio, _ in ratios])
        found.append({"tol": tol, "median": np.median(values), "above 1.2": int((values > 1.2).sum()),
                      "above 1.5": int((values > 1.5).sum()), "of": len(values), "largest": values.max(),
                      "scene": max(ratios)[1]})
    return found


def main() -> None:
    """Measure and print."""
    options = parser(__doc__, repetitions=(1, "runs of each, of which the least CPU time counts"))
    options.add_argument("--only", default="", help="scenes whose name holds this")
    options.add_argument("--every", action="store_true", help="with every integrator as well")
    options.add_argument("--references", action="store_true", help="make the references anew")
    options = options.parse_args()
    if options.references:
        make_references(options.only)
        return
    rows = []
    for name in few(name for name in SCENES if options.only in name):
        for tol in few(TOLS):
            others = INTEGRATORS if options.every else ()
            measured = in_turns(name, tol, ("auto", *others), options.repetitions)
            rows.append(measured["auto"] | {f"{each} {figure}": measured[each][figure]
                                            for each in others for figure in ("error/tol", "CPU s")})
    show(rows, options.out)
    show(by_tolerance(rows), table="by tolerance")
    if options.every:
        show(by_best(rows), table="cost over the best")
    errors = np.array([row["error/tol"] for row in rows])
    print(f"{np.mean(errors <= 1):.1%} of {len(errors)} cells within tol, the largest error {errors.max():.2g} tol")


if __name__ == "__main__":
    main()
