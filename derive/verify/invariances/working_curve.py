"""Working curves in cases known without derivation, and turned as a whole."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import EPS, Numbers, State
from .measures import Invariance


def working_curve(family: CouplingFamily, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield the strain of a stretch, the force's direction, and the meeting of both curves at the highest strain."""
    a = np.eye(family.dim)[0]
    yield "a stretch of the slope is its strain", abs(k("measure", {**s, "a": 2.0 * a})["e"].item() - 1), 8 * EPS
    turned = np.linalg.qr(np.ones((family.dim, family.dim)) + np.diag(np.arange(family.dim)))[0]
    there = k("force", {**s, "a": turned @ s["a"]})["g"]
    yield "the force turns with the slope", np.abs(there - turned @ k("force", s)["g"]).max(), 64 * EPS
    ends = np.zeros_like(s["shape"])  # a straight shape
    ends[0], ends[3:5] = 1, (0, 1)
    top = k("change", {**s, "shape": ends, "e": s["highest"]})
    yield "the curves meet at the highest strain", abs(top["n"].item()) / s["first"][4], 64 * EPS
    low = k("change", {**s, "shape": ends, "e": s["permanent"] * s["highest"]})
    plain = k("change", {**s, "shape": ends, "permanent": 0.0, "e": 0.0})
    yield "no force at the permanent strain but that of first loading", abs(plain["n"].item()) / s["first"][4], 64 * EPS
    yield "unloading gives up first loading's force", float(max(0.0, low["n"].item())), 0.0
