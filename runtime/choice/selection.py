"""The decision: of the models whose estimated error keeps the tolerance the one with the least work."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from .candidates import Kind
from .estimate import Estimate
from .remeshing import CableModel

LEAST = 0.15
"""Of the tolerance: what is left for the mesh at least."""

NEARLY = 1.1
"""Of the least error: where none keeps the tolerance, what is no worse than this is as good."""

ROUNDED = 0.01
"""Of the tolerance: what an estimate may exceed it by, since numbers of elements are whole."""


def decide(estimate: Estimate, tol: float, most: int) -> dict[str, CableModel]:
    """Return the models of the cables, of at most so many elements each; those of the least error where none keeps the
    tolerance.
    """
    options = [_meshed(estimate, kinds, tol, most) for kinds in _assignments(estimate)]
    keeping = [models for models in options if estimate.error(models) <= tol * (1 + ROUNDED)]
    least = min(map(estimate.error, options))
    return min(keeping or [models for models in options if estimate.error(models) <= NEARLY * least], key=estimate.cost)


def _assignments(estimate: Estimate) -> Iterator[dict[str, Kind]]:
    """Yield elements and laws by cable: first without shear where that can be, then with beams for the cables on whose
    shear most depends, one after the other.
    """
    kinds = {each.cable.name: each.kinds.slender or each.kinds.finest for each in estimate.free}
    yield dict(kinds)
    for name in sorted(estimate.shear, key=lambda name: -estimate.shear[name]):
        kinds[name] = next(each.kinds.finest for each in estimate.free if each.cable.name == name)
        yield dict(kinds)


def _meshed(estimate: Estimate, kinds: Mapping[str, Kind], tol: float, most: int) -> dict[str, CableModel]:
    """Return models of these kinds, on meshes for what the tolerance leaves."""
    left = tol - estimate.time - sum(error for name, error in estimate.shear.items() if not kinds[name].is_beam)
    meshed = [each for each in estimate.free if each.fixed is None]
    levels = dict.fromkeys(kinds, 1.0)
    if meshed:
        work = [each.base * kinds[each.cable.name].work for each in meshed]
        mesh, left = estimate.mesh, max(left, LEAST * tol)
        errors = [estimate.of_cable[each.cable.name] * mesh.growth(mesh.level) for each in meshed]
        longer = balanced(errors, work, mesh.lowest if sum(errors) > left else mesh.highest, left)
        for each, ratio in zip(meshed, longer, strict=True):
            levels[each.cable.name] = min(max(estimate.mesh.level / ratio, estimate.least), max(most // each.base, 1))
    return {each.cable.name: each.model(kinds[each.cable.name], levels[each.cable.name]) for each in estimate.free}


def balanced(errors: Sequence[float], work: Sequence[float], order: float, wanted: float) -> np.ndarray:
    """Return by what the elements of each mesh may be longer, for the least work at which the errors add up to wanted.

    errors: of meshes, each ~ length to the power of order; work: of their elements. By Lagrange's multiplier the length
    is ~ (work / error)^(1 / (order + 1)).
    """
    e, w = np.maximum(errors, 1e-3 * max(*errors, 1e-30)), np.asarray(work, dtype=float)
    total = float(np.sum(e ** (1 / (order + 1)) * w ** (order / (order + 1))))
    return (wanted / total) ** (1 / order) * (w / e) ** (1 / (order + 1))
