"""Equilibrium: a scene's rest under its loads, by damped Newton in load steps or along the equilibrium path.

R(x) is what forces and constraints leave over. From the drawn state x0 the path R(x) = (1 - p) R(x0) leads from p = 0 to
equilibrium at p = 1: for a drawn state without stress that is loading in proportion, and any other state will do too.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from funicular.equilibrium import Equilibrium
from funicular.errors import EquilibriumError
from funicular.model import build
from funicular.scene import Scene
from funicular.settings import EquilibriumSettings
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

FULL_STEPS = 15
SMALLEST_DAMPING = 1e-3
SMALLEST_STEP = 1e-5
"""Of the load: where smaller steps do not converge either, the path has ended."""
MOST_PATH_STEPS = 2000
ROUNDING = 1e-13
"""Corrections below this part of the scene's size are what coordinates are rounded to."""


class Path:
    """The engine's static state, and the path that leads from where it was drawn."""

    def __init__(self, scene: Scene, settings: EquilibriumSettings):
        from funicular.engine import Engine

        self.scene, self.settings = scene, settings
        self.model = build(scene)
        self.engine = Engine(self.model)
        self.engine.place(0.0)
        self.start = self.residual()
        place = self.model.place
        free = place >= 0
        self.weight = np.zeros(len(self.start))  # forces and arc-lengths do not count in the size of a correction
        self.weight[place[free]] = self.model.weight[free]
        self.size = self._extent()
        self.iterations = 0

    def _extent(self) -> float:
        """The scene's size in m."""
        lengths = [cable.length * cable.n_elements for cable in self.model.cables]
        return max([*lengths, *np.abs(self.model.q[[b.configuration for b in self.model.rigids]]), 1e-30])

    def residual(self) -> np.ndarray:
        """R at the static state."""
        return self.engine.static_residual()

    def off(self, fraction: float) -> np.ndarray:
        """R - (1 - fraction) R0."""
        return self.residual() - (1.0 - fraction) * self.start

    def factor(self, inertia: float = 0.0) -> Callable[[np.ndarray], np.ndarray]:
        """Solver of the tangent, with some mass added where it is asked for."""
        return _solver(self.engine.matrix(inertia, 0.0, 1.0))

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

    def newton(self, fraction: float) -> bool:
        """Newton at a load fraction: full steps, then from the same start steps found by a line search."""
        kept = self.keep()
        if self._full_steps(fraction):
            return True
        self.restore(kept)
        return self._line_search(fraction)

    def _full_steps(self, fraction: float) -> bool:
        """Corrections may grow for a while: the second order of a turn stretches what is stiff along its axis, and the next
        correction takes that back. A line search would make many small steps of it.
        """
        least = np.inf
        for _ in range(FULL_STEPS):
            change = self._correction(fraction)
            if change is None:
                return False
            size = self.length(change)
            if not size < min(1e3 * least, 10.0 * self.size):
                return False
            least = min(least, size)
            self.move(change)
            if size <= self.settings.tolerance * self.size:
                return True
        return False

    def _correction(self, fraction: float) -> np.ndarray | None:
        """Newton's, None where the tangent is singular."""
        self.iterations += 1
        try:
            return self.factor()(-self.off(fraction))
        except RuntimeError:
            return None

    def _line_search(self, fraction: float) -> bool:
        """Newton, damped so that corrections with the same tangent shrink (Deuflhard 2011, ch. 3)."""
        damping, before = 1.0, None
        for _ in range(self.settings.max_iterations):
            self.iterations += 1
            try:
                solve = self.factor()
            except RuntimeError:
                return False
            change = solve(-self.off(fraction))
            size = self.length(change)
            if not size < np.inf:
                return False
            if before is not None:
                old, bar = before
                gap = self.length(bar - change)
                damping = min(1.0, self.length(old) * self.length(bar) / (gap * size) * damping if gap * size else 1.0)
            kept = self.keep()
            while True:
                self.move(damping * change)
                bar = solve(-self.off(fraction))
                ratio = self.length(bar) / size if size else 0.0
                if size <= self.settings.tolerance * self.size and ratio <= 1.0 and damping == 1.0:
                    return True
                if ratio < 1.0 or size <= ROUNDING * self.size:
                    break
                self.restore(kept)
                gap = self.length(bar - (1.0 - damping) * change)
                damping = min(0.5 * size * damping**2 / gap if gap else 0.0, 0.5 * damping)
                if not damping >= SMALLEST_DAMPING:
                    return False
            before = change, bar
        return False

    def relax(self, fraction: float) -> bool:
        """Pseudo-transient continuation: implicit Euler without regard to accuracy, its step growing as R falls
        (Kelley & Keyes 1998). It finds stable equilibria where Newton's tangent is singular: slack cables.
        """
        mass, first, kept = None, None, self.keep()
        for _ in range(20 * self.settings.max_iterations):
            self.iterations += 1
            if mass is None:
                stiffness = abs(self.engine.matrix(0.0, 0.0, 1.0).diagonal())
                inertia = abs(self.engine.matrix(1.0, 0.0, 0.0).diagonal())
                mass = float(np.max(stiffness[inertia > 0] / inertia[inertia > 0], initial=0.0)) * 1e-3
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
            first = first or now
            kept = self.keep()
            mass *= 0.5 if size < 0.02 * self.size else 1.0
            if mass < 1e-6 and size < 1e-3 * self.size:
                return self.newton(fraction)
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
        near = " (a limit point: beyond it no equilibrium is near)" if settings.method == "newton" else ""
        raise EquilibriumError(
            f"no equilibrium was reached: the path from the drawn state ends at {100 * reached:.4g} % of the load{near}; "
            "the state there is kept in .state", state, reached)
    return state


def _load(path: Path) -> float:
    """Load steps, halved where Newton fails; returns the fraction of the load that was reached."""
    reached, step = 0.0, 1.0 / path.settings.load_steps
    while reached < 1.0:
        kept = path.keep()
        target = min(1.0, reached + step)
        if path.newton(target):
            reached, step = target, 2.0 * step
            continue
        path.restore(kept)
        if step <= SMALLEST_STEP:
            return 1.0 if path.relax(1.0) else _back(path, kept, reached)
        step = 0.25 * (target - reached)
    return reached


def _back(path: Path, kept: dict, reached: float) -> float:
    path.restore(kept)
    return reached


def _follow(path: Path) -> float:
    """Arc-length continuation (Riks 1979; Crisfield 1981): the load fraction is an unknown more, so that limit points are
    passed; returns the fraction reached, 1 where the path got there.
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
            if fraction is not None:
                break
            path.restore(kept)
            step *= 0.25
            if step < 1e-8:
                return reached
        reached, tangent_before, step = fraction, direction, 1.5 * step
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


