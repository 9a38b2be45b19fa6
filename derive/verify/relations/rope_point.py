"""Relations of the kernels of a material point of a rope."""

from __future__ import annotations

from typing import Any

from ...codegen.family import CouplingFamily
from ...couplings.rope_point import ELEMENT
from ...elements import ELEMENTS
from ..methods import Relation
from ..references.element import Shape
from .paths import along, of, root


def rope_point(family: CouplingFamily) -> list[Relation]:
    """Return the relations of the kernels."""
    spec = ELEMENTS[ELEMENT[family.dim]]
    coordinates = (("e", spec.n_coordinates), ("s", 2))
    n = spec.n_coordinates + 2

    def place(s: Any) -> Any:
        first, last = s["s"]
        a, b = s["share"]
        x = s["S"].item() - first - a * (last - first)
        return Shape(spec, (b - a) * (last - first))((x, 0, 0), (0, 0, 0)).dot(s["e"])

    def moving(k, s, t, j):
        return k("point", s, e=s["e"] + t * s["v"], s=s["s"] + t * s["s_rate"])["p"]

    def force(k, s):
        return k("point", s)["P"].T.dot(s["f"])

    return [Relation("point", "p", "Σ N d at 50 digits, at the same place in the material", 0, root(place)),
            Relation("point", "P", "dp by e, s1, s2", 1, along(of("point", "p"), coordinates), n),
            Relation("point", "velocity", "dp/dt", 1, moving),
            Relation("point", "bias", "d²p/dt² at zero second rates", 2, moving),
            Relation("wrench", "K", "d(P' f) by e, s1, s2", 1, along(force, coordinates), n),
            Relation("wrench", "v_q", "dv by e, s1, s2", 1, along(of("point", "velocity"), coordinates), n)]
