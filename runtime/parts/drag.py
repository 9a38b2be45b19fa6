"""What a fluid does to a cable or a body: drag and buoyancy."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, ClassVar

from .cable import Cable
from .part import Part
from .plane import across
from .quantity import Quantity, vector_of_time
from .section import Circle, Tube
from .validation import Name, Reference, Vector, not_negative, positive, xyz

OF_CABLE = ("normal", "tangential", "diameter", "displaced_area")
OF_BODY = ("area", "coefficient", "at", "volume")


class Drag(Part):
    """Drag and buoyancy of a cable or a body in a `Fluid`.

    on: the cable, all of it, or the body; fluid: its name, the scene's only one if not given.
    Of a cable: ``normal`` and ``tangential``, the coefficients of Morison's equation, whose forces a length are
    ``ρ/2 d normal |w_n| w_n`` across and ``ρ/2 π d tangential |w_t| w_t`` along, with the fluid's velocity w past it;
    ``diameter`` d in m and ``displaced_area``, the volume a length that the cable displaces, in m², are those of the
    section (of a tube with its inside) if not given; 0 for no buoyancy.
    Of a body: ``area`` (m²) and ``coefficient`` of the force ``ρ/2 area coefficient |w| w`` at its centre of pressure
    ``at`` (m, body axes), and the displaced ``volume`` (m³), whose buoyancy acts there, too.
    Added mass is not in it.
    """

    kind: ClassVar[str] = "drag"
    group: ClassVar[str] = "drags"
    positional: ClassVar[tuple[str, ...]] = ("on",)
    results: ClassVar[dict[str, Quantity]] = {"force": vector_of_time("N", "drag and buoyancy on the cable or body")}
    name: Name | None = None
    on: Reference
    fluid: Reference | None = None
    normal: Annotated[float, not_negative()] = 0.0
    tangential: Annotated[float, not_negative()] = 0.0
    diameter: Annotated[float, positive("m")] | None = None
    displaced_area: Annotated[float, not_negative("m²")] | None = None
    area: Annotated[float, not_negative("m²")] = 0.0
    coefficient: Annotated[float, not_negative()] = 1.0
    at: Annotated[Vector, xyz("m")] | None = None
    volume: Annotated[float, not_negative("m³")] = 0.0

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        return across("at", self.at, "m")

    def width(self, cable: Cable) -> float:
        """Return the diameter that drag counts with, m. Raises ValueError where the section has none."""
        if self.diameter is not None:
            return self.diameter
        if not isinstance(cable.section, Circle | Tube):
            raise ValueError("diameter is missing, which the section of the cable does not tell")
        return 2 * (cable.section.radius if isinstance(cable.section, Circle) else cable.section.outer_radius)

    def displaced(self, cable: Cable | None) -> float:
        """Return the displaced volume: of a cable that of a length, m²; of a body all of it, m³."""
        if cable is None:
            return self.volume
        if self.displaced_area is not None:
            return self.displaced_area
        return math.pi * cable.section.outer_radius**2 if isinstance(cable.section, Tube) else cable.section.area
