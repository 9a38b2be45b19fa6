"""Invariances of a modal body's kernels under motions of the frame."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...bodies.modal import vector_product
from ...codegen.family import BodyFamily
from ..motion import RIDERS
from ..numbers import EPS, Numbers, State
from .measures import ORIGIN_SHIFT, Invariance, quantised, relative


def modal(family: BodyFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield symmetry of the mass matrix, weight, and digits far away."""
    dim = RIDERS[family.rider].dim
    M = k("mass_matrix", s)["M"]
    yield "M symmetric", relative(M - M.T, M), 8 * EPS
    least = float(np.linalg.eigvalsh((M + M.T) / 2)[0]) if np.isfinite(M).all() else -np.inf
    yield "M positive definite (least eigenvalue below zero)", max(-least, 0.0), 0.0
    axes = k("attachment", s)["axes"]
    yield "axes' axes = 1", relative(axes.T @ axes - np.eye(len(axes)), 1), 8 * EPS
    b = np.concatenate([quantised(s["b"][: dim]) + ORIGIN_SHIFT, s["b"][dim :]])
    yield "forces: same digits at 10⁴ lengths", max(
        relative(k(name, s, b=b)["f"] - k(name, s)["f"], 1) for name in ("inertia_force", "mode_force")), 0.0
    along = vector_product(s["S"], s["g"])
    weight = k("inertia_force", {**s, "w": 0 * s["w"], "a": 0 * s["a"], "S1": 0 * s["S1"], "S2": 0 * s["S2"],
                                 "X1": 0 * s["X1"], "X2": 0 * s["X2"], "b": np.eye(len(s["b"]))[dim]})["f"]
    yield "weight is m g, its moment S x g", relative(
        weight + np.concatenate([s["mass"] * s["g"], along]), weight), 8 * EPS
