"""Relations of the kernels of loads, for any element."""

from __future__ import annotations

import mpmath
import numpy as np

from ...elements.load_kernels import turning_slopes
from ...spec import Element
from ..methods import Relation
from ..motion import cross, frame
from ..references.element import Shape
from .paths import entry, from_kernel, root


def loads(spec: Element) -> list[Relation]:
    """Return the relations of the load kernels: shape functions at 50 digits, forces from their definition, K from f.
    """
    n = spec.n_coordinates

    def shape(s, by=""):
        return Shape(spec, s["l"].item())((s["x"].item(), 0, 0), tuple(by.count(c) for c in "xyz"))

    def follower(k, s, t, j):
        tangent = shape(s, "x").dot(s["e"])
        director = shape(s, spec.director.partition("_")[2]).dot(s["e"]) if spec.director else None
        return np.outer(shape(s), frame(k, tangent, director).dot(s["c"]))

    def moment(s):
        """Return M . omega of the rotation that each coordinate's rate is."""
        weights = [shape(s, c) for c in turning_slopes(spec)]
        slopes = [w.dot(s["e"]) for w in weights]
        unit = np.eye(spec.dim, dtype=int)
        return [s["M"].dot(turning_rate(slopes, [w[k] * axis for w in weights]))
                for k in range(spec.n_vectors) for axis in unit]

    return [
        Relation("on_axis", "N", "nodal conditions solved at 50 digits", 0, root(shape)),
        Relation("on_axis", "N_x", "their derivative by x", 0, root(lambda s: shape(s, "x"))),
        Relation("slopes", "S", "derivatives of the shape functions at 50 digits", 0,
                 root(lambda s: np.array([[shape(s, a + order) for order in ("", "x", "xx")] for a in "xyz"]))),
        Relation("follower_force", "f", "N' times the force in the frame by Gram-Schmidt", 0, follower),
        Relation("follower_force", "K", "df/de", 1, from_kernel("follower_force", "f", e=entry("e")), n),
        Relation("moment", "f", "M . ω, ω the best fit to the rates of the slopes", 0, root(moment)),
        Relation("moment", "K", "df/de", 1, from_kernel("moment", "f", e=entry("e")), n),
    ]


def turning_rate(slopes: list[np.ndarray], rates: list[np.ndarray]) -> np.ndarray:
    """Return the smallest omega with the least sum |a' - omega x a|^2, in mpmath numbers."""
    if len(slopes[0]) == 2:
        return np.array([sum(a[0] * v[1] - a[1] * v[0] for a, v in zip(slopes, rates, strict=True))
                         / sum(a.dot(a) for a in slopes)])
    if len(slopes) == 1:
        return cross(slopes[0], rates[0]) / slopes[0].dot(slopes[0])
    turning = np.concatenate([np.stack([cross(axis, a) for axis in np.eye(3, dtype=int)], axis=1) for a in slopes])
    every = np.concatenate(rates)
    # more equations than unknowns: mpmath solves in least squares
    return np.array(list(mpmath.lu_solve(mpmath.matrix(turning.tolist()), mpmath.matrix(every.tolist()))))
