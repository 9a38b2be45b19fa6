"""Branches in cases known without derivation, and turned as a whole."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.branch import MEASURES
from ..numbers import EPS, Numbers, State
from .measures import Invariance


def branch(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the measures of an arc, forces without power in a turn, and the continuous change to sliding."""
    dim = family.dim
    a, b, arc = np.eye(dim)[0], 0.7 * np.eye(dim)[1], 0.7 * np.eye(MEASURES[dim])[-1]
    straight = k("measures", {**s, "i_0": a, "a": a, "b": b})["m"]
    yield "an arc of unit slope has its curvature alone", np.abs(straight - arc).max(), 8 * EPS
    scaled = k("measures", {**s, "i_0": a, "a": 2.0 * a, "b": b})["m"]
    yield "a stretch of the tangent is its strain", abs(scaled[0] - 1), 8 * EPS
    tangent = s["a"] / np.linalg.norm(s["a"])
    g = k("force", {**s, "i_0": tangent})["g"].reshape(2, dim)
    yield "the force of r'' is across the tangent", abs(g[1] @ tangent) / np.abs(g).max(), 32 * EPS
    trial = k("hold", {**s, "decay": 1.0, "share": 1.0})["n"]
    slid = k("slide", {**s, "limit": np.linalg.norm(trial)})["n"]
    yield "sliding begins with the stress that held", np.abs(slid - trial).max() / np.abs(trial).max(), 8 * EPS
