"""Runs of tests/benchmarks/model_choice.py, each made once: references, and every model by brute force, in a cache.

The cache is a folder outside of the repository (--cache, by default in the user's cache folder): for each scene the
converged motion of its finest model as .npz, and one line of JSON for each run by brute force.
"""

from __future__ import annotations

import json
import os
import time
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path

import funicular as fu
import numpy as np
from funicular.choice.motion import motion
from funicular.choice.planar import planar_of
from funicular.choice.remeshing import CableModel, coarsest, remade
from funicular.kernels.elements import built_in
from funicular.results.trajectories import distance, largest_change
from model_scenes import SCENES
from table import few

CACHE = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "funicular-benchmarks" / "model_choice"
TIMES = 20
TOLS = (1e-2, 1e-3, 1e-4)
INTEGRATORS = ("genalpha", "radau", "explicit")
MESHES = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64)
"""Elements of each cable, in units of the coarsest mesh that has nodes at all supports."""

KINDS = {3: (("cable12", "engineering_exact"), ("cable12", "engineering_exact_reduced"),
             ("cable18", "engineering_exact"), ("beam24", "structural")),
         2: (("cable8p", "engineering_exact"), ("cable8p", "engineering_exact_reduced"), ("beam12p", "structural"))}
FINEST = {3: (("beam24", "structural"), ("cable12", "engineering_exact")),
          2: (("beam12p", "structural"), ("cable8p", "engineering_exact"))}
"""The finest model comes first; the others stand for sections that it does not take."""

REFERENCE_MESHES = {"beam24": (16, 32, 64), "beam12p": (16, 32, 64, 128), "cable12": (32, 64, 128, 256),
                    "cable8p": (32, 64, 128, 256)}
CONVERGED = 1e-5
"""Of the motion: where two meshes of a reference agree so well, no finer one is run."""

MOST_SECONDS = 1.0
"""CPU time of a run by brute force from which on no finer mesh of that model is tried."""


@dataclass(frozen=True)
class Cell:
    """One run by brute force: its model, time tolerance, error over the motion and CPU cost in s."""

    element: str
    law: str
    mesh: int
    integrator: str
    tol: float
    error: float
    cpu: float
    set_up: float
    failed: str = ""


@lru_cache
def drawn(name: str, dim: int) -> fu.Scene | None:
    """Return a scene with cables of a dimension: a planar motion of a spatial scene may have planar ones, else None."""
    scene = SCENES[name].make()
    if scene.dim == dim:
        return scene
    if scene.dim == 2:
        return None
    return planar_of(remade(scene, models(scene, *able(scene, FINEST[3])[0], 4))).scene


def models(scene: fu.Scene, element: str, law: str, mesh: int) -> dict[str, CableModel]:
    """Return one model for all cables of a scene."""
    return {name: CableModel(element, law, mesh * coarsest(scene, cable)) for name, cable in scene.cables.items()}


def simulate(name: str, chosen: dict[str, CableModel] | None, **settings) -> fu.Run:
    """Return a run of a scene with these models of its cables."""
    subject = SCENES[name]
    dim = 3 if chosen is None else max(built_in()[model.element].dim for model in chosen.values())
    scene = subject.make() if chosen is None else drawn(name, dim)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fu.FunicularWarning)
        scene = scene if chosen is None else remade(scene, chosen)
        return scene.run(subject.duration, output_step=subject.duration / TIMES, initial=subject.initial,
                         **{"progress": False} | settings)


