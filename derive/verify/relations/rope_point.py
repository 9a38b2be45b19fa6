"""Relations of the kernels of a material point of a rope."""

from __future__ import annotations

from typing import Any

import numpy as np

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

    def over_step(k, s):
        change = np.concatenate([(s["e_next"] - s["e"]).ravel(), s["s_next"] - s["s"]])
        return k("point", s)["p"] + k("discrete_point", s)["P"].dot(change)

    moves = (*coordinates, ("S", 1))

    def slope(s: Any) -> Any:
        first, last = s["s"]
        a, b = s["share"]
        x = s["S"].item() - first - a * (last - first)
        return Shape(spec, (b - a) * (last - first))((x, 0, 0), (1, 0, 0)).dot(s["e"])

    def sliding(k, s, t, j):
        return k("slope", s, e=s["e"] + t * s["v"], s=s["s"] + t * s["s_rate"], S=s["S"] + t * s["S_rate"])["t"]

    def pull(k, s):
        return k("slope", s)["T"].T.dot(s["g"])

    return [Relation("slope", "t", "Σ N_x d at 50 digits", 0, root(slope)),
            Relation("slope", "T", "dt by e, s1, s2, S", 1, along(of("slope", "t"), moves), n + 1),
            Relation("slope", "rate", "dt/dt", 1, sliding),
            Relation("slope", "bias", "d²t/dt² at zero second rates", 2, sliding),
            Relation("slope_stiffness", "K", "d(T' g) by e, s1, s2, S", 1, along(pull, moves), n + 1),
            Relation("discrete_point", "P", "p + P dq is p at the end of the step", 0,
                     lambda k, s, t, j: k("point", s, e=s["e_next"], s=s["s_next"])["p"], of=over_step),
            Relation("discrete_point", "P", "dp by e, s1, s2, over no step", 1, along(of("point", "p"), coordinates), n,
                     of=lambda k, s: k("discrete_point", s, e_next=s["e"], s_next=s["s"])["P"]),
            Relation("point", "p", "Σ N d at 50 digits, at the same place in the material", 0, root(place)),
            Relation("point", "P", "dp by e, s1, s2", 1, along(of("point", "p"), coordinates), n),
            Relation("point", "velocity", "dp/dt", 1, moving),
            Relation("point", "bias", "d²p/dt² at zero second rates", 2, moving),
            Relation("wrench", "K", "d(P' f) by e, s1, s2", 1, along(force, coordinates), n),
            Relation("wrench", "v_q", "dv by e, s1, s2", 1, along(of("point", "velocity"), coordinates), n)]
