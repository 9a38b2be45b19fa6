"""The choice of a model for a tolerance, from short runs on coarse meshes and what they indicate.

The error of a run has three parts, and each gets a share of the tolerance: that of the model (what the elements leave
out), that of the mesh, and that of time, which the integrator bounds by the tolerance that it is given.

1. Each cable gets the elements that know what the scene asks of it (`candidates`): those of a cable, or of a beam.
2. A ladder of meshes, each of half the element length, is run until the error of the next one can be extrapolated
   (`mesh_error`). On its second mesh two integrators are compared: generalised-alpha is the cheapest at loose
   tolerances, but estimates its error by positions alone.
3. What cable elements leave out is estimated on the second mesh, from the energy of shear and the dependence of the
   motion on the bending stiffness (`indicators`). Where it exceeds its share, the cable becomes a beam.
4. With more than one cable, each is run on half of its elements, the others as they are: that tells whose mesh matters.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import partial
from typing import Generic

import numpy as np

from ..errors import SceneError
from ..integrators import AUTO
from ..parts.cable import Cable
from ..parts.settings import RunSettings
from .choice import Choice
from .estimate import Estimate, Free
from .indicators import SOFTER, deformation, shear_compliance, softened
from .mesh_error import MeshError, mesh_error
from .motion import motion, size
from .probes import Probe, Prober, S, Simulate
from .remaking import remade

MODEL_SHARE, TIME_SHARE = 0.6, 0.5
"""Of the tolerance, at most, for what the elements leave out and for the integrator; the mesh gets what they leave."""

LEAST = 0.2
"""Of the tolerance, for the mesh at least."""

ASSUMED = 0.2
"""Of the tolerance: the error in time of the automatic choice, which is seldom more (tests/benchmarks/README.md)."""

SHEAR_SAFETY = 2.0
"""The estimate of what shear does is low by up to that."""

NEGLIGIBLE = 0.03
"""Of the tolerance: a change of the bending stiffness by that much has no effect that counts, however it is magnified.
"""

ROUNDED = 0.01
"""Of the tolerance: what an estimate may exceed it by, since numbers of elements are whole and estimates are not exact.
"""

EXTRAPOLATED = 2.0
"""How many times as fine as the finest probe a mesh may be whose error is extrapolated."""

LOOSEST = 3e-3
"""Tolerance of a probe's time integration at most."""

MOST_ELEMENTS = 256
"""Of a cable that is chosen; a finer mesh is seldom what is wanted."""

TIGHTEST = 0.05
"""Of the tolerance: where generalised-alpha needs a smaller one, what it errs by does not follow its tolerance."""

DAMPING = "genalpha"
"""The integrator that is compared with the automatic choice."""


