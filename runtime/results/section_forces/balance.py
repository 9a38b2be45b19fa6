"""Section forces in balance: force and moment at a cut, from the nodal forces on its element and the loads before it.

The elastic, damping and inertia forces of an element, less its loads, are the forces of its two nodes
(nodal_forces.py). Shape functions of positions add up to one, so that these forces balance loads and inertia; elastic
forces do not change in a rigid rotation, so that the moments balance, too. The force at the first node is therefore
known without the stress inside the element, which jumps between elements and does not follow a kink. From there,

    n' = rho A (a - g) - p,     m' = -r' x n + rate of spin of the section - moments per length,

with jumps at riders, forces, springs and joints, are integrated over the part of the element before the cut. a, r and
the section's slopes are those of the shape functions, for which the balance of the element is exact.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from ...base.quadrature import gauss
from ...model.model import CableModel
from ...model.states import positions, spatial
from ...parts.cable import Cable
from ...parts.piece import UniformPiece
from ...parts.validation import LENGTH_TOLERANCE
from ..shape_functions import of_slopes, on_axis
from .cable_loads import CableLoads
from .nodal_forces import ElementForces
from .spreads import Spread


class Cuts:
    """Places of cuts on a cable: s (T or 1, n) in m; element and x in it, likewise.

    after: at a jump the side of larger s, else that of smaller; at the ends of the cable always the inner side.
    """

    def __init__(self, cable: CableModel, s: np.ndarray, after: bool):
        mesh = cable.mesh
        total = mesh.total
        self.near = LENGTH_TOLERANCE * total
        self.s = np.clip(s, 0.0, total)
        self.after = np.where(self.s <= self.near, True, np.where(self.s >= total - self.near, False, after))
        node, within = mesh.nearest_boundary(self.s), mesh.element_at(self.s)
        on_node = np.abs(self.s - mesh.boundaries[node]) <= self.near
        element = np.where(on_node, node - ~self.after, within).astype(int)
        self.element = np.clip(element, 0, cable.n_elements - 1)
        length = mesh.each_length(self.element)
        self.x = np.clip(self.s - mesh.each_start(self.element), 0.0, length)
        self.x = np.where(on_node, np.where(self.after, 0.0, length), self.x)


def resultants(f: np.ndarray, e: np.ndarray, is_r: np.ndarray, about: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return force and moment (..., 3) of generalised forces f (..., vectors, dim) on e about points `about` (..., 3).
    """
    f, e = spatial(f), spatial(e)
    arms = e - np.where(is_r[:, None], about[..., None, :], 0.0)
    return f[..., is_r, :].sum(axis=-2), np.cross(arms, f).sum(axis=-2)


def balanced(cable: Cable, model: CableModel, forces: ElementForces, loads: CableLoads, number: int,
             cuts: Cuts) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the force and moment (T, n, 3) on the part before each cut, along the ground's axes, in N and N m.

    The third is the derivative of the force by the stress-free length there, in N/m.
    """
    is_r, half = positions(model), model.shape[1]
    times, n = len(forces.e), cuts.s.shape[1]
    instants = np.arange(times)[:, None]
    element, x, after = (np.broadcast_to(each, (times, n)) for each in (cuts.element, cuts.x, cuts.after))
    first = spatial(forces.e[:, :, 0])  # r of each element's first node
    at_node = resultants(forces.given[:, :, :half], forces.e[:, :, :half], is_r[:half], first)
    start = first[instants, element]
    e, inertia = (spatial(values)[instants, element] for values in (forces.e, forces.inertia))
    e = e - np.where(is_r[:, None], start[:, :, None], 0.0)
    force, moment = (-value[instants, element] for value in at_node)
    of_inertia = _of_inertia(cable, model, cuts, e, inertia)
    force, moment = force + of_inertia[0], moment + of_inertia[1]
    N = on_axis(model, cuts.element, cuts.x)[0]
    change = _per_cut(cable, cuts, lambda piece: piece.material.density * piece.section.area) * _at(N, inertia)
    spreads = [*loads.spreads.get(number, []), *forces.spreads]
    for spread in spreads:
        inside = (cuts.element == spread.element) & (cuts.x > spread.start)
        columns = np.flatnonzero(inside.any(axis=0))
        if len(columns):
            here, reach = inside[:, columns, None], cuts.x[:, columns]
            ends = here & (reach <= spread.stop)[..., None]
            parts = _of_spread(model, spread, np.clip(reach, spread.start, spread.stop), e[:, columns])
            for total, part, where in zip((force, moment, change), parts, (here, here, ends), strict=True):
                total[:, columns] -= np.where(where, part, 0.0)
    for load in [*loads.points.get(number, []), *forces.masses]:
        of = forces.e[instants[:, 0], load.element]
        jump = resultants(load.f, of, is_r, spatial(of[:, 0]))
        near = np.where(after, cuts.near, -cuts.near)
        before = (element == load.element[:, None]) & (load.x[:, None] <= x + near)
        for total, value in zip((force, moment), jump, strict=True):
            total -= before[..., None] * value[:, None]
    moment = moment - np.cross(_at(N, e), force)
    for spread in spreads:
        if spread.on_slope is not None:
            inside = (cuts.element == spread.element) & spread.holds(cuts.x, model.mesh.length(spread.element))
            columns = np.flatnonzero(inside.any(axis=0))
            here, of_x = inside[:, columns, None], cuts.x[:, columns]
            for total, weights in zip((force, change), _lagrange(spread.x, of_x), strict=True):
                total[:, columns] += np.where(here, _through(weights, spread.on_slope), 0.0)
    return force, moment, change / forces.growth[instants, element][..., None]


def _of_inertia(cable: Cable, model: CableModel, cuts: Cuts, e: np.ndarray, a: np.ndarray) -> tuple[np.ndarray,
                np.ndarray]:
    """Return force and moment (T, n, 3) about the element's first node of the element's inertia up to the cut.

    The Gauss rule is exact for the product of two shape functions.
    """
    places, weights = gauss(2 * sum(set(name) <= set("r_x") for name in model.vectors))
    area, yy, zz = (_per_cut(cable, cuts, partial(_inertia, k)) for k in range(3))
    force = moment = np.zeros(3)
    across = [(k, I) for k, (name, I) in enumerate((("r_y", yy), ("r_z", zz)), start=1) if name in model.vectors]
    for place, weight in zip((1 + places) / 2, weights / 2, strict=True):
        x = cuts.x * place
        N, part = on_axis(model, cuts.element, x)[0], (weight * cuts.x)[..., None]
        pull = part * area * _at(N, a)
        force = force + pull
        moment = moment + np.cross(_at(N, e), pull)
        if across:
            slopes = of_slopes(model, cuts.element, x)
        for k, I in across:
            moment = moment + part * I * np.cross(_at(slopes[..., k, :], e), _at(slopes[..., k, :], a))
    return force, moment


def of_cuts(cable: Cable, element: np.ndarray, of_piece: Callable[[UniformPiece], float]) -> Any:
    """Return a number of the piece of each cut on elements of these numbers (...); one of a cable of one piece."""
    pieces = cable.uniform_pieces
    return of_piece(pieces[0]) if len(pieces) == 1 else cable.of_elements(of_piece)[element]


def _inertia(k: int, piece: UniformPiece) -> float:
    """Return the density times a moment of the section of a piece: mass by length, or rotary inertia."""
    return piece.material.density * float(piece.section.mass_moments()[k])


def _per_cut(cable: Cable, cuts: Cuts, of_piece: Callable[[UniformPiece], float]) -> Any:
    """Return a number of the piece of each cut, (T or 1, n, 1); one of a cable of one piece."""
    found = of_cuts(cable, cuts.element, of_piece)
    return found[..., None] if np.ndim(found) else found


def _at(N: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return (T, n, 3) from shape functions (T or 1, n, vectors) and vectors (T, n, vectors, 3)."""
    found: np.ndarray = np.einsum("tnk,tnkd->tnd", np.broadcast_to(N, (len(values), *N.shape[1:])), values)
    return found


