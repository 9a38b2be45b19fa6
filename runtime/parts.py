"""What a scene is made of: cables, rigid bodies, pins and slides, each checked when it is made."""

from __future__ import annotations

import math
import os
from typing import Annotated, Any, ClassVar

import numpy as np
from funicular.elements import ElementKind, of_library
from funicular.errors import near
from funicular.materials import Material
from funicular.rotations import rotate
from funicular.sections import AnySection
from funicular.validation import Count, Name, Part, Reference, Vector, finite, one_of, positive, show, vector, xyz
from pydantic import Field, PlainValidator, ValidationInfo, model_validator

Quaternion = tuple[float, float, float, float]

EXACT = 1e-9
"""Lengths that differ by this part of the cable's length are taken as equal."""


def _library(value: Any) -> str | None:
    """A directory, as an absolute path; what is in it is looked at with the element."""
    if value is None:
        return None
    if not isinstance(value, str | os.PathLike):
        raise ValueError(f"must be a directory, got {value!r}")
    return os.path.abspath(value)


def _element(value: Any, info: ValidationInfo) -> str:
    """An element's name in the library, or in this package."""
    library = info.data.get("library")
    known = [name for name, kind in of_library(library).items() if kind.dim == 3]
    if not isinstance(value, str):
        raise ValueError(f"must be a name, got {value!r}", "known: " + ", ".join(known))
    if value not in known:
        where = f' in library "{library}"' if library else ""
        raise ValueError(f'"{value}" is not known{where}', near(value, known))
    return value


class Cable(Part):
    """A straight, stress-free cable from ``start`` to ``end`` (m), of equal elements.

    ``up`` is the direction of the section's height; only its part across the axis counts. ``strain``
    ("green" or "engineering") and ``curvature`` ("exact" or "linear") are for the cable elements: which measures
    their axial and bending stiffness act on, by default green and exact. ``library`` is the directory of a library
    of elements of your own, made by ``funicular derive --spec``, for an ``element`` that stands there.
    """

    kind: ClassVar[str] = "cable"
    name: Name
    start: Annotated[Vector, xyz("m")]
    end: Annotated[Vector, xyz("m")]
    elements: Count
    library: Annotated[str | None, PlainValidator(_library)] = None
    element: Annotated[str, PlainValidator(_element)] = "beam24"
    strain: Annotated[str | None, one_of(("green", "engineering"), optional=True)] = None
    curvature: Annotated[str | None, one_of(("exact", "linear"), optional=True)] = None
    section: AnySection
    material: Material
    up: Annotated[Vector, xyz()] = (0.0, 1.0, 0.0)

    @model_validator(mode="after")
    def _axes_exist(self) -> Cable:
        if not 0 < self.length < math.inf:
            raise ValueError(
                f"start and end must be different points, got {show(self.start)} and {show(self.end, 'm')}"
            )
        tilt = np.linalg.norm(np.cross(self._along, self.up))
        if not tilt > 1e-6 * math.hypot(*self.up):
            axis = show(self._along)
            raise ValueError(
                f"up must not be zero or parallel to the axis {axis}, got {show(self.up)}",
                "give the direction of the section's height",
            )
        return self

    @model_validator(mode="after")
    def _element_can(self) -> Cable:
        cable = self.kind_of_element.is_cable
        if not cable and (self.strain or self.curvature):
            raise ValueError(f"strain and curvature are for cable elements, {self.element} is a continuum",
                             'leave them out, or take element="cable12"')
        if cable:
            across = self.section.second_moment_yy, self.section.second_moment_zz
            if abs(across[0] - across[1]) > EXACT * max(across):
                raise ValueError(f"{self.element} has one bending stiffness: its section needs equal second moments, "
                                 f"got {show(across, 'm⁴')}", 'take a square, a circle or a tube, or element="beam24"')
        if self.law not in self.kind_of_element.laws:
            raise ValueError(f"{self.element} has no law {self.law}", "known: " + ", ".join(self.kind_of_element.laws))
        return self

    @property
    def kind_of_element(self) -> ElementKind:
        """What its element is."""
        return of_library(self.library)[self.element]

    @property
    def law(self) -> str:
        """Name of the elastic law among the element's kernels."""
        if self.strain or self.curvature:
            return f"{self.strain or 'green'}_{self.curvature or 'exact'}"
        return next(iter(self.kind_of_element.laws))

    @property
    def length(self) -> float:
        """Undeformed length in m."""
        return math.dist(self.start, self.end)

    @property
    def _along(self) -> np.ndarray:
        return (np.array(self.end) - self.start) / self.length

    @property
    def axes(self) -> np.ndarray:
        """(3, 3): the unit vectors along the axis, the height and the width, as rows."""
        i = self._along
        j = np.array(self.up) - np.dot(self.up, i) * i
        j /= np.linalg.norm(j)
        return np.array([i, j, np.cross(i, j)])

    @property
    def node_s(self) -> np.ndarray:
        """(nodes,): arc-length of the nodes in m."""
        return self.length * np.arange(self.elements + 1) / self.elements

    @property
    def nodal_vectors(self) -> np.ndarray:
        """(nodes, vectors, 3): the nodal vectors of the undeformed cable, r in m and its gradients."""
        i, j, k = self.axes
        slopes = {"r_x": i, "r_y": j, "r_z": k}  # higher derivatives of a straight cable are zero
        return np.array([[self.point(s) if name == "r" else slopes.get(name, np.zeros(3))
                          for name in self.kind_of_element.nodal_vectors] for s in self.node_s])

    def point(self, s: float) -> np.ndarray:
        """(3,): the point of the undeformed centreline at arc-length ``s``, in m."""
        ratio = s / self.length  # weighting both ends makes both of them exact
        return (1 - ratio) * np.array(self.start) + ratio * np.array(self.end)

    def nearest_s(self, point: np.ndarray) -> float:
        """Arc-length of the point of the undeformed cable nearest to ``point``, in m."""
        return float(np.clip(np.dot(np.asarray(point) - self.start, self._along), 0, self.length))

    def node_at(self, s: float) -> int | None:
        """The node at arc-length ``s``, None if there is none."""
        node = round(s / self.length * self.elements)
        on_node = 0 <= node <= self.elements and abs(self.node_s[node] - s) <= EXACT * self.length
        return node if on_node else None


