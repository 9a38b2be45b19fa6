"""Tangent points in space under motions of the frame, in the plane, and along a geodesic of a cylinder."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import EPS, Numbers, State
from ..samples.shapes import rotation
from .measures import ORIGIN_SHIFT, Invariance, quantised, relative

VECTORS = ("x", "slope", "chord", "weight", "axis", "x_rate", "slope_rate", "chord_rate")


def tangent_point(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the symmetry of K, a turned scene, a chord in the plane of the groove, a geodesic, and a far origin."""
    K = k("conditions", s)["K"]
    yield "K symmetric", relative(K - K.T, K), 64 * EPS
    Q = rotation(np.random.default_rng(3), 3)
    turned = s | {name: Q @ s[name] for name in VECTORS}
    for kernel, output in (("conditions", "phi"), ("motion", "Q_d")):
        value = k(kernel, s)[output]
        yield f"turned scene: same {output}", relative(k(kernel, turned)[output] - value, value), 512 * EPS
    yield from _in_plane(k, s)
    yield from _geodesic(k, s)
    near = s | {"e": quantised(s["e"])}
    away = near | {"e": near["e"] + np.outer([1, 0, 1, 0], np.full(3, ORIGIN_SHIFT))}
    here, there = k("chord", near), k("chord", away)
    yield "same digits at 10⁴ lengths", max(float(np.max(np.abs(here[n] - there[n]))) for n in ("r_L", "r_LL")), 0.0


def _in_plane(k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that a chord in the plane of the groove leaves |x| = R, whatever its length and direction."""
    axis = s["axis"]
    flat = {name: s[name] - axis * (axis @ s[name]) for name in ("x", "chord", "weight")}
    found = k("conditions", s | flat)
    yield "chord in the plane: |x| - R", relative(
        found["phi"][2] - (np.linalg.norm(flat["x"]) - s["R"]), s["R"]), 16 * EPS
    yield "chord in the plane: no force on it", relative(found["J"][2, 6:9], 1 / s["R"]), 64 * EPS


def _geodesic(k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that a taut string satisfies the conditions where R phi + l is stationary, its end anywhere."""
    axis, R = s["axis"], float(s["R"])
    fleet, length = 0.23, 2.1
    n = np.linalg.svd(axis[None])[2][1]
    t = np.cross(axis, n)
    x, e = R / np.cos(fleet) * n, np.cos(fleet) * t + np.sin(fleet) * axis
    found = k("conditions", s | {"x": x, "slope": 1.01 * e, "chord": length * e, "weight": np.zeros(3)})
    yield "geodesic: the conditions hold", relative(found["phi"], R), 64 * EPS
    by_angle = R * t / np.linalg.norm(x)  # of R phi, by x
    slope = by_angle - e  # of R phi + l, in the plane of the groove
    yield "geodesic: R phi + l is stationary", relative(slope - axis * (axis @ slope), 1.0), 64 * EPS
