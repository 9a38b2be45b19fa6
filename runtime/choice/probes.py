"""Short, cheap runs of a scene with coarse models of its cables, and how far apart they are."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar, cast

import numpy as np

from ..errors import FunicularError, FunicularWarning
from ..parts.scene_methods import SceneMethods
from ..parts.settings import RunSettings
from ..results.equilibrium import Equilibrium
from ..results.run import Run
from ..results.trajectories import distance, largest_change
from ..solve.notes.sensitivity import GROWTH_TEXT
from .motion import MOTION, samples
from .remeshing import CableModel, remade

S = TypeVar("S", bound=SceneMethods)


@dataclass(frozen=True)
class Runner(Generic[S]):
    """What runs a scene, from a state of rest or as drawn, and raises where the run stops early; and what finds that
    state, from one on another mesh where that is at hand.
    """

    simulate: Callable[[S, RunSettings, Equilibrium | None], Run]
    at_rest: Callable[[S, Equilibrium | None], Equilibrium]


RADAU, IMPLICIT, STEP = 7.0, 2.5, 0.7
"""Work of an iteration of radau, and of the other implicit methods, and of a step of these, in evaluations of
accelerations, as measured on pendulums of 4 to 64 elements of each kind: radau has three stages and a complex system.
"""

ROUNDED = 1e-12
"""Of its largest value: what rounding may change of a quantity."""

INSTANTS = 24
"""Output times of a probe, after the start."""


@dataclass(frozen=True)
class Probe(Generic[S]):
    """A run with coarse models: the scene, what is compared (time, ...) by name, CPU seconds, and steps.

    run: None where the run failed, which failed tells; rest: the state that it starts from, where that is one of rest.
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
        """Return the names of what stays as it is, but for rounding, and a motion for what its steps may err by."""
        allowed = 0.0 if self.run is None else self.run.report["absolute_tol"] or 0.0
        return [name for name, values in self.sampled.items()
                if not largest_change(values) > max(ROUNDED * float(np.abs(values).max(initial=0.0)),
                                                    allowed if name == MOTION else 0.0)]

    @property
    def grows(self) -> bool:
        """Return whether its run says that small differences grow in the motion."""
        return self.run is not None and any(GROWTH_TEXT in message for message in self.run.report["messages"])

    @property
    def scales(self) -> dict[str, float]:
        """Return what differences are taken over, by name: the largest change; 0 of what stays as it is.

        Of a motion that is none it is the largest distance of a point from the first one: the shape still errs.
        """
        still = {name: self._extent(values) if name == MOTION else 0.0 for name, values in self.sampled.items()
                 if name in self.unchanged}
        return {name: largest_change(values) for name, values in self.sampled.items()} | still

    @staticmethod
    def _extent(points: np.ndarray) -> float:
        """Return the largest distance at the start of a point (time, point, 3) from the first one, m."""
        return distance(points[0], points[:1, 0])

    @property
    def work(self) -> float:
        """Return the work of its integration, in evaluations of accelerations; by counts, that are the same each time.
        """
        if self.run is None:
            return np.inf
        report = self.run.report
        iterations = report.get("newton_iterations", 0)
        if report["integrator"] == "explicit":
            return float(report["evaluations"])
        if report["integrator"] == "radau":
            return RADAU * iterations
        return IMPLICIT * iterations + STEP * report["steps"]


class Prober(Generic[S]):
    """Makes probes of a scene, each once, and compares them."""

    def __init__(self, scene: S, settings: RunSettings, quantities: Sequence[str], runner: Runner[S]):
        """quantities: names of results; none stands for the motion."""
        self.scene, self.settings, self.quantities, self.runner = scene, settings, tuple(quantities), runner
        self.made: dict[tuple, Probe[S]] = {}
        self.scenes: dict[tuple, S] = {}
        self.rests: dict[tuple, Equilibrium] = {}
        self.seconds = 0.0

    def probe(self, models: Mapping[str, CableModel], tol: float, integrator: str,
              change: Callable[[S], S] | None = None, label: str = "") -> Probe[S]:
        """Return the run with these models; change: makes another scene of it, label: the name of that."""
        key = (*_key(models), tol, integrator, label)
        if key not in self.made:
            self.made[key] = self._probed(dict(models), tol, integrator, change, label)
        return self.made[key]

    def _probed(self, models: dict[str, CableModel], tol: float, integrator: str,
                change: Callable[[S], S] | None, label: str) -> Probe[S]:
        begin = time.process_time()
        scene = self.scene_of(models, change, label)
        settings = RunSettings(duration=self.settings.duration, tol=tol, output_step=self.settings.duration / INSTANTS,
                               initial=self.settings.initial, integrator=integrator)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", FunicularWarning)
                rest = self._rest(scene, models, label)
                if rest is not None and rest.adjusted:  # the state is at rest in the scene with the values found
                    scene = cast(S, rest.scene)
                run = self.runner.simulate(scene, settings, rest)
        except FunicularError as error:
            self.seconds += time.process_time() - begin
            return Probe(models, scene, None, {}, time.process_time() - begin, str(error))
        sampled = samples(scene, run, self.quantities)
        self.seconds += time.process_time() - begin
        return Probe(models, scene, run, sampled, run.report["time_s"]["solve_cpu"], rest=rest)

    def _rest(self, scene: S, models: Mapping[str, CableModel], label: str) -> Equilibrium | None:
        """Return the state of rest that runs of a scene start from, found once, where they do not start as drawn."""
        if self.settings.initial == "drawn":
            return None
        key = (*_key(models), label)
        if key not in self.rests:
            self.rests[key] = self.runner.at_rest(scene, self.last_rest)
        return self.rests[key]

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
        """Return how far two probes are apart: the largest distance of a quantity over its own largest change.

        The change is that of the second one, see `Probe.scales`; infinite where one of them failed.
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


def _key(models: Mapping[str, CableModel]) -> tuple:
    """Return what tells models from others."""
    return tuple((name, models[name]) for name in sorted(models))