class Pin(Part):
    """Holds the position of a cable's node at ``s`` (m) where it starts; its slopes stay free."""

    kind: ClassVar[str] = "pin"
    cable: Reference
    s: Annotated[float, finite("m")]

    @classmethod
    def place(cls, data: dict) -> str:
        """How messages name the pin."""
        return f'pin on "{getattr(data.get("cable"), "name", data.get("cable"))}"'

    @property
    def label(self) -> str:
        """Its name in the results, such as ``wire@0``."""
        return f"{self.cable}@{self.s + 0.0:.12g}"


def _inertia(value: Any) -> tuple[Vector, Vector, Vector]:
    """A symmetric inertia from 3 principal moments or 3 rows, in kg m²."""
    rows = value.tolist() if isinstance(value, np.ndarray) else value
    if isinstance(rows, list | tuple) and len(rows) == 3 and all(isinstance(r, list | tuple) for r in rows):
        matrix = np.array([vector(row, "kg m²") for row in rows])
    else:
        matrix = np.diag(vector(rows, "kg m²"))
    if not np.allclose(matrix, matrix.T, rtol=0, atol=1e-12 * np.abs(matrix).max()):
        raise ValueError(f"must be symmetric, got {matrix.tolist()}")
    small, middle, large = np.linalg.eigvalsh(matrix).tolist()
    shown = show((small, middle, large), "kg m²")
    if not small > 0:
        raise ValueError(f"must be positive, got the principal moments {shown}")
    if large > (small + middle) * (1 + EXACT):
        raise ValueError(f"is not that of a body: no principal moment exceeds the sum of the others, got {shown}")
    return tuple(map(tuple, matrix.tolist()))


def _unit_quaternion(value: Any) -> Quaternion:
    quaternion = vector(value, size=4)
    norm = math.hypot(*quaternion)
    if abs(norm - 1) > 1e-3:
        raise ValueError(
            f"must be a unit quaternion (w, x, y, z), got {show(quaternion)}, of length {norm:.6g}",
            "divide it by its length",
        )
    if abs(norm - 1) < 1e-15:  # already rounded to a unit: dividing again would only move the last digit
        return quaternion
    return tuple(component / norm for component in quaternion)


class RigidBody(Part):
    """A rigid body.

    mass in kg; inertia about its centre of mass in body axes, 3 principal moments or 3x3, in kg m²; position
    of the centre of mass in m; orientation: the unit quaternion (w, x, y, z) from body axes to the ground's;
    velocity in m/s; angular_velocity in body axes, in rad/s.
    """

    kind: ClassVar[str] = "rigid_body"
    name: Name
    mass: Annotated[float, positive("kg")]
    inertia: Annotated[tuple[Vector, Vector, Vector], PlainValidator(_inertia)]
    position: Annotated[Vector, xyz("m")]
    orientation: Annotated[Quaternion, PlainValidator(_unit_quaternion)] = (1.0, 0.0, 0.0, 0.0)
    velocity: Annotated[Vector, xyz("m/s")] = (0.0, 0.0, 0.0)
    angular_velocity: Annotated[Vector, xyz("rad/s")] = (0.0, 0.0, 0.0)

    def point(self, at: Vector) -> np.ndarray:
        """(3,): where the body's point ``at`` (m, body axes) starts, in m."""
        return np.array(self.position) + rotate(self.orientation, at)


class Slide(Part):
    """A body's point that rides the centreline of a cable.

    body, along: the rigid body and the cable; s: the arc-length where it starts, in m; at: the point in body
    axes, in m.
    """

    kind: ClassVar[str] = "slide"
    body: Reference
    along: Reference
    s: Annotated[float, finite("m")]
    at: Annotated[Vector, xyz("m")] = (0.0, 0.0, 0.0)
    name: Name = Field(default_factory=lambda data: f"{data['body']}_on_{data['along']}")
