"""What the outputs of the load kernels are, for any element, and what no motion of the frame may change in them."""

from __future__ import annotations

from collections.abc import Iterator

import mpmath
import numpy as np

from ...elements.load_kernels import turning_slopes
from ...spec import Element
from ..invariances.element import FAR, Invariance, quantised, relative, spins
from ..methods import Relation
from ..motion import cross, frame
from ..numbers import EPS, Numbers, State
from ..references.element import Shape
from ..states import rotation
from .element import entry, from_kernel, root


def loads(spec: Element) -> list[Relation]:
    """Shape functions at 50 digits, forces from their definition with these, K from f."""
    n = spec.n_coordinates

    def shape(s, by=""):
        return Shape(spec, s["l"].item())((s["x"].item(), 0, 0), tuple(by.count(c) for c in "xyz"))

    def follower(k, s, t, j):
        tangent = shape(s, "x").dot(s["e"])
        director = shape(s, spec.director.partition("_")[2]).dot(s["e"]) if spec.director else None
        return np.outer(shape(s), frame(k, tangent, director).dot(s["c"]))

    def moment(s):
        """M . omega of the rotation that each coordinate's rate is."""
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
    """The least omega of those with the least sum |a' - omega x a|^2, in mpmath numbers."""
    if len(slopes[0]) == 2:
        return np.array([sum(a[0] * v[1] - a[1] * v[0] for a, v in zip(slopes, rates, strict=True))
                         / sum(a.dot(a) for a in slopes)])
    if len(slopes) == 1:
        return cross(slopes[0], rates[0]) / slopes[0].dot(slopes[0])
    turning = np.concatenate([np.stack([cross(axis, a) for axis in np.eye(3, dtype=int)], axis=1) for a in slopes])
    rates = np.concatenate(rates)
    # more equations than unknowns: mpmath solves in least squares
    return np.array(list(mpmath.lu_solve(mpmath.matrix(turning.tolist()), mpmath.matrix(rates.tolist()))))


def invariances(spec: Element, k: Numbers, s: State) -> Iterator[Invariance]:
    """Work on rotations, turned frames, digits far away."""
    positions = np.array(spec.is_position, dtype=float)
    e = quantised(s["e"])
    away = {**s, "e": e + np.outer(positions, np.full(spec.dim, FAR))}
    for kernel in ("follower_force", "moment"):
        out, there = k(kernel, s, e=e), k(kernel, away)
        yield "loads: same digits at 10⁴ lengths", max(float(np.max(np.abs(out[n] - there[n]))) for n in out), 0.0
        for axis in np.eye(spec.dim):
            shift = np.outer(positions, axis).ravel()
            yield "loads: K null on translation", relative(out["K"] @ shift, out["K"]), 8 * EPS
    f, K = (k("follower_force", s)[name] for name in "fK")
    yield "follower force: the net force is as large as c", abs(np.linalg.norm(positions @ f)
                                                                / np.linalg.norm(s["c"]) - 1), 16 * EPS
    Q = rotation(np.random.default_rng(4), spec.dim)
    yield "follower force turns with the element", relative(k("follower_force", s, e=s["e"] @ Q.T)["f"] - f @ Q.T, f), (
        64 * EPS)
    moment = k("moment", s)["f"]
    yield "moment: no net force", relative(positions @ moment, moment), 8 * EPS
    M, tangent = s["M"], k("on_axis", s)["N_x"] @ s["e"]
    for turn in spins(spec.dim):
        arms = s["e"] - np.outer(positions, s["e"][0])
        yield "follower force: K turns it", relative(K @ (arms @ turn.T).ravel() - (f @ turn.T).ravel(), K), 64 * EPS
        omega = turn[1, :1] if spec.dim == 2 else np.array([turn[2, 1], turn[0, 2], turn[1, 0]])
        if spec.dim == 3 and turning_slopes(spec) == ["x"]:
            omega = omega - tangent * (tangent @ omega) / (tangent @ tangent)
        yield "moment: f . v = M . ω in a rotation", relative(np.sum(moment * (arms @ turn.T)) - M @ omega, M), 64 * EPS
