"""Samples of lines in contact."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ..numbers import Numbers, State


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return two curved lines at their closest points, in contact, a penalty with both of its terms, and a stretch."""
    dim, shape = family.dim, (family.dim - 1, family.dim)
    t, k, w = random.normal(size=shape), 0.3 * random.normal(size=shape), random.normal(size=shape)
    square = np.array([t[0, 1], -t[0, 0]]) if dim == 2 else np.cross(*t)
    side = float(random.choice([-1, 1]))
    d = 0.4 * side * square / np.linalg.norm(square)
    return {"d": d, "t": t, "k": k, "w": w,
            "u": 0.3 * random.normal(size=dim), "c": np.array([0.7, side, 5.0, 3.0, 0.2, 1e-30, 0.3, 0.1]),
            "mu": 0.4, "k_t": 7.0, "e": 0.1 * random.normal(size=dim - 1),
            "third": 0.3 * random.normal(size=shape), "k_rate": 0.3 * random.normal(size=shape),
            "d_0": d + 0.1 * random.normal(size=dim), "d_rate": random.normal(size=dim),
            "t_0": t + 0.1 * random.normal(size=shape), "t_rate": random.normal(size=shape),
            "s_rate": random.normal(size=dim - 1), "v": random.normal(size=dim - 1),
            "slid": 1.0, "r_0": 0.35, "turns": 1.0, "x": 0.6 + 0.2 * random.random(dim - 1),
            "n": square / np.linalg.norm(square), "displacement": 0.1 * random.normal(size=dim),
            "turn": 0.1 * random.normal(size=shape), "size": 0.5 + random.random(dim - 1), "p": 0.3 * random.random(),
            "p_next": 0.3 * random.random(), "h": 0.1,
            **{name: random.normal(size=dim) for name in ("x_now", "x_old", "slip_old", "slip")}, "r_1": 0.4,
            "least": 1e-30}