def able(scene: fu.Scene, wanted: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return the elements and laws that the cables of a scene permit."""
    found = []
    for element, law in wanted:
        try:
            remade(scene, models(scene, element, law, 4))
        except fu.SceneError:
            continue
        found.append((element, law))
    return found


def kinds(name: str) -> list[tuple[str, str]]:
    """Return the elements and laws of the runs by brute force, with planar ones for a planar motion."""
    scenes = {dim: scene for dim in (3, 2) if (scene := drawn(name, dim)) is not None}
    return [kind for dim, scene in scenes.items() for kind in able(scene, KINDS[dim])]


def reference(name: str, cache: Path = CACHE) -> tuple[np.ndarray, float, str]:
    """Return the converged motion of the finest model, its convergence, and the model."""
    path = cache / f"{name}.npz"
    if not path.exists():
        exact, converged, label = _reference(name)
        cache.mkdir(parents=True, exist_ok=True)
        np.savez_compressed(path, motion=exact, converged=converged, model=label)
    with np.load(path) as held:
        return held["motion"], float(held["converged"]), str(held["model"])


def _reference(name: str) -> tuple[np.ndarray, float, str]:
    scene = SCENES[name].make()
    element, law = able(scene, FINEST[scene.dim])[0]
    before, converged = None, np.inf
    for mesh in few(REFERENCE_MESHES[element]):
        run = simulate(name, models(scene, element, law, mesh), tol=1e-6)
        exact = motion(run.scene, run)
        if before is not None:
            converged = distance(before, exact) / largest_change(exact)
        print(f"{name}: {mesh} {element} {law}: {converged:.1e}, {run.report['time_s']['total']:.1f} s", flush=True)
        if converged < CONVERGED or run.report["time_s"]["total"] > 60:
            break
        before = exact
    return exact, converged, f"{mesh} {element}, {law}"


def known_cells(name: str, cache: Path = CACHE) -> dict[tuple, Cell]:
    """Return the runs by brute force in the cache, by model, integrator and tolerance."""
    path = cache / f"{name}.jsonl"
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    cells = [Cell(**json.loads(line)) for line in lines]
    return {(cell.element, cell.law, cell.mesh, cell.integrator, cell.tol): cell for cell in cells}


def brute_force(name: str, cache: Path = CACHE) -> Iterator[Cell]:
    """Yield models at every tolerance, cached or computed: meshes from coarse to fine, until one meets the tolerance or
    costs more than the cheapest that does.
    """
    exact = reference(name, cache)[0]
    path = cache / f"{name}.jsonl"
    known = known_cells(name, cache)
    for tol in TOLS:
        cheapest = np.inf
        for element, law in kinds(name):
            for integrator in INTEGRATORS:
                for mesh in MESHES:
                    key = element, law, mesh, integrator, tol
                    if key not in known:
                        known[key] = measured(name, exact, *key)
                        with path.open("a", encoding="utf-8") as file:
                            file.write(json.dumps(asdict(known[key])) + "\n")
                    cell = known[key]
                    yield cell
                    if cell.error <= tol:
                        cheapest = min(cheapest, cell.cpu)
                        break
                    if cell.cpu > min(1.5 * cheapest, MOST_SECONDS):  # times of short runs scatter
                        break


class Stopwatch:
    """Ends a run that takes more than twice `MOST_SECONDS`."""

    def __init__(self):
        self.begin = time.process_time()

    def __call__(self, reached: float) -> None:
        if time.process_time() - self.begin > 2 * MOST_SECONDS:
            raise TimeoutError(f"more than {2 * MOST_SECONDS:g} s")


def measured(name: str, exact: np.ndarray, element: str, law: str, mesh: int, integrator: str, tol: float) -> Cell:
    """Return one run by brute force; a short one is repeated, and the shortest time counts."""
    cost = set_up = np.inf
    try:
        for _ in range(3):
            chosen = models(drawn(name, built_in()[element].dim), element, law, mesh)
            run = simulate(name, chosen, tol=tol, integrator=integrator, progress=Stopwatch())
            cost = min(cost, run.report["time_s"]["solve_cpu"])
            set_up = min(set_up, run.report["time_s"]["set_up"])
            if cost > 0.1:
                break
    except TimeoutError as error:
        return Cell(element, law, mesh, integrator, tol, float("nan"), 2 * MOST_SECONDS, 0.0, str(error))
    except fu.FunicularError as error:
        return Cell(element, law, mesh, integrator, tol, float("nan"), 0.0, 0.0, str(error)[:200])
    error = distance(motion(run.scene, run), exact) / largest_change(exact)
    return Cell(element, law, mesh, integrator, tol, error, cost, set_up)
