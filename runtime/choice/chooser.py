"""The choice of a model for a tolerance, from short runs on coarse meshes and what they indicate.

The error of a run has three parts, which share the tolerance: that of the model (what the elements leave out), that of
the mesh, and that of time, which the integrator bounds by the tolerance that it is given.

1. Each cable gets the elements that know what the scene asks of it (`candidates`): those of a cable, or of a beam.
2. A ladder of meshes, each of half the element length, is run until the error of the next one can be extrapolated
   (`mesh_error`). On its second mesh two integrators are compared, which tells how loose the steps of the other probes
   may be (`time_error`). Meshes so close to each other that these steps hide it are run again with shorter ones.
   Where the meshes do not converge from the first on, the finest one is run with a smaller tolerance, too: if the
   cheaper integrator of the probes errs there by more than the second mesh tells, all is done again without it. What
   moves along a cable faster than its waves makes short ones: then the ladder begins with meshes that show them
   (`short_waves`).
3. With more than one cable, each is run on half of its elements, the others as they are: that tells whose mesh matters.
4. What cable elements leave out is estimated on the second mesh, from the energy of shear and the dependence of the
   motion on the bending stiffness (`indicators`).
5. Of the models whose estimated error keeps the tolerance the one with the least work is taken (`deciding`): cables, or
   beams on coarser meshes.
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
from .candidates import Kind
from .choice import Choice, of_unchanged
from .estimate import Estimate, Free
from .indicators import SOFTER, deformation, shear_compliance, softened
from .mesh_error import MeshError, mesh_error
from .motion import motion
from .probes import Probe, Prober, Runner, S
from .remeshing import CableModel, remade
from .selection import LEAST, ROUNDED, decide
from .short_waves import elements_for_waves
from .time_error import ASSUMED, DAMPING, SMALLER, InTime, compared

SHEAR_SAFETY = 2.0
"""The estimate of what shear does is low by up to that."""

NEGLIGIBLE = 0.03
"""Of the tolerance: a change of the bending stiffness by that much has no effect that counts, however it is magnified.
"""

STOUT = 0.03
"""Of its bending stiffness: where shear takes more of it, the ladder is run with beams."""

UNCLEAR = 2.0
"""Times what steps bring two probes apart: meshes that are closer are run again with shorter steps."""

MOST_ELEMENTS = 256
"""Of a cable that is chosen; a finer mesh is seldom what is wanted."""


class Chooser(Generic[S]):
    """Chooses for one scene; `choose` is its one method."""

    def __init__(self, scene: S, settings: RunSettings, quantities: Sequence[str], runner: Runner[S],
                 free: Sequence[Free]):
        """free: the cables of the scene, with what is to be chosen of them."""
        self.scene, self.settings, self.tol, self.free = scene, settings, settings.tol, list(free)
        self.prober: Prober[S] = Prober(scene, settings, quantities, runner)
        self.reasons: list[str] = []
        self.unresolved: list[str] = []
        self.least = 1
        self.time: InTime
        self.kinds = {each.cable.name: each.kinds.slender or each.kinds.finest for each in free}

    def models(self, level: float, coarse: Collection[str] = ()) -> dict[str, CableModel]:
        """Return the models of a level; coarse: cables that have half of it."""
        return {each.cable.name: each.model(self.kinds[each.cable.name],
                                            level / 2 if each.cable.name in coarse else level) for each in self.free}

    def probe(self, level: float, coarse: Collection[str] = (), soft: Collection[str] = ()) -> Probe[S]:
        """Return the probe of a level; coarse: cables that have half of it, soft: those that are `softened`."""
        change = partial(softened, names=soft) if soft else None
        return self.prober.probe(self.models(level, coarse), self.time.probe_tol, self.time.probed, change,
                                 ", ".join(soft))

    def choose(self) -> Choice[S]:
        """Return the choice. Raises SceneError where no probe runs."""
        begin = time.process_time()
        level = self._first_level()
        second = 2 * level if self._base else level
        self.time = self._in_time(second)
        if (finer := self._level_of_waves(second)) > second:
            self.least, second = finer // 2, finer
            if self.settings.integrator == AUTO:
                self.time = self.time.automatic(self.tol, f"{DAMPING} damps short waves")
        self.reasons.append(self.time.why)
        shear = self._model_errors(second)
        estimate = self._estimate(max(level, self.least), second, shear)
        taken = self._kinds_of(decide(estimate, self.tol, MOST_ELEMENTS))
        doubtful = any(probe.grows for probe in estimate.probes) or not estimate.mesh.regular
        if doubtful and taken != self.kinds:  # cables do not tell what beams err by there
            self.kinds = taken
            estimate = self._estimate(max(level, self.least), second, shear)
        return self._result(estimate, time.process_time() - begin)

    def _estimate(self, level: int, second: int, shear: dict[str, float]) -> Estimate:
        """Return the estimate of errors and costs, from a ladder of meshes of the kinds of elements that are probed."""
        mesh, levels = self._trusted_ladder(level, second)
        probes = [self.probe(at) for at in levels[-2:]]
        return Estimate(mesh, self._shares(mesh, levels), shear, self.time.error, probes, self.free, self.time.longer,
                        self.least)

    def _kinds_of(self, models: Mapping[str, CableModel]) -> dict[str, Kind]:
        """Return the kinds of elements of models, by cable."""
        return {name: Kind(model.element, model.law) for name, model in models.items()}

    def _ladder(self, level: int) -> tuple[MeshError, list[int]]:
        """Return the error of the finest mesh that was run, and the levels from coarse to fine: until the mesh that is
        needed can be extrapolated.
        """
        levels, apart = [level], []
        while self._base and 2 * levels[-1] * self._base <= MOST_ELEMENTS:
            levels.append(2 * levels[-1])
            apart.append(self._apart(levels))
            if self._suffices(mesh_error(levels, apart)):
                break
            if apart[-1] < UNCLEAR * self.time.noise and (tightened := self.time.tightened(self.tol)) is not None:
                self.time = tightened
                apart[-1] = self._apart(levels)
                if self._suffices(mesh_error(levels, apart)):
                    break
        if self.probe(levels[-1]).run is None:
            raise SceneError("choose", f"no short run of the scene ends: {self.probe(levels[-1]).failed}",
                             "run it with elements of your own choice")
        return mesh_error(levels, apart) if self._base else MeshError(level, 0.0, 1.0), levels

    def _apart(self, levels: Sequence[int]) -> float:
        """Return how far the last two levels are apart."""
        return self.prober.difference(self.probe(levels[-2]), self.probe(levels[-1]))

    def _suffices(self, mesh: MeshError) -> bool:
        """Return whether the error of a mesh can be extrapolated to the mesh that is needed, or to the finest."""
        needed = min(mesh.level_for(self.wanted), MOST_ELEMENTS / self._base)
        return bool(np.isfinite(mesh.error)) and needed <= mesh.trusted * mesh.level

    @property
    def wanted(self) -> float:
        """Return the error that the mesh may have, as long as that of the model is not known."""
        could_shear = any(each.could_shear for each in self.free)
        return max((1 - ASSUMED * could_shear) * self.tol - self.time.error, LEAST * self.tol)

    def _first_level(self) -> int:
        """Return the level of the coarsest mesh to start from: two elements at least, and able to follow a curve."""
        level = 1 if all(each.base > 1 or each.fixed for each in self.free) else 2
        while True:
            try:
                self.prober.scene_of(self.models(level))  # a coarse mesh may begin inside of what it touches
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

    def _in_time(self, level: int) -> InTime:
        """Return the integrators of the run and of probes, from runs on the mesh of a level."""
        models = self.models(level)
        rubbing = self.scene.slides, self.scene.contacts, self.scene.crossings
        rubs = any(part.friction for parts in rubbing for part in parts.values())
        return compared(lambda integrator, tol: self.prober.probe(models, tol, integrator), self.prober.difference,
                        self.settings.integrator, self.tol, rubs)

    def _level_of_waves(self, level: int) -> int:
        """Return the level of a mesh that shows the short waves of what moves fast along a cable, a power of two times
        a level; that itself where there are none.
        """
        probe = self.prober.probe(self.models(level), self.time.probe_tol, self.time.probed)
        if probe.run is None:
            return level
        beams = [each.cable.name for each in self.free if each.kinds.finest.is_beam]
        bent, found = (elements_for_waves(probe.scene, probe.run, names) for names in ((), beams))
        finer = level
        for each in self.free:
            elements, maker = found.get(each.cable.name, (0, ""))
            if elements <= probe.models[each.cable.name].elements:
                continue
            most = MOST_ELEMENTS if each.fixed is None else each.fixed
            waves = f"{maker} moves faster than the waves of the tension of {each.cable.where}, and makes short ones " \
                    f"that show from {elements} elements on"
            self.reasons.append(waves)
            if elements > most:
                self.unresolved.append(f"{waves}: they are not resolved, and what they do is not in the estimate")
                elements = bent.get(each.cable.name, (0, ""))[0]  # no mesh shows what shear adds
            while each.fixed is None and finer * each.base < elements and 2 * finer * self._base <= MOST_ELEMENTS:
                finer *= 2
        return finer

    def _trusted_ladder(self, level: int, second: int) -> tuple[MeshError, list[int]]:
        """Return the ladder, by probes whose integrator errs on its finest mesh by no more than on the second one.

        That is looked at where meshes did not converge from the first on, and where the integrator was asked for.
        """
        mesh, levels = self._ladder(level)
        asked = self.settings.integrator != AUTO
        if not asked and (self.time.probed != DAMPING or levels[-1] <= second or mesh.regular):
            return mesh, levels
        models = self.models(levels[-1])
        finest = (self.prober.probe(models, self.time.tried, AUTO) if asked else
                  self.prober.probe(models, self.time.probe_tol / SMALLER, DAMPING))
        apart = self.prober.difference(self.probe(levels[-1]), finest) / (1.0 if asked else 1 - 1 / SMALLER)
        if not self.time.distrusts(apart):
            return mesh, levels
        tells = f"on a fine mesh {self.time.probed} with tol {self.time.probe_tol:.2g} errs by {apart:.1e}"
        self.reasons.append(tells)
        if asked:
            self.time = replace(self.time, error=apart)
            return mesh, levels
        self.time = self.time.automatic(self.tol, tells)
        return self._ladder(level)

    def _model_errors(self, level: int) -> dict[str, float]:
        """Return what cable elements leave out of each cable that could be a beam, over the largest change."""
        softer: dict[str, float] = {}
        for each in self.free:
            self.reasons += [f"{each.cable.where}: {why}" for why in each.kinds.why]
            if each.fixed is not None:
                self.reasons.append(f"{each.cable.where}: {each.fixed} elements as given: the error of its mesh is not "
                                    "estimated")
            probe = self.probe(level) if each.could_shear else None
            if probe is not None and probe.run is not None:
                softer[each.cable.name] = shear_compliance(probe.scene.cables[each.cable.name], probe.run)
        moved = self._moved([name for name, by in softer.items() if by >= NEGLIGIBLE * self.tol], softer, level)
        errors = {name: SHEAR_SAFETY * by * moved[name] if name in moved else by for name, by in softer.items()}
        for name, by in softer.items():
            effect = (f"and rotary inertia soften its bending by {by:.1e}, which changes the result by about "
                      f"{errors[name]:.1e}" if name in moved else f"softens its bending by {by:.1e} alone")
            self.reasons.append(f"{self.scene.cables[name].where}: shear {effect}")
        stout = {name for name in moved if softer[name] > STOUT and errors[name] > self.tol}
        self.kinds |= {each.cable.name: each.kinds.finest for each in self.free if each.cable.name in stout}
        return errors  # meshes of stout cables err in another way

    def _moved(self, names: Sequence[str], softer: Mapping[str, float], level: int) -> dict[str, float]:
        """Return the relative change of the result by that of the bending stiffness of each of these cables.

        More than two are softened at once first: if what that changes is little enough for each, it is not told apart.
        """
        def by(soft: Sequence[str]) -> float:
            return self.prober.difference(self.probe(level, soft=soft), self.probe(level)) / (1 - SOFTER)

        if len(names) > 2:
            together = by(names)
            if SHEAR_SAFETY * together * sum(softer[name] for name in names) < ASSUMED * self.tol:
                return dict.fromkeys(names, together)
        return {name: by([name]) for name in names}

    def _shares(self, mesh: MeshError, levels: Sequence[int]) -> dict[str, float]:
        """Return what of the error of the finest probe's mesh comes from each cable: those that are alike share it.

        They are told apart on the mesh before the finest, where there are three.
        """
        groups: dict[tuple, list[str]] = {}
        for each in self.free:
            if each.fixed is None:
                alike = each.base, each.cable.length, each.cable.section, each.cable.material
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

    def _result(self, estimate: Estimate, seconds: float) -> Choice[S]:
        """Return the choice, with what it and its alternatives are estimated to err and to cost."""
        models, mesh = decide(estimate, self.tol, MOST_ELEMENTS), estimate.mesh
        error = estimate.error(models)
        kept = bool(error <= self.tol * (1 + ROUNDED)) and not self.unresolved
        if self._base:
            self.reasons.append(f"the error of {mesh.level} times the coarsest meshes is about {mesh.error:.1e}, of "
                                f"order {mesh.order:.1f} in the length of an element, at least {mesh.lowest:.1f}")
        stiff = [each.cable.where for each in self.free if self._is_stiff(each.cable, estimate.probes[-1])]
        if stiff:
            self.reasons.append(f"{', '.join(stiff)}: deforms by less than tol; a rigid or a modal body may do")
        if error > self.tol * (1 + ROUNDED):
            self.reasons.append(f"no model at hand keeps tol = {self.tol:g}: the finest is taken, which may err by "
                                f"{error:.1e}")
        unchanged = estimate.probes[-1].unchanged
        if unchanged:
            self.reasons.append(of_unchanged(unchanged))
        scene = remade(self.scene, models)
        scene.run_settings = scene.run_settings | {"duration": self.settings.duration, "tol": self.time.tol,
                                                   "integrator": self.time.integrator}
        return Choice(scene, self.tol, self.time.tol, self.time.integrator, models, error, estimate.cost(models), kept,
                      self.reasons, estimate.alternatives(models, self.tol), len(self.prober.made), seconds,
                      [each.cable.name for each in self.free if each.fixed is not None or each.keeps],
                      mesh_error=estimate.mesh_error(models), unchanged=unchanged, unresolved=self.unresolved,
                      rest=self.prober.last_rest)

    def _is_stiff(self, cable: Cable, probe: Probe[S]) -> bool:
        """Return whether a cable moves as a rigid body does, but for a part of the tolerance."""
        touched = {name for crossing in self.scene.crossings.values() for name in (crossing.a, crossing.b)}
        if probe.run is None or cable.name in touched.union(slide.along for slide in self.scene.slides.values()):
            return False
        return deformation(probe.scene.cables[cable.name], probe.run) < self.wanted * largest_change(
            motion(probe.scene, probe.run))
