"""The choice of a model for a tolerance, from short runs on coarse meshes and their indicators.

The error of a run has three parts, which share the tolerance: the error of the model (deformations that its elements
leave out), that of the mesh, and that of time, which the integrator bounds by its own tolerance.

1. Each cable gets the elements that suit the scene (`candidates`): those of a cable, or of a beam.
2. Meshes, each of half the element length, are run until the error of the needed one can be extrapolated
   (`mesh_error`). On the second mesh two integrators are compared, which gives the tolerance of the other probes
   (`time_error`). Meshes whose difference is hidden by the error of these steps are run again with shorter ones. Where
   the meshes do not converge from the first on, the finest one is run with a smaller tolerance, too: if the cheaper
   integrator errs there by more than on the second mesh, all is done again without it. Points that move along a cable
   faster than its waves make short waves: then the first mesh is one that shows them (`indicators`).
3. With more than one cable, each is run on half of its elements, the others as they are, for its part of the error.
4. The error of cable elements is estimated on the second mesh, from the energy of shear and the influence of the
   bending stiffness on the motion (`indicators`).
5. Ropes keep their meshes: the error of these is the change of the finest probe with finer ropes.
6. Of the models whose estimated error keeps the tolerance the one with the least work is taken (`estimate`).
"""

from __future__ import annotations

import time
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Generic

import numpy as np

from ..errors import SceneError
from ..integrators import AUTO
from ..parts.cable import Cable
from ..parts.settings import RunSettings
from ..results.trajectories import largest_change
from .candidates import Free
from .choice import Choice, of_unchanged
from .estimate import MIN_MESH_SHARE, TOLERANCE_EXCESS, Estimate
from .indicators import BENDING_RATIO, deformation, elements_for_waves, shear_compliance, softened
from .mesh_error import MeshError, mesh_error
from .motion import motion
from .probes import Key, Probe, Prober, Runner
from .remeshing import CableModel, S, remade, with_finer_ropes
from .time_error import ASSUMED_ERROR, DAMPING, FINEST_TOL_RATIO, InTime, compared

SHEAR_SAFETY = 2.0
"""Safety factor of the estimated effect of shear."""

NEGLIGIBLE_SOFTENING = 0.03
"""Change of the bending stiffness, over the tolerance, without effect on the choice, however it is magnified."""

STOUT_SOFTENING = 0.03
"""Part of its bending stiffness that shear takes from a cable above which the meshes are run with beams."""

CLEAR_DIFFERENCE = 2.0
"""Ratio of the distance of two meshes to that due to their steps below which they are run with shorter steps."""

MAX_ELEMENTS = 256
"""Elements of a chosen cable."""


