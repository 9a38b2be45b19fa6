"""The root of verification of a cable with a curved stress-free shape: from derivatives r', r'' of both shapes."""

from __future__ import annotations

from typing import Any

import mpmath

from ...spec import Element
from ..motion import cross
from .element import Shape, gauss, spatial

mp = mpmath.mp


def measures(strain: str, r: Any, r0: Any) -> tuple[Any, ...]:
    """Return the strain, and what the curvature has more than the stress-free one, both by the stress-free arc-length.
    """
    stretch = mp.sqrt(r[0].dot(r[0]) / r0[0].dot(r0[0]))
    change = _curvature(strain, r, r0) - _curvature("", r0, r0)
    return (stretch**2 - 1) / 2 if strain == "green" else stretch - 1, change


def _curvature(strain: str, r, r0):
    normal, length = cross(*r), mp.sqrt(r[0].dot(r[0]))
    by = mp.sqrt(r0[0].dot(r0[0])) * length**2 if strain == "engineering" else length**3
    return mp.sqrt(normal.dot(normal)) / by


def density(strain: str, r: Any, r0: Any, EA: Any, EI: Any, l: Any) -> Any:
    """Return energy per x; kappa and kappa0 are rounded to sqrt(kappa^2 + 1e-6 kappa0^2 + floor), floor = (2e-6/l)^2,
    and a kappa0^2 below the floor is none.
    """
    eps, _ = measures(strain, r, r0)
    kappa, kappa0, floor = _curvature(strain, r, r0), _curvature("", r0, r0), 4 / mp.mpf(10) ** 12 / mp.mpf(l) ** 2
    rounding = kappa0**2 / 10**6 + floor
    rounded, rounded0 = mp.sqrt(kappa**2 + rounding), mp.sqrt(kappa0**2 + rounding)
    preferred = rounded0 * kappa0**4 / (kappa0**4 + floor**2)
    bending = (kappa**2 - kappa0**2) / 2 - preferred * (rounded - rounded0)
    return mp.sqrt(r0[0].dot(r0[0])) * (EA * eps**2 / 2 + EI * bending)


def energy(element: Element, strain: str, s: Any, n: int) -> Any:
    """Return the energy by n Gauss points."""
    shape, half, total = Shape(element, s["l"].item()), mp.mpf(s["l"].item()) / 2, mp.mpf(0)
    EA, EI = s["S"]
    for t, weight in gauss(n):
        at = (half * (1 + t), 0, 0)
        r, r0 = ([spatial(shape(at, (k, 0, 0)).dot(s[e])) for k in (1, 2)] for e in ("e", "e0"))
        total += half * weight * density(strain, r, r0, EA, EI, s["l"].item())
    return total
