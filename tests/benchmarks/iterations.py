"""Iterations of Newton's method per step of generalised-alpha, with their error and cost.

    python tests/benchmarks/iterations.py [--only WORDS] [--out FILE.csv]

Each scene runs with prescribed steps and with tol = 1e-3 and 1e-4. ``error`` is the largest distance of a node or body
from the reference at 20 output times, over the largest motion; references are those of choice.py, else radau's with
tol = 1e-7. Iterations are substitutions with a factored matrix, per step; ``factored`` is the number of factorisations
per step. Neither depends on the machine; CPU seconds do. The last line has the median of the iterations.
"""

from __future__ import annotations

import os
import statistics
import warnings
from functools import partial

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import funicular as fu
import numpy as np
from choice import TIMES, farthest, motion, references
from choice_scenes import SCENES, Subject
from hard_cases.case import positions
from pendulum import pendulum
from sliding import sliding_mass
from table import few, parser, show

SETTINGS: tuple[dict[str, float], ...] = ({"step": 1e-3}, {"step": 2e-4}, {"tol": 1e-3}, {"tol": 1e-4})
OF_CHOICE = ("first scene", "zip line", "cable car", "double pendulum", "heavy top on a spring", "rigid link",
             "flexible link", "modal link", "friction, vibrating", "stick", "follower force", "shaken support",
             "taut cable, rider", "buckling")


def chain(links: int) -> fu.Scene:
    """Return rods of 0.2 m in a chain of spherical joints, released from the horizontal."""
    scene = fu.Scene()
    for k in range(links):
        scene.rigid_body(f"link{k}", mass=0.1, inertia=(1e-5, 4e-4, 4e-4), position=(0.2 * k + 0.1, 0, 0))
        scene.joint("spherical", (f"link{k}", (-0.1, 0, 0)), (f"link{k - 1}", (0.1, 0, 0)) if k else (0, 0, 0),
                    name=f"joint{k}")
    return scene


def subjects() -> dict[str, Subject]:
    """The scenes by name."""
    made = {f"pendulum, {n}, E {modulus:.0e}": Subject(partial(pendulum, n, modulus, 7200), 0.5)
            for modulus in (2e6, 7e8) for n in (8, 32, 128)}
    for name, modulus, mass in (("sliding mass", 0.4e9, 1.0), ("sliding mass, flexible", 2e6, 5.0)):
        made |= {f"{name}, {n}": Subject(partial(sliding_mass, n, strain="engineering", youngs_modulus=modulus,
                                                 mass=mass), 0.5) for n in (3, 12, 48)}
    made["chain of 20 links"] = Subject(partial(chain, 20), 0.5)
    return made | {name: SCENES[name] for name in OF_CHOICE}


def simulate(subject: Subject, **settings) -> fu.Run:
    """A run of a scene, 20 output times after the start."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        return subject.make().run(subject.duration, output_step=subject.duration / TIMES, initial=subject.initial,
                                  progress=False, **settings)


def cell(subject: Subject, exact: np.ndarray, settings: dict[str, float]) -> dict:
    """Return the figures of one run, its error first."""
    run = simulate(subject, integrator="genalpha", **settings)
    report = run.report
    (setting, value), = settings.items()
    return {"setting": f"{setting} {value:g}", "error": farthest(positions(run), exact) / motion(exact),
            "steps": report["steps"], "iterations": report["newton_iterations"] / report["steps"],
            "factored": report["factorisations"] / report["steps"], "CPU s": report["time_s"]["solve_cpu"]}


def medians(rows: list[dict]) -> list[dict]:
    """Return the medians of iterations and factorisations per step by setting, over all scenes."""
    found = {setting: [row for row in rows if row["setting"] == setting] for setting in {r["setting"]: 0 for r in rows}}
    return [{"setting": setting, "scenes": len(of), "largest error": max(row["error"] for row in of),
             **{key: statistics.median(row[key] for row in of) for key in ("iterations", "factored")}}
            for setting, of in found.items()]


def main() -> None:
    """Measure and print."""
    options = parser(__doc__)
    options.add_argument("--only", default="", help="scenes whose name holds this")
    options = options.parse_args()
    rows = []
    for name, subject in few(subjects().items()):
        if options.only in name:
            known = references().get(name)
            exact = positions(simulate(subject, integrator="radau", tol=1e-7)) if known is None else known
            rows += [{"scene": name} | cell(subject, exact, settings) for settings in SETTINGS]
    show(rows, options.out)
    show(medians(rows), table="medians")
    print(f"all: {statistics.median(row['iterations'] for row in rows):.2f}")


if __name__ == "__main__":
    main()