class Chooser(Generic[S]):
    """Chooses for one scene; `choose` is its one method."""

    def __init__(self, scene: S, settings: RunSettings, quantities: Sequence[str], runner: Runner[S],
                 free: Sequence[Free]):
        """free: the cables of the scene with their possible models."""
        self.scene, self.settings, self.tol, self.free = scene, settings, settings.tol, list(free)
        self.prober: Prober[S] = Prober(scene, settings, quantities, runner)
        self.reasons: list[str] = []
        self.unresolved: list[str] = []
        self.least = 1
        self.time: InTime
        self.kinds = {each.cable.name: each.cheapest for each in free}
        self.base = max((each.base for each in free if each.fixed is None), default=0)
        """The largest number of elements of a coarsest mesh that is free; 0 without any."""

    def models(self, level: float, coarse: Collection[str] = ()) -> dict[str, CableModel]:
        """Return the models of a level; coarse: cables of half the level."""
        return {each.cable.name: each.model(self.kinds[each.cable.name],
                                            level / 2 if each.cable.name in coarse else level) for each in self.free}

    def probe(self, level: float, coarse: Collection[str] = (), soft: Collection[str] = ()) -> Probe[S]:
        """Return the probe of a level; coarse: cables of half the level, soft: those that are `softened`."""
        change = partial(softened, names=soft) if soft else None
        return self.prober.probe(self.models(level, coarse), self.time.probe_tol, self.time.probed, change,
                                 ", ".join(soft))

    def choose(self) -> Choice[S]:
        """Return the choice. Raises SceneError where no probe runs."""
        begin = time.process_time()
        level = self._first_level()
        second = 2 * level if self.base else level
        models = self.models(second)
        self.time = compared(lambda integrator, tol: self.prober.probe(models, tol, integrator), self.prober.difference,
                             self.settings.integrator, self.tol,
                             any(getattr(part, "friction", None) for part in self.scene.parts()))
        if (finer := self._level_of_waves(second)) > second:
            self.least, second = finer // 2, finer
            if self.settings.integrator == AUTO:
                self.time = self.time.automatic(self.tol, f"{DAMPING} damps short waves")
        self.reasons.append(self.time.why)
        shear = self._model_errors(second)
        estimate = self._estimate(max(level, self.least), second, shear)
        decided = estimate.decide(self.tol, MAX_ELEMENTS)
        taken = {name: model.of(0) for name, model in decided.items()}
        doubtful = any(probe.grows for probe in estimate.probes) or not estimate.mesh.regular
        if doubtful and taken != self.kinds:  # cables do not show the error of beams there
            self.kinds = taken
            estimate = self._estimate(max(level, self.least), second, shear)
            decided = estimate.decide(self.tol, MAX_ELEMENTS)
        return self._result(estimate, decided, time.process_time() - begin)

    def _estimate(self, level: int, second: int, shear: dict[str, float]) -> Estimate:
        """Return the estimate of errors and costs, from meshes of the elements that are probed."""
        mesh, levels = self._trusted_ladder(level, second)
        probes = [self.probe(at) for at in levels[-2:]]
        return Estimate(mesh, self._shares(mesh, levels), shear, self.time.error, probes, self.free,
                        self.time.work_ratio, self.least)

    def _ladder(self, level: int) -> tuple[MeshError, list[int]]:
        """Return the error of the finest mesh that was run, and the levels from coarse to fine.

        The last one is the first from which the error of the needed mesh can be extrapolated.
        """
        levels, apart = [level], list[float]()
        while self.base and 2 * levels[-1] * self.base <= MAX_ELEMENTS:
            levels.append(2 * levels[-1])
            apart.append(self._apart(levels))
            if self._suffices(mesh_error(levels, apart)):
                break
            if apart[-1] < CLEAR_DIFFERENCE * self.time.noise and (tight := self.time.tightened(self.tol)) is not None:
                self.time = tight
                apart[-1] = self._apart(levels)
                if self._suffices(mesh_error(levels, apart)):
                    break
        if self.probe(levels[-1]).run is None:
            raise SceneError("choose", f"no short run of the scene ends: {self.probe(levels[-1]).failed}",
                             "run it with elements of your own choice")
        return mesh_error(levels, apart) if self.base else MeshError(level, 0.0, 1.0), levels

    def _apart(self, levels: Sequence[int]) -> float:
        """Return the distance of the last two levels."""
        return self.prober.difference(self.probe(levels[-2]), self.probe(levels[-1]))

    def _suffices(self, mesh: MeshError) -> bool:
        """Return whether the error of a mesh can be extrapolated to the needed mesh, or to the finest."""
        needed = min(mesh.level_for(self.wanted), MAX_ELEMENTS / self.base)
        return bool(np.isfinite(mesh.error)) and needed <= mesh.trusted * mesh.level

    @property
    def wanted(self) -> float:
        """Return the error allowed for the mesh before the error of the model is known."""
        could_shear = any(each.could_shear for each in self.free)
        return max((1 - ASSUMED_ERROR * could_shear) * self.tol - self.time.error, MIN_MESH_SHARE * self.tol)

    def _first_level(self) -> int:
        """Return the level of the first mesh: two elements at least, and fine enough to follow a curve."""
        level = 1 if all(each.base > 1 or each.fixed for each in self.free) else 2
        while True:
            try:
                self.prober.scene_of(self.models(level))  # a coarse mesh may start inside a surface
            except SceneError:
                if 2 * level * self.base > MAX_ELEMENTS:
                    raise
                level *= 2
            else:
                return level

    def _level_of_waves(self, level: int) -> int:
        """Return the level of a mesh that shows the short waves of fast points, a power of two times a level.

        It is the level itself where there are none.
        """
        probe = self.probe(level)
        if probe.run is None:
            return level
        beams = [each.cable.name for each in self.free if each.finest.shears]
        bent, found = (elements_for_waves(probe.scene, probe.run, names) for names in ((), beams))
        finer = level
        for each in self.free:
            name = each.cable.name
            elements, source = found.get(name, (0, ""))
            if elements <= probe.models[name].elements:
                continue
            waves = f"{source} moves faster than the waves of the tension of {each.cable.where}, and makes short " \
                    f"waves, which a mesh of {elements} elements or more shows"
            self.reasons.append(waves)
            if elements > (MAX_ELEMENTS if each.fixed is None else each.fixed):
                self.unresolved.append(f"{waves}: they are not resolved, and their effect is not in the estimate")
                elements, _ = bent.get(name, (0, ""))  # no mesh shows the part of shear
            while each.fixed is None and finer * each.base < elements and 2 * finer * self.base <= MAX_ELEMENTS:
                finer *= 2
        return finer

    def _trusted_ladder(self, level: int, second: int) -> tuple[MeshError, list[int]]:
        """Return the ladder, by an integrator that errs on its finest mesh by no more than on the second one.

        This is tested where meshes did not converge from the first on, and where the integrator was asked for.
        """
        mesh, levels = self._ladder(level)
        asked = self.settings.integrator != AUTO
        if not asked and (self.time.probed != DAMPING or levels[-1] <= second or mesh.regular):
            return mesh, levels
        models = self.models(levels[-1])
        finest = (self.prober.probe(models, self.time.tried, AUTO) if asked else
                  self.prober.probe(models, self.time.probe_tol / FINEST_TOL_RATIO, DAMPING))
        apart = self.prober.difference(self.probe(levels[-1]), finest) / (1.0 if asked else 1 - 1 / FINEST_TOL_RATIO)
        if not self.time.distrusts(apart):
            return mesh, levels
        reason = f"on a fine mesh {self.time.probed} with tol {self.time.probe_tol:.2g} errs by {apart:.1e}"
        self.reasons.append(reason)
        if asked:
            self.time = replace(self.time, error=apart)
            return mesh, levels
        self.time = self.time.automatic(self.tol, reason)
        return self._ladder(level)

    def _model_errors(self, level: int) -> dict[str, float]:
        """Return the error of cable elements in each cable that could be a beam, over the largest change."""
        softer: dict[str, float] = {}
        for each in self.free:
            self.reasons += [f"{each.cable.where}: {why}" for why in each.why]
            if each.fixed is not None:
                self.reasons.append(f"{each.cable.where}: {each.fixed} elements as given: the error of its mesh is not "
                                    "estimated")
            probe = self.probe(level) if each.could_shear else None
            if probe is not None and probe.run is not None:
                softer[each.cable.name] = shear_compliance(probe.scene.cables[each.cable.name], probe.run)
        moved = self._moved([name for name, by in softer.items() if by >= NEGLIGIBLE_SOFTENING * self.tol], softer,
                            level)
        errors = {name: SHEAR_SAFETY * by * moved[name] if name in moved else by for name, by in softer.items()}
        for name, by in softer.items():
            effect = (f"and rotary inertia soften its bending by {by:.1e}, which changes the result by about "
                      f"{errors[name]:.1e}" if name in moved else f"softens its bending by {by:.1e} alone")
            self.reasons.append(f"{self.scene.cables[name].where}: shear {effect}")
        self.kinds |= {each.cable.name: each.finest for each in self.free  # meshes of stout cables err in another way
                       if each.cable.name in moved and softer[each.cable.name] > STOUT_SOFTENING
                       and errors[each.cable.name] > self.tol}
        return errors

    def _moved(self, names: Sequence[str], softer: Mapping[str, float], level: int) -> dict[str, float]:
        """Return the relative change of the result by that of the bending stiffness of each of these cables.

        More than two are first softened together: a change that is small enough for each is not divided further.
        """
        def by(soft: Sequence[str]) -> float:
            return self.prober.difference(self.probe(level, soft=soft), self.probe(level)) / (1 - BENDING_RATIO)

        if len(names) > 2:
            together = by(names)
            if SHEAR_SAFETY * together * sum(softer[name] for name in names) < ASSUMED_ERROR * self.tol:
                return dict.fromkeys(names, together)
        return {name: by([name]) for name in names}

    def _shares(self, mesh: MeshError, levels: Sequence[int]) -> dict[str, float]:
        """Return the part of each cable in the error of the finest probe's mesh; equal cables share theirs.

        The parts are found on the mesh before the finest, where there are three.
        """
        groups: dict[Key, list[str]] = {}
        for each in self.free:
            if each.fixed is None:
                alike = each.base, each.cable.length, each.cable.uniform_pieces
                groups.setdefault(alike, []).append(each.cable.name)
        shares = dict.fromkeys(self.kinds, 0.0)
        level = levels[-2] if len(levels) > 2 else levels[-1]
        for names in groups.values():
            apart = mesh.error
            if len(groups) > 1:
                coarse = self.prober.difference(self.probe(level, coarse=tuple(names)), self.probe(level))
                apart = min(coarse / (2**mesh.order - 1) * (level / levels[-1]) ** mesh.order, mesh.error)
                self.reasons.append(f"{', '.join(names)}: adds {apart:.1e} to the error of the mesh")
            shares |= dict.fromkeys(names, apart / len(names))
        return shares

    def _result(self, estimate: Estimate, models: dict[str, CableModel], seconds: float) -> Choice[S]:
        """Return the choice, with estimated errors and costs of it and of its alternatives."""
        of_ropes = self._error_of_ropes(estimate.probes[-1])
        error, mesh = estimate.error(models) + of_ropes, estimate.mesh
        kept = bool(error <= self.tol * (1 + TOLERANCE_EXCESS))
        if self.base:
            self.reasons.append(f"the error of {mesh.level} times the coarsest meshes is about {mesh.error:.1e}, of "
                                f"order {mesh.order:.1f} in the length of an element, at least {mesh.lowest:.1f}")
        stiff = [each.cable.where for each in self.free if self._is_stiff(each.cable, estimate.probes[-1])]
        if stiff:
            self.reasons.append(f"{', '.join(stiff)}: deforms by less than tol; a rigid or a modal body may do")
        if not kept and estimate.error(models) <= self.tol * (1 + TOLERANCE_EXCESS):
            self.reasons.append(f"the meshes of ropes do not keep tol = {self.tol:g}: give their spans more elements")
        elif not kept:
            self.reasons.append(f"no model at hand keeps tol = {self.tol:g}: the finest is taken, which may err by "
                                f"{error:.1e}")
        unchanged = estimate.probes[-1].unchanged
        if unchanged:
            self.reasons.append(of_unchanged(unchanged))
        scene = remade(self.scene, models)
        scene.run_settings = scene.run_settings | {"duration": self.settings.duration, "tol": self.time.tol,
                                                   "integrator": self.time.integrator}
        return Choice(scene, self.tol, self.time.tol, self.time.integrator, models, error, estimate.cost(models),
                      kept and not self.unresolved, self.reasons, estimate.alternatives(models, self.tol),
                      len(self.prober.made), seconds,
                      [each.cable.name for each in self.free if each.fixed is not None or each.keeps],
                      mesh_error=estimate.mesh_error(models) + of_ropes, unchanged=unchanged,
                      unresolved=self.unresolved, rest=self.prober.last_rest)

    def _error_of_ropes(self, probe: Probe[S]) -> float:
        """Return the error of the meshes of ropes, which stay as given, from a run of `Rope.refined`."""
        if not self.scene.ropes:
            return 0.0
        finer = self.prober.probe(probe.models, self.time.probe_tol, self.time.probed, with_finer_ropes, "finer ropes")
        apart = self.prober.difference(probe, finer)
        names = ", ".join(self.scene.ropes)
        if not np.isfinite(apart):
            self.unresolved.append(f"the error of the meshes of {names} is not estimated: with twice the elements "
                                   f"{finer.failed or 'the run ends at another time'}")
            return 0.0
        counts = "; ".join(f"{rope.name}: {', '.join(map(str, rope.elements_of_spans))}"
                           for rope in self.scene.ropes.values())
        halved = [name for rope in self.scene.ropes.values() for name in rope.zones_halved]
        self.reasons.append(f"elements of the spans of ropes as given ({counts}): with elements of half the length and "
                            f"twice the zones{', half of them on ' * bool(halved)}{', '.join(halved)} the result "
                            f"changes by {apart:.1e}")
        return apart

    def _is_stiff(self, cable: Cable, probe: Probe[S]) -> bool:
        """Return whether a cable moves as a rigid body, within a part of the tolerance."""
        crossing = {name for crossing in self.scene.crossings.values() for name in (crossing.a, crossing.b)}
        if probe.run is None or cable.name in crossing.union(slide.along for slide in self.scene.slides.values()):
            return False
        return deformation(probe.scene.cables[cable.name], probe.run) < self.wanted * largest_change(
            motion(probe.scene, probe.run))
