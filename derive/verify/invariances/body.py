"""Invariances of a body's kernels under motions of the frame."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import BodyFamily
from ..motion import RIDERS
from ..numbers import EPS, Numbers, State
from .measures import ORIGIN_SHIFT, Invariance, quantised, relative
from .moves import moves


def body(family: BodyFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield lengths, power, and digits far away."""
    rider = RIDERS[family.rider]
    dim, n = rider.dim, rider.n_velocity
    out, force = k("point", s), k("wrench", {**s, "m": 0 * s["m"]})
    distance = np.linalg.norm(out["p"] - s["b"][:dim])
    yield "the point keeps its distance", float(abs(distance / np.linalg.norm(s["u"]) - 1)), 8 * EPS
    yield "velocity is p_q w", relative(out["v"] - out["p_q"] @ s["w"], out["v"]), 8 * EPS
    b = np.concatenate([quantised(s["b"][:dim]) + ORIGIN_SHIFT, s["b"][dim:]])
    away = k("point", s, b=b)
    arm = rider.point(np.concatenate([np.zeros(dim), s["b"][dim:]]), s["u"])
    yield "position at 10⁴ lengths", relative(away["p"] - b[:dim] - arm, b[:dim]), 2 * EPS
    yield "derivatives: same digits at 10⁴ lengths", max(
        *(relative(away[name] - out[name], out[name]) for name in ("p_q", "v", "bias")),
        *(relative(k("wrench", s, b=b)[name] - k("wrench", s)[name], force["K"]) for name in ("K", "v_q"))), 0.0
    turning = force["K"][dim:, dim:]
    bracket = rider.bracket((out["p_q"].T @ s["f"])[dim:])
    yield "K symmetric, but for the bracket of rotations", relative(turning - turning.T - bracket, turning), 16 * EPS
    f = k("inertia_force", s)["f"]
    still = k("inertia_force", s, a=np.zeros(n))["f"]
    M = k("inertia_tangent", s)["M"]
    yield "the gyroscopic moment does no work", abs(still @ s["w"]) / relative(f, 1), 32 * EPS
    yield "f . w is the rate of the kinetic energy", abs(f @ s["w"] - s["w"] @ M @ s["a"]) / relative(f, 1), 64 * EPS
    yield from moves(rider, k, s)
    T = k("kinetic_energy", s)["T"][0]
    yield "kinetic energy is w . M w / 2", abs(s["w"] @ M @ s["w"] / 2 / T - 1), 8 * EPS
