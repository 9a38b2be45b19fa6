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
MASSES = np.array([CAR, COUNTERWEIGHT, J_TOP / R**2, J_BOTTOM / R**2, TENSION_MASS])
WRAP = DENSITY * pi * R
"""Mass of the rope on a sheave, kg: it moves with the rim; on the lower one with the tension mass, too."""
OF_WRAPS = WRAP * np.array([0, 0, 1, 1, 1])


def stiffness(omega: float, held: bool, wraps: bool = False) -> float:
    """Return the determinant of the dynamic stiffness, scaled: that of a bar is EA k/sin(k l) (cos(k l), -1)."""
    found = -(omega**2) * np.diag(MASSES + wraps * OF_WRAPS)
    for axial, length, one, other in BARS:
        k = omega * sqrt(DENSITY / axial)
        ends = np.array([one, other], float)
        own = axial * k / np.sin(k * length) * np.array([[np.cos(k * length), -1], [-1, np.cos(k * length)]])
        found += ends.T @ own @ ends
    if held:
        found = np.delete(np.delete(found, 2, 0), 2, 1)
    return float(np.linalg.det(found / 1e6))


def frequencies(wraps: bool = False) -> tuple[float, ...]:
    """Return the first three with the top sheave free, and with it held: roots of the exact dynamic stiffness of bars.

    wraps: whether the rope on the sheaves counts, as a mass that sticks to them.

    The determinant has no poles below 11.2 Hz, the lowest frequency of a bar between held ends. Finite elements, 100 a
    bar, give the same to 2e-5 Hz. A rigid motion of the whole has the frequency zero.
    """
    found = []
    for held in (False, True):
        at = 2 * pi * np.arange(0.5, 6.5, 0.05)
        signs = [stiffness(each, held, wraps) for each in at]
        roots = [brentq(stiffness, a, b, args=(held, wraps), xtol=1e-12)
                 for a, b, one, other in zip(at, at[1:], signs, signs[1:], strict=False) if one * other < 0]
        found += [root / (2 * pi) for root in roots[:3]]
    return tuple(found)


NAMES = "first free, second free, third free, first held, second held, third held"
CASES = [
    Case("elevator", "frequencies of an elevator with a compensation rope, ropes as bars, wraps left out",
         numbers(NAMES, "Hz", "1.484561 2.954060 5.423718 1.316770 1.890324 3.044083", 1e-3), frequencies),
    Case("elevator with wraps", "the same with the mass of the wraps, which lowers them by .06 to .9 %",
         numbers(NAMES, "Hz", "1.483135 2.944942 5.374488 1.315967 1.887614 3.036601", 1e-3),
         lambda: frequencies(wraps=True)),
]
