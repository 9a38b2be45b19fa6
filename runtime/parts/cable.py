"""Cables: what they are made with, and which elements and elastic laws suit which sections."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field, PrivateAttr, ValidationInfo, model_validator

from ..errors import SceneError, near
from ..kernels.elements import ElementKind, LawTraits
from ..kernels.libraries import of_library, resolved
from ..kernels.mesh import Mesh
from . import cable_drawing, cable_laws, cable_mesh, curves
from .drawn_cable import DrawnCable
from .hanging import catenary
from .material import Material
from .part import Part
from .schemas import ONLY_PYTHON, POINT, GivenAs, Turning, checked, list_of_lists
from .section import AnySection, outer_radius_of
from .validation import Count, Name, Vector, one_of, positive, show, shown, xyz


def _library(value: Any) -> str | None:
    """Return the directory of a library, as an absolute path without links; what is there is loaded."""
    if value is None:
        return None
    if not isinstance(value, str | os.PathLike):
        raise ValueError(f"must be a directory, got {shown(value)}")
    directory = resolved(value)
    of_library(directory)
    return directory


def _element(value: Any, info: ValidationInfo) -> str:
    """Return an element's name in the library, or in this package."""
    library = info.data.get("library")
    known = of_library(library)
    if not isinstance(value, str):
        raise ValueError(f"must be a name, got {shown(value)}", "known: " + ", ".join(known))
    if value not in known:
        where = f' in library "{library}"' if library else ""
        raise ValueError(f'"{value}" is not known{where}', near(value, known))
    return value


def _points(value: Any) -> tuple[tuple[float, ...], ...]:
    return curves.points(value)


