"""A rope without load is hauled at one end: its load starts when the wave arrives."""

from __future__ import annotations

from math import pi, sqrt

from .case import Case, numbers

EA, DENSITY, R, NEAR, FAR, TENSION = 1e5, 0.5, 0.2, 2.0, 40.0, 500.0
"""Of a rope over a sheave: its free lengths NEAR, which is hauled, and FAR, with the load; drawn with TENSION."""


def delay() -> tuple[float, ...]:
    """Return sqrt(rho/EA) l, l the stress-free length: waves of engineering strain run at one speed in the material."""
    return (sqrt(DENSITY / EA) * (NEAR + pi * R + FAR) / (1 + TENSION / EA),)


CASES = [Case("wave", "a load starts when the wave arrives", numbers("delay", "s", ".09484559", 0.01), delay)]
