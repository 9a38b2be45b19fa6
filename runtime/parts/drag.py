"""Forces of a fluid on a cable or a body: drag, lift, buoyancy and added mass."""

import math
from collections.abc import Iterator, Mapping
from numbers import Real
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from .attachment import Attachment
from .part import Part
from .piece import UniformPiece
from .point_mass import PointMass
from .polar import Polar
from .quantity import all_of_engine
from .schemas import AXIS, TENSOR, Turning, checked, list_of_lists, list_schema, number_schema
from .section import Section, Tube, outer_radius_of
from .stretches import stretches
from .validation import (
    Matrix,
    Name,
    Reference,
    Vector,
    direction,
    finite,
    not_negative,
    number,
    one_of,
    place_on,
    positive,
    show,
    symmetric,
    xyz,
)

if TYPE_CHECKING:
    from .cable import Cable
    from .rope import Rope

FORMS = ("lagrange", "morison")
"""Forms of the inertia of the fluid."""
OF_CABLE = ("start", "stop", "normal", "tangential", "lift", "polar", "chord", "diameter", "displaced_area",
            "added_mass", "added_mass_tangential", "added_mass_form")
OF_ROPE = ("normal", "tangential", "lift", "diameter", "displaced_area", "added_mass", "added_mass_tangential")
OF_MASS = ("area", "coefficient", "volume", "height", "added_mass")
OF_BODY = ("area", "coefficient", "lift", "polar", "span", "chord", "at", "volume", "height", "added_mass",
           "added_mass_form")


def _added_mass(value: Any) -> float | Matrix:
    """Return a coefficient, or the symmetric matrix (3, 3) of three or of three rows of them, in body axes."""
    if isinstance(value, Real) and not isinstance(value, bool):
        found = number(value)
        if found < 0:
            raise ValueError(f"must not be negative, got {show(found)}")
        return found
    return symmetric(value, "", _check_added_mass)


def _check_added_mass(matrix: np.ndarray) -> None:
    if np.linalg.eigvalsh(matrix)[0] < -1e-12 * np.abs(matrix).max():
        raise ValueError(f"must not be negative in any direction, got {matrix.tolist()}")


