"""Spring and damper of no length, whose extension is the gap itself: nothing is singular where the points meet."""

from ...spec import PointLaw
from .spring import energy

LAW = PointLaw(
    doc="spring and damper of no length between two points",
    source="linear spring and damper",
    parameters={"stiffness": ("N/m", "stiffness"),
                "damping": ("N s/m", "damping")},
    energy=energy,
    damping="damping",
)
