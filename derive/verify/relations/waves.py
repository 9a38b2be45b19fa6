"""Relations of the kernels of waves: velocity from its potential, derivatives, and the surface that moves with it."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..methods import Relation
from ..numbers import Numbers, State
from .paths import unit

PHASE, STRETCHING = "wave_phase", "wave_stretching"
ELEVATION, VELOCITY = "wave_elevation", "wave_velocity"


def _at(k: Numbers, kernel: str, s: State) -> dict[str, np.ndarray]:
    """Return the outputs of a kernel of the phase, at the place, time and height of a state."""
    theta = np.asarray(k(PHASE, s)["theta"]).item()
    return k(kernel, s, cosine=np.asarray(k.cos(theta)), sine=np.asarray(k.sin(theta)),
             grow=np.asarray(k.exp(np.asarray(s["wave"][3] * s["Z"]).item())))


def _moved(s: State, t: Any, j: int) -> State:
    """Return the state at a place t times entry j away, where the height is another one."""
    return {**s, "place": s["place"] + t * unit(s["place"], j), "Z": s["Z"] + t * s["Z_r"][j]}


def _later(s: State, t: Any) -> State:
    return {**s, "time": s["time"] + t, "Z": s["Z"] + t * s["Z_t"]}


def waves(dim: int) -> list[Relation]:
    """Return the relations."""
    def upright(s):
        """Return the state with a wave that is square to the vertical, a unit vector, at the still level."""
        up = s["up"] / s["up"].dot(s["up"]) ** 0.5
        across = s["k"] - up * up.dot(s["k"])
        a, omega, phase, _, q = s["wave"]
        return {**s, "up": up, "k": across, "Z": 0 * s["Z"],
                "wave": np.array([a, omega, phase, across.dot(across) ** 0.5, q])}

    def with_rate(k, s):
        """Return the velocity with the rate of the elevation as its vertical part."""
        found, up = _at(k, VELOCITY, s)["U"], s["up"]
        return found + up * (_at(k, ELEVATION, s)["eta_t"][0] - up.dot(found))

    def bernoulli(k, s):
        """Return -g eta, with g = omega^2/k coth(kd) of the dispersion relation."""
        _, omega, _, size, q = s["wave"]
        return -_at(k, ELEVATION, s)["eta"] * omega**2 * (1 + q) / ((1 - q) * size)

    def potential_rate(k, s, t, j):
        return _at(k, VELOCITY, {**_later({**s, "Z_t": 0 * s["Z_t"]}, t), "Z": 0 * s["Z"]})["potential"]

    def stretched(s):
        """Return the height with the elevation taken off, by the height of the water column."""
        return (s["height"] - s["eta"]) / (1 + s["eta"] * s["inv_depth"])

    def height_later(k, s, t, j):
        return stretched({**s, "eta": s["eta"] + t * s["eta_t"]})

    def height_moved(k, s, t, j):
        return stretched({**s, "height": s["height"] + t * s["up"][j], "eta": s["eta"] + t * s["eta_r"][j]})

    def phase(s):
        return s["k"].dot(s["place"]) - s["wave"][1] * s["time"] + s["wave"][2]

    return [
        Relation(PHASE, "theta", "k . r - omega t + phi", 0, lambda k, s, t, j: phase(s)),
        Relation(STRETCHING, "Z", "(height - eta)/(1 + eta/depth)", 0, lambda k, s, t, j: stretched(s)),
        Relation(STRETCHING, "Z_t", "dZ by the time", 1, height_later),
        Relation(STRETCHING, "Z_r", "dZ by the place", 1, height_moved, dim),
        Relation(VELOCITY, "potential", "its rate at the still level, -g eta with g of the dispersion relation", 1,
                 potential_rate, of=lambda k, s: bernoulli(k, s)),
        Relation(ELEVATION, "eta", "-1/g times the rate of the potential at the still level", 1, potential_rate,
                 of=lambda k, s: bernoulli(k, s)),
        Relation(ELEVATION, "eta_t", "d eta by the time", 1,
                 lambda k, s, t, j: _at(k, ELEVATION, {**s, "time": s["time"] + t})["eta"]),
        Relation(ELEVATION, "eta_r", "d eta by the place", 1,
                 lambda k, s, t, j: _at(k, ELEVATION, _moved(s, t, j))["eta"], dim),
        Relation(VELOCITY, "U", "its vertical part at the still level, the rate of eta", 0,
                 lambda k, s, t, j: with_rate(k, upright(s)), of=lambda k, s: _at(k, VELOCITY, upright(s))["U"]),
        Relation(VELOCITY, "U", "gradient of the potential", 1,
                 lambda k, s, t, j: _at(k, VELOCITY, _moved({**s, "Z_r": s["up"]}, t, j))["potential"], dim),
        Relation(VELOCITY, "U_t", "dU by the time", 1, lambda k, s, t, j: _at(k, VELOCITY, _later(s, t))["U"]),
        Relation(VELOCITY, "G", "dU by the place", 1, lambda k, s, t, j: _at(k, VELOCITY, _moved(s, t, j))["U"], dim),
        Relation(VELOCITY, "G", "divergence, nil", 0, lambda k, s, t, j: 0 * s["Z"],
                 of=lambda k, s: sum(_at(k, VELOCITY, {**upright(s), "Z_r": upright(s)["up"]})["G"][i][i]
                                     for i in range(dim))),
    ]
