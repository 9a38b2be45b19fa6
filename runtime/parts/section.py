"""Cross-sections. y runs along the cable's ``up`` (height), z along its width; lengths in m.

A further section is one class with ``moments``, its torsion constant and shear factors, and one entry in `SECTIONS`.
"""

from math import exp, nan, pi
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field, model_validator

from ..errors import SceneError
from .part import Family, Part
from .schemas import checked, list_schema
from .tension_table import TensionTable
from .validation import finite, not_negative, positive, show, vector

Length = Annotated[float, positive("m")]
MIN_WALL = 1e-12
"""Of the radius of a tube, whose moments are differences."""
ZETA_5 = 1.03692775514336992633  # Σ 1/n⁵


def _factors(value: Any) -> tuple[float, float]:
    factors = vector(value, size=2)
    if not min(factors) > 0:
        raise ValueError(f"must be positive, got {show(factors)}", "give (ky, kz), 1 for no correction")
    return factors[0], factors[1]


class Section(Part):
    """Base of doubly symmetric sections: their odd moments are zero, their axis is the centroid.

    torsion_constant: m⁴, in the place of that of the shape
    shear_factors: (ky, kz), in the place of those of the shape
    torque_per_tension: of helical wires, for element="beam24" with law="structural": torque over tension where the rope
        cannot turn, m; positive for a right-hand lay. Tension is EA (strain + it twist), torque EA it strain + GJ twist
    tension_table: of ropes, for membrane="tabulated": the axial force by strain, in the place of EA times the strain
    """

    tag = "shape"
    shape: ClassVar[str]
    given_torsion_constant: Annotated[float, positive("m⁴")] | None = Field(None, alias="torsion_constant")
    given_shear_factors: Annotated[tuple[float, float], checked(_factors, list_schema("", 2, 2))] | None = Field(
        None, alias="shear_factors")
    torque_per_tension: Annotated[float, finite("m")] = 0.0
    tension_table: TensionTable | None = None

    def moments(self) -> np.ndarray:
        """Return (6,): [∫dA, ∫y²dA, ∫z²dA, ∫y⁴dA, ∫y²z²dA, ∫z⁴dA] in m², m⁴, m⁴, m⁶, m⁶, m⁶."""
        raise NotImplementedError

    def mass_moments(self) -> np.ndarray:
        """Return the `moments` of the inertia: times the density, mass and rotary inertia per length."""
        return self.moments()

    @property
    def torsion_constant(self) -> float:
        """Return St Venant's J in m⁴: torque = G J times the twist per length."""
        return self._shape_torsion_constant() if self.given_torsion_constant is None else self.given_torsion_constant

    def shear_factors(self, poisson_ratio: float) -> tuple[float, float]:
        """Return Timoshenko's (ky, kz): shear force = k G A times the mean shear angle, along y and z."""
        given = self.given_shear_factors
        return self._shape_shear_factors(poisson_ratio) if given is None else given

    def _shape_torsion_constant(self) -> float:
        raise SceneError(type(self).__name__, "has no torsion_constant", "give it, in m⁴")

    def _shape_shear_factors(self, poisson_ratio: float) -> tuple[float, float]:
        raise SceneError(type(self).__name__, "has no shear_factors", "give (ky, kz)")

    @property
    def given_beside_shape(self) -> set[str]:
        """Return which of torsion_constant and shear_factors are given."""
        return {name for name in ("torsion_constant", "shear_factors") if getattr(self, f"given_{name}") is not None}

    @property
    def area(self) -> float:
        """Return the area ∫dA in m²."""
        return float(self.moments()[0])

    @property
    def second_moment_about_z(self) -> float:
        """Return ∫y²dA in m⁴: resists bending in the plane of the axis and ``up``."""
        return float(self.moments()[1])

    @property
    def second_moment_about_y(self) -> float:
        """Return ∫z²dA in m⁴: resists bending out of the plane of the axis and ``up``."""
        return float(self.moments()[2])


class Rectangle(Section):
    """A solid rectangle.

    height: along ``up``, m
    width: m
    """

    shape = "rectangle"
    height: Length
    width: Length

    def moments(self) -> np.ndarray:
        """Return the even moments of the section, see `Section.moments`."""
        h, w = self.height, self.width
        area = h * w
        yy, zz = h * h / 12, w * w / 12
        return area * np.array([1, yy, zz, h**4 / 80, yy * zz, w**4 / 80])

    def _shape_torsion_constant(self) -> float:
        """Return J by St Venant's series (Timoshenko & Goodier, Theory of Elasticity, art. 109), to rounding.

        J = long short³ / 3 (1 - 192/π⁵ short/long Σ tanh(nπ long / 2 short) / n⁵), n odd. Summed as Σ 1/n⁵, which is
        31/32 ζ(5), less Σ (1 - tanh) / n⁵, whose terms fall like exp(-nπ).
        """
        short, long = sorted((self.height, self.width))
        less = sum(2 / (exp(n * pi * long / short) + 1) / n**5 for n in range(1, 15, 2) if n * long < 200 * short)
        return long * short**3 / 3 * (1 - 192 / pi**5 * short / long * (31 / 32 * ZETA_5 - less))

    def _shape_shear_factors(self, poisson_ratio: float) -> tuple[float, float]:
        """Return the shear factors of the shape (Cowper, J. Appl. Mech. 33 (1966) 335-340)."""
        factor = 10 * (1 + poisson_ratio) / (12 + 11 * poisson_ratio)
        return factor, factor


