"""Invariances of the slide's kernels in C: motions that keep the joint, turned frames, equilibrium of its forces."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ...codegen.family import SlideFamily
from ...couplings.slide import DISCRETE_GRADIENT, FLOWING_GRADIENT, N_ENDS
from ..motion import RIDERS, swung
from ..numbers import EPS, Numbers, State
from .measures import ORIGIN_SHIFT, Invariance, quantised, relative

_OUTPUTS = ("C", "C_s", "s_rate", "Q_d", "W", "s_bias")


def slide(family: SlideFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield motions that keep the joint, turned frames, digits far away, and equilibrium of forces."""
    A = k("constraint", s)["A_t"]
    yield "A_t' A_t = I", relative(A.T @ A - np.eye(len(A)), 1), 8 * EPS
    yield "A_t right-handed", abs(np.linalg.det(A) - 1), 8 * EPS
    out = k("terms", s)
    n_e = family.element.n_coordinates + N_ENDS * family.flows
    yield "eq 30: C_lq + C_ls G = 0", relative(out["C_q"][0] + out["C_s"][0] * out["G"], out["C_q"][0]), 8 * EPS
    yield from _constraint_invariances(family, k, s, n_e)
    yield from _frame(family, k, s, out, n_e)
    yield from _forces(family, k, s, n_e)
    yield from _step(family, k, s, n_e)


def _constraint_invariances(family: SlideFamily, k: Numbers, s: State, n_e: int) -> Iterator[Invariance]:
    """Yield that H is blind to any velocity of the cable, any turning and any speed of sliding on the joint."""
    gap = k("residual", s)["phi"]
    b = s["b"].copy()
    b[: len(gap)] += gap  # the rider's origin comes first in every rider's configuration
    on = {**s, "b": b}
    out, J = k("terms", on), k("tangent", on)["J"]
    random = np.random.default_rng(2)
    n = J.shape[1] - 1
    along = J[:, n]
    for _ in range(4):
        motion, speed = random.normal(size=n), random.normal()
        motion[n_e : n_e + len(gap)] = 0
        motion[n_e : n_e + len(gap)] = J[:, :n] @ motion + speed * along
        scale = relative(motion, 1) * relative(out["H"], 1)
        yield "H null on motions that keep the joint", relative(out["H"] @ motion, scale), 64 * EPS
        yield "s_rate is the speed of sliding", relative(out["G"] @ motion - speed, relative(motion, 1)), 64 * EPS
    free = np.zeros(n)
    free[n_e : n_e + len(gap)] = along
    yield "the rider is free along the tangent", relative(out["H"] @ free, along), 16 * EPS
    if len(gap) == 3:
        H = k("terms", {**on, "director": np.roll(s["director"], -1) - s["director"]})["H"]
        yield "H'H is the same for any director", relative(H.T @ H - out["H"].T @ out["H"], H.T @ H), 64 * EPS


def _frame(family: SlideFamily, k: Numbers, s: State, out: dict[str, Any], n_e: int) -> Iterator[Invariance]:
    """Yield the changes in the tangent frame by a turn of the whole scene, and by a shift far away."""
    element, rider = family.element, RIDERS[family.rider]
    positions = np.array(element.is_position, dtype=float)
    Q, turn = rider.frame(np.random.default_rng(3))
    n, v = element.n_coordinates, s["v"].copy()
    v.ravel()[:n] = (v.ravel()[:n].reshape(-1, element.dim) @ Q.T).ravel()
    turned = {**s, "e": s["e"] @ Q.T, "v": v, "b": turn(s["b"]), "w": s["w"].copy()}
    turned["w"][: element.dim] = Q @ s["w"][: element.dim]
    turned["director"] = Q @ s["director"]
    if rider.n_velocity == element.dim:  # the arm of a mere point is in global axes
        turned["u"] = Q @ s["u"]
    new = k("terms", turned)
    yield "turned scene: same C, s_rate, Q_d, W", max(
        relative(new[name] - out[name], max(relative(out[name], 1), 1.0)) for name in _OUTPUTS), 256 * EPS
    for name in ("H", "C_q", "G"):
        back = np.atleast_2d(new[name]).copy()
        rows = len(back)
        back[:, :n] = (back[:, :n].reshape(rows, -1, element.dim) @ Q).reshape(rows, -1)
        back[:, n_e : n_e + element.dim] = back[:, n_e : n_e + element.dim] @ Q
        yield "turned scene: H, C_q, G turn", relative(back - out[name], out[name]), 256 * EPS
    ends = {"e": quantised(s["e"]), "e_next": quantised(s["e_next"]), "b": s["b"].copy(), "b_next": s["b_next"].copy()}
    near, away = {**s, **ends}, {**s}
    for name, value in ends.items():
        if name.startswith("b"):
            value[: element.dim] = quantised(value[: element.dim])
            shift = ORIGIN_SHIFT * (np.arange(len(value)) < element.dim)
        else:
            shift = np.outer(positions, np.full(element.dim, ORIGIN_SHIFT))
        away[name] = value + shift
    for kernel in ("constraint", "terms", "residual", "tangent", _step_kernel(family)):
        here, there = k(kernel, near), k(kernel, away)
        yield "same digits at 10⁴ lengths", max(float(np.max(np.abs(here[n] - there[n]))) for n in here), 0.0


def _step(family: SlideFamily, k: Numbers, s: State, n_e: int) -> Iterator[Invariance]:
    """Yield the momenta over a step of the joint's force on cable and rider, about the rider's mean place."""
    element, rider = family.element, RIDERS[family.rider]
    dim, positions = element.dim, np.array(element.is_position, dtype=float)
    forces = k(_step_kernel(family), s)["G"].T @ s["f"]
    on_cable, on_rider = forces[: element.n_coordinates].reshape(-1, dim), forces[n_e:-1]
    yield "step: no net force of the joint", relative(positions @ on_cable + on_rider[:dim], forces), 8 * EPS
    arms = (s["e"] + s["e_next"] - np.outer(positions, s["b"][:dim] + s["b_next"][:dim])) / 2
    half = rider.step(s["b"], s["b_next"]) / 2
    for k_axis, row in zip(np.eye(rider.n_velocity)[dim:], on_rider[dim:], strict=True):
        about = rider.turn(s["b"], k_axis)  # the axes half-way are those of the rider turned by half of the step
        about = about + np.cross(rider.turn(s["b"], half), about)
        turning = np.array([swung(about, arm) for arm in arms])
        yield "step: no net moment of the joint", relative(np.sum(turning * on_cable) + row, forces), 32 * EPS


def _step_kernel(family: SlideFamily) -> str:
    return FLOWING_GRADIENT if family.flows else DISCRETE_GRADIENT


def _forces(family: SlideFamily, k: Numbers, s: State, n_e: int) -> Iterator[Invariance]:
    element, rider = family.element, RIDERS[family.rider]
    g, out = k("residual", s)["g"], k("tangent", s)
    positions = np.array(element.is_position, dtype=float)
    net = positions @ g[: element.n_coordinates].reshape(-1, element.dim) + g[n_e : n_e + element.dim]
    yield "no net force of the joint", relative(net, g), 8 * EPS
    yield "g is J' f", relative(out["J"].T @ s["f"] - g, g), 16 * EPS
    K = out["K"]
    skew = K - K.T
    turning = slice(n_e + rider.rotations.start, n_e + rider.rotations.stop)
    skew[turning, turning] -= rider.bracket(g[turning])
    yield "K symmetric, but for the bracket of rotations", relative(skew, K), 16 * EPS
