"""Invariances of the load kernels of an element under motions of the frame."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...elements.load_kernels import turning_slopes
from ...spec import Element
from ..numbers import EPS, Numbers, State
from ..samples.shapes import rotation
from .measures import ORIGIN_SHIFT, Invariance, quantised, relative, spins


def invariances(spec: Element, k: Numbers, s: State) -> Iterator[Invariance]:
    """Yield work on rotations, turned frames, and digits far away."""
    positions = np.array(spec.is_position, dtype=float)
    e = quantised(s["e"])
    away = {**s, "e": e + np.outer(positions, np.full(spec.dim, ORIGIN_SHIFT))}
    for kernel in ("follower_force", "moment"):
        out, there = k(kernel, s, e=e), k(kernel, away)
        yield "loads: same digits at 10⁴ lengths", max(float(np.max(np.abs(out[n] - there[n]))) for n in out), 0.0
        for axis in np.eye(spec.dim):
            shift = np.outer(positions, axis).ravel()
            yield "loads: K null on translation", relative(out["K"] @ shift, out["K"]), 8 * EPS
    f, K = (k("follower_force", s)[name] for name in "fK")
    yield "follower force: the net force is as large as c", float(
        abs(np.linalg.norm(positions @ f) / np.linalg.norm(s["c"]) - 1)), 16 * EPS
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
