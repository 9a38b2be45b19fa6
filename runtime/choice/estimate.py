"""Estimated errors and costs of models, from the short runs, and the decision between them.

Of the models whose estimated error keeps the tolerance, the one with the least work is taken.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .candidates import Free
from .choice import Alternative
from .mesh_error import MeshError
from .probes import Probe
from .remeshing import CableModel

MIN_MESH_SHARE = 0.15
"""Part of the tolerance that the error of the mesh has at least."""

EQUAL_ERROR_RATIO = 1.1
"""Ratio to the least error up to which models are equally good where none keeps the tolerance."""

TOLERANCE_EXCESS = 0.01
"""Part of the tolerance by which an estimate may exceed it, since numbers of elements are whole."""


@dataclass(frozen=True)
class Estimate:
    """Errors and costs of models, from probes.

    mesh: the error of the finest probe's mesh; of_cable: the part of it due to each cable; shear: the error of cable
    elements in each; time: the error of the integrator; all over the largest change of a quantity; work_ratio: the work
    of a run over that of a probe with its models; least: the level of the coarsest mesh that may be chosen.
    """

    mesh: MeshError
    of_cable: Mapping[str, float]
    shear: Mapping[str, float]
    time: float
    probes: Sequence[Probe[Any]]
    free: Sequence[Free]
    work_ratio: float = 1.0
    least: int = 1

    def error(self, models: Mapping[str, CableModel]) -> float:
        """Return an upper estimate of the error of models of all cables."""
        left_out = [self.shear.get(name, 0.0) for name, model in models.items() if not model.shears]
        return self.time + self.mesh_error(models) + sum(left_out)

    def mesh_error(self, models: Mapping[str, CableModel]) -> float:
        """Return the part of the error of models that is due to their meshes."""
        levels = {each.cable.name: models[each.cable.name].elements / each.base for each in self.free
                  if each.fixed is None}
        return sum(self.of_cable[name] * self.mesh.growth(level) for name, level in levels.items())

    def cost(self, models: Mapping[str, CableModel]) -> float:
        """Return the CPU seconds of a run, from those of the finest probe, the work of its elements and its steps."""
        probe = self.probes[-1]
        if not self.free:
            return probe.seconds * self.work_ratio
        growth, work = 0.5, [each.work for each in self.probes[-2:]]  # growth: power of elements in the number of steps
        if len(work) == 2 and all(np.isfinite(each) and each > 0 for each in work):
            growth = float(np.clip(np.log2(work[1] / work[0]), 0.0, 1.0))
        ratio = sum(model.work for model in models.values()) / sum(model.work for model in probe.models.values())
        finer = sum(model.elements for model in models.values()) / sum(m.elements for m in probe.models.values())
        return float(probe.seconds * self.work_ratio * ratio * finer**growth)

    def alternatives(self, models: Mapping[str, CableModel], tol: float) -> list[Alternative]:
        """Return the models that were considered of each cable, the others as chosen."""
        found, least = [], self.cost(models)
        for each in self.free:
            name, chosen = each.cable.name, models[each.cable.name]
            coarser = each.base * max(1, chosen.elements // each.base // 2)
            meshes = {coarser, chosen.elements, 2 * chosen.elements} if each.fixed is None else {chosen.elements}
            for kind in dict.fromkeys([each.cheapest, each.finest]):
                for model in map(kind.of, sorted(meshes)):
                    others = {**models, name: model}
                    error, cost = self.error(others), self.cost(others)
                    why = ("chosen" if model == chosen else "errs by more than the tolerance" if error > tol else
                           "costs more" if cost > least else "no cheaper for its error")
                    found.append(Alternative(name, model, error, cost, model == chosen, why))
        return found

    def decide(self, tol: float, most: int) -> dict[str, CableModel]:
        """Return the cheapest models of the cables that keep a tolerance; those of the least error where none does.

        most: elements of a cable.
        """
        options = [self._meshed(kinds, tol, most) for kinds in self._assignments()]
        keeping = [models for models in options if self.error(models) <= tol * (1 + TOLERANCE_EXCESS)]
        least = min(map(self.error, options))
        return min(keeping or [models for models in options if self.error(models) <= EQUAL_ERROR_RATIO * least],
                   key=self.cost)

    def _assignments(self) -> Iterator[dict[str, CableModel]]:
        """Yield elements and laws by cable: first the cheapest, then with beams, by the error that they remove."""
        kinds = {each.cable.name: each.cheapest for each in self.free}
        finest = {each.cable.name: each.finest for each in self.free}
        yield dict(kinds)
        for name in sorted(self.shear, key=lambda name: -self.shear[name]):
            kinds[name] = finest[name]
            yield dict(kinds)

    def _meshed(self, kinds: Mapping[str, CableModel], tol: float, most: int) -> dict[str, CableModel]:
        """Return models of these elements and laws, on meshes for the remaining tolerance."""
        left = tol - self.time - sum(error for name, error in self.shear.items() if not kinds[name].shears)
        meshed = [each for each in self.free if each.fixed is None]
        levels = dict.fromkeys(kinds, 1.0)
        if meshed:
            work = [kinds[each.cable.name].of(each.base).work for each in meshed]
            mesh, left = self.mesh, max(left, MIN_MESH_SHARE * tol)
            errors = [self.of_cable[each.cable.name] * mesh.growth(mesh.level) for each in meshed]
            longer = balanced(errors, work, mesh.lowest if sum(errors) > left else mesh.highest, left)
            for each, ratio in zip(meshed, longer, strict=True):
                levels[each.cable.name] = min(max(mesh.level / ratio, self.least), max(most // each.base, 1))
        return {each.cable.name: each.model(kinds[each.cable.name], levels[each.cable.name]) for each in self.free}


def balanced(errors: Sequence[float], work: Sequence[float], order: float, wanted: float) -> np.ndarray:
    """Return the ratios by which to lengthen the elements of meshes, so that the errors add up to wanted at least work.

    errors: of meshes, each ~ length to the power of order; work: of their elements. By Lagrange's multiplier the length
    is ~ (work / error)^(1 / (order + 1)).
    """
    e, w = np.maximum(errors, 1e-3 * max(*errors, 1e-30)), np.asarray(work, dtype=float)
    total = float(np.sum(e ** (1 / (order + 1)) * w ** (order / (order + 1))))
    longer: np.ndarray = (wanted / total) ** (1 / order) * (w / e) ** (1 / (order + 1))
    return longer
