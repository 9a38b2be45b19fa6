"""Relations of the kernels of the frame of two vectors."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ..methods import Relation
from ..motion import frame as gram_schmidt
from ..motion import swung_axes


def frame(family: CouplingFamily) -> list[Relation]:
    """Return the relations of the kernels of the frame of two vectors, eq 13-18."""
    dim = family.dim

    def moved(s, t, j):
        """Return the state with entry j of (a, b) moved by t."""
        motion = t * np.eye(2 * dim, dtype=int)[j]
        return {"a": s["a"] + motion[:dim], "b": s["b"] + motion[dim:]}

    def along(s, t):
        names = ("a", "b")
        return ({n: s[n] + t * s[f"{n}_rate"] + t * t / 2 * s[f"{n}_second"] for n in names}
                | {f"{n}_rate": s[f"{n}_rate"] + t * s[f"{n}_second"] for n in names})

    def turn(k, s):
        out = k("axes", s)
        return np.stack([swung_axes(column, out["A"]) for column in out["T"].T], axis=-1)

    return [
        Relation("axes", "A", "Gram-Schmidt of a and b", 0, lambda k, s, t, j: gram_schmidt(k, s["a"], s["b"])),
        Relation("axes", "T", "dA is T's turn of A", 1, lambda k, s, t, j: k("axes", s, **moved(s, t, j))["A"], 2 * dim,
                 of=turn),
        Relation("motion", "omega", "dA/dt is omega's turn of A", 1,
                 lambda k, s, t, j: k("axes", s, **along(s, t))["A"],
                 of=lambda k, s: swung_axes(k("motion", s)["omega"], k("axes", s)["A"])),
        Relation("motion", "alpha", "rate of omega", 1, lambda k, s, t, j: k("motion", s, **along(s, t))["omega"]),
        Relation("moment", "g", "T' m", 0, lambda k, s, t, j: k("axes", s)["T"].T.dot(s["m"])),
        Relation("moment", "K", "d(T' m) by a and b", 1, lambda k, s, t, j: k("moment", s, **moved(s, t, j))["g"],
                 2 * dim),
    ]
