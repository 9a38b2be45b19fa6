"""Meshes of unequal elements: tried beside a choice's equal ones, taken where they save a third.

Nodes are close where the curvature of a run jumps from element to element. The error in energy of cubic elements is
about the integral of h^4 (d2 kappa/ds2)^2 ds, with the length h of the element at s, and the jump of the curvature
kappa at a node is about h^2 times that second derivative. For a number of elements the integral is least where h ~
density^-1, with a density ~ (jump/h^2)^(2/5).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..parts.cable import Cable
from ..parts.scene_data import SceneData
from .choice import Alternative, Choice
from .mesh_error import ASSUMED_ORDER
from .motion import shapes
from .probes import Prober
from .remeshing import S, node_places, remade

ENERGY_ORDER = 4
"""Power of the elements' length in their error in energy."""

MIN_DENSITY = 0.02
"""Smallest density over its mean, so that an element is not too long for a later instant."""

MAX_LENGTH_RATIO = 2.0
"""Largest ratio of the lengths of neighbours."""

MAX_PROMISING_RATIO = 0.5
"""Largest estimated ratio of unequal to equal elements that is tried."""

MAX_TAKEN_RATIO = 2 / 3
"""Largest ratio of unequal to equal elements that is taken."""


def with_unequal_elements(choice: Choice[S], names: Sequence[str], prober: Prober[S], tol: float,
                          integrator: str) -> Choice[S]:
    """Return the choice with unequal elements where these save a third and keep its tolerance, else as it is.

    Two short runs move the nodes, each by the curvature of the one before; a third, on elements of half the length,
    shows the error. names: of cables whose mesh is free; tol, integrator: of these runs.
    """
    start = max((probe for key, probe in prober.made.items() if probe.run is not None and not key[-1]),
                key=lambda probe: sum(model.elements for model in probe.models.values()), default=None)
    if start is None or start.run is None:
        return choice
    ratios = {name: saving(start.scene.cables[name], start.run[f"{name}.nodal_vectors"]) for name in names}
    tried = {name: min(MAX_TAKEN_RATIO, max(ratio, MAX_TAKEN_RATIO / 2)) for name, ratio in ratios.items()
             if ratio <= MAX_PROMISING_RATIO}
    if not tried:
        choice.reasons.append("unequal elements: curvature jumps alike at all nodes, they would save little")
        return choice
    probe, equal, models = start, choice.models, dict(choice.models)
    for _ in range(2):
        if probe.run is None:
            break
        for name, ratio in tried.items():
            nodes = graded(probe.scene, probe.scene.cables[name], probe.run[f"{name}.nodal_vectors"],
                           int(ratio * equal[name].elements))
            models[name] = replace(equal[name], elements=len(nodes) - 1, nodes=nodes)
        probe = prober.probe(models, tol, integrator)
    finer = prober.probe({name: model.halved(remade(choice.scene, models).cables[name].mesh.divided(2))
                          for name, model in models.items()}, tol, integrator)
    error = choice.error - choice.mesh_error + prober.difference(probe, finer) / (2**ASSUMED_ORDER - 1)
    few = all(models[name].elements <= MAX_TAKEN_RATIO * equal[name].elements for name in tried)
    what = f"unequal elements: {', '.join(f'{models[name].elements} of {name}' for name in tried)}"
    if not (few and error <= max(choice.tol, choice.error)):
        choice.reasons.append(f"{what} would err by about {error:.1e}: equal ones are kept")
        return choice
    choice.reasons.append(f"{what}, closest where curvature jumps, err by about {error:.1e}: they are taken in the "
                          "place of " + ", ".join(f"{equal[name].elements}" for name in tried) + " equal ones")
    cost = choice.cost * sum(each.elements for each in models.values()) / sum(each.elements for each in equal.values())
    table = [replace(each, chosen=False, why="costs more") if each.chosen and each.cable in tried else each
             for each in choice.alternatives]
    table += [Alternative(name, models[name], error, cost, True, "chosen") for name in tried]
    return replace(choice, scene=remade(choice.scene, models), models=models, error=error, cost=cost,
                   kept=error <= choice.tol, alternatives=table, probes=len(prober.made))


