"""Spring and damper along the gap, with a length where it is free of force."""

from typing import Any

import numpy as np
import sympy as sp

from ...spec import PointLaw, Stages


def extension(p: Stages, gap: np.ndarray, c: Any) -> list[sp.Expr]:
    """Return the distance of the points less the length."""
    distance = p.define("distance", sp.sqrt(gap.dot(gap)))
    p.define("inv_distance", 1 / distance)
    return [p.define("extension", distance - c.length)]


def energy(p: Stages, e: np.ndarray, c: Any) -> sp.Expr:
    """Return k e.e/2."""
    return c.stiffness * e.dot(e) / 2


LAW = PointLaw(
    doc="spring and damper between two points",
    source="linear spring and damper along the gap",
    parameters={"stiffness": ("N/m", "stiffness"),
                "damping": ("N s/m", "damping along the gap"),
                "length": ("m", "length without force, above zero")},
    energy=energy,
    measures=extension,
    damping="damping",
)