def _of_spread(model: CableModel, spread: Spread, x: np.ndarray, e: np.ndarray) -> tuple[np.ndarray, np.ndarray,
               np.ndarray]:
    """Return force and moment (T, n, 3) about the element's first node of a spread up to x, and its density at x.

    x: (T or 1, n) in m; e: (T, n, vectors, 3). The whole spread is summed by its own rule, as its generalised force is.
    """
    places, weights = gauss(len(spread.x))
    force = moment = np.zeros(3)
    length = x - spread.start
    for place, weight in zip((1 + places) / 2, weights / 2, strict=True):
        at = spread.start + place * length
        of_nodes = _lagrange(spread.x, at)[0]
        parts = _moments(model, spread, at, e, [None if values is None else _through(of_nodes, values)
                                                * (weight * length)[..., None]
                                                for values in (spread.density, spread.on_slope, spread.couple)])
        force, moment = force + parts[0], moment + parts[1]
    whole = (x >= spread.stop)[..., None]
    if whole.any():
        exact = [np.zeros(3), np.zeros(3)]
        for k, weight in enumerate(spread.weights):
            parts = _moments(model, spread, np.full((1, 1), spread.x[k]), e,
                             [None if values is None else weight * values[:, k, None]
                              for values in (spread.density, spread.on_slope, spread.couple)])
            exact = [exact[0] + parts[0], exact[1] + parts[1]]
        force, moment = (np.where(whole, *each) for each in zip(exact, (force, moment), strict=True))
    return force, moment, _through(_lagrange(spread.x, x)[0], spread.density)


def _moments(model: CableModel, spread: Spread, x: np.ndarray, e: np.ndarray,
             acting: list[np.ndarray | None]) -> tuple[np.ndarray, np.ndarray]:
    """Return force and moment of a force, one on r_x, and a couple (T, n, 3) at x (T or 1, n)."""
    force, on_slope, couple = acting
    assert force is not None, "a spread has a density"
    N, N_x = (np.broadcast_to(shape, (len(x), e.shape[1], shape.shape[-1]))
              for shape in on_axis(model, spread.element, x))
    moment = np.cross(_at(N, e), force)
    if on_slope is not None:
        moment = moment + np.cross(_at(N_x, e), on_slope)
    return force, moment if couple is None else moment + couple


def _through(weights: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return (T, n, 3) from weights (T or 1, n, nodes) of values (T, nodes, 3)."""
    found: np.ndarray = np.einsum("tnp,tpd->tnd", np.broadcast_to(weights, (len(values), *weights.shape[1:])), values)
    return found


def _lagrange(nodes: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the weights (..., nodes) of values at nodes in their interpolation polynomial at x (...), and in its
    derivative.
    """
    others = [np.delete(nodes, k) for k in range(len(nodes))]
    weights = np.stack([np.prod((x[..., None] - other) / (node - other), axis=-1)
                        for node, other in zip(nodes, others, strict=True)], axis=-1)
    slopes = [sum(np.prod((x[..., None] - np.delete(other, k)), axis=-1) for k in range(len(other)))
              / np.prod(node - other) for node, other in zip(nodes, others, strict=True)]
    return weights, np.stack(slopes, axis=-1)
