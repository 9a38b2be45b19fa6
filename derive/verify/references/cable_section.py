"""The root of verification of the section forces of cables: variations of the energy per length, at 50 digits."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np

from ...laws import TRAITS
from ...spec import Element
from ..motion import cross
from . import cable, curved_cable
from .element import Shape, spatial

mp = mpmath.mp
STEP = mpmath.mpf(10) ** -12  # of differences of second order: errors 1e-24, rounding 1e-26


def section(element: Element, law: str, s: Any) -> dict[str, np.ndarray]:
    """Return force (3,) in N, moment (3,) in N m and strain (6,) at x, see TEXTS of references/section.py."""
    traits = TRAITS[law]
    strain, curvature, curved, assumed = (traits.strain, traits.curvature, bool(traits.straight),
                                          traits.membrane == "assumed")
    shape, (EA, EI), x = Shape(element, s["l"].item()), s["S"][:2], s["x"].item()
    modes = [(mode * mp.legendre(m, 2 * x / shape.l - 1), stiffness)
             for m, (mode, stiffness) in enumerate(cable.strain_modes(element, law, s))] if assumed else []
    N = sum(stiffness * mode for mode, stiffness in modes)

    def derivatives(at, of="e"):
        return [spatial(shape((at, 0, 0), (k, 0, 0)).dot(s[of])) for k in (1, 2)]

    def measures(r1, r2):
        length, normal = mp.sqrt(r1.dot(r1)), cross(r1, r2)
        eps = (length**2 - 1) / 2 if strain == "green" else length - 1
        kappa = mp.sqrt(r2.dot(r2)) if curvature == "linear" else (
            mp.sqrt(normal.dot(normal)) / length ** (3 if strain == "green" else 2))
        return eps, kappa

    def variation(at, by):
        """Return W_r' or W_r'', the derivative of the energy per length by one of its vectors."""
        def energy(t, axis):
            vectors = derivatives(at)
            vectors[by] = vectors[by] + t * np.eye(3, dtype=int)[axis]
            if curved:
                return curved_cable.density(strain, vectors, derivatives(at, "e0"), EA, EI, s["l"].item())
            eps, kappa = measures(*vectors)
            return (N * eps if assumed else cable.membrane_energy(law, eps, s)) + EI * kappa**2 / 2

        return np.array([(energy(STEP, i) - energy(-STEP, i)) / (2 * STEP) for i in range(3)])

    h = mp.mpf(10) ** -8  # on differences good to 1e-24: 1e-16
    change = (8 * (variation(x + h, 1) - variation(x - h, 1))
              - (variation(x + 2 * h, 1) - variation(x - 2 * h, 1))) / (12 * h)
    r1, r2 = derivatives(x)
    eps, kappa = curved_cable.measures(strain, [r1, r2], derivatives(x, "e0")) if curved else measures(r1, r2)
    eps = sum(mode for mode, _ in modes) if assumed else eps
    return {"force": variation(x, 0) - change, "moment": cross(r1, variation(x, 1)),
            "strain": np.array([eps, 0, 0, 0, 0, kappa])}
