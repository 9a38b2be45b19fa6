"""Cross-sections. y runs along the cable's ``up`` (height), z along its width; lengths in m.

A further section is one class with ``moments`` and one entry in `SHAPES`.
"""

from __future__ import annotations

from math import pi
from typing import Annotated, Any, ClassVar

import numpy as np
from funicular.errors import near
from funicular.validation import Part, positive
from pydantic import PlainValidator, model_validator

Length = Annotated[float, positive("m")]


class Section(Part):
    """Base of doubly symmetric sections: their odd moments are zero, their axis is the centroid."""

    shape: ClassVar[str]

    def moments(self) -> np.ndarray:
        """The even moments up to order 4.

        Returns (6,): [∫dA, ∫y²dA, ∫z²dA, ∫y⁴dA, ∫y²z²dA, ∫z⁴dA] in m², m⁴, m⁴, m⁶, m⁶, m⁶.
        """
        raise NotImplementedError

    @property
    def area(self) -> float:
        """∫dA in m²."""
        return float(self.moments()[0])

    @property
    def second_moment_yy(self) -> float:
        """∫y²dA in m⁴: resists bending in the plane of the axis and ``up``."""
        return float(self.moments()[1])

    @property
    def second_moment_zz(self) -> float:
        """∫z²dA in m⁴: resists bending out of the plane of the axis and ``up``."""
        return float(self.moments()[2])


class Rectangle(Section):
    """A solid rectangle, ``height`` along ``up``, in m."""

    shape: ClassVar[str] = "rectangle"
    height: Length
    width: Length

    def moments(self) -> np.ndarray:
        """See `Section.moments`."""
        h, w = self.height, self.width
        area = h * w
        yy, zz = h * h / 12, w * w / 12
        return area * np.array([1, yy, zz, h**4 / 80, yy * zz, w**4 / 80])


class Circle(Section):
    """A solid circle, ``radius`` in m."""

    shape: ClassVar[str] = "circle"
    radius: Length

    def moments(self) -> np.ndarray:
        """See `Section.moments`."""
        return _disc(self.radius)


class Tube(Section):
    """A ring between ``inner_radius`` and ``outer_radius``, in m."""

    shape: ClassVar[str] = "tube"
    outer_radius: Length
    inner_radius: Length

    @model_validator(mode="after")
    def _has_a_wall(self) -> Tube:
        if not self.inner_radius < self.outer_radius:
            raise ValueError(
                f"inner_radius must be smaller than outer_radius ({self.outer_radius:g} m), got {self.inner_radius:g} m"
            )
        return self

    def moments(self) -> np.ndarray:
        """See `Section.moments`."""
        return _disc(self.outer_radius) - _disc(self.inner_radius)


def _disc(r: float) -> np.ndarray:
    return pi * np.array([r**2, r**4 / 4, r**4 / 4, r**6 / 8, r**6 / 24, r**6 / 8])


SHAPES = {section.shape: section for section in (Rectangle, Circle, Tube)}


def _section(value: Any) -> Section:
    """A section from itself or from a table such as {shape="circle", radius=0.01}."""
    if isinstance(value, Section):
        return value
    if not isinstance(value, dict):
        raise ValueError(f"must be a section such as Rectangle(height=0.05, width=0.05), got {value!r}")
    sizes = dict(value)
    shape = sizes.pop("shape", None)
    if shape is None:
        raise ValueError("has no shape", "known: " + ", ".join(SHAPES))
    if not isinstance(shape, str):
        raise ValueError(f"has the shape {shape!r}, not a name", "known: " + ", ".join(SHAPES))
    if shape not in SHAPES:
        raise ValueError(f'has the unknown shape "{shape}"', near(shape, SHAPES))
    return SHAPES[shape].model_validate(sizes)


AnySection = Annotated[Section, PlainValidator(_section)]