def density(cable: Cable, nodal_vectors: np.ndarray) -> np.ndarray:
    """Return (elements,): the density of nodes in each element, over the mean along the cable; 1 without curvature.

    nodal_vectors: (time, nodes, vectors, 3).
    """
    lengths = np.broadcast_to(cable.mesh.lengths, cable.elements)
    jumps = _curvature_jumps(cable, nodal_vectors) if cable.elements > 1 else np.zeros(1)
    beside = np.maximum(np.append(jumps[0], jumps), np.append(jumps, jumps[-1]))
    found = (beside / lengths**2) ** (2 / (ENERGY_ORDER + 1))
    mean = float(found @ lengths) / cable.length
    found = np.maximum(found / mean, MIN_DENSITY) if mean > 0 else np.ones(cable.elements)
    for k in range(1, cable.elements):  # a coarse element beside a fine one may hide the end of a layer
        found[k] = max(found[k], found[k - 1] / MAX_LENGTH_RATIO)
    for k in reversed(range(cable.elements - 1)):
        found[k] = max(found[k], found[k + 1] / MAX_LENGTH_RATIO)
    return np.asarray(found / (float(found @ lengths) / cable.length))


def _curvature_jumps(cable: Cable, nodal_vectors: np.ndarray) -> np.ndarray:
    """Return (elements - 1,): the largest jump of the curvature over time at each inner node, 1/m."""
    every, e = np.arange(cable.elements), np.concatenate([nodal_vectors[:, :-1], nodal_vectors[:, 1:]], axis=2)
    ends = []
    for part in (0.0, 1.0):
        x = part * np.broadcast_to(cable.mesh.lengths, cable.elements)
        r_x, r_xx = (np.einsum("ek,tekd->ted", shapes(cable, every, x, derivative), e) for derivative in (1, 2))
        ends.append(np.cross(r_x, r_xx) / np.sum(r_x * r_x, axis=-1, keepdims=True))
    jumps = ends[0][:, 1:] - ends[1][:, :-1]
    return np.asarray(np.linalg.norm(jumps - (jumps[:1] if cable.is_curved else 0.0), axis=-1).max(axis=0, initial=0.0))


def saving(cable: Cable, nodal_vectors: np.ndarray) -> float:
    """Return the ratio of graded to equal elements at equal error, about."""
    lengths = np.broadcast_to(cable.mesh.lengths, cable.elements) / cable.length
    return float(float(density(cable, nodal_vectors) ** (ENERGY_ORDER + 1) @ lengths) ** (-1 / ENERGY_ORDER))


def graded(scene: SceneData, cable: Cable, nodal_vectors: np.ndarray, elements: int) -> tuple[float, ...]:
    """Return the arc-lengths in m of the nodes of about this number of elements, spaced by a run's `density`.

    Supports, ties, point loads and joints have nodes. nodal_vectors: (time, nodes, vectors, 3).
    """
    lengths = np.broadcast_to(cable.mesh.lengths, cable.elements)
    needed = np.append(0.0, np.cumsum(density(cable, nodal_vectors) * lengths))
    places = np.unique([0.0, cable.length, *node_places(scene, cable)])
    places = places[np.append(True, np.diff(places) > 1e-6 * cable.length)]
    places[-1] = cable.length
    at = np.interp(places, cable.node_s, needed) / needed[-1]
    nodes = [0.0]
    for k in range(len(places) - 1):
        parts = max(1, round(elements * float(at[k + 1] - at[k])))
        inner = np.interp(np.linspace(at[k], at[k + 1], parts + 1)[1:-1] * needed[-1], needed, cable.node_s)
        nodes += [*inner.tolist(), float(places[k + 1])]
    return tuple(nodes)
