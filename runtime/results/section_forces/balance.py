"""Section forces in balance: what a cut passes on, from what the nodes give to its element and what acts before it.

An element's elastic and damping forces and its inertia, less the loads on it, leave what its two nodes give to it
(nodal_forces.py). Shape functions of positions add up to one, so that these forces are in balance with loads
and
inertia; and nothing elastic changes when all turns, so that their moments are, too. The force at its first node is
therefore known without the stress inside the element, which jumps from element to element and cannot follow a kink.
From there on

    n' = rho A (a - g) - p,     m' = -r' x n + rate of spin of the section - moments a length,

with jumps where a rider, a force, a spring or a joint is attached, are integrated over the part of the element before
the cut. a, r and the section's slopes are those of the shape functions, for which the balance of the element is
exact.
"""

from __future__ import annotations

import numpy as np

from ...model.element_coordinates import positions
from ...model.model import CableModel
from ...model.states import spatial
from ...parts.cable import Cable
from ...parts.validation import EXACT
from .cable_loads import CableLoads
from .nodal_forces import ElementForces
from .spreads import Spread, lengths_of_rows, rows, shape_on_axis


class Cuts:
    """Places of cuts on a cable: s (T or 1, n) in m; element and x in it, likewise.

    after: of a jump at s the side of larger s, else that of smaller; at the ends of the cable always that inside.
    """

    def __init__(self, cable: CableModel, s: np.ndarray, after: bool):
        mesh = cable.mesh
        total = mesh.total
        self.near = EXACT * total
        self.s = np.clip(s, 0.0, total)
        self.after = np.where(self.s <= self.near, True, np.where(self.s >= total - self.near, False, after))
        node, within = mesh.nearest_node(self.s), mesh.element_at(self.s)
        on_node = np.abs(self.s - mesh.node_s[node]) <= self.near
        element = np.where(on_node, node - ~self.after, within).astype(int)
        self.element = np.clip(element, 0, cable.n_elements - 1)
        length = mesh.each_length(self.element)
        self.x = np.clip(self.s - mesh.each_start(self.element), 0.0, length)
        self.x = np.where(on_node, np.where(self.after, 0.0, length), self.x)


