"""Meshes of unequal elements beside a choice's equal ones: taken where they save a third and keep the tolerance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ..results.run import Run
from .choice import Alternative, Choice
from .grading import graded, saving
from .mesh_error import FIRST_ORDER
from .probes import Prober
from .remeshing import CableModel, S, remade

PROMISING = 0.5
"""Of the equal elements: a mesh of unequal ones that is estimated to need more is not tried."""

WORTH = 2 / 3
"""Of the equal elements: a mesh of unequal ones has at most so many."""


def with_unequal_elements(choice: Choice[S], names: Sequence[str], prober: Prober[S], tol: float,
                          integrator: str) -> Choice[S]:
    """Return the choice with unequal elements where these save a third and keep its tolerance, else as it is.

    Two short runs move the nodes, each by what the one before shows; a third, on elements of half the length, tells
    the error. names: of cables whose mesh is free; tol, integrator: of these runs.
    """
    start = max((probe for key, probe in prober.made.items() if probe.run is not None and not key[-1]),
                key=lambda probe: sum(model.elements for model in probe.models.values()), default=None)
    if start is None or start.run is None:
        return choice
    ratios = {name: saving(start.scene.cables[name], start.run[f"{name}.nodal_vectors"])
              for name in names}
    tried = {name: min(WORTH, max(ratio, WORTH / 2)) for name, ratio in ratios.items() if ratio <= PROMISING}
    if not tried:
        choice.reasons.append("unequal elements: curvature jumps alike at all nodes, they would save little")
        return choice
    probe, models = start, dict(choice.models)
    for _ in range(2):
        if probe.run is None:
            break
        models |= _models(probe.scene, probe.run, choice.models, tried)
        probe = prober.probe(models, tol, integrator)
    finer = prober.probe({name: model.halved(remade(choice.scene, models).cables[name].mesh.divided(2))
                          for name, model in models.items()}, tol, integrator)
    error = choice.error - choice.mesh_error + prober.difference(probe, finer) / (2**FIRST_ORDER - 1)
    few = all(models[name].elements <= WORTH * choice.models[name].elements for name in tried)
    what = f"unequal elements: {', '.join(f'{models[name].elements} of {name}' for name in tried)}"
    if not (few and error <= max(choice.tol, choice.error)):
        choice.reasons.append(f"{what} would err by about {error:.1e}: equal ones are kept")
        return choice
    choice.reasons.append(f"{what}, closest where curvature jumps, err by about {error:.1e}: they are taken in the "
                          "place of " + ", ".join(f"{choice.models[name].elements}" for name in tried) + " equal ones")
    cost = choice.cost * sum(each.elements for each in models.values()) / sum(
        each.elements for each in choice.models.values())
    table = [replace(each, chosen=False, why="costs more") if each.chosen and each.cable in tried else each
             for each in choice.alternatives]
    table += [Alternative(name, models[name], error, cost, True, "chosen") for name in tried]
    return replace(choice, scene=remade(choice.scene, models), models=models, error=error, cost=cost,
                   kept=error <= choice.tol, alternatives=table, probes=len(prober.made))


def _models(scene: S, run: Run, equal: Mapping[str, CableModel],
            ratios: Mapping[str, float]) -> dict[str, CableModel]:
    """Return models on meshes that a run's curvature grades, with these parts of the equal elements."""
    found = {}
    for name, ratio in ratios.items():
        nodes = graded(scene, scene.cables[name], run[f"{name}.nodal_vectors"], int(ratio * equal[name].elements))
        found[name] = replace(equal[name], elements=len(nodes) - 1, nodes=nodes)
    return found