class Drag(Part):
    """Drag, lift, buoyancy and added mass of a cable, a body or a point mass in a `Fluid`.

    The velocity w is that of the fluid past the cable or body, w_n and w_t its parts across and along a cable, i the
    direction along the cable from its start, s the span of a body, w_p the part of w across the span.

    At the surface of a fluid, all forces are proportional to the wet part. Of a cable it is the part below the surface
    of a circular section of the diameter d, without one of the displaced area, at each point along it. Of a body it is
    the part of a sphere of its ``volume`` about ``at``, without a volume of its ``area``, or of a column of ``height``.
    Buoyancy acts at ``at``, not at the middle of the wet part. A heeling body needs several drags; its stiffness is too
    high by its weight times that distance.

    On a rope all but polar act on its spans, by the velocity of the material. Nothing acts on what lies on sheaves and
    drums: where material runs onto one, the energy of its added mass returns to the rope.

    on: the cable or the rope, all of it, or the body, or the point mass, a body without axes
    fluid: by default all fluids of the scene, which must not overlap
    start, stop: of a cable, arc-lengths of the nodes between which the fluid acts, m; by default all of it
    normal: of a cable, coefficient of the force ``ρ/2 d normal |w_n| w_n`` a length
    tangential: of a cable, coefficient of the force ``ρ/2 π d tangential |w_t| w_t`` a length
    diameter: of a cable, d, m; by default that of the section
    displaced_area: displaced volume a length of a cable, m²; by default the area of the section, including the inside
        of a tube; 0 for no buoyancy
    lift: C_L, of either sign: of a cable ``ρ/2 d C_L |w_n| i × w_n`` a length, of a body ``ρ/2 area C_L |w_p| s × w_p``
    area: of a body, m²
    coefficient: of a body, of the force ``ρ/2 area coefficient |w| w`` at ``at``; by default 1
    polar: coefficients by the angle of the flow from the ``chord``. Of a body, about the span, in the place of
        coefficient and lift; drag is then along w_p. Of a spatial beam, about i, in the place of normal and lift, with
        the moment ``ρ/2 d² C_M |w_n|²`` a length
    span: of a body, a direction in body axes; z in the plane
    chord: of a body a direction in body axes square to the span; of a beam a direction across, in local axes (y the
        height, z the width)
    at: of a body, the centre of pressure and of buoyancy in body axes, m
    volume: displaced by a body, m³
    height: of a body at a surface, m: of a column, upright in all orientations, with half of its height below ``at``,
        and ends rounded by a fortieth of the height. By default the body is a sphere
    added_mass: C, coefficient of the inertia of the fluid: C times the displaced mass moves with a cable across it, or
        with a body at ``at``; three numbers along the axes of a body, or 3x3. The acceleration of the fluid acts with
        (1 + C) times the displaced mass. None: no inertia; 0: only the acceleration of the fluid
    added_mass_tangential: of a cable, C of the motion along it
    added_mass_form: "lagrange", Lagrange's equations of the kinetic energy of the fluid, or "morison", Morison's
        equation, of the acceleration alone: with the parts across a cable, ρ V ((1 + C) (DU/Dt)_n - C a_n)
    """

    kind = "drag"
    group = "drags"
    positional = ("on",)
    results = all_of_engine("drag", force="drag and buoyancy on the cable, rope or body")
    name: Name | None = None
    on: Reference
    fluid: Reference | None = None
    start: Annotated[float, place_on("on")] | None = None
    stop: Annotated[float, place_on("on")] | None = None
    normal: Annotated[float, not_negative()] = 0.0
    tangential: Annotated[float, not_negative()] = 0.0
    diameter: Annotated[float, positive("m")] | None = None
    displaced_area: Annotated[float, not_negative("m²")] | None = None
    lift: Annotated[float, finite()] = 0.0
    area: Annotated[float, not_negative("m²")] = 0.0
    coefficient: Annotated[float, not_negative()] | None = None
    polar: Polar | None = None
    span: Annotated[Vector, direction("on", AXIS)] | None = None
    chord: Annotated[Vector, direction(of="on")] | None = None
    at: Annotated[Vector, xyz("m", of="on")] | None = None
    volume: Annotated[float, not_negative("m³")] = 0.0
    height: Annotated[float, positive("m")] | None = None
    added_mass: Annotated[float | Matrix | None, checked(
        _added_mass, {"anyOf": [number_schema(minimum=0), list_schema(), list_of_lists("1")]},
        Turning(TENSOR, "on"))] = None
    added_mass_tangential: Annotated[float, not_negative()] = 0.0
    added_mass_form: Annotated[str, one_of(FORMS)] = FORMS[0]

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        if self.span is not None and any(self.span[:2]):
            yield f"span {show(self.span)}, which is not square to it,"
        if isinstance(self.added_mass, tuple) and (off := [self.added_mass[k][2] for k in range(2)]) != [0.0, 0.0]:
            yield f"added_mass, whose entries xz and yz are {show((off[0], off[1]))},"
        yield from super().off_plane()

    def attachment(self, masses: Mapping[str, PointMass]) -> Attachment:
        """Return the point of a body or of one of the point masses, by name, that it acts on."""
        mass = masses.get(self.on)
        return Attachment(on=self.on, at=self.at) if mass is None else Attachment(on=mass.on, s=mass.s)

    @property
    def foil_axes(self) -> tuple[np.ndarray, np.ndarray]:
        """Return unit vectors (3,) along span and chord, in body axes."""
        span = np.array((0.0, 0.0, 1.0) if self.span is None else self.span)
        span /= np.linalg.norm(span)
        chord = np.zeros(3) if self.chord is None else np.array(self.chord) / np.linalg.norm(self.chord)
        return span, chord

    @property
    def drag_coefficient(self) -> float:
        """Return ``coefficient``, 1 where it is not given."""
        return 1.0 if self.coefficient is None else self.coefficient

    def added_of_cable(self) -> np.ndarray:
        """Return the coefficients of added mass of a cable, across and along it (2,)."""
        return np.array([self.added_mass, self.added_mass_tangential], dtype=float)

    def added_of_body(self, dim: int) -> np.ndarray:
        """Return the coefficients of added mass of a body, (dim, dim)."""
        C = self.added_mass if isinstance(self.added_mass, tuple) else np.eye(3) * (self.added_mass or 0.0)
        return np.array(C)[:dim, :dim]

    def width(self, section: Section) -> float:
        """Return the diameter of drag of a section of a cable or a rope, m. Raises ValueError where it has none."""
        if self.diameter is not None:
            return self.diameter
        radius = outer_radius_of(section)
        if radius is None:
            raise ValueError("diameter is missing, which the section does not tell")
        return 2 * radius

    def extent(self, section: Section | None) -> float:
        """Return half of the height of a cable's or a rope's section or, without one, of a body at a surface, in m; 0
        for a point.
        """
        if section is None:
            if self.height is not None:
                return self.height / 2
            return math.cbrt(3 * self.volume / (4 * math.pi)) if self.volume else math.sqrt(self.area / math.pi)
        try:
            return self.width(section) / 2
        except ValueError:
            return math.sqrt(self.displaced(section) / math.pi)

    def displaced(self, section: Section | None) -> float:
        """Return the displaced volume, of a section of a cable or a rope by length, m², of a body in all, m³."""
        if section is None:
            return self.volume
        if self.displaced_area is not None:
            return self.displaced_area
        return math.pi * section.outer_radius**2 if isinstance(section, Tube) else section.area

    def stretches(self, line: "Cable | Rope") -> list[UniformPiece]:
        """Return the elements of a cable or a rope that it acts on, by pieces with equal forces, see `UniformPiece`.

        Raises ValueError where the section of one of them has no diameter that drag needs.
        """
        return stretches(line, self.start, self.stop, self._sizes)

    def _sizes(self, section: Section) -> tuple[float, float, float]:
        """Return what forces depend on of a section, in m and m²."""
        has_width = self.normal or self.tangential or self.lift or self.polar
        return self.width(section) if has_width else 0.0, self.displaced(section), self.extent(section)
