"""Invariances of the frame of two vectors under turns."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ..motion import swung_axes
from ..numbers import EPS, Numbers, State
from .measures import Invariance


def frame(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield that the frame is orthonormal and right-handed, that a turn of both vectors turns it, and that length does
    not matter.
    """
    out = k("axes", s)
    A, T = out["A"], out["T"]
    off = np.abs(A.T @ A - np.eye(len(A))).max()
    yield "A' A = I, right-handed", max(float(off), abs(np.linalg.det(A) - 1)), 8 * EPS
    for theta in np.eye(len(T)):
        both = np.concatenate([swung_axes(theta, s[name][:, None])[:, 0] for name in "ab"])
        yield "turned vectors turn the frame", float(np.abs(T @ both - theta).max()), 64 * EPS
    stretched = T @ np.concatenate([s["a"], 0 * s["b"]])
    yield "their lengths do not", float(np.abs(stretched).max()), 16 * EPS