def resultants(f: np.ndarray, e: np.ndarray, is_r: np.ndarray, about: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return force and moment (..., 3) about a point `about` (..., 3) of generalised forces f (..., vectors, dim) on e.
    """
    f, e = spatial(f), spatial(e)
    arms = e - np.where(is_r[:, None], about[..., None, :], 0.0)
    return f[..., is_r, :].sum(axis=-2), np.cross(arms, f).sum(axis=-2)


def balanced(cable: Cable, model: CableModel, forces: ElementForces, loads: CableLoads, number: int,
             cuts: Cuts) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the force and moment (T, n, 3) on the part before each cut, along the ground's axes, in N and N m.

    The third is the derivative of the force by s there, in N/m.
    """
    is_r, half = positions(model), model.shape[1]
    times, n = len(forces.e), cuts.s.shape[1]
    instants = np.arange(times)[:, None]
    element = np.broadcast_to(cuts.element, (times, n))
    x = np.broadcast_to(cuts.x, (times, n))
    after = np.broadcast_to(cuts.after, (times, n))
    first = spatial(forces.e[:, :, 0])  # r of each element's first node
    at_node = resultants(forces.given[:, :, :half], forces.e[:, :, :half], is_r[:half], first)
    start = first[instants, element]
    e, inertia = (spatial(values)[instants, element] for values in (forces.e, forces.inertia))
    e = e - np.where(is_r[:, None], start[:, :, None], 0.0)
    force, moment = (-value[instants, element] for value in at_node)
    taken = _of_inertia(cable, model, cuts, e, inertia)
    force, moment = force + taken[0], moment + taken[1]
    change = cable.material.density * cable.section.area * _at(shape_on_axis(model, cuts.element, cuts.x), inertia)
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
    for load in loads.points.get(number, []):
        of = forces.e[instants[:, 0], load.element]
        jump = resultants(load.f, of, is_r, spatial(of[:, 0]))
        near = np.where(after, cuts.near, -cuts.near)
        before = (element == load.element[:, None]) & (load.x[:, None] <= x + near)
        for total, value in zip((force, moment), jump, strict=True):
            total -= before[..., None] * value[:, None]
    r = np.einsum("tnk,tnkd->tnd", shape_on_axis(model, cuts.element, cuts.x), e)
    moment = moment - np.cross(r, force)
    for spread in spreads:
        if spread.on_slope is not None:
            inside = (cuts.element == spread.element) & spread.holds(cuts.x, model.mesh.length(spread.element))
            columns = np.flatnonzero(inside.any(axis=0))
            here, of_x = inside[:, columns, None], cuts.x[:, columns]
            for total, weights in zip((force, change), _lagrange(spread.x, of_x), strict=True):
                total[:, columns] += np.where(here, _through(weights, spread.on_slope), 0.0)
    return force, moment, change


def _of_inertia(cable: Cable, model: CableModel, cuts: Cuts, e: np.ndarray, a: np.ndarray) -> tuple[np.ndarray,
                np.ndarray]:
    """Return the force and moment (T, n, 3) about the element's first node that the element's inertia takes up to the
    cut.

    Gauss points in as large a number as the product of two shape functions needs.
    """
    places, weights = np.polynomial.legendre.leggauss(2 * sum(set(name) <= set("r_x") for name in model.vectors))
    density = cable.material.density
    area, yy, zz = cable.section.mass_moments()[:3]
    force = moment = np.zeros(3)
    across = [(k, I) for k, (name, I) in enumerate((("r_y", yy), ("r_z", zz)), start=1) if name in model.vectors]
    for place, weight in zip((1 + places) / 2, weights / 2, strict=True):
        x = cuts.x * place
        N, share = shape_on_axis(model, cuts.element, x), (weight * density * cuts.x)[..., None]
        pull = share * area * _at(N, a)
        force = force + pull
        moment = moment + np.cross(_at(N, e), pull)
        if across:
            lengths = lengths_of_rows(model.mesh, cuts.element, x.shape)
            slopes = rows(model.kernel("slopes"), x.size, lengths, x.ravel())[:, :, 0].reshape(*x.shape, 3, -1)
        for k, I in across:
            moment = moment + share * I * np.cross(_at(slopes[..., k, :], e), _at(slopes[..., k, :], a))
    return force, moment


def _at(N: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return (T, n, 3) from shape functions (T or 1, n, vectors) and vectors (T, n, vectors, 3)."""
    return np.einsum("tnk,tnkd->tnd", np.broadcast_to(N, (len(values), *N.shape[1:])), values)


def _of_spread(model: CableModel, spread: Spread, x: np.ndarray, e: np.ndarray) -> tuple[np.ndarray, np.ndarray,
               np.ndarray]:
    """Return the force and moment (T, n, 3) about the element's first node of what is spread up to x, and the force a
    length at x.

    x: (T or 1, n) in m; e: (T, n, vectors, 3).
    """
    places, weights = np.polynomial.legendre.leggauss(len(spread.x))
    force = moment = np.zeros(3)
    length = x - spread.start
    for place, weight in zip((1 + places) / 2, weights / 2, strict=True):
        at = spread.start + place * length
        share = _density(spread, at) * (weight * length)[..., None]
        force = force + share
        moment = moment + np.cross(_at(shape_on_axis(model, spread.element, at), e), share)
        if spread.on_slope is not None:
            pull = _through(_lagrange(spread.x, at)[0], spread.on_slope) * (weight * length)[..., None]
            moment = moment + np.cross(_at(_slope_on_axis(model, spread.element, at), e), pull)
        if spread.couple is not None:
            moment = moment + _through(_lagrange(spread.x, at)[0], spread.couple) * (weight * length)[..., None]
    if spread.weights is not None:
        whole = (x >= spread.stop)[..., None]
        exact = _of_all(model, spread, e)
        force, moment = (np.where(whole, *each) for each in zip(exact, (force, moment), strict=True))
    return force, moment, _density(spread, x)


def _of_all(model: CableModel, spread: Spread, e: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the force and moment (T, 1 or n, 3) about the element's first node of all of it, by its weights."""
    assert spread.weights is not None, "a spread without weights"

    def moment_of(shape: np.ndarray, force: np.ndarray) -> np.ndarray:
        return np.cross(np.einsum("gk,tnkd->tngd", shape, e), force[:, None]).sum(axis=2)

    share = spread.weights[:, None] * spread.density
    moment = moment_of(shape_on_axis(model, spread.element, spread.x), share)
    if spread.on_slope is not None:
        moment = moment + moment_of(_slope_on_axis(model, spread.element, spread.x),
                                    spread.weights[:, None] * spread.on_slope)
    return share.sum(axis=1)[:, None], moment


def _density(spread: Spread, x: np.ndarray) -> np.ndarray:
    """Return (T, n, 3): force a length at x (T or 1, n)."""
    return _through(_lagrange(spread.x, x)[0], spread.density)


def _through(weights: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return (T, n, 3) from weights (T or 1, n, nodes) of values (T, nodes, 3)."""
    return np.einsum("tnp,tpd->tnd", np.broadcast_to(weights, (len(values), *weights.shape[1:])), values)


def _slope_on_axis(model: CableModel, element: int, x: np.ndarray) -> np.ndarray:
    """Return (..., vectors): slopes of shape functions at places x (...) of the centreline of an element."""
    lengths = lengths_of_rows(model.mesh, element, x.shape)
    return rows(model.kernel("on_axis"), x.size, lengths, x.ravel())[1].reshape(*x.shape, -1)


def _lagrange(nodes: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return (..., nodes): weights of the values at nodes in the polynomial through them, at x (...), and those in its
    derivative.
    """
    others = [np.delete(nodes, k) for k in range(len(nodes))]
    weights = np.stack([np.prod((x[..., None] - other) / (node - other), axis=-1)
                        for node, other in zip(nodes, others, strict=True)], axis=-1)
    slopes = [sum(np.prod((x[..., None] - np.delete(other, k)), axis=-1) for k in range(len(other)))
              / np.prod(node - other) for node, other in zip(nodes, others, strict=True)]
    return weights, np.stack(slopes, axis=-1)
