"""What a model is estimated to err and to cost, from the probes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..parts.cable import Cable
from .candidates import Kind, Kinds
from .choice import Alternative
from .mesh_error import MeshError
from .probes import Probe
from .remeshing import CableModel


@dataclass(frozen=True)
class Free:
    """A cable of which something is chosen. base: elements of its coarsest mesh; fixed: those that were given, or None;
    keeps: whether its element was given.
    """

    cable: Cable
    kinds: Kinds
    base: int
    fixed: int | None
    keeps: bool = False

    @property
    def could_shear(self) -> bool:
        """Return whether it may be made of cable elements, or of beams that know shear."""
        return self.kinds.slender not in (None, self.kinds.finest)

    def model(self, kind: Kind, level: float) -> CableModel:
        """Return its model at a level of the mesh, rounded up."""
        return kind.with_elements(self.fixed or self.base * max(1, int(np.ceil(level - 1e-9))))


@dataclass(frozen=True)
class Estimate:
    """Errors and costs of models, from probes.

    mesh: the error of the finest probe's mesh; of_cable: what of it comes from each cable; shear: what cable elements
    leave out of each; time: the error of the integrator; all over the largest change of a quantity; longer: how many
    times the work of a probe a run with its models takes, whose steps are shorter;
    least: the level of the coarsest mesh that may be chosen.
    """

    mesh: MeshError
    of_cable: Mapping[str, float]
    shear: Mapping[str, float]
    time: float
    probes: Sequence[Probe]
    free: Sequence[Free]
    longer: float = 1.0
    least: int = 1

    def error(self, models: Mapping[str, CableModel]) -> float:
        """Return what models of all cables err by at most: the estimate, with what it may be off."""
        left_out = [self.shear.get(name, 0.0) for name, model in models.items()
                    if not Kind(model.element, model.law).is_beam]
        return self.time + self.mesh_error(models) + sum(left_out)

    def mesh_error(self, models: Mapping[str, CableModel]) -> float:
        """Return what of the error of models comes from their meshes."""
        levels = {each.cable.name: models[each.cable.name].elements / each.base for each in self.free
                  if each.fixed is None}
        return sum(self.of_cable[name] * self.mesh.growth(level) for name, level in levels.items())

    def cost(self, models: Mapping[str, CableModel]) -> float:
        """Return the CPU seconds of a run: those of the finest probe, by its elements, their work, and its steps."""
        probe = self.probes[-1]
        if not self.free:
            return probe.seconds * self.longer
        ratio = _work(models) / _work(probe.models)
        finer = sum(model.elements for model in models.values()) / sum(m.elements for m in probe.models.values())
        return probe.seconds * self.longer * ratio * finer ** self._growth()

    def _growth(self) -> float:
        """Return the power of the number of elements by which the steps of a run grow."""
        if len(self.probes) < 2 or not all(np.isfinite(probe.work) and probe.work > 0 for probe in self.probes[-2:]):
            return 0.5
        return float(np.clip(np.log2(self.probes[-1].work / self.probes[-2].work), 0.0, 1.0))

    def alternatives(self, models: Mapping[str, CableModel], tol: float) -> list[Alternative]:
        """Return the models that were considered of each cable, the others as chosen."""
        found = []
        for each in self.free:
            name, chosen = each.cable.name, models[each.cable.name]
            kinds = [kind for kind in (each.kinds.slender, each.kinds.finest) if kind is not None]
            for kind in dict.fromkeys(kinds):
                for elements in self._meshes(each, chosen.elements):
                    model = kind.with_elements(elements)
                    others = dict(models) | {name: model}
                    error, cost = self.error(others), self.cost(others)
                    why = ("chosen" if model == chosen else "errs by more than the tolerance" if error > tol else
                           "costs more" if cost > self.cost(models) else "no cheaper for its error")
                    found.append(Alternative(name, model, error, cost, model == chosen, why))
        return found

    def _meshes(self, each: Free, elements: int) -> list[int]:
        """Return numbers of elements around the chosen one."""
        if each.fixed is not None:
            return [elements]
        level = elements // each.base
        return sorted({each.base * max(1, level // 2), elements, 2 * elements})


def _work(models: Mapping[str, CableModel]) -> float:
    return sum(model.elements * Kind(model.element, model.law).work for model in models.values())
