"""Equilibrium: a scene's rest under its loads, by Newton and relaxation in load steps, or along the equilibrium path.

R(x) is what forces and constraints leave over. From the drawn state x0 the path R(x) = (1 - p) R(x0) leads from p = 0
to equilibrium at p = 1: for a drawn state without stress that is loading in proportion, and any other state will do
too.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from funicular.equilibrium import Equilibrium
from funicular.errors import EquilibriumError
from funicular.modal import condensed, fastest
from funicular.model import build
from funicular.recording import end_points
from funicular.redundancy import settle
from funicular.scene import Scene
from funicular.settings import EquilibriumSettings
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

GROWTH = 1e3
"""Of a correction over the least one before: Newton diverges."""
SMALLEST_STEP = 1e-3
"""Of the load: where smaller steps do not converge either, the path has ended."""
MOST_PATH_STEPS = 2000
MOST_RELAXATIONS = 1000
FREE = 1e-14
"""Of the fastest vibration's square: a stiffness this small is none."""


class Path:
    """The engine's static state, and the path that leads from where it was drawn."""

    def __init__(self, scene: Scene, settings: EquilibriumSettings):
        from funicular.engine import Engine

        self.scene, self.settings = scene, settings
        self.model = build(scene)
        self.engine = Engine(self.model)
        settle(self.model, self.engine)
        self.engine.place(0.0)
        self.start = self.residual()
        place = self.model.place
        free = place >= 0
        self.weight = np.zeros(len(self.start))  # forces and arc-lengths do not count in the size of a correction
        self.weight[place[free]] = self.model.weight[free]
        self.size = self._extent()
        self.mass = self.engine.matrix(1.0, 0.0, 0.0)
        stiffness, _ = condensed(self.engine.matrix(0.0, 0.0, 1.0), self.model)
        # rad²/s²: what is left free (a rider that may turn about its rope) has no stiffness. Of points, not of
        # directors: a thin beam's section vibrates so fast that its share of mass would stop the beam
        points = np.flatnonzero(self.weight == 1.0)
        self.fastest = max(fastest(stiffness, self.mass, points), self._falls(points))
        self.iterations = 0
        self.history: list[Equilibrium] = []

    def _falls(self, points: np.ndarray) -> float:
        """rad²/s², of pendulums: where nothing is elastic, weight is all that holds."""
        inertia = self.mass.diagonal()[points]
        return float(np.max(np.abs(self.start[points]) / inertia, initial=0.0, where=inertia > 0)) / self.size

    def _extent(self) -> float:
        """The scene's size in m."""
        model = self.model
        lengths = [cable.length * cable.n_elements for cable in model.cables]
        lengths += [np.linalg.norm(model.q[b.configuration : b.configuration + model.dim]) for b in model.rigids]
        gaps = [end_points(model, s.ends[1], model.q[None]) - end_points(model, s.ends[0], model.q[None])
                for s in model.springs]
        return max([*lengths, *(np.linalg.norm(gap) for gap in gaps)], default=0.0) or 1.0

    def residual(self) -> np.ndarray:
        """R at the static state."""
        return self.engine.static_residual()

    def off(self, fraction: float) -> np.ndarray:
        """R - (1 - fraction) R0."""
        return self.residual() - (1.0 - fraction) * self.start

    def factor(self, inertia: float = 0.0) -> Callable[[np.ndarray], np.ndarray]:
        """Solver of the tangent, with some mass added."""
        return _solver(self.engine.matrix(0.0, 0.0, 1.0) + (inertia or FREE * self.fastest) * self.mass)

    def length(self, change: np.ndarray) -> float:
        """Size of a correction in m."""
        size = float(np.linalg.norm(self.weight * change))
        return size if np.isfinite(size) else np.inf

    def keep(self) -> dict:
        """The static state."""
        return self.engine.placed()

    def restore(self, kept: dict) -> None:
        """Back to a state."""
        self.engine.place(0.0, **kept)

    def move(self, change: np.ndarray) -> None:
        """Move the state; slides that leave their element enter the next."""
        self.engine.move(change)
        if self.model.joints:
            self.engine.place(0.0, **self.engine.placed())

    def remember(self, fraction: float) -> None:
        """Add a state of rest to the history."""
        if fraction < 1.0:
            self.history.append(Equilibrium.of(self.scene, self, fraction))

    def newton(self, fraction: float) -> bool:
        """Newton at a load fraction, full steps.

        Corrections may grow for a while: the second order of a turn stretches what is stiff along its axis, and the
        next correction takes that back. A line search makes hundreds of small steps of it; `relax` does better.
        """
        least = np.inf
        for _ in range(self.settings.max_iterations):
            self.iterations += 1
            try:
                change = self.factor()(-self.off(fraction))
            except RuntimeError:  # an exactly singular tangent
                return False
            size = self.length(change)
            if not size < min(GROWTH * least, 10.0 * self.size):
                return False
            least = min(least, size)
            self.move(change)
            if size <= self.settings.tolerance * self.size:
                return self.on_cables()
        return False

    def on_cables(self) -> bool:
        """Whether no slide is past an end of its cable, where the last element would go on for ever."""
        ends = np.array([self.model.cables[j.cable].length * self.model.cables[j.cable].n_elements
                         for j in self.model.joints])
        s = self.engine.placed()["s"]
        past = np.maximum(-s, s - ends)
        return bool(np.all(past <= self.settings.tolerance * self.size))

    def relax(self, fraction: float) -> bool:
        """Pseudo-transient continuation: implicit Euler without regard to accuracy, its step growing as R falls
        (Kelley & Keyes 1998). It finds the stable equilibria that Newton misses: far turns of stiff cables, slack ones.
        """
        mass, near, kept = 1e-3 * self.fastest, 1e-5, self.keep()
        for _ in range(MOST_RELAXATIONS):
            self.iterations += 1
            try:
                change = self.factor(mass)(-self.off(fraction))
            except RuntimeError:
                break
            size = self.length(change)
            if not size < 0.2 * self.size:
                mass *= 10.0
                if not mass < 1e30:
                    break
                continue
            self.move(change)
            now = float(np.linalg.norm(self.off(fraction)))
            if not np.isfinite(now):
                self.restore(kept)
                mass *= 100.0
                continue
            kept = self.keep()
            mass *= 0.5 if size < 0.02 * self.size else 1.0
            if mass < 1e-10 * self.fastest or size < near * self.size:
                if self.newton(fraction):
                    return True
                self.restore(kept)
                near *= 1e-2
                if near < 1e-10:
                    break
        return False


