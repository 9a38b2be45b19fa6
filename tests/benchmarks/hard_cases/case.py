"""A hard case: figures of a scene on which integrators fail, and their bounds."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache

import numpy as np
from funicular import FunicularWarning, Run, Scene
from funicular.base.rotations import rotate

INTEGRATORS = "genalpha", "energy", "explicit", "radau"

CONVERGED = {"integrator": "explicit", "tol": 1e-10}
"""Settings of references: another method than the one that is measured, of order 8."""

BALANCE = {"genalpha": 4e-4, "energy": 2e-9, "explicit": 4e-5, "radau": 1e-3}
"""Bounds of the books' residual with the default tolerance; the energy method's is rounding, most of it far from the
origin."""
HELD = {"genalpha": 4e-9, "energy": 1e-11, "explicit": 1e-11, "radau": 1e-11}
"""Bounds of the distance of riders to their cables, m: where Newton's iteration stops, and rounding where positions are
projected."""
SHAKEN = BALANCE | {"radau": 1e-2}
"""The same where much energy is in waves that Radau IIA does not resolve, and damps."""

Bounds = dict[str, float | tuple[float, float]]


@dataclass(frozen=True)
class Case:
    """measure(integrator): figures by name. bounds: upper bounds, or pairs. slow: some integrators.

    A bound by integrator, as ``{"error": {"genalpha": 1e-4, "explicit": 1e-6}}``, holds for that one alone.
    """

    name: str
    measure: Callable[[str], dict[str, float]]
    bounds: dict[str, float | tuple[float, float] | dict]
    integrators: tuple[str, ...] = INTEGRATORS
    slow: tuple[str, ...] = ()

    def limits(self, integrator: str) -> Bounds:
        """Return the bounds for one integrator."""
        given = {figure: b.get(integrator) if isinstance(b, dict) else b for figure, b in self.bounds.items()}
        return {figure: bound for figure, bound in given.items() if bound is not None}


@dataclass
class Subject:
    """Cases of one file."""

    cases: list[Case] = field(default_factory=list)

    def case(self, name: str, *, integrators=INTEGRATORS, slow=(), **bounds):
        """Declare the decorated function as a case."""
        def declare(measure):
            self.cases.append(Case(name, measure, bounds, tuple(integrators), tuple(slow)))
            return measure

        return declare


def broken(value: float, bound: float | tuple[float, float]) -> bool:
    """Return whether a figure is not within its bound; NaN is not."""
    low, high = bound if isinstance(bound, tuple) else (-np.inf, bound)
    return not low <= value <= high


def simulate(scene: Scene, duration: float, **settings) -> Run:
    """Return a run without a progress bar; its notes are in the report."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FunicularWarning)
        return scene.run(duration, progress=False, **settings)


@cache
def reference(make: Callable[[], Scene], duration: float, **settings) -> Run:
    """Return the converged motion of a scene that a function makes, computed once: by another method, of order 8."""
    return simulate(make(), duration, **settings, **CONVERGED)


def compared(make: Callable[[], Scene], duration: float, integrator: str, **settings) -> tuple[Run, dict[str, float]]:
    """Return a run with the default tolerance, and its figures beside those of its reference.

    settings: of both runs.
    """
    run = simulate(make(), duration, integrator=integrator, **settings)
    return run, figures(run, reference(make, duration, **settings))


def positions(run: Run) -> np.ndarray:
    """Return (time, points, 3) positions of bodies and nodes."""
    nodes = [run[key][:, :, 0] for key in run.keys() if key.endswith(".nodal_vectors")]
    bodies = [run[key][:, None] for key in run.keys() if key.endswith(".position")]
    return np.concatenate(nodes + bodies, axis=1)


def largest_motion(run: Run) -> float:
    """Return the largest displacement of a body or node from its start, m, the scale of ``tol``."""
    at = positions(run)
    return float(np.linalg.norm(at - at[0], axis=-1).max())


def error(run: Run, reference: Run) -> float:
    """Return the largest deviation of a position at any output time, over the largest motion. The reference may have
    more times.
    """
    every = (len(reference.time) - 1) // (len(run.time) - 1)
    off = positions(run) - positions(reference)[::every]
    return float(np.linalg.norm(off, axis=-1).max()) / largest_motion(reference)


def balance(run: Run) -> float:
    """Return the largest residual of the energy balance, over the energy exchanged, or the kinetic energy if larger."""
    books = run.energy_balance()
    return float(np.abs(books.residual).max() / max(books.exchanged, run["energy.kinetic"].max()))


def residual(run: Run) -> float:
    """Return the largest distance of a rider to its cable by the engine, m."""
    return max(float(run[f"{name}.residual"].max()) for name in run.scene.slides)


def gap(run: Run) -> float:
    """Return the same distance without the engine: r at s by its element, and the rider's point, which shows a wrong
    element index.
    """
    worst = 0.0
    for name, slide in run.scene.slides.items():
        cable = run.scene.cables[slide.along]
        vectors, length = run[f"{slide.along}.nodal_vectors"], cable.length / cable.elements
        element = np.clip((run[f"{name}.s"] // length).astype(int), 0, cable.elements - 1)
        x, row = run[f"{name}.s"] / length - element, np.arange(len(run.time))
        (a, da), (b, db) = (vectors[row, element + k, :2].swapaxes(0, 1) for k in (0, 1))
        N = np.array([1 - 3 * x**2 + 2 * x**3, length * (x - 2 * x**2 + x**3), 3 * x**2 - 2 * x**3,
                      length * (x**3 - x**2)])[..., None]
        r = N[0] * a + N[1] * da + N[2] * b + N[3] * db
        at = np.array([rotate(o, np.array(slide.at)) for o in run[f"{slide.body}.orientation"]])
        worst = max(worst, float(np.abs(r - run[f"{slide.body}.position"] - at).max()))
    return worst


def figures(run: Run, reference: Run | None = None) -> dict[str, float]:
    """Return the figures of every scene."""
    found = {"balance": balance(run), "steps": run.report["steps"], "rejected": run.report["rejected_steps"]}
    if run.scene.slides:
        found |= {"residual": residual(run), "gap": gap(run), "crossings": run.report["element_crossings"]}
    if reference is not None:
        found = {"error": error(run, reference)} | found
    return found