class Chooser(Generic[S]):
    """Chooses for one scene; `choose` is its one method."""

    def __init__(self, scene: S, settings: RunSettings, quantities: Sequence[str], simulate: Simulate,
                 free: Sequence[Free]):
        """free: the cables of the scene, with what is to be chosen of them."""
        self.scene, self.settings, self.tol, self.free = scene, settings, settings.tol, list(free)
        self.prober: Prober[S] = Prober(scene, settings, quantities, simulate)
        self.probe_tol = min(settings.tol, LOOSEST)
        self.reasons: list[str] = []
        self.kinds = {each.cable.name: each.kinds.slender or each.kinds.finest for each in free}
        self.integrator, self.time_tol = settings.integrator, settings.tol
        self.of_cable = dict.fromkeys(self.kinds, 0.0)
        self.time_error = self.model_error = ASSUMED * self.tol

    def probe(self, level: float, integrator: str | None = None, coarse: str | None = None,
              soft: str | None = None) -> Probe[S]:
        """Return the probe of a level; coarse: a cable that has half of it, soft: one that is `softened`."""
        models = {each.cable.name: each.model(self.kinds[each.cable.name],
                                              level / 2 if each.cable.name == coarse else level) for each in self.free}
        change = None if soft is None else partial(softened, name=soft)
        return self.prober.probe(models, self.probe_tol, integrator or self.integrator, change, soft or "")

    def choose(self) -> Choice[S]:
        """Return the choice. Raises SceneError where no probe runs."""
        begin = time.process_time()
        levels, probes = [self._first_level()], []
        probes.append(self._first_probe(levels[0]))
        differences: list[float] = []
        while self._needs_finer(levels, differences):
            levels.append(2 * levels[-1])
            probes.append(self.probe(levels[-1]))
            differences.append(self.prober.difference(probes[-2], probes[-1]))
        if probes[-1].run is None:
            raise SceneError("choose", f"no short run of the scene ends: {probes[-1].failed}",
                             "run it with elements of your own choice")
        mesh = self._mesh_error(levels, differences)
        model_errors = self._model_errors(levels[min(1, len(levels) - 1)])
        chosen = self._levels(mesh, levels)
        return self._result(mesh, chosen, model_errors, probes, time.process_time() - begin)

    @property
    def wanted(self) -> float:
        """Return the error that the mesh may have."""
        return self.tol - self.time_error - self.model_error

    def _first_level(self) -> int:
        """Return the level of the coarsest mesh to start from: two elements at least, and able to follow a curve."""
        level = 1 if all(each.base > 1 or each.fixed for each in self.free) else 2
        while True:
            try:
                remade(self.scene, {each.cable.name: each.model(self.kinds[each.cable.name], level)
                                    for each in self.free})
            except SceneError:
                if 2 * level * self._base > MOST_ELEMENTS:
                    raise
                level *= 2
            else:
                return level

    @property
    def _base(self) -> int:
        """Return the largest number of elements of a coarsest mesh that is not fixed; 0 where all are."""
        return max((each.base for each in self.free if each.fixed is None), default=0)

    def _first_probe(self, level: int) -> Probe[S]:
        """Return the probe of the coarsest mesh, by the cheaper integrator of those that agree on it."""
        if self.settings.integrator != AUTO:
            self.reasons.append(f"integrator {self.settings.integrator}: as asked for")
            return self.probe(level)
        found, other = self.probe(level, AUTO), self.probe(level, DAMPING)
        apart = self.prober.difference(other, found)
        allowed = min(TIME_SHARE * self.tol * self.probe_tol / max(apart, 1e-300), self.tol)
        work = other.work * np.sqrt(max(self.probe_tol / allowed, 1.0))  # of second order
        if found.run is None or allowed < TIGHTEST * self.tol or work >= found.work:
            why = "is no cheaper" if np.isfinite(apart) else "fails"
            self.reasons.append(f"integrator {AUTO}, by stiffness and tolerance: {DAMPING}, whose error on the "
                                f"coarsest mesh is {apart:.1e}, {why}")
            return found
        self.integrator, self.time_tol = DAMPING, allowed
        self.time_error = apart * allowed / self.probe_tol
        self.reasons.append(f"integrator {DAMPING} with tol {allowed:.2g}: on the coarsest mesh within {apart:.1e} of "
                            f"the automatic choice ({found.run.report['integrator']}), for {work / found.work:.2g} of "
                            "its work")
        if allowed >= self.probe_tol:
            return other
        self.probe_tol = allowed
        return self.probe(level)

    def _mesh_error(self, levels: Sequence[int], differences: Sequence[float]) -> MeshError:
        """Return the error of the last mesh; none where all meshes are fixed."""
        return mesh_error(levels, differences) if self._base else MeshError(levels[-1], 0.0, 1.0)

    def _needs_finer(self, levels: Sequence[int], differences: Sequence[float]) -> bool:
        """Return whether a finer mesh has to be run: the one that is needed cannot be extrapolated yet."""
        if not self._base or 2 * levels[-1] * self._base > MOST_ELEMENTS:
            return False
        mesh = mesh_error(levels, differences)
        return not differences or mesh.level_for(self.wanted) > EXTRAPOLATED * mesh.level

    def _model_errors(self, level: int) -> dict[str, float]:
        """Return what cable elements leave out of each cable, over the largest change; cables that need it get beams.
        """
        errors = {}
        for each in self.free:
            name, kinds = each.cable.name, each.kinds
            self.reasons += [f"{each.cable.where}: {why}" for why in kinds.why]
            if kinds.slender is None or kinds.slender == kinds.finest:
                continue
            probe = self.probe(level)
            if probe.run is None:
                continue
            softer = shear_compliance(probe.scene.cables[name], probe.run)
            if softer < NEGLIGIBLE * self.tol:
                errors[name] = softer
                self.reasons.append(f"{each.cable.where}: shear softens its bending by {softer:.1e} alone")
                continue
            moved = self.prober.difference(self.probe(level, soft=name), probe) / (1 - SOFTER)
            errors[name] = SHEAR_SAFETY * softer * moved
            self.reasons.append(f"{each.cable.where}: shear and rotary inertia soften its bending by {softer:.1e}, "
                                f"which changes the result by about {errors[name]:.1e}")
        most = min(MODEL_SHARE * self.tol, (1 - LEAST) * self.tol - self.time_error)
        while sum(errors[name] for name in errors if not self.kinds[name].is_beam) > most:
            worst = max((name for name in errors if not self.kinds[name].is_beam), key=errors.__getitem__)
            self.kinds[worst] = next(each.kinds.finest for each in self.free if each.cable.name == worst)
        self.model_error = sum(errors[name] for name in errors if not self.kinds[name].is_beam)
        return errors

    def _levels(self, mesh: MeshError, levels: Sequence[int]) -> dict[str, float]:
        """Return the level of each cable's mesh: for the error that it adds, and the work that its elements are."""
        wanted, free = self.wanted, [each for each in self.free if each.fixed is None]
        if len(free) < 2 or len(levels) < 2:
            self.of_cable = {each.cable.name: mesh.error / max(len(free), 1) for each in free}
            return dict.fromkeys(self.kinds, float(np.clip(mesh.level_for(wanted), 1.0, self._finest)))
        fine, shares = self.probe(levels[-1]), {}
        for each in free:
            apart = self.prober.difference(self.probe(levels[-1], coarse=each.cable.name), fine)
            shares[each.cable.name] = min(apart / (2**mesh.order - 1), mesh.error)
        work = [each.base * self.kinds[each.cable.name].work for each in free]
        found = mesh.level / balanced([shares[each.cable.name] for each in free], work, mesh.order, wanted)
        self.of_cable = shares
        self.reasons.append("of the mesh's error come " + ", ".join(
            f"{share:.1e} from {name}" for name, share in shares.items()))
        return dict.fromkeys(self.kinds, 1.0) | {
            each.cable.name: float(np.clip(level, 1.0, self._finest)) for each, level in zip(free, found, strict=True)}

    @property
    def _finest(self) -> float:
        """Return the level of the finest mesh that is chosen."""
        return max(1.0, MOST_ELEMENTS / max(self._base, 1))

    def _result(self, mesh: MeshError, chosen: dict[str, float], model_errors: dict[str, float],
                probes: Sequence[Probe[S]], seconds: float) -> Choice[S]:
        """Return the choice, with what it and its alternatives are estimated to err and to cost."""
        estimate = Estimate(mesh, self.of_cable, model_errors, self.time_error, probes, self.free)
        models = {each.cable.name: each.model(self.kinds[each.cable.name], chosen[each.cable.name])
                  for each in self.free}
        error = estimate.error(models)
        kept = error <= self.tol * (1 + ROUNDED)
        if self._base:
            self.reasons.append(f"the error of {mesh.level} times the coarsest meshes is about {mesh.error:.1e}, of "
                                f"order {mesh.order:.1f} in the length of an element")
        if not kept:
            self.reasons.append(f"no model at hand keeps tol = {self.tol:g}: the finest is taken, which errs by about "
                                f"{error:.1e}")
        scene = remade(self.scene, models)
        scene.run_settings = scene.run_settings | {"duration": self.settings.duration, "tol": self.time_tol,
                                                   "integrator": self.integrator}
        stiff = [each.cable.where for each in self.free if self._is_stiff(each.cable, probes[-1])]
        if stiff:
            self.reasons.append(f"{', '.join(stiff)}: deforms by less than tol; a rigid or a modal body may do")
        return Choice(scene, self.tol, self.time_tol, self.integrator, models, error, estimate.cost(models), kept,
                      self.reasons, estimate.alternatives(models, self.tol), len(self.prober.made), seconds)

    def _is_stiff(self, cable: Cable, probe: Probe[S]) -> bool:
        """Return whether a cable moves as a rigid body does, but for a part of the tolerance."""
        if probe.run is None or any(slide.along == cable.name for slide in self.scene.slides.values()):
            return False
        return deformation(probe.scene.cables[cable.name], probe.run) < self.wanted * size(
            motion(probe.scene, probe.run))


def balanced(errors: Sequence[float], work: Sequence[float], order: float, wanted: float) -> np.ndarray:
    """Return by what the elements of each mesh may be longer, for the least work at which the errors add up to wanted.

    errors: of meshes, each ~ length to the power of order; work: of their elements. By Lagrange's multiplier the length
    is ~ (work / error)^(1 / (order + 1)).
    """
    e, w = np.maximum(errors, 1e-3 * max(max(errors), 1e-300)), np.asarray(work, dtype=float)
    total = float(np.sum(e ** (1 / (order + 1)) * w ** (order / (order + 1))))
    return (wanted / total) ** (1 / order) * (w / e) ** (1 / (order + 1))
