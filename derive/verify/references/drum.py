"""The root of verification of drums: points of the wound rope and the way on the rim along the motion, at 50 digits.

Points of the wound rope turn with the drum; sums over it are means over whole turns. Rates are differences.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np

from .element import gauss
from .sheave import STEP, strains

mp = mpmath.mp
ON_TURN = 8
"""Points on a turn: exact for squares of sines."""
ON_STRETCHES = 4
"""Gauss points between two stretches: exact for polynomials."""


# --- winding ----------------------------------------------------------------------------------------------------

def winding(s: Any) -> Any:
    """Return the rate of the way on the rim less that of the drawn length."""
    return _rate(lambda t: _way(s, t) - _passing(s, 0) * s["u_rate"].item() * t)


def winding_motion(s: Any) -> Any:
    """Return its rate where x, the slope, the drum and the wound length move evenly."""
    way = (_way(s, STEP) - 2 * _way(s, 0) + _way(s, -STEP)) / STEP**2
    return way - _rate(lambda t: _passing(s, t)) * s["u_rate"].item()


def _way(s: Any, t: Any) -> Any:
    """Return the way of the tangent point on the rim, from a mark on the drum."""
    x = s["x"] + t * s["x_rate"]
    return s["sense"].item() * s["R"].item() * (mp.atan2(x[1], x[0]) - t * s["spin"].item())


def _passing(s: Any, t: Any) -> Any:
    """Return the stretch of what passes."""
    slope, winds = s["slope"] + t * s["slope_rate"], s["winds"].item()
    return winds * mp.sqrt(slope.dot(slope)) + (1 - winds) * s["wound"].item()


# --- the wound rope ---------------------------------------------------------------------------------------------

def kinetic_energy(s: Any) -> Any:
    """Return the kinetic energy of the wound rope."""
    return s["rho"].item() * s["u"].item() * _mean(lambda angle: _square(_velocity(s, angle, 0))) / 2


def laying(s: Any) -> Any:
    """Return half the weight of a length times the way over the half turn before the tangent point: the rope is laid on
    at its height there, and the energy is zero on the average of a turn.
    """
    x, g = s["x"], s["g"]
    size, end = mp.sqrt(x.dot(x)), mp.atan2(x[1], x[0])
    along = mp.quad(lambda angle: size * (g[0] * mp.cos(angle) + g[1] * mp.sin(angle)), [end - mp.pi, end])
    return -s["rho"].item() * s["sense"].item() * s["R"].item() / s["wound"].item() * along / 2


def gravity(s: Any) -> Any:
    """Return the energy of gravity of the wound rope."""
    return -s["rho"].item() * s["u"].item() * _mean(lambda angle: s["g"].dot(_place(s, angle, 0)))


def forces(s: Any) -> list[Any]:
    """Return the rates of the momenta of the wound points on the rotation and the centre, less weight; and the force on
    the length: energy of gravity less kinetic energy, of a length, and the tangent of W at the span's stretch.
    """
    rho, u, u_rate = s["rho"].item(), s["u"].item(), s["u_rate"].item()

    def momentum(t: Any) -> np.ndarray:
        def of_point(angle: Any) -> np.ndarray:
            v, arm = _velocity(s, angle, t), _place(s, angle, t) - _centre(s, t)
            return np.array([arm[0] * v[1] - arm[1] * v[0], *v])
        return np.asarray(rho * (u + t * u_rate) * _mean(of_point))

    span = mp.sqrt(s["slope"].dot(s["slope"]))
    elastic = elastic_energy(s, span) + tension(s, span) * (_passing(s, 0) - span)
    inertia, weight = _rate(momentum), rho * u * s["g"]
    return [inertia[0], *(inertia[1:] - weight), (gravity(s) - kinetic_energy(s)) / u + elastic]


def _centre(s: Any, t: Any) -> np.ndarray:
    return np.asarray(s["c"] + t * s["c_rate"] + t * t / 2 * s["c_acc"])


def _place(s: Any, angle: Any, t: Any) -> np.ndarray:
    """Return the place at the time t of the wound point at this angle at time 0."""
    angle = angle + t * s["spin"].item() + t * t / 2 * s["spin_acc"].item()
    return np.asarray(_centre(s, t) + s["R"].item() * np.array([mp.cos(angle), mp.sin(angle)]))


def _velocity(s: Any, angle: Any, t: Any) -> np.ndarray:
    return np.asarray((_place(s, angle, t + STEP) - _place(s, angle, t - STEP)) / (2 * STEP))


def _mean(value: Callable[[Any], Any]) -> Any:
    return sum(value(2 * mp.pi * k / ON_TURN) for k in range(ON_TURN)) / ON_TURN


# --- elastic energy ---------------------------------------------------------------------------------------------

def elastic_energy(s: Any, stretch: Any) -> Any:
    """Return the elastic energy a length of rope on the rim, by strain and curvature of its places."""
    still = np.array([mp.mpf(0), mp.mpf(0)])
    on_rim = {"phi": np.array([mp.mpf(0), stretch / s["R"].item()]), "l": np.array(mp.mpf(1)), "R": s["R"], "c": still,
              "phi_rate": still, "c_rate": still, "s_rate": still}
    return s["A"].dot(strains(on_rim, mp.mpf(1) / 2, 0) ** 2) / 2


def tension(s: Any, stretch: Any) -> Any:
    """Return the derivative of the elastic energy a length by the stretch."""
    return _rate(lambda t: elastic_energy(s, stretch + t))


def loss(s: Any) -> Any:
    """Return the work of the excess of the tension over that of the span, from the span's stretch to the wound one."""
    span, wound = s["span_stretch"].item(), s["wound"].item()
    half, middle = (wound - span) / 2, (wound + span) / 2
    return sum(weight * half * (tension(s, middle + half * x) - tension(s, span)) for x, weight in gauss(ON_STRETCHES))


def _rate(path: Callable[[Any], Any]) -> Any:
    return (path(STEP) - path(-STEP)) / (2 * STEP)


def _square(vector: np.ndarray) -> Any:
    return vector.dot(vector)
