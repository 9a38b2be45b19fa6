"""The spring of a tow by the gap to the moving point; with the factor 1/radius, the equation of its rail."""

from typing import Any

import numpy as np
import sympy as sp

from ...spec import PointLaw, Stages


def energy(p: Stages, gap: np.ndarray, c: Any) -> sp.Expr:
    """Return c (gap.gap - a^2)/2."""
    return c.factor * (gap.dot(gap) - c.radius**2) / 2


LAW = PointLaw(
    doc="tow on a rail",
    source="half the difference of two squares",
    parameters={"factor": ("N/m", "stiffness"), "radius": ("m", "distance without energy")},
    energy=energy,
)
