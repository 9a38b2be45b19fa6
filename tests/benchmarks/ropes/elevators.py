"""Frequencies of an elevator with a compensation rope: ropes as bars, bodies and sheaves as masses."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
from scipy.optimize import brentq

from .case import Case, numbers

CAR, COUNTERWEIGHT, TENSION_MASS, J_TOP, J_BOTTOM, R = 2400.0, 2800.0, 800.0, 60.0, 30.0, 0.4
HEIGHT, BELOW, DENSITY, EA, EA_COMPENSATION = 60.0, 20.0, 5.0, 9e6, 4e6
BARS = [(EA, BELOW, (0, 0, 1, 0, 0), (1, 0, 0, 0, 0)), (EA, HEIGHT - BELOW, (0, 0, -1, 0, 0), (0, 1, 0, 0, 0)),
        (EA_COMPENSATION, HEIGHT - BELOW, (1, 0, 0, 0, 0), (0, 0, 0, 1, 1)),
        (EA_COMPENSATION, BELOW, (0, 1, 0, 0, 0), (0, 0, 0, -1, 1))]
"""Stiffness, length and the motion of both ends, upwards: by car, counterweight, rims of both sheaves, tension mass."""
MASSES = np.diag([CAR, COUNTERWEIGHT, J_TOP / R**2, J_BOTTOM / R**2, TENSION_MASS])


def stiffness(omega: float, held: bool) -> float:
    """Return the determinant of the dynamic stiffness, scaled: that of a bar is EA k/sin(k l) (cos(k l), -1)."""
    found = -(omega**2) * MASSES
    for axial, length, one, other in BARS:
        k = omega * sqrt(DENSITY / axial)
        ends = np.array([one, other], float)
        own = axial * k / np.sin(k * length) * np.array([[np.cos(k * length), -1], [-1, np.cos(k * length)]])
        found += ends.T @ own @ ends
    if held:
        found = np.delete(np.delete(found, 2, 0), 2, 1)
    return float(np.linalg.det(found / 1e6))


def frequencies() -> tuple[float, ...]:
    """Return the first three with the top sheave free, and with it held: roots of the exact dynamic stiffness of bars.

    The determinant has no poles below 11.2 Hz, the lowest frequency of a bar between held ends. Finite elements, 100 a
    bar, give the same to 2e-5 Hz. A rigid motion of the whole has the frequency zero.
    """
    found = []
    for held in (False, True):
        at = 2 * pi * np.arange(0.5, 6.5, 0.05)
        signs = [stiffness(each, held) for each in at]
        roots = [brentq(stiffness, a, b, args=(held,), xtol=1e-12)
                 for a, b, one, other in zip(at, at[1:], signs, signs[1:], strict=False) if one * other < 0]
        found += [root / (2 * pi) for root in roots[:3]]
    return tuple(found)


CASES = [
    Case("elevator", "frequencies of an elevator with a compensation rope, ropes as bars, wraps left out",
         numbers("first free, second free, third free, first held, second held, third held", "Hz",
                 "1.484561 2.954060 5.423718 1.316770 1.890324 3.044083", 1e-3), frequencies),
]
