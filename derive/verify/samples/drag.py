"""Samples of drag."""

from __future__ import annotations

import numpy as np

from ...codegen.family import CouplingFamily
from ..motion import swung_axes
from ..numbers import Numbers, State


def sample(family: CouplingFamily, exact: Numbers, random: np.random.Generator) -> State:
    """Return the slope of a cable, the velocity of the fluid past it, with rates and at the end of a step; axes of a
    body and its turn, over a step by a Cayley vector; coefficients of drag, added masses along and across; a surface
    that cuts what is wetted.
    """
    dim = family.dim
    vectors = ("t", "w", "t_rate", "t_next", "w_next", "v", "a", "U", "U_rate", "up")
    moving = {name: random.normal(size=dim) for name in vectors}
    axes, half = np.linalg.qr(random.normal(size=(dim, dim)))[0], random.normal(size=(dim, dim))
    sampled = moving | {"A": axes, "G": random.normal(size=(dim, dim)), "displaced": np.float64(1.7),
                     "wet": np.array([0.6, -0.9, 0.7, 0.5]),
                     **_wave(random, dim), "Z_t": np.float64(0.7), "Z_r": random.normal(size=dim),
                     "height": np.float64(-0.7), "eta": np.float64(0.3),
                     "eta_t": np.float64(0.4), "eta_r": random.normal(size=dim), "inv_depth": np.float64(0.2),
                     "omega": random.normal(size=3 if dim == 3 else 1), "C": half @ half.T, "m": np.array([1.3, 0.2]),
                     "u": np.array([-0.97]), "delta": np.array([0.05]), "phi": np.array([0.4]),
                     "s": _unit(random.normal(size=3)) if dim == 3 else -np.ones(1),
                     "c_lift": np.array([0.6, 1e-30]), "c_foil": np.array([0.9, 1e-30]),
                     "coefficients": np.array([0.5, 0.3, 0.8, -1.2]), "c": np.array([0.8, 0.3, 1e-30]),
                     "c_point": np.array([0.7, 1e-30]), **(_section(random) if dim == 3 else {})}
    theta = random.normal(size=3 if dim == 3 else 1)
    one, across = np.eye(dim), swung_axes(theta / 2, np.eye(dim))
    return sampled | {"theta": theta, "A_next": np.linalg.solve(one - across, (one + across) @ axes),
                      "turning": random.normal(size=dim), "y": random.normal(size=dim), "growth": np.float64(0.4)}


def _wave(random: np.random.Generator, dim: int) -> State:
    """Return a wave with its phase at a place and time, and its decay to a height."""
    place, time, k = random.normal(size=dim), np.float64(0.3), random.normal(size=dim)
    wave, Z = np.array([0.8, 1.3, 0.4, 0.9, 0.2]), np.float64(-0.6)
    theta = k @ place - wave[1] * time + wave[2]
    return {"place": place, "time": time, "k": k, "wave": wave, "Z": Z, "cosine": np.cos(theta), "sine": np.sin(theta),
            "grow": np.exp(wave[3] * Z)}


def _section(random: np.random.Generator) -> State:
    """Return the chord of a section that is sheared, and its coefficients by the angle of attack."""
    return {"d": random.normal(size=3), "c_section": np.array([0.8, 1.4, 1e-30]),
            "polar": np.array([0.5, 0.3, 0.8, -1.2, 0.4, 0.9])}


def _unit(vector: np.ndarray) -> np.ndarray:
    return np.asarray(vector / np.linalg.norm(vector))
