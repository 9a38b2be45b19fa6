"""Ropes without mass in cases known without derivation."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import EPS, Numbers, State
from ..samples.shapes import rotation
from .measures import Invariance, relative


def taut_rope(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the tangent to both circles, the gradient of the drawn length, a turned scene, and known states."""
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
    (L, w), (free, length) = s["lengths"], s["past"]
    inextensible = s | {"past": np.array([length, length]), "lengths": np.array([length - w, w])}
    yield "without stretch: L0 is less by the way", relative(
        k("free_length", inextensible)["L0"] - (length - w), length), 16 * EPS
    there = k("free_length", s)["L0"][0]
    back = k("free_length", s | {"past": np.array([there, L]), "lengths": np.array([length, -w])})["L0"]
    yield "there and back: the same L0", relative(back - free, free), 16 * EPS
    slack = k("tension", s, EA=0.0)["T"]
    yield "slack: no tension", float(abs(slack[0])), 0.0
    still = k("tension", s, rates=np.zeros(2), lengths=np.array([free, 0.0]), past=np.array([free, free]))["T"]
    yield "without stretch: no tension", float(abs(still[0])), 0.0
    alone = float(k("free_length", s)["L0"][0])
    of_chain = k("slide", s, ratio=np.float64(1), x=np.float64(L / alone - 1))["sums"]
    yield "a chain of one rope: its way", abs(float(of_chain[0])) / free, 64 * EPS
    D = k("tension_tangent", s)["D"]
    yield "damping: of L' + w'", relative(D[0] - D[1], D), 4 * EPS
