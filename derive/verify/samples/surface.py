"""Samples of surfaces and contact."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ...couplings.frame import TURNS
from ...couplings.surface import HEIGHTS
from ..numbers import Numbers, State


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return a point near a surface, its velocity, an anchor's distance, and the numbers of the laws."""
    dim = family.dim
    y, axis, n, x, w = random.normal(size=(5, dim))
    second = random.normal(size=(dim, dim))
    r, v, a, r_o, v_o, a_o = random.normal(size=(6, dim))
    omega, alpha, omega_o, alpha_o = random.normal(size=(4, TURNS[dim]))
    f, arm, mean_arm, dr, dv = random.normal(size=(5, dim))
    turn, dtheta, dtheta_o, domega_o = random.normal(size=(4, TURNS[dim]))
    f_y, f_w, f_x = random.normal(size=(3, dim, dim))
    return {"f": f, "f_y": f_y, "f_w": f_w, "f_x": f_x, "arm": arm, "mean_arm": mean_arm, "share": np.array(0.5),
            "turn": turn, "dr": dr, "dv": dv, "dtheta": dtheta, "dtheta_o": dtheta_o, "domega_o": domega_o,
            "y": y, "axis": (dim - 2) * axis / np.linalg.norm(axis), "normal": n / np.linalg.norm(n),
            "radius": np.array(0.4),
            "h": 0.5 * random.normal(size=len(HEIGHTS[dim])), "depth": np.array(0.7), "depth_next": np.array(0.4),
            "depth_rate": np.array(0.3), "law": np.array([1.7, 0.6]), "n": 1.1 * n / np.linalg.norm(n),
            "H": second + second.T, "w": w, "normal_force": np.array([0.8, 1.3, 0.4]), "x": x, "k_t": np.array(1.4),
            "mu": np.array(0.35), "v0": np.array(0.9), "r": r, "v": v, "a": a, "r_o": r_o, "v_o": v_o, "a_o": a_o,
            "omega": omega, "alpha": alpha, "omega_o": omega_o, "alpha_o": alpha_o}
