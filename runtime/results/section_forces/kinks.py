"""Kinks of the force along a cable, at riders, loads, springs, joints and supports, and sections of fixed direction."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from ...model.model import CableModel
from ...model.states import positions, spatial
from ...parts.cable import Cable
from ...parts.scene_data import SceneData
from ...parts.support import Clamp, Motion, Support
from ...parts.validation import LENGTH_TOLERANCE
from ..shape_functions import on_axis
from .balance import Cuts, balanced, resultants
from .cable_loads import CableLoads
from .layer import Kink, between, fixed_direction, line_bending, of_hinge, of_joint
from .nodal_forces import ElementForces

ForceAt = Callable[[np.ndarray, bool], np.ndarray]
"""The section force at s (m), after or before a jump."""


def kinks(scene: SceneData, cable: Cable, model: CableModel, forces: ElementForces, loads: CableLoads,
          number: int) -> list[Kink]:
    """Return the kinks of one cable at the instants of its forces."""

    def force_at(s: np.ndarray, after: bool) -> np.ndarray:
        return balanced(cable, model, forces, loads, number, Cuts(model, s, after))[0]

    return [*_of_points(cable, model, forces, loads, number, force_at),
            *_of_nodes(scene, cable, model, forces, force_at),
            *_of_pieces(cable, model, forces, loads, number)]


def _of_pieces(cable: Cable, model: CableModel, forces: ElementForces, loads: CableLoads, number: int) -> list[Kink]:
    """Return the kinks at the joints of pieces."""
    found: list[Kink] = []
    for pieces in pairwise(cable.uniform_pieces):
        s, moments = np.full(len(forces.e), cable.mesh.start(pieces[1].first)), []
        one, other = (piece.material.youngs_modulus * float(np.mean(piece.section.moments()[1 : cable.dim]))
                      for piece in pieces)
        for after, EI in ((False, one), (True, other)):
            force, _, change = balanced(cable, model, forces, loads, number, Cuts(model, s[:1, None], after))
            moments.append(EI * line_bending(lambda turn: np.ones(turn.shape[:2]), force, change)[:, 0])
        found += (of_hinge(s, moments[0], moments[1]) if pieces[1].hinge else
                  of_joint(s, moments[0], moments[1], (one, other)))
    return found


def _of_points(cable: Cable, model: CableModel, forces: ElementForces, loads: CableLoads, number: int,
               force_at: ForceAt) -> list[Kink]:
    points, is_r = [*loads.points.get(number, []), *forces.masses], positions(model)
    if not points:
        return []
    s = np.stack([model.mesh.each_start(load.element) + load.x for load in points], axis=1)
    inside = (s > LENGTH_TOLERANCE * cable.length) & (s < (1 - LENGTH_TOLERANCE) * cable.length)
    for element in cable.hinges:
        inside &= np.abs(s - cable.mesh.start(element)) > LENGTH_TOLERANCE * cable.length
    before, instants, found = force_at(s, False), np.arange(len(s)), []
    for k, load in enumerate(points):
        e = forces.e[instants, load.element]
        at = spatial(np.einsum("tk,tkd->td", on_axis(model, load.element, load.x)[0], e))
        jump, moment = resultants(load.f, e, is_r, at)
        sides = np.where(inside[:, k], 2.0, 1.0)[:, None]  # that share the moment
        found.append(between(s[:, k], before[:, k], before[:, k] - np.where(inside[:, k, None], jump, 0.0),
                             2 * moment / sides))
    return found


def _of_nodes(scene: SceneData, cable: Cable, model: CableModel, forces: ElementForces,
              force_at: ForceAt) -> list[Kink]:
    """Return the kinks at supports and ties; a section that cannot turn fixes the direction of the line."""
    found: list[Kink] = []
    directed: dict[int, bool] = {}  # by the end of an element: whether its section keeps its direction
    ends = [(support.cable, support.s, _keeps_direction(support)) for support in scene.supports]
    for tie in scene.ties.values():
        ends += [(tie.cable, tie.s, tie.rotation == "rigid"), (tie.to, tie.at, tie.rotation == "rigid")]
    for on, at_s, keeps in ends:
        if on == cable.name:
            node = cable.boundary(at_s)
            directed[node] = directed.get(node, False) or keeps
    times = len(forces.e)
    for node, is_directed in directed.items():
        s = np.full(times, model.mesh.boundaries[node])
        first, last = node == 0, node == cable.elements
        element, at = (node - 1, len(model.vectors)) if last else (node, 0)
        direction = _normal(model, spatial(forces.e[:, element, at : at + len(model.vectors)]))
        sides = [(False, -1)] * (not first) + [(True, 1)] * (not last)
        n = {side: force_at(s[:, None], after)[:, 0] for after, side in sides}
        if is_directed:
            found += [fixed_direction(s, direction, force, side) for side, force in n.items()]
        elif len(n) == 2:
            found.append(between(s, n[-1], n[1], np.zeros((times, 3))))
    return found


def _normal(model: CableModel, vectors: np.ndarray) -> np.ndarray:
    """Return the section normal (T, 3) at a node with vectors (T, vectors, 3); of a cable the tangent."""
    named: dict[str, np.ndarray] = dict(zip(model.vectors, np.moveaxis(vectors, 1, 0), strict=True))
    if "r_y" not in named:
        return named["r_x"]
    return np.asarray(np.cross(named["r_y"], named.get("r_z", np.array([0.0, 0.0, 1.0]))))


def _keeps_direction(support: Support) -> bool:
    return isinstance(support, Clamp) or (isinstance(support, Motion) and support.rotation is not None)
