"""Steps, events and errors of scenes with springs that become slack and taut, by integrator and tolerance or step.

overhead_span: the bundled scene from equilibrium, a wire under nine droppers. thrown: a mass on a tension-only spring.
table: a mass on a spring with a table of tension. pair: a wire under two droppers is lifted. ropes: a body on six
ropes, thrown. catenary: 1, 3 and 10 spans, 0.3 s of a pantograph at 300 km/h, with tolerance and error in m. Errors
against radau with a tolerance of 1e-9, over the largest motion. Passed: deferred events within steps; instants: the
median distance of the instants of all events from those of the reference, s.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
import warnings

import funicular as fu
import numpy as np
import pantographs as lines
from funicular import catenary
from table import few, parser, show


def hanging(speed: float, **law) -> fu.Scene:
    """Return 2 kg on a spring of 1 m with a downward speed."""
    scene = fu.Scene(gravity=(0, 0, -9.81))
    scene.rigid_body("m", mass=2.0, inertia=(1, 1, 1), position=(0, 0, -1.0), velocity=(0, 0, -speed))
    scene.spring((0, 0, 0), "m", length=1.0, name="dropper", **law)
    return scene


def overhead_span() -> fu.Scene:
    """Return the bundled scene in equilibrium."""
    return fu.load_scene("overhead_span").equilibrium().scene


def pair() -> fu.Scene:
    """Return a wire under two droppers, which is lifted in its middle and lowered."""
    scene = fu.Scene(gravity=(0, 0, -9.81))
    wire = scene.cable("wire", start=(0, 0, 0), end=(10, 0, 0), elements=20, element="cable12",
                       section=fu.Circle(radius=6e-3), rest_length=10 / (1 + 7e-4),
                       material=fu.Material(youngs_modulus=1e11, poisson_ratio=0.3, density=8900))
    for s in (0.0, wire.rest_length):
        scene.pin(wire, s=s)
    for k, s in enumerate((0.3, 0.7)):
        scene.spring((10 * s, 0, 1.0), (wire, s * wire.rest_length), stiffness=1e5, length=0.998, tension_only=True,
                     name=f"dropper{k}")
    lift = fu.TableSignal(time=[0, 0.3, 0.5, 0.8], value=[0, 1, 1, 0])
    scene.force(wire, s=wire.rest_length / 2, value=(0, 0, 120.0), scale=lift)
    return scene


def ropes() -> fu.Scene:
    """Return a thrown, rotating body on six ropes."""
    scene = fu.Scene(gravity=(0, 0, -9.81))
    scene.rigid_body("b", mass=5.0, inertia=(0.1, 0.15, 0.2), position=(0, 0, 0), velocity=(0.8, 0.3, 1.5),
                     angular_velocity=(1.0, 2.0, 0.5))
    for k, (x, y) in enumerate((x, y) for x in (-1, 1) for y in (-1, 0.2, 1)):
        scene.spring((2 * x, 1.5 * y, 2.0), ("b", (0.2 * x, 0.2 * y, 0.1)), stiffness=3000.0, length=2.4 + 0.05 * k,
                     tension_only=True, name=f"rope_{k}")
    return scene


def line(spans: int) -> fu.Scene:
    """Return spans of the reference model with its pantograph."""
    scene = catenary.scene(lines.reference(spans), lines.COARSE)
    catenary.add_pantograph(scene, lines.TWO_MASSES, 5.0 if spans == 1 else 20.0, 300 / 3.6, "pantograph")
    return scene


SCENES = {
    "overhead_span": (overhead_span, 0.8), "pair": (pair, 1.0), "ropes": (ropes, 0.4),
    "thrown": (lambda: hanging(0.5, stiffness=400.0, tension_only=True), 2.0),
    "table": (lambda: hanging(1.5, table={"extension": [-0.1, 0, 0.05, 0.1], "tension": [-30, 0, 10, 60]}), 1.0),
    "catenary_1": (lambda: line(1), 0.3), "catenary_3": (lambda: line(3), 0.3), "catenary_10": (lambda: line(10), 0.3),
}


def instants(run: fu.Run) -> dict[str, list]:
    """Return the events of each coupling: instant, words, whether it was deferred."""
    found: dict[str, list] = {}
    for event in run.events:
        if "what" in event:
            found.setdefault(event["name"], []).append((event["time"], event["what"], event.get("passed", False)))
    return found


def off(run: fu.Run, reference: fu.Run, passed: bool) -> float:
    """Return the median distance of instants from those of the reference, of couplings with the same events, s."""
    mine, theirs = instants(run), instants(reference)
    same = [pair for name in theirs if [e[1] for e in mine.get(name, [])] == [e[1] for e in theirs[name]]
            for pair in zip(mine[name], theirs[name], strict=True)]
    found = [abs(a[0] - b[0]) for a, b in same if a[2] is passed]
    return float(np.median(found)) if found else float("nan")


def simulate(name: str, **settings) -> tuple[fu.Run, float]:
    """Return a run of a scene, and its CPU time in s."""
    make, duration = SCENES[name]
    if "tol" in settings and name.startswith("catenary"):
        settings["absolute_tol"], settings["tol"] = settings["tol"], 1e-9
    scene, begin = make(), time.process_time()
    return scene.run(duration=duration, output_step=duration / 20, initial="equilibrium" if name == "pair" else None,
                     progress=False, **settings), time.process_time() - begin


def row(name: str, reference: fu.Run, settings: dict) -> dict:
    """Return the row of a run with these settings."""
    run, taken = simulate(name, **settings)
    names = [key for key in (*run.scene.cables, *run.scene.bodies) if not key.startswith("pantograph")]
    moved = [np.linalg.norm(reference[f"{k}.position"] - reference[f"{k}.position"][0], axis=-1).max() for k in names]
    error = max(np.linalg.norm(run[f"{k}.position"] - reference[f"{k}.position"], axis=-1).max() for k in names)
    size, balance = settings.get("tol", settings.get("step")), run.energy_balance()
    allowed = 1.0 if name.startswith("catenary") else max(moved)
    return {"scene": name, "integrator": settings["integrator"], "tol" if "tol" in settings else "step_s": size,
            "steps": run.report["steps"], "iterations": run.report["newton_iterations"],
            "factorisations": run.report["factorisations"], "evaluations": run.report.get("evaluations", 0),
            "events": sum(map(len, instants(run).values())),
            "passed": sum(event[2] for events in instants(run).values() for event in events), "seconds": taken,
            "error": error / allowed, "balance": float(np.abs(balance.residual).max() / balance.exchanged),
            "instants": off(run, reference, True), "of_landed": off(run, reference, False)}


def thrown_body(seed: int) -> fu.Scene:
    """Return a body on five ropes and a spring, of random mass, stiffnesses and velocities."""
    random, scene = np.random.default_rng(seed), fu.Scene(gravity=(0, 0, -9.81))
    scene.rigid_body("b", mass=float(random.uniform(2, 8)), inertia=(0.1, 0.15, 0.2), position=(0, 0, 0),
                     velocity=tuple(random.uniform(-1, 1, 3)), angular_velocity=tuple(random.uniform(-1.5, 1.5, 3)))
    for k, (x, y) in enumerate((x, y) for x in (-1, 1) for y in (-1, 0.2, 1)):
        scene.spring((2 * x, 1.5 * y, 2.0), ("b", (0.2 * x, 0.2 * y, 0.1)), stiffness=float(random.uniform(500, 5000)),
                     length=2.4 + 0.05 * k, tension_only=k != 2, name=f"rope_{k}")
    return scene


def random_rows(scenes: int, integrators: list[str], tols: list[float]) -> list[dict]:
    """Return errors over the tolerance, and the cost, of a number of bodies on ropes for 0.3 s."""
    shown = {"duration": 0.3, "output_step": 0.03, "progress": False}
    made = [(scene, scene.run(integrator="explicit", tol=1e-12, **shown)["b.position"])
            for scene in map(thrown_body, range(scenes))]
    rows = []
    for integrator in integrators:
        for tol in tols:
            runs = [scene.run(integrator=integrator, tol=tol, **shown) for scene, _ in made]
            errors = [np.linalg.norm(run["b.position"] - exact, axis=-1).max() for run, (_, exact) in
                      zip(runs, made, strict=True)]
            motions = [np.linalg.norm(exact - exact[0], axis=-1).max() for _, exact in made]
            over = np.array(errors) / np.array(motions) / tol
            rows.append({"integrator": integrator, "tol": tol, "median": float(np.median(over)),
                         "largest": float(over.max()), "beyond_2": int((over > 2).sum()),
                         "events": sum(len(run.events) for run in runs),
                         "passed": sum(event.get("passed", False) for run in runs for event in run.events),
                         **{key: sum(run.report[key] for run in runs)
                            for key in ("newton_iterations", "evaluations", "factorisations")}})
    return rows


def main() -> None:
    """Measure and print."""
    options = parser(__doc__)
    options.add_argument("--tol", type=float, nargs="*", default=[1e-2, 1e-3, 1e-4])
    options.add_argument("--steps", type=float, nargs="*", default=[1e-3, 5e-4])
    options.add_argument("--random", type=int, metavar="SCENES", help="so many random bodies on ropes instead")
    options.add_argument("--scene", nargs="+", choices=SCENES, default=["overhead_span"])
    options.add_argument("--integrator", nargs="+", default=["genalpha", "radau", "explicit", "energy"])
    options = options.parse_args()
    by_tol, by_step = [], []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        if options.random:
            show(random_rows(options.random, options.integrator, options.tol), options.out, "random")
            return
        for name in few(options.scene):
            reference = simulate(name, integrator="radau", tol=1e-5 if name.startswith("catenary") else 1e-9)[0]
            for integrator in few(options.integrator):
                if integrator == "energy" and name.startswith("catenary"):
                    continue  # it has no discrete gradient of the pantograph's contact
                of = {"integrator": integrator}
                by_tol += [row(name, reference, of | {"tol": tol}) for tol in few(options.tol)]
                if integrator != "explicit" and not name.startswith("catenary"):
                    by_step += [row(name, reference, of | {"step": step}) for step in few(options.steps)]
    for rows, out, table in ((by_tol, options.out, "tolerances"), (by_step, None, "steps")):
        if rows:
            show(rows, out, table)


if __name__ == "__main__":
    main()