class Cable(DrawnCable, Part):
    """A cable of elements, drawn straight, through points or along a curve.

    All arc-lengths s are of the undeformed cable. Drawn is how a run starts. The tangent of a curve must be continuous,
    the curvature need not: straight, arc, straight is possible.

    Without ``elements`` and ``nodes``, `Scene.choose`, or a run with ``model="auto"``, chooses equal elements for a
    tolerance, and element and law where no ``element`` is given.

    Planar elements lie in the plane through their line and ``up``, with the height on the side of ``up``; a line in z =
    0 with ``up`` in it stays in that plane, with the height at z x tangent.

    A cable that is stress-free where it is curved has the exact curvature, whose size alone it measures: it resists
    bending in the plane of its curve, and across that plane by tension alone. The law "structural" is the one for thin
    arcs of beams: the continuum locks there, unless its elements are about as short as two heights.

    start, end: ends of a straight or hanging cable, m
    points: points (x, y, z) of a smooth curve, m
    curve: a function of u from 0 to 1 that returns x, y, z in m; kept as points
    shape: "straight"; or "hanging": from ``start`` to ``end`` along the catenary of an inextensible cable of this
        ``rest_length``, longer than the span, under the gravity of the scene, straight where it is stress-free
    elements: number of elements of equal length
    nodes: arc-lengths of the nodes, from 0 to the length, m; close where the cable bends much or where something is
        attached. The longest element is at most 1e6 times as long as the shortest
    library: directory of a library of elements
    element: name of the element
    law: of beams, "continuum" (the default), "poisson_split" or "structural"
    strain: of cable elements, the axial measure, "green" (the default) or "engineering"
    curvature: of cable elements, the measure of bending, "exact" (the default) or "linear"
    membrane: of cable elements, the representation of axial strain. "full" (the default): at every point.
        "tension_only": the same, engineering strain, with 1e-4 of the axial stiffness in compression, where the force
        is at most that and 2.5e-7 EA. "assumed": by Legendre modes of degree 0 to 2 ("cable18": 0 to 4). "reduced": by
        those of degree 0 and 1 ("cable18": 0 to 2), with 1 % of the axial stiffness on the modes above. Beside a point
        force on a taut rope, the tension of full and assumed strain oscillates along the cable, that of reduced strain
        hardly. Reduced strain is for small strain: stable up to a compression of 1 %, with about four times as many
        elements for axial waves
    section: cross-section
    material: material
    up: direction of the section's height at the start, of which the part across the axis counts; from there on the
        section follows the curve without turning about its tangent. It may lie along the axis where the section is
        round or the element has no axes across: the height then lies along the ground's axis most nearly across
    rest: undeformed shape, "drawn" or "straight"
    rest_length: undeformed length, m, by default the length as drawn. A shorter one makes the drawn cable taut, a
        longer one slack (a straight one is compressed)
    velocity: of the first point at the start, m/s; the cable moves as a rigid body, except where supports hold it
    angular_velocity: about the first point at the start, rad/s, along the ground's axes
    """

    _hanging: tuple[tuple[float, ...], ...] | None = PrivateAttr(None)

    kind: ClassVar[str] = "cable"
    group: ClassVar[str] = "cables"
    name: Name
    start: Annotated[Vector | None, xyz("m")] = None
    end: Annotated[Vector | None, xyz("m")] = None
    points: Annotated[tuple[tuple[float, ...], ...] | None, checked(_points, list_of_lists("m"), Turning(POINT))] = None
    curve: Annotated[Callable | None, GivenAs(ONLY_PYTHON)] = None  # kept as points, see `_settled`
    shape: Annotated[str | None, one_of(("straight", "hanging"), optional=True)] = None
    given_elements: Annotated[Count | None, Field(alias="elements")] = None
    nodes: Annotated[tuple[float, ...] | None, cable_mesh.increasing()] = None
    library: Annotated[str | None, checked(_library, {"type": "string"})] = None
    element: Annotated[str, checked(_element, {"type": "string"})] = "beam24"
    law: str = None  # type: ignore[assignment]  # `_with_a_law` chooses one where none is given
    strain: Annotated[str | None, one_of(("green", "engineering"), optional=True)] = None
    curvature: Annotated[str | None, one_of(("exact", "linear"), optional=True)] = None
    membrane: Annotated[str | None, one_of(cable_laws.MEMBRANES, optional=True)] = None
    section: AnySection
    material: Material
    up: Annotated[Vector, xyz()] = (0.0, 1.0, 0.0)
    rest: Annotated[str, one_of(("drawn", "straight"))] = "drawn"
    rest_length: Annotated[float, positive("m")] | None = None
    velocity: Annotated[Vector, xyz("m/s")] = (0.0, 0.0, 0.0)
    angular_velocity: Annotated[Vector, xyz("rad/s")] = (0.0, 0.0, 0.0)

    @model_validator(mode="before")
    @classmethod
    def _settled(cls, data: Any) -> Any:
        """Return a curve as points, and the law by its name."""
        if not isinstance(data, dict):
            return data
        optional = ("start", "end", "points", "curve", "law", "library", "strain", "curvature", "membrane",
                    "rest_length", "elements", "nodes", "shape")
        data = {name: value for name, value in data.items() if value is not None or name not in optional}
        if "curve" in data:
            if "points" in data:
                raise ValueError("has points and a curve", "give one of them")
            curve, elements = data.pop("curve"), data.get("elements", len(np.atleast_1d(data.get("nodes", 0))))
            if not callable(curve):
                raise ValueError(f"curve must be a function of u from 0 to 1, got {shown(curve)}", "or give points")
            data["points"] = curves.sample(curve, min(elements, 1000) if isinstance(elements, int) else 1)
        if data.get("shape") == "hanging":
            data.setdefault("rest", "straight")
        try:
            known = of_library(_library(data.get("library")))
        except ValueError:  # the check of the library says it
            return data
        element = data.get("element", "beam24")
        kind = known.get(element) if isinstance(element, str) else None
        if kind is not None:
            data["law"] = cable_laws.chosen(kind, data)
        return data

    @model_validator(mode="after")
    def _is_drawn(self) -> Cable:
        ends = self.start is not None, self.end is not None
        if self.points is not None and any(ends):
            raise ValueError("has points and start or end", "give the points alone, the first is the start")
        if self.points is None and not all(ends):
            missing = "end is" if ends[0] else "start is" if ends[1] else "start and end, or points, are"
            raise ValueError(f"{missing} missing")
        if self.shape is not None and self.points is not None:
            raise ValueError(f'has points and shape="{self.shape}"', "give one of them")
        if self.shape == "hanging" and self.rest_length is None:
            raise ValueError("hangs with the length that it has, but rest_length is missing")
        if self.shape == "hanging" and self.rest != "straight":
            raise ValueError('has shape="hanging", but is to be free of stress as drawn', 'leave rest out, or give the '
                             "catenary as curve")
        if self.start is not None and self.end is not None and self.start == self.end:
            raise ValueError(
                f"start and end must be different points, got {show(self.start)} and {show(self.end, 'm')}")
        if self.nodes is not None:
            if self.given_elements is not None:
                raise ValueError(f"has {self.given_elements} elements and {len(self.nodes)} nodes",
                                 "give elements of equal lengths, or the nodes")
            cable_mesh.check_ends(self.nodes, self.length)
        self._check_drawing()
        return self

    def _check_drawing(self) -> None:
        """Raise ValueError where its elements cannot be drawn along its shape."""
        if self.dim == 2:
            cable_drawing.check_plane(self.element, self.drawn_through, self.velocity, self.angular_velocity, self.up)
        else:
            cable_drawing.check_height(self.drawn_through, self.up, self._is_round)
        if not self.is_open:
            cable_drawing.check_elements(self._shape, self.node_s * self.stretch)

    def hanging_under(self, gravity: tuple[float, ...]) -> Cable:
        """Return the cable drawn as it hangs under gravity (m/s²), where its shape is that. Raises SceneError."""
        if self.shape != "hanging":
            return self
        assert self.start is not None, f"{self.where} has no start"
        assert self.end is not None, f"{self.where} has no end"
        try:
            curve = catenary(self.start, self.end, self.length, gravity)
            made = self.hanging_through(curves.points(curves.sample(curve, 1 if self.is_open else
                                                                    min(self.elements, 1000))))
            made._check_drawing()
        except ValueError as error:
            raise SceneError(self.where, *error.args) from None
        return made

    def hanging_through(self, points: Iterable[tuple[float, ...]]) -> Cable:
        """Return the cable drawn through points in m, without checks: those of the catenary in which it hangs."""
        made = self.model_copy()
        made._hanging = tuple(points)
        return made

    @property
    def _is_round(self) -> bool:
        """Return whether all directions across its axis are alike: a round section, or elements that have none."""
        return outer_radius_of(self.section) is not None or not self.kind_of_element.director

    @model_validator(mode="after")
    def _law_suits(self) -> Cable:
        if not self.is_open or "element" in self.model_fields_set:
            cable_laws.check(self)
        return self

    @property
    def is_open(self) -> bool:
        """Return whether its elements were left out, so that they have to be chosen before it can be simulated."""
        return self.given_elements is None and self.nodes is None

    @property
    def elements(self) -> int:
        """Return the number of its elements. Raises SceneError where they were left out."""
        if self.given_elements is not None:
            return self.given_elements
        if self.nodes is not None:
            return len(self.nodes) - 1
        raise SceneError(self.where, "has no elements yet",
                         "give elements=, or let them be chosen: scene.choose(tol).scene")

    def mesh_entries(self, elements: int) -> dict[str, Any]:
        """Return, by keyword, what makes it one of that many elements: unequal ones are divided or joined alike where
        the number is a multiple or a divisor of theirs; else they are equal.
        """
        nodes = cable_mesh.refined(self.uneven_nodes, elements)
        return {"nodes": nodes, "elements": None} if nodes else {"elements": elements, "nodes": None}

    @property
    def uneven_nodes(self) -> tuple[float, ...]:
        """Return the arc-lengths of its nodes in m where its elements are not equal, else ()."""
        return () if self.nodes is None or self.mesh.is_even else tuple(self.mesh.node_s.tolist())

    @property
    def mesh(self) -> Mesh:
        """Return where its nodes are. Raises SceneError where its elements were left out."""
        if self.nodes is None:
            return Mesh.even(self.length / self.elements, self.elements)
        return cable_mesh.mesh_of(self.nodes, self.length)

    def entries(self) -> dict[str, Any]:
        """Return what it could be made with; of an open one without the element and the law that nobody gave."""
        entries = super().entries()
        if self.is_open and "element" not in self.model_fields_set:
            return {name: value for name, value in entries.items() if name not in ("element", "law")}
        return entries

    def entries_with(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """Return what a cable like this one is made with: drawn anew, or with another law, it keeps nothing of the old
        one, but with another measure it keeps the other measures. Elements take the place of nodes, and nodes that of
        elements. One that hangs is free of stress where it is straight.
        """
        other = {"elements": "nodes", "nodes": "elements"}
        left: dict[str, Any] = {other[name]: None for name in other if changes.get(name) is not None}
        if any(changes.get(name) is not None for name in ("points", "curve")):
            left |= dict.fromkeys(("start", "end", "points", "shape"))
        if changes.get("shape") == "hanging":
            left["rest"] = None
        if "law" not in changes:
            left |= cable_laws.changed(self.kind_of_element, self.law, changes, self.library)
        elif changes["law"] != self.law:
            left |= dict.fromkeys(cable_laws.MEASURES)
        return super().entries_with(left | {**changes})

    @property
    def kind_of_element(self) -> ElementKind:
        """Return what its element is."""
        return of_library(self.library)[self.element]

    @property
    def dim(self) -> int:
        """Return 3, or 2 for planar elements."""
        return self.kind_of_element.dim

    def off_plane(self) -> Iterator[str]:
        """Yield nothing: a planar cable lies in a plane of its own."""
        return iter(())

    @property
    def kernel_law(self) -> str:
        """Return the name of the law among the element's kernels."""
        return cable_laws.name_of_kernels(self.kind_of_element, self.law, self.is_curved)

    @property
    def traits(self) -> LawTraits:
        """Return what the law of its kernels is."""
        return self.kind_of_element.laws[self.kernel_law]

    @property
    def stiffness_law(self) -> str:
        """Return the name of the law whose stiffness of the section it takes, see `section_stiffness`."""
        laws = self.kind_of_element.laws
        return laws[self.law].stiffness_of if self.law in laws else self.law

    @property
    def drawn_through(self) -> tuple[tuple[float, ...], ...]:
        """Return the points that it is drawn through, in m."""
        if self.shape == "hanging" and self._hanging is not None:
            return self._hanging
        if self.points is not None:
            return self.points
        if self.start is not None and self.end is not None:
            return self.start, self.end
        return tuple(end for end in (self.start, self.end) if end is not None)
