"""The root of verification of sheaves: points of the material along the motion, and quadrature over them, at 50 digits.

A material point stays at S between the ends of a zone, whose angles and material coordinates move. Velocities, slopes
and their rates are differences of its places.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np

from .element import gauss

mp = mpmath.mp
POINTS = 24
"""Of the quadrature of sines: good to 50 digits over an angle of 2.5."""
STEP = mp.mpf(10) ** -9
"""Of central differences at 50 digits, second ones and rates of those among them: good to 18 digits."""


def angle(s: Any, S: Any, t: Any) -> Any:
    """Return the angle at the time t of the material point at the distance S from s_a at time 0."""
    phi, ends = s["phi"] + t * s["phi_rate"], [t * s["s_rate"][0], s["l"].item() + t * s["s_rate"][1]]
    return phi[0] + (phi[1] - phi[0]) * (S - ends[0]) / (ends[1] - ends[0])


def place(s: Any, S: Any, t: Any) -> np.ndarray:
    """Return the place of that point."""
    phi = angle(s, S, t)
    return s["c"] + t * s["c_rate"] + s["R"].item() * np.array([mp.cos(phi), mp.sin(phi)])


def strains(s: Any, S: Any, t: Any) -> np.ndarray:
    """Return the engineering strain |r_S| - 1 and the curvature |r_S x r_SS|/|r_S|^2 at that point."""
    before, here, after = (place(s, S + k * STEP, t) for k in (-1, 0, 1))
    slope, second = (after - before) / (2 * STEP), (after - 2 * here + before) / STEP**2
    square = slope.dot(slope)
    return np.array([mp.sqrt(square) - 1, abs(slope[0] * second[1] - slope[1] * second[0]) / square])


def energy(s: Any) -> Any:
    """Return the elastic energy."""
    return _over_material(s, lambda S: s["A"].dot(strains(s, S, 0) ** 2) / 2)


def dissipation(s: Any) -> Any:
    """Return the power dissipated by the rates of strain and curvature at material points."""
    return s["tau"].item() * _over_material(s, lambda S: s["A"].dot(_rate(lambda t: strains(s, S, t)) ** 2))


def gravity(s: Any) -> Any:
    """Return the energy of gravity."""
    return -s["rho"].item() * _over_material(s, lambda S: s["g"].dot(place(s, S, 0)))


def kinetic_energy(s: Any) -> Any:
    """Return the kinetic energy."""
    return s["rho"].item() / 2 * _over_material(s, lambda S: _square(_rate(lambda t: place(s, S, t))))


def _over_material(s: Any, value: Callable[[Any], Any]) -> Any:
    half = s["l"].item() / 2
    return sum(weight * half * value(half * (1 + t)) for t, weight in gauss(POINTS))


def _rate(path: Callable[[Any], np.ndarray]) -> np.ndarray:
    return np.asarray((path(STEP) - path(-STEP)) / (2 * STEP))


def _square(vector: np.ndarray) -> Any:
    return vector.dot(vector)


def _stretches(suffix: str, s: Any) -> list[Any]:
    """Return the stretches before and behind a point of friction."""
    if suffix == "_short":
        return [s[name].dot(s[name]) ** 0.5 for name in ("slope", "span_slope")]
    angles, lengths = (s["angles2"], s["lengths1"]) if suffix else (s["angles3"], s["lengths2"])
    of_zones = [abs(b - a) * s["R"].item() / length for a, b, length in zip(angles, angles[1:], lengths, strict=False)]
    of_span = s["span_slope"].dot(s["span_slope"]) ** 0.5
    return {"": of_zones, "_on": [of_span, *of_zones], "_off": [*of_zones, of_span]}[suffix]


def coulomb(suffix: str, s: Any) -> list[Any]:
    """Return the speed of sliding, P- + P+, and the limit of the jump of the tension by Euler's belt equation."""
    before, behind = _stretches(suffix, s)
    sense, R, rate, spin, flow = (s[name].item() for name in ("sense", "R", "angle_rate", "spin", "flow"))
    EA, rho = s["A"][0], s["rho"].item()
    speed = sense * R * rate - (before + behind) / 2 * flow
    angles = s["angles2" if suffix else "angles3"]
    here = {"_on": angles[0], "_short": sum(angles) / 2}.get(suffix, angles[1])
    outwards = s["R"].item() * s["g"].dot(np.array([mp.cos(here), mp.sin(here)]))
    pressure = EA * (before + behind - 2) - 4 * rho / (before + behind) * (speed * speed + outwards)
    sliding = sense * R * (rate - spin) - (before if flow < 0 else behind) * flow
    half = s["mu"].item() * abs(angles[-1] - angles[0]) / (2 if suffix == "_short" else 4)
    up, down = mpmath.exp(half), mpmath.exp(-half)
    return [sliding, pressure, (up - down) / (up + down) * pressure]


def friction(suffix: str, s: Any) -> list[Any]:
    """Return the speed of sliding, P- + P+, and the jump of the tension, regularised."""
    sliding, pressure, limit = coulomb(suffix, s)
    v0 = s["v0"].item()
    return [sliding, pressure, limit * sliding / (sliding * sliding + v0 * v0) ** 0.5]


def friction_forces(suffix: str, jump: Any, s: Any) -> list[Any]:
    """Return the generalised forces of a jump of the tension on the angle, on the rotation of the sheave, and on s."""
    arm = s["sense"].item() * s["R"].item() * jump
    return [arm, -arm, -jump * sum(_stretches(suffix, s)) / 2]


# --- a short wrap -------------------------------------------------------------------------------------------------

def short_wrap(s: Any) -> list[Any]:
    """Return how much longer the arc is than the drawn length of a short wrap."""
    return [s["sense"].item() * s["R"].item() * (s["phi"][1] - s["phi"][0]) - mean_stretch(s, 0) * s["l"].item()]


def short_wrap_energy(s: Any) -> Any:
    """Return its elastic energy: that of a zone with the arc of the drawn length."""
    angle = mean_stretch(s, 0) * s["l"].item() / s["R"].item()
    return energy({**s, "phi": np.array([mp.mpf(0), angle])})


def short_wrap_motion(s: Any) -> Any:
    """Return the second rate of the condition where the angles, slopes and the length move evenly."""
    def drawn(t: Any) -> Any:
        return mean_stretch(s, t) * (s["l"].item() + t * s["l_rate"].item())
    return -(drawn(STEP) - 2 * drawn(0) + drawn(-STEP)) / STEP**2


def mean_stretch(s: Any, t: Any) -> Any:
    """Return the mean length of the slopes of both spans beside it, at the time t."""
    slopes = [s[name] + t * s[f"{name}_rate"] for name in ("slope", "span_slope")]
    return sum(mp.sqrt(slope.dot(slope)) for slope in slopes) / 2
