"""Relations of the kernels of working curves: forces are derivatives of energies."""

from __future__ import annotations

from typing import Any

from ...codegen.family import CouplingFamily
from ...codegen.piecewise import NUMERICAL
from ..methods import Relation
from .paths import along, entry, from_kernel, root


def _strain(s: Any) -> Any:
    return s["a"].dot(s["a"]) ** 0.5 - 1


def working_curve(family: CouplingFamily) -> list[Relation]:
    """Return the relations of the strain, the force and its energy."""
    dim = family.dim

    def curve(k, s, t, j):
        """Return the force of the working curve less that of first loading."""
        value, low = NUMERICAL["fu_cubic_value"], s["permanent"] * s["highest"]
        x = (s["e"] - low) / (s["highest"] - low)
        return value(s["first"], s["highest"]) * value(s["shape"], x) - value(s["first"], s["e"])

    def stored(k, s, t, j):
        """Return the energy of the working curve from the permanent strain, less that of first loading from 0."""
        work, low = NUMERICAL["fu_cubic_integral"], s["permanent"] * s["highest"]
        top, reach = NUMERICAL["fu_cubic_value"](s["first"], s["highest"]), s["highest"] - low
        return top * reach * work(s["shape"], (s["e"] - low) / reach) - work(s["first"], s["e"])

    def work(k, s):
        return s["n"] * k("measure", s)["e"]

    def stressed(k, s):
        """Return the force of n + D (e - that of the sample)."""
        return k("force", s | {"n": s["n"] + s["D"] * (k("measure", s)["e"] - s["e_sample"])})["g"]

    def from_sample(k, s, t, j):
        return along(stressed, (("a", dim),))(k, s | {"e_sample": k("measure", s)["e"]}, t, j)

    return [
        Relation("measure", "e", "strain at 50 digits", 0, root(_strain)),
        Relation("change", "n", "force at 50 digits", 0, curve),
        Relation("change", "U", "energy at 50 digits", 0, stored),
        Relation("change", "n", "dU by e", 1, from_kernel("change", "U", e=entry("e"))),
        Relation("change", "D", "dn by e", 1, from_kernel("change", "n", e=entry("e"))),
        Relation("force", "g", "d(n e) by r'", 1, along(work, (("a", dim),)), dim),
        Relation("tangent", "K", "dg by r'", 1, from_sample, dim),
    ]
