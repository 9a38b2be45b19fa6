"""Material points of ropes: powers, a rope at rest whose nodes flow, the ends of elements, and a far origin."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.rope_point import ELEMENT
from ...elements import ELEMENTS
from ..numbers import EPS, Numbers, State
from ..samples.shapes import rotation
from .measures import ORIGIN_SHIFT, Invariance, quantised, relative


def rope_point(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the velocity and the symmetry by P, a turned scene, a rope at rest, both ends of elements, a far origin."""
    at, tangent = k("point", s), k("wrench", s)
    rates = np.concatenate([s["v"].ravel(), s["s_rate"]])
    yield "velocity = P q'", relative(at["P"] @ rates - at["velocity"], at["velocity"]), 64 * EPS
    yield "K symmetric", relative(tangent["K"] - tangent["K"].T, tangent["K"]), 64 * EPS
    yield "bias . f = q' . K q'", relative(
        np.array([rates @ tangent["K"] @ rates - at["bias"] @ s["f"]]), at["bias"]), 1024 * EPS
    Q = rotation(np.random.default_rng(3), family.dim)
    turned = k("point", s | {"e": s["e"] @ Q.T, "v": s["v"] @ Q.T})
    for name in ("p", "velocity", "bias"):
        yield f"turned scene: {name} follows", relative(turned[name] - Q @ at[name], at[name]), 512 * EPS
    slope = k("slope", s)
    yield "rate of the slope = T q'", relative(
        slope["T"] @ np.append(rates, s["S_rate"]) - slope["rate"], slope["rate"]), 64 * EPS
    K = k("slope_stiffness", s)["K"]
    yield "K of the slope symmetric", relative(K - K.T, K), 64 * EPS
    yield from _at_rest(family, k, s)
    yield from _at_nodes(family, k, s)
    yield from _step(family, k, s)
    near = s | {"e": quantised(s["e"]), "e_next": quantised(s["e_next"])}
    positions = ELEMENTS[ELEMENT[family.dim]].is_position
    shift = np.outer(positions, np.full(family.dim, ORIGIN_SHIFT))
    away = near | {name: near[name] + shift for name in ("e", "e_next")}
    for kernel, names in (("point", ("P", "velocity", "bias")), ("discrete_point", ("P",))):
        here, there = k(kernel, near), k(kernel, away)
        difference = max(float(np.max(np.abs(here[name] - there[name]))) for name in names)
        yield "same digits at 10⁴ lengths", difference, 0.0


def _at_rest(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that points of an evenly stretched straight rope stay where they are while its nodes flow."""
    stretch, direction = 1.3, np.eye(family.dim)[0]
    first, last = s["s"]
    nodes, rates = first + s["share"] * (last - first), s["s_rate"][0] + s["share"] * (s["s_rate"][1] - s["s_rate"][0])
    slope = stretch * direction
    still = s | {"e": np.array([nodes[0] * slope, slope, nodes[1] * slope, slope]),
                 "v": np.array([rates[0] * slope, 0 * slope, rates[1] * slope, 0 * slope])}
    found = k("point", still)
    size = np.max(np.abs(rates))
    yield "rope at rest, nodes flow: at its place", relative(found["p"] - s["S"] * slope, slope), 256 * EPS
    yield "rope at rest, nodes flow: no velocity", relative(found["velocity"], size), 256 * EPS
    yield "rope at rest, nodes flow: no acceleration", relative(found["bias"], size**2), 4096 * EPS


def _at_nodes(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that at a node the place is that of the node and the material flows past it along the slope."""
    first, last = s["s"]
    for i, name in enumerate(("first", "last")):
        S = np.float64(first + s["share"][i] * (last - first))
        rate = s["s_rate"][0] + s["share"][i] * (s["s_rate"][1] - s["s_rate"][0])
        found, place, slope = k("point", s | {"S": S}), s["e"][2 * i], s["e"][2 * i + 1]
        yield f"{name} node: its place", relative(found["p"] - place, place), 64 * EPS
        expected = s["v"][2 * i] - rate * slope
        yield f"{name} node: r' = e' - s' r_S", relative(found["velocity"] - expected, expected), 512 * EPS


def _step(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the momenta over a step of a force on the point; in space the moment where the rope does not flow."""
    spec = ELEMENTS[ELEMENT[family.dim]]
    dim, positions = family.dim, np.array(spec.is_position, dtype=float)
    for said, step in (("", s), (", rope at rest", s | {"s_next": s["s"]})):
        forces = (k("discrete_point", step)["P"].T @ s["f"])[: spec.n_coordinates].reshape(-1, dim)
        yield f"step{said}: net force is that on the point", relative(positions @ forces - s["f"], forces), 8 * EPS
        ends = (k("point", s), k("point", s | {"e": step["e_next"], "s": step["s_next"]}))
        if dim == 2 or said:
            moment = _moment((step["e"] + step["e_next"]) / 2, forces)
            of_point = _moment((ends[0]["p"] + ends[1]["p"])[None] / 2, s["f"][None])
            yield f"step{said}: moment is that of the mean place", relative(moment - of_point, forces), 64 * EPS


def _moment(arms: np.ndarray, forces: np.ndarray) -> np.ndarray:
    if arms.shape[1] == 2:
        return np.array([np.sum(arms[:, 0] * forces[:, 1] - arms[:, 1] * forces[:, 0])])
    return np.asarray(np.sum(np.cross(arms, forces), axis=0))
