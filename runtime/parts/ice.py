"""Ice on cables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from .part import Part
from .piece import UniformPiece
from .quantity import all_of_engine
from .section import Section, outer_radius_of
from .signal import Signal, varying
from .stretches import stretches
from .validation import Name, Reference, not_negative, place_on, positive

if TYPE_CHECKING:
    from .cable import Cable


class Ice(Part):
    """Ice around a cable, a ring whose thickness t may change: its mass, its weight, and the larger diameter in fluids.

    A length has the mass ``density π t (d + t)``. Ice grows at the velocity of the cable, as that of droplets at rest
    in it, and falls off with it: no thrust acts, and the energy of ice that comes or goes is in ``energy.external``.
    Ice has no stiffness; it moves with the axis, without rotary inertia. Along drag of the cable the diameter grows by
    2 t, the displaced area by that of the ring, unless it is given. A piece that falls off at an instant is a thickness
    that falls within a time short beside the motion, such as ``fu.Ramp`` from t to 0.

    cable: the cable
    thickness: t, m, a number or a signal
    density: of ice, kg/m³: 900 of glaze, 300 to 900 of rime
    start, stop: arc-lengths of the nodes between which there is ice, m; by default all of the cable
    diameter: d of the cable, m; by default that of its section, of each piece its own
    """

    kind = "ice"
    group = "ices"
    positional = ("cable",)
    results = all_of_engine("ice", thickness="thickness of the ice", mass="mass of the ice")
    name: Name | None = None
    cable: Reference
    thickness: Annotated[float | Signal, varying(not_negative("m"))]
    density: Annotated[float, positive("kg/m³")] = 900.0
    start: Annotated[float, place_on("cable")] | None = None
    stop: Annotated[float, place_on("cable")] | None = None
    diameter: Annotated[float, positive("m")] | None = None

    def diameter_of(self, section: Section) -> float | None:
        """Return the diameter under the ice of a section, m; None where neither tells it."""
        if self.diameter is not None:
            return self.diameter
        radius = outer_radius_of(section)
        return None if radius is None else 2 * radius

    def stretches(self, cable: Cable) -> list[UniformPiece]:
        """Return the elements of its cable under ice, by pieces with equal diameters, see `UniformPiece`."""
        return stretches(cable, self.start, self.stop, self.diameter_of)
