"""Ropes without mass in cases known without derivation."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import EPS, Numbers, State
from ..samples.shapes import rotation
from .measures import Invariance, relative


def taut_rope(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the tangent to both circles, the gradient of the drawn length, symmetry, a turned scene, and rest."""
    at = k("straight", s)
    u, rise = at["u"], float(s["rise"])
    n = np.array([-u[1], u[0]])
    yield "d = l u + rise n", relative(at["l"] * u + rise * n - s["d"], s["d"]), 16 * EPS
    yield "u is a unit vector", abs(float(u @ u) - 1), 16 * EPS
    yield "gradient of l - rise times the angle: u", relative(at["l_d"] - rise * at["b_d"] - u, u), 64 * EPS
    K = k("straight_tangent", s)["K"]
    yield "K symmetric", relative(K - K.T, K), 64 * EPS
    Q = rotation(np.random.default_rng(3), 2)
    turned = k("straight", s, d=Q @ s["d"])
    for name in ("u", "l_d", "b_d"):
        yield f"turned scene: {name}", relative(turned[name] - Q @ at[name], at[name]), 256 * EPS
    T, X = k("tension", s)["f"]
    stretch = s["lengths"][0] / s["lengths"][1]
    still = k("tension", s, rates=np.zeros(2))["f"]
    yield "damping: on L0 it is -stretch times that on L", abs((X - still[1]) + stretch * (T - still[0])), 64 * EPS
    slack = k("tension", s, EA=0.0)["f"]
    yield "slack: no tension, and what wheels hold", relative(slack - [0, -s["kept"]], s["kept"]), 4 * EPS
    held = s["EA"] / 2 * (stretch - 1) ** 2
    equal = k("tension", s, rates=np.zeros(2), kept=held)["f"]
    yield "at the stretch of what a wheel holds: -T stretch", relative(equal[1] + stretch * equal[0], equal), 64 * EPS
    K = k("tension_tangent", s, rates=np.zeros(2))["K"]
    yield "K of the lengths symmetric", relative(K - K.T, K), 64 * EPS
