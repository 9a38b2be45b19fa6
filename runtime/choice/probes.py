"""Short, cheap runs of a scene with coarse models of its cables, and the distances between them."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, TypeAlias, cast

import numpy as np

from ..errors import FunicularError, FunicularWarning
from ..parts.settings import RunSettings
from ..results.equilibrium import Equilibrium
from ..results.run import Run
from ..results.trajectories import distance, largest_change
from ..solve.notes.sensitivity import GROWTH_TEXT
from .motion import MOTION, samples
from .remeshing import CableModel, S, remade

RADAU_WORK, IMPLICIT_WORK, LINEAR_WORK, STEP_WORK, SLIDE_WORK = 7.0, 2.5, 1.0, 0.7, 0.3
"""Work of an iteration of radau, of the other implicit methods and of the linear model, and of a step of these, in
evaluations of accelerations, measured on pendulums of 4 to 64 elements of each kind: radau has three stages and a
complex system; the linear model on taut cables of 8 to 128 elements. Of a slide in a step of the linear model: of 30 on
a footbridge, and of 30 and 100 on a cable."""

ROUNDING_TOLERANCE = 1e-12
"""Part of the largest value of a quantity that rounding may change."""

OUTPUT_TIMES = 24
"""Output times of a probe, after the start."""

Key: TypeAlias = tuple[object, ...]


@dataclass(frozen=True)
class Runner(Generic[S]):
    """Functions of a scene.

    simulate: returns a run from a state of rest, or as drawn, and raises where it stops early; at_rest: returns the
    state of rest, found from one on another mesh where there is one.
    """

    simulate: Callable[[S, RunSettings, Equilibrium | None], Run]
    at_rest: Callable[[S, Equilibrium | None], Equilibrium]


@dataclass(frozen=True)
class Probe(Generic[S]):
    """A run with coarse models.

    run: None where it failed, for the reason ``failed``; sampled: the compared values (time, point, components) by
    name; seconds: of CPU; rest: the state of rest at the start, if it is one.
    """

    models: dict[str, CableModel]
    scene: S
    run: Run | None
    sampled: dict[str, np.ndarray]
    seconds: float
    failed: str = ""
    rest: Equilibrium | None = None

    @property
    def unchanged(self) -> list[str]:
        """Return the names of constant quantities, within rounding; a motion within the absolute tolerance, too."""
        allowed = 0.0 if self.run is None else self.run.report["absolute_tol"] or 0.0
        return [name for name, values in self.sampled.items()
                if not largest_change(values) > max(ROUNDING_TOLERANCE * float(np.abs(values).max(initial=0.0)),
                                                    allowed if name == MOTION else 0.0)]

    @property
    def grows(self) -> bool:
        """Return whether the run reports that small differences grow in the motion."""
        return self.run is not None and any(GROWTH_TEXT in message for message in self.run.report["messages"])

    @property
    def scales(self) -> dict[str, float]:
        """Return the scales of differences by name: the largest change, 0 for a constant quantity.

        For a constant motion it is the largest distance of a point from the first one: the shape still has an error.
        """
        unchanged = self.unchanged
        return {name: largest_change(values) if name not in unchanged else
                distance(values[0], values[:1, 0]) if name == MOTION else 0.0 for name, values in self.sampled.items()}

    @property
    def work(self) -> float:
        """Return the work of the integration in evaluations of accelerations, from counts that repeat exactly."""
        if self.run is None:
            return np.inf
        report = self.run.report
        if report["integrator"] == "explicit":
            return float(report["evaluations"])
        iterations = report.get("newton_iterations", 0)
        if report["integrator"] == "radau":
            return float(RADAU_WORK * iterations)
        steps = report["steps"]
        if report["integrator"] == "linear":
            return float(LINEAR_WORK * iterations + (STEP_WORK + SLIDE_WORK * len(self.scene.slides)) * steps)
        return float(IMPLICIT_WORK * iterations + STEP_WORK * steps)


class Prober(Generic[S]):
    """Makes each probe of a scene once, and compares probes."""

    def __init__(self, scene: S, settings: RunSettings, quantities: Sequence[str], runner: Runner[S]):
        """quantities: names of results; none stands for the motion."""
        self.scene, self.settings, self.quantities, self.runner = scene, settings, tuple(quantities), runner
        self.made: dict[Key, Probe[S]] = {}
        self.scenes: dict[Key, S] = {}
        self.rests: dict[Key, Equilibrium] = {}

    def probe(self, models: Mapping[str, CableModel], tol: float, integrator: str,
              change: Callable[[S], S] | None = None, label: str = "") -> Probe[S]:
        """Return the run with these models; change: makes another scene of it, which the label names."""
        key = (*_key(models), tol, integrator, label)
        if key not in self.made:
            self.made[key] = self._probed(dict(models), tol, integrator, change, label)
        return self.made[key]

    def _probed(self, models: dict[str, CableModel], tol: float, integrator: str,
                change: Callable[[S], S] | None, label: str) -> Probe[S]:
        begin = time.process_time()
        scene = self.scene_of(models, change, label)
        settings = RunSettings(duration=self.settings.duration, tol=tol, initial=self.settings.initial,
                               output_step=self.settings.duration / OUTPUT_TIMES, integrator=integrator)
        rest = None
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", FunicularWarning)
                if settings.initial != "drawn":
                    key = (*_key(models), label)
                    if key not in self.rests:
                        self.rests[key] = self.runner.at_rest(scene, self.last_rest)
                    rest = self.rests[key]
                    if rest.adjusted:  # the state is at rest in the scene with the values found
                        scene = cast(S, rest.scene)
                run = self.runner.simulate(scene, settings, rest)
        except FunicularError as error:
            return Probe(models, scene, None, {}, time.process_time() - begin, str(error))
        sampled = samples(scene, run, self.quantities)
        return Probe(models, scene, run, sampled, run.report["time_s"]["solve_cpu"], rest=rest)

    @property
    def last_rest(self) -> Equilibrium | None:
        """Return the last state of rest that was found, None without any."""
        return next(reversed(self.rests.values()), None)

    def scene_of(self, models: Mapping[str, CableModel], change: Callable[[S], S] | None = None, label: str = "") -> S:
        """Return the scene with these models, made once for all tolerances and integrators. Raises SceneError."""
        key = (*_key(models), label)
        if key not in self.scenes:
            scene = remade(self.scene, models)
            self.scenes[key] = scene if change is None else change(scene)
        return self.scenes[key]

    def difference(self, one: Probe[S], other: Probe[S]) -> float:
        """Return the distance of two probes: the largest one of a quantity over its scale in the second one.

        Infinite where one of them failed, or ended at another time.
        """
        if one.run is None or other.run is None:
            return np.inf
        worst, scales = 0.0, other.scales
        for name, exact in other.sampled.items():
            found = one.sampled[name]
            if len(found) != len(exact):  # a run that an event ended early
                return np.inf
            worst = max(worst, distance(found, exact) / scales[name] if scales[name] > 0 else 0.0)
        return worst


def _key(models: Mapping[str, CableModel]) -> Key:
    """Return a key of models by cable."""
    return tuple((name, models[name]) for name in sorted(models))
