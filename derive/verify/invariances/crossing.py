"""What lines that touch do in cases known without derivation."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import EPS, Numbers, State
from .measures import Invariance, relative, spins


def crossing(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that the force turns with the scene, is along the common normal, and keeps the balance of power."""
    out, told = k("force", s), k("contact", s)
    F, n = out["F"], told["n"]
    for spin in spins(family.dim):
        slopes = (s["t"] @ spin.T).ravel()
        turned = out["F_d"] @ (spin @ s["d"]) + out["F_u"] @ (spin @ s["u"]) + out["F_t"] @ slopes
        points = out["s_d"] @ (spin @ s["d"]) + out["s_t"] @ slopes
        yield "the force turns with the scene", relative(turned - spin @ F, F), 512 * EPS
        yield "closest points stay where the scene turns", float(np.max(np.abs(points))), 512 * EPS
    yield "the force is along the normal", relative(F - told["N"][0] * n, F), 64 * EPS
    yield "the normal is square to the lines", float(np.max(np.abs(s["t"] @ n))), 64 * EPS
    yield "the points are closest: no step is left", float(np.max(np.abs(k("closest", s)["step"]))), 64 * EPS
    depth, rate = told["p"]
    yield "way and penetration make the radii", abs(float(np.linalg.norm(s["d"])) + depth - s["c"][0]), 64 * EPS
    elastic = k("contact", {**s, "u": 0 * s["u"]})["N"][0]
    power = relative(told["N"] * rate - elastic * rate - told["P"], told["P"])
    yield "the force's power is stored or dissipated", power, 256 * EPS