class _Round(Section):
    """Base of round sections: discs and rings."""

    @property
    def _inner_ratio(self) -> float:
        """Return the ratio of the inner and the outer radius."""
        return 0.0

    def _shape_torsion_constant(self) -> float:
        return self.second_moment_about_z + self.second_moment_about_y

    def _shape_shear_factors(self, poisson_ratio: float) -> tuple[float, float]:
        """Return the shear factors of a ring (Cowper, J. Appl. Mech. 33 (1966) 335-340)."""
        nu, inner = poisson_ratio, self._inner_ratio
        square = (1 + inner**2) ** 2
        factor = 6 * (1 + nu) * square / ((7 + 6 * nu) * square + (20 + 12 * nu) * inner**2)
        return factor, factor


class Circle(_Round):
    """A solid circle.

    radius: m
    """

    shape = "circle"
    radius: Length

    def moments(self) -> np.ndarray:
        """Return the even moments of the section, see `Section.moments`."""
        return _disc(self.radius)


class Tube(_Round):
    """A ring.

    outer_radius: m
    inner_radius: m
    """

    shape = "tube"
    outer_radius: Length
    inner_radius: Length

    @model_validator(mode="after")
    def _has_a_wall(self) -> "Tube":
        outer, wall = self.outer_radius, self.outer_radius - self.inner_radius
        if wall <= 0:
            raise ValueError(f"inner_radius must be smaller than outer_radius ({outer:g} m), got "
                             f"{self.inner_radius:g} m")
        if wall < MIN_WALL * outer:
            raise ValueError(f"the wall must be thicker than {MIN_WALL:g} of outer_radius ({outer:g} m), got "
                             f"{wall:g} m", "its moments are lost in rounding")
        return self

    def moments(self) -> np.ndarray:
        """Return the even moments of the section, see `Section.moments`."""
        return _disc(self.outer_radius) - _disc(self.inner_radius)

    @property
    def _inner_ratio(self) -> float:
        return self.inner_radius / self.outer_radius


def outer_radius_of(section: Section) -> float | None:
    """Return the radius of a round section in m, else None."""
    if isinstance(section, Circle):
        return section.radius
    return section.outer_radius if isinstance(section, Tube) else None


class GeneralSection(Section):
    """A section known by its constants alone, for cables and for structural beams.

    torsion_constant: m⁴, for beams
    shear_factors: (ky, kz), for beams
    area: m²
    second_moment_about_z: ∫y²dA, m⁴; 0 of a cable without bending stiffness, as a chain
    second_moment_about_y: ∫z²dA, m⁴; equal to the other one if only one is given
    rotary_moment_about_z, rotary_moment_about_y: m⁴, for beams whose mass is elsewhere than their stiffness: the
        density times it is the rotary inertia a length about that axis, kg m; equal if only one is given, the second
        moments if none is
    """

    shape = "general"
    area_: Annotated[float, positive("m²")] = Field(alias="area")
    about_z: Annotated[float, not_negative("m⁴")] = Field(alias="second_moment_about_z")
    about_y: Annotated[float, not_negative("m⁴")] = Field(default_factory=lambda data: data["about_z"],
                                                      alias="second_moment_about_y")
    rotary_about_z: Annotated[float, positive("m⁴")] | None = Field(None, alias="rotary_moment_about_z")
    rotary_about_y: Annotated[float, positive("m⁴")] | None = Field(None, alias="rotary_moment_about_y")

    @model_validator(mode="after")
    def _twists_less_than_a_disc(self) -> "GeneralSection":
        """Check that J does not exceed the polar moment, which warping reduces. Raises ValueError."""
        constant, polar = self.given_torsion_constant, self.about_z + self.about_y
        if constant is not None and constant > polar * (1 + 1e-9):
            raise ValueError("torsion_constant must not exceed second_moment_about_z + second_moment_about_y = "
                             f"{polar:.6g} m⁴, got {constant:.6g} m⁴")
        return self

    def moments(self) -> np.ndarray:
        """Return the moments, see `Section.moments`; those of order 4 are unknown, NaN."""
        return np.array([self.area_, self.about_z, self.about_y, nan, nan, nan])

    def entries(self) -> dict[str, Any]:
        """Return its entries without a second moment that follows from the other one."""
        entries = super().entries()
        if "about_y" not in self.model_fields_set:
            del entries["second_moment_about_y"]
        return entries

    @property
    def has_rotary(self) -> bool:
        """Return whether its rotary moments are given."""
        return self.rotary_about_z is not None or self.rotary_about_y is not None

    def mass_moments(self) -> np.ndarray:
        """Return its moments with rotary moments where they are given, see `Section.mass_moments`."""
        if not self.has_rotary:
            return self.moments()
        about_z, about_y = self.rotary_about_z or self.rotary_about_y, self.rotary_about_y or self.rotary_about_z
        return np.array([self.area_, about_z, about_y, nan, nan, nan])


def _disc(r: float) -> np.ndarray:
    return pi * np.array([r**2, r**4 / 4, r**4 / 4, r**6 / 8, r**6 / 24, r**6 / 8])


SECTIONS = Family("section", "a section such as Rectangle(height=0.05, width=0.05)",
                  (Rectangle, Circle, Tube, GeneralSection), Section)
AnySection = Annotated[Section, SECTIONS.checked()]
