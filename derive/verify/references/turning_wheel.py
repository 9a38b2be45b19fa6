"""The root of verification of turning wheels: material points of a wrap in space along the motion, at 50 digits.

The motion is that of ten coordinates about their values: both angles from the body, the centre, the rotation vector of
the groove, and both ends of the zone along the rope. Lagrange's equations of the sum over points follow by differences.
"""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np

from .element import gauss
from .sheave import POINTS, STEP

mp = mpmath.mp
ANGLES, CENTRE, TURN, ENDS = slice(0, 2), slice(2, 5), slice(5, 8), slice(8, 10)
N = 10
COMPUTED = [0, 1, 2, 3, 4, 5, 6, 8, 9]
"""Those whose forces the kernels have: not the rotation about the axis."""


def inertia(s: Any) -> list[Any]:
    """Return d/dt dT/dv - dT/dq."""
    q, v, a = _motion(s)
    found = []
    for i in COMPUTED:
        e = _unit(i)
        rate = (_momentum(s, q + STEP * v + STEP**2 / 2 * a, v + STEP * a, e)
                - _momentum(s, q - STEP * v + STEP**2 / 2 * a, v - STEP * a, e)) / (2 * STEP)
        found.append(rate - (_kinetic(s, q + STEP * e, v) - _kinetic(s, q - STEP * e, v)) / (2 * STEP))
    return found


def kinetic_energy(s: Any) -> list[Any]:
    """Return T."""
    q, v, _ = _motion(s)
    return [_kinetic(s, q, v)]


def moment_of_weight(s: Any) -> Any:
    """Return the moments about both vectors of the groove of forces against gravity at all points."""
    q, _, _ = _motion(s)
    total = sum(weight * _cross(_place(s, q, x), s["gravity"]) for x, weight in gauss(POINTS)) / 2
    return (-s["rho"].item() * s["l"].item() * total)[:2]


def _motion(s: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the coordinates with their first and second rates."""
    zero = np.array([mp.mpf(0)] * 3)
    about = s["omega"][2]
    return (np.array([*s["phi"], *zero, *zero, mp.mpf(0), s["l"].item()]),
            np.array([*(s["phi_rate"] - about), *s["c_rate"], *s["omega"], *s["s_rate"]]),
            np.array([*s["phi_acc"], *s["c_acc"], *s["omega_acc"], mp.mpf(0), *s["s_acc"]]))


def _unit(i: int) -> np.ndarray:
    return np.array([mp.mpf(i == k) for k in range(N)])


def _momentum(s: Any, q: np.ndarray, v: np.ndarray, e: np.ndarray) -> Any:
    """Return dT by a rate: a difference over a unit, as T is quadratic."""
    return (_kinetic(s, q, v + e) - _kinetic(s, q, v - e)) / 2


def _kinetic(s: Any, q: np.ndarray, v: np.ndarray) -> Any:
    """Return T: half the square of the velocity of points that stay at their S."""
    start, end = q[ENDS]
    total = mp.mpf(0)
    for x, weight in gauss(POINTS):
        S = start + (end - start) * (x + 1) / 2
        velocity = (_of_material(s, q + STEP * v, S) - _of_material(s, q - STEP * v, S)) / (2 * STEP)
        total += weight * velocity.dot(velocity)
    return s["rho"].item() * (end - start) * total / 4


def _of_material(s: Any, q: np.ndarray, S: Any) -> np.ndarray:
    """Return the place of the material point S."""
    start, end = q[ENDS]
    return _place(s, q, 2 * (S - start) / (end - start) - 1)


def _place(s: Any, q: np.ndarray, x: Any) -> np.ndarray:
    """Return the place of the point at x, from -1 to 1, of the zone."""
    phi = q[ANGLES][0] + (q[ANGLES][1] - q[ANGLES][0]) * (x + 1) / 2
    arm = s["R"].item() * np.array([mp.cos(phi), mp.sin(phi), mp.mpf(0)])
    turn = q[TURN]
    once = _cross(turn, arm)  # the rotation by a small vector, to third order
    twice = _cross(turn, once)
    return np.asarray(q[CENTRE] + arm + once + twice / 2 + _cross(turn, twice) / 6)


def _cross(a: Any, b: Any) -> np.ndarray:
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
