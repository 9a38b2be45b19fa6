"""Relations of the kernels of branches: forces are derivatives of the power of the stress."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.branch import MEASURES
from ..methods import Relation
from ..motion import cross
from .paths import along, entry, from_kernel, root


def _measures(s: Any) -> np.ndarray:
    """Return strain and curvature, turned to the tangent before by the rotation exp(theta~) between both tangents."""
    a, b = s["a"], s["b"]
    size = a.dot(a) ** 0.5
    if len(a) == 2:
        return np.array([size - 1, (a[0] * b[1] - a[1] * b[0]) / a.dot(a)])
    i, before, kappa = a / size, s["i_0"], cross(a, b) / a.dot(a)
    axis, cos = cross(i, before), i.dot(before)  # of the size of the sine
    turned = kappa * cos + cross(axis, kappa) + axis * (axis.dot(kappa) / (1 + cos))  # Rodrigues
    return np.array([size - 1, *turned])


def branch(family: CouplingFamily) -> list[Relation]:
    """Return the relations of measures, forces and stresses."""
    dim, size = family.dim, MEASURES[family.dim]

    def power(k, s):
        return s["n"].dot(k("measures", s)["m"])

    def stressed(k, s):
        """Return the forces of the stress n + D (m - those of the sample)."""
        return k("force", s | {"n": s["n"] + s["D"].dot(k("measures", s)["m"] - s["m_sample"])})["g"]

    def held(k, s, t, j):
        return s["k"] * (s["decay"] * s["d_0"] + s["share"] * (s["m"] - s["m_0"]))

    def slid(k, s, t, j):
        trial = s["k"] * (s["d_0"] + s["m"] - s["m_0"])
        return s["limit"] * trial / trial.dot(trial) ** 0.5

    def from_sample(k, s, t, j):
        return along(stressed, (("a", dim), ("b", dim)))(k, s | {"m_sample": k("measures", s)["m"]}, t, j)

    return [
        Relation("measures", "m", "rotation between the tangents at 50 digits", 0, root(_measures)),
        Relation("force", "g", "d(n.m) by r' and r''", 1, along(power, (("a", dim), ("b", dim))), 2 * dim),
        Relation("tangent", "K", "dg by r' and r''", 1, from_sample, 2 * dim),
        Relation("hold", "n", "stress at 50 digits", 0, held),
        Relation("hold", "D", "dn by m", 1, from_kernel("hold", "n", m=entry("m")), size),
        Relation("slide", "n", "stress at 50 digits", 0, slid),
        Relation("slide", "D", "dn by m", 1, from_kernel("slide", "n", m=entry("m")), size),
    ]
