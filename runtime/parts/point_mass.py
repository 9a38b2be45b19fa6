"""Point masses on cables: clump weights, clamps, floats."""

from typing import Annotated

from .part import Part
from .validation import Name, Reference, not_negative, place_on


class PointMass(Part):
    """A mass at a point of a cable, without rotary inertia, as of a clump weight, a clamp or a float.

    It moves with the material there, and need not be at a node. Buoyancy, drag and added mass of what has the mass are
    those of a `Drag` on it. ``mass_damping`` of the material there acts on it as well.

    on: the cable
    s: arc-length, m
    mass: kg; 0 where only a fluid acts
    """

    kind = "point_mass"
    group = "point_masses"
    positional = ("on",)
    name: Name | None = None
    on: Reference
    s: Annotated[float, place_on("on")]
    mass: Annotated[float, not_negative("kg")]
