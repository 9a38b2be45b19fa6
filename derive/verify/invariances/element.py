"""Invariances of an element's kernels under motions of the frame."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import ElementFamily
from ...spec import x, y, z
from ..numbers import EPS, Numbers, State
from ..samples.shapes import reference
from . import load
from .measures import Invariance, relative


def element(family: ElementFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield partition of unity, totals, and balances of loads."""
    yield from _shape_and_mass(family, k, s)
    yield from load.invariances(family.element, k, s)


def _shape_and_mass(family: ElementFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    spec = family.element
    at_nodes = np.array(spec.is_position, dtype=float)
    e0 = reference(spec, float(s["l"]))
    held = np.array([c in spec.basis for c in (x, y, z)][: spec.dim], dtype=float)
    for part in (0.0, 0.31, 0.5, 1.0):
        at = np.array([part * s["l"], 0.1, -0.07])
        out = k("position", s, at=at, e=e0)
        yield "partition of unity", abs(out["N"].dot(at_nodes) - 1), 4 * EPS
        yield "the reference is reproduced", relative(out["r"] - held * at[: spec.dim], s["l"]), 4 * EPS
    total = s["density"] * s["section"][0] * s["l"]
    m = k("mass", s)["m"]
    yield "mass total is ρ A l", abs(at_nodes.dot(m).dot(at_nodes) / total - 1), 8 * EPS
    yield "mass symmetric", relative(m - m.T, m), 0.0
    least = float(np.linalg.eigvalsh(m)[0]) if np.isfinite(m).all() else -np.inf
    yield "mass positive definite (least eigenvalue below zero)", max(-least, 0.0), 0.0
    Q = k("gravity", s)["Q"]
    yield "gravity total is ρ A l g", relative(at_nodes.dot(Q) - total * s["g"], total * s["g"]), 8 * EPS
