"""Spring and damper along the gap, with a length where it is free of force."""

import sympy as sp

from ...spec import PointLaw


def extension(p, gap, c):
    """Return the distance of the points less the length."""
    distance = p.define("distance", sp.sqrt(gap.dot(gap)))
    p.define("inv_distance", 1 / distance)
    return [p.define("extension", distance - c.length)]


def energy(p, e, c):
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