def _solver(matrix: csc_array) -> Callable[[np.ndarray], np.ndarray]:
    if not matrix.shape[0]:
        return lambda right: right
    return splu(matrix.tocsc(), permc_spec="COLAMD").solve


def equilibrium(scene: Scene, settings: EquilibriumSettings) -> Equilibrium:
    """The scene at rest under gravity, its loads at t = 0 and its springs. Raises SceneError, EquilibriumError."""
    path = Path(scene, settings)
    reached = _follow(path) if settings.method == "arc_length" else _load(path)
    state = Equilibrium.of(scene, path, reached)
    if reached < 1.0:
        remedy = ('; take method="newton", which also relaxes, or draw the scene nearer to its rest'
                  if settings.method == "arc_length" else
                  "; smaller steps of the load do not converge either: something may be free to move away, or it is a "
                  'limit point, which method="arc_length" passes; or take more load_steps or max_iterations')
        raise EquilibriumError(
            f"no equilibrium was reached: the path from the drawn state ends at {100 * reached:.4g} % of the load"
            f"{remedy}; the state there is kept in .state", state, reached)
    return state


def _load(path: Path) -> float:
    """Load steps, halved where neither Newton nor relaxation ends; returns the fraction of the load reached."""
    reached = 0.0
    step = largest = 1.0 / path.settings.load_steps
    while reached < 1.0:
        kept, target = path.keep(), reached + step
        if target > 1.0 - SMALLEST_STEP / 2:  # a sum of steps is not 1 to the last digit
            target = 1.0
        for solve in (path.newton, path.relax):
            if solve(target):
                reached, step = target, min(2 * step, largest)
                path.remember(reached)
                break
            path.restore(kept)
        else:
            step = 0.5 * (target - reached)
            if step < SMALLEST_STEP:
                break
    return reached


def _follow(path: Path) -> float:
    """Arc-length continuation (Riks 1979; Crisfield 1981): the load fraction is an unknown more, so that limit points
    are passed; returns the fraction reached, 1 where the path got there.
    """
    reached, tangent_before = 0.0, None
    step = None
    for _ in range(MOST_PATH_STEPS):
        kept = path.keep()
        try:
            solve = path.factor()
        except RuntimeError:
            return reached
        forward = solve(-path.start)
        direction = np.append(forward * path.weight / path.size, 1.0)
        direction /= np.linalg.norm(direction)
        if tangent_before is not None and direction @ tangent_before < 0:
            direction = -direction
        step = step if step is not None else 1.0 / path.settings.load_steps * np.linalg.norm(
            np.append(forward * path.weight / path.size, 1.0))
        step = min(step, 0.5)
        while True:
            rate = step * direction[-1]
            if reached + rate >= 1.0 and path.newton(1.0):
                return 1.0
            path.restore(kept)
            fraction = _correct(path, reached, rate, forward, direction)
            if fraction is not None and fraction < 1.0:
                break
            path.restore(kept)
            step *= 0.25
            if step < 1e-8:
                return reached
        reached, tangent_before, step = fraction, direction, 1.5 * step
        path.remember(reached)
    return reached


def _correct(path: Path, reached: float, rate: float, forward: np.ndarray, direction: np.ndarray) -> float | None:
    """Predict along the tangent, then Newton in the plane normal to it; returns the new load fraction."""
    scale = path.weight / path.size
    path.move(rate * forward)
    fraction, last = reached + rate, np.inf
    for _ in range(12):
        path.iterations += 1
        try:
            solve = path.factor()
        except RuntimeError:
            return None
        by_force, by_load = solve(-path.off(fraction)), solve(-path.start)
        below = direction[:-1] @ (scale * by_load) + direction[-1]
        load = -(direction[:-1] @ (scale * by_force)) / below if below else np.inf
        change = by_force + load * by_load
        size = path.length(change)
        if not size < 2.0 * last:
            return None
        path.move(change)
        fraction, last = fraction + load, size
        if size <= 1e-6 * path.size and abs(load) <= 1e-6:
            return fraction
    return None


