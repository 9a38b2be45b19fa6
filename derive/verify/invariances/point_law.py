"""Invariances of the laws of forces between two points."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import PointLawFamily
from ..motion import spatial
from ..numbers import EPS, Numbers, State
from ..samples.point_law import undamped
from ..samples.shapes import rotation
from .measures import Invariance, relative


def point_law(family: PointLawFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that a law has no directions of its own, no moment on the pair of points, and a symmetric stiffness."""
    Q = rotation(np.random.default_rng(0), family.dim)
    turned = {name: Q @ s[name] for name in ("gap", "gap_rate", "gap_next")}
    for kernel, output in (("energy", "U"), ("force", "f"), ("discrete_force", "f")):
        straight = k(kernel, s)[output]
        expected = Q @ straight if output == "f" else straight
        yield f"{kernel} turns with the gap", relative(k(kernel, s, **turned)[output] - expected, straight), 64 * EPS
    elastic = undamped(family, s["parameters"])
    f = k("force", s, parameters=elastic)["f"]
    yield "no moment on the pair of points", _moment(s["gap"], f), 8 * EPS
    f = k("discrete_force", s, parameters=elastic)["f"]
    yield "step: no moment about the mean points", _moment(s["gap"] + s["gap_next"], f), 8 * EPS
    K = k("tangent", s, gap_rate=0 * s["gap_rate"])["K"]
    yield "stiffness symmetric", relative(K - K.T, K), 4 * EPS


def _moment(arm: np.ndarray, force: np.ndarray) -> float:
    """Moment of a force over its size times that of its arm."""
    moment = np.cross(spatial(arm), spatial(force))
    return float(np.linalg.norm(moment) / np.linalg.norm(arm) / np.linalg.norm(force))
