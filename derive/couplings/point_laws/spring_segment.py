"""One segment of a spring whose tension is piecewise linear in its extension, with a damper along the gap."""

from typing import Any

import numpy as np
import sympy as sp

from ...spec import PointLaw, Stages


def beyond(p: Stages, gap: np.ndarray, c: Any) -> list[sp.Expr]:
    """Return the distance of the points beyond that with the given tension."""
    distance = p.define("distance", sp.sqrt(gap.dot(gap)))
    p.define("inv_distance", 1 / distance)
    return [p.define("beyond", distance - c.reference)]


def energy(p: Stages, e: np.ndarray, c: Any) -> sp.Expr:
    """Return U + T e + k e²/2."""
    return c.energy + e[0] * (c.tension + c.stiffness * e[0] / 2)


LAW = PointLaw(
    doc="one segment of a spring of piecewise linear tension, and damper, between two points",
    source="piecewise linear spring and damper along the gap",
    parameters={"stiffness": ("N/m", "slope of the tension"),
                "damping": ("N s/m", "damping along the gap"),
                "reference": ("m", "distance of the points, above zero, at which tension and energy are given"),
                "tension": ("N", "tension there"),
                "energy": ("J", "energy there")},
    energy=energy,
    measures=beyond,
    damping="damping",
)
