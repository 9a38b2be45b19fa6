"""Cables: how they are drawn, their stress-free shape, and which elements and elastic laws suit which sections."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from pydantic import Field, PrivateAttr, ValidationInfo, model_validator

from ..errors import SceneError, near
from ..kernels.element_line import ElementLine
from ..kernels.elements import ElementKind, LawTraits
from ..kernels.libraries import of_library, resolved
from ..kernels.mesh import Mesh
from ..rotations import cross
from . import cable_drawing, cable_laws, cable_mesh, curves
from .hanging import catenary
from .material import Material
from .part import Part
from .plane import Plane
from .schemas import ONLY_PYTHON, GivenAs, checked, list_of_lists
from .section import AnySection, outer_radius_of
from .validation import EXACT, Count, Name, Vector, one_of, positive, show, shown, xyz

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers alone

OPEN = 257
"""Places at which a cable is looked at whose elements are still to be chosen."""


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


class Cable(Part):
    """A cable of elements, drawn straight, through points or along a curve.

    It has ``elements`` of equal lengths, or ``nodes`` at given arc-lengths in m, from 0 to its length: close where it
    bends much, or where something is attached. Both may be left out: `Scene.choose`, or a run with ``model="auto"``,
    then chooses equal elements for a tolerance, and element and law where no ``element`` is given.

    Drawn, which is how a run starts: from ``start`` to ``end``; or smoothly through ``points`` (x, y, z); or along
    ``curve``, a function of u from 0 to 1 that gives x, y, z (kept as points; in Python only). All in m. The tangent
    must be continuous, the curvature need not: straight, arc, straight will do. ``shape`` "hanging": from ``start`` to
    ``end`` along the catenary of a cable with this ``rest_length``, longer than the span, that cannot stretch, under
    the gravity of the scene; its stress-free shape is straight.
    Undeformed: ``rest`` "drawn", the drawn shape, or "straight"; ``rest_length`` in m, the length as drawn if not
    given: a shorter one makes the drawn cable taut, a longer one slack (or compressed, where it is straight).
    All arc-lengths s are of the undeformed cable.

    At the start it moves as a rigid body would: its first point with ``velocity`` (m/s), and turning about that with
    ``angular_velocity`` (rad/s, along the ground's axes), but for what supports hold.

    ``up`` is the direction of the section's height at the start; only its part across the axis counts, and from there
    on the section turns with the curve, about its tangent nowhere. It may lie along the axis where the section is round
    or the element has no axes across: then the height lies along the ground's axis most nearly across. Planar elements
    lie in the plane through their line and ``up``, with the height on the side of that; a line in z = 0 with ``up`` in
    it, too, stays in that plane, with the height at z x tangent, wherever ``up`` points there. ``law``: for beams
    "continuum" (the default), "poisson_split" or "structural"; for cables ``strain`` ("green" or "engineering") and
    ``curvature`` ("exact" or "linear"), the measures that their axial and bending stiffness act on, by default green
    and exact; and ``membrane``, how an element represents its axial strain: "full" (the default) at every point;
    "tension_only" the same, engineering strain, with 1e-4 of the axial stiffness in compression, where the force is at
    most that and 2.5e-7 EA; "assumed" by its Legendre modes of degree 0 to 2; "reduced" by those of degree 0 and 1,
    with 1 % of the axial stiffness on degree 2, which keeps the lengths of the slopes stable ("cable18": 0 to 4, 0 to
    2, and 3 and 4). Beside a point force on a taut rope the tension of full and assumed strain swings, that of reduced
    strain hardly. Reduced strain is for small strain: stable up to a compression of 1 %, with about four times as many
    elements for axial waves.

    A cable that is stress-free where it is curved has the exact curvature, whose size alone it measures: it resists in
    the plane of its curve, and across that plane by tension alone. Of the beams' laws, "structural" is the one for thin
    arcs: the continuum locks there, unless its elements are about as short as two heights.
    """

    _hanging: tuple[tuple[float, ...], ...] | None = PrivateAttr(None)

    kind: ClassVar[str] = "cable"
    group: ClassVar[str] = "cables"
    name: Name
    start: Annotated[Vector | None, xyz("m")] = None
    end: Annotated[Vector | None, xyz("m")] = None
    points: Annotated[tuple[tuple[float, ...], ...] | None, checked(_points, list_of_lists("m"))] = None
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

    @property
    def height_direction(self) -> Vector:
        """Return ``up``; where that lies along the axis of a round section, the ground's axis most nearly across it."""
        if curves.has_height(self.drawn_through, self.up):
            return self.up
        least = int(np.argmin(np.abs(self._shape.tangent(0.0))))
        return float(least == 0), float(least == 1), float(least == 2)

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

    @property
    def plane(self) -> Plane | None:
        """Return the plane that planar elements lie in; None of z = 0, and of spatial elements."""
        return cable_drawing.plane_of(self.drawn_through, self.up) if self.dim == 2 else None

    @property
    def normal(self) -> np.ndarray:
        """Return (3,): the unit normal of the plane that planar elements lie in; their height is normal x tangent."""
        plane = self.plane
        return np.array([0.0, 0.0, 1.0]) if plane is None else plane.normal

    def in_plane(self, vectors: np.ndarray) -> np.ndarray:
        """Return directions (..., 3) along the ground's axes as (..., dim), along those of its plane."""
        plane = self.plane
        return (vectors if plane is None else plane.into(vectors))[..., : self.dim]

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

    @property
    def _shape(self) -> curves.Line | curves.Spline:
        return curves.shape_through(self.drawn_through)

    @property
    def drawn_length(self) -> float:
        """Return the length in m of the cable as it is drawn."""
        return self._shape.length

    @property
    def length(self) -> float:
        """Return the undeformed length in m."""
        return self.drawn_length if self.rest_length is None else self.rest_length

    @property
    def stretch(self) -> float:
        """Return the length as drawn over undeformed length."""
        return 1.0 if self.rest_length is None else self.drawn_length / self.rest_length

    @property
    def is_curved(self) -> bool:
        """Return whether the undeformed shape is."""
        return self.rest == "drawn" and not self._shape.straight

    @property
    def node_s(self) -> np.ndarray:
        """Return (nodes,): arc-length of the nodes in m."""
        mesh = self.mesh
        return self.length * np.arange(self.elements + 1) / self.elements if mesh.is_even else mesh.node_s

    def divided(self, parts: int) -> np.ndarray:
        """Return (parts elements + 1,): arc-lengths of its nodes and of points that divide each element alike, in m."""
        mesh = self.mesh
        return np.linspace(0.0, self.length, parts * self.elements + 1) if mesh.is_even else mesh.divided(parts)

    def samples(self, parts: int) -> np.ndarray:
        """Return (n,): arc-lengths at which its drawn shape is looked at, in m: `divided`, or evenly apart where its
        elements are still to be chosen.
        """
        return np.linspace(0.0, self.length, OPEN) if self.is_open else self.divided(parts)

    def point(self, s: float) -> np.ndarray:
        """Return (3,): the point of the centreline at arc-length ``s``, in m, as the elements draw it.

        Between nodes that is not quite the curve that they are drawn along; a rider has to start on the elements.
        """
        if self._shape.straight or self.is_open:
            return self._shape.point(s * self.stretch)
        return self._as_drawn_point(s)

    def points_at(self, s: np.ndarray) -> np.ndarray:
        """Return (n, 3): the points of the centreline at arc-lengths ``s`` (n,), in m, see `point`."""
        if self._shape.straight or self.is_open:
            return self._shape.point(s * self.stretch)
        line, plane = self._as_drawn, self.plane
        points = np.array([line.point(float(each)) for each in s])
        return points if plane is None else plane.points_out(points)

    def slope(self, s: float) -> np.ndarray:
        """Return (3,): r_x at arc-length ``s``, as the elements draw it."""
        if self._shape.straight or self.is_open:
            return self.stretch * self._shape.tangent(s * self.stretch)
        slope, plane = self._as_drawn.slope(s), self.plane
        return slope if plane is None else plane.out(slope)

    def height(self, s: float) -> np.ndarray:
        """Return (3,): along the section's height at ``s``: r_y as the elements draw it, the axis there if they have
        none.
        """
        if self._shape.straight or self.is_open or not self.kind_of_element.director:
            return self.axes_at(s)[1]
        return self._as_drawn_point(s, y=1.0) - self._as_drawn_point(s)

    def width(self, s: float) -> np.ndarray:
        """Return (3,): along the section's width at ``s``: r_z as the elements draw it, the axis there if they have
        none.
        """
        if self._shape.straight or self.is_open or "r_z" not in self.kind_of_element.nodal_vectors:
            return self.axes_at(s)[2]
        return self._as_drawn_point(s, z=1.0) - self._as_drawn_point(s)

    def _as_drawn_point(self, s: float, y: float = 0.0, z: float = 0.0) -> np.ndarray:
        """Return (3,) in m: the point at arc-length s, height y and width z of the section, as the elements draw it."""
        return self.point_between(self.nodal_vectors, s, y, z)

    def point_between(self, nodal_vectors: np.ndarray, s: float, y: float = 0.0, z: float = 0.0) -> np.ndarray:
        """Return (3,) in m: the point at arc-length s, height y and width z of the section, as its elements have it
        between nodes with these vectors (nodes, vectors, 3), along the ground's axes.
        """
        point, plane = self._line(nodal_vectors).point(s, y, z), self.plane
        return point if plane is None else plane.points_out(point)

    @property
    def _as_drawn(self) -> ElementLine:
        """Return the elements at the start, which interpolate between the nodes, in the axes of its plane."""
        return self._line(self.nodal_vectors)

    def _line(self, nodal_vectors: np.ndarray) -> ElementLine:
        """Return its elements between nodes with these vectors (nodes, vectors, 3), in the axes of its plane."""
        vectors, plane = nodal_vectors, self.plane
        if plane is not None:
            vectors = vectors.copy()
            vectors[:, self.kind_of_element.nodal_vectors.index("r")] -= plane.origin
        return ElementLine(self.library, self.element, self.mesh, self.in_plane(vectors))

    def axes_at(self, s: ArrayLike) -> np.ndarray:
        """Return (..., 3, 3): unit vectors along axis, height and width, as rows, at arc-lengths ``s`` as drawn."""
        s = np.asarray(s, dtype=float)
        if self._shape.straight:  # they are the same everywhere
            axes = self._axes_along(np.array([0.0, self.drawn_length]))[0]
            return np.tile(axes, (*s.shape, 1, 1))
        places, which = np.unique(np.append(s.ravel() * self.stretch, [0.0, self.drawn_length]), return_inverse=True)
        return self._axes_along(places)[which[: s.size]].reshape(*s.shape, 3, 3)

    def _axes_along(self, places: np.ndarray) -> np.ndarray:
        """Return (places, 3, 3): `axes_at` increasing arc-lengths as drawn, the first of them 0."""
        if self.dim == 2:
            i, k = self._shape.tangent(places), self.normal
            return np.stack([i, cross(k, i), np.broadcast_to(k, i.shape)], axis=1)
        return curves.transported(self.drawn_through, self.height_direction, tuple(places.tolist()))

    @property
    def axes(self) -> np.ndarray:
        """Return (3, 3): the axes at the start, see `axes_at`."""
        return self.axes_at(0.0)

    @property
    def nodal_vectors(self) -> np.ndarray:
        """Return (nodes, vectors, 3): as drawn; r in m, its gradients by the undeformed cable, r_xx in 1/m."""
        drawn, stretch = self.node_s * self.stretch, self.stretch
        bent = "r_xx" in self.kind_of_element.nodal_vectors
        return self._vectors(self._shape.point(drawn), self.axes_at(self.node_s), stretch,
                             stretch**2 * self._shape.curvature(drawn) if bent else None)

    @property
    def nodal_rates(self) -> np.ndarray:
        """Return (nodes, vectors, 3): rates of `nodal_vectors` at the start, of a rigid motion."""
        names = self.kind_of_element.nodal_vectors
        if not any((*self.velocity, *self.angular_velocity)):
            return np.zeros((self.elements + 1, len(names), 3))
        vectors, place = self.nodal_vectors, names.index("r")
        vectors[:, place] -= vectors[0, place]
        rates = cross(self.angular_velocity, vectors)
        rates[:, place] += self.velocity
        return rates

    @property
    def reference(self) -> np.ndarray | None:
        """Return (elements, 2 vectors, dim): stress-free nodal vectors of each element; None where the law takes none.
        """
        if not self.traits.takes_shape:
            return None
        rest = self.in_plane(self.rest_nodal_vectors)
        return np.concatenate([rest[:-1], rest[1:]], axis=1)

    @property
    def rest_nodal_vectors(self) -> np.ndarray:
        """Return (nodes, vectors, 3): those of the stress-free cable, with the drawn one's start and direction there.
        """
        start = self._shape.point(0.0)
        if self.rest == "straight":
            axes = np.broadcast_to(self.axes, (self.elements + 1, 3, 3))
            return self._vectors(start + self.node_s[:, None] * axes[:, 0], axes, 1.0, np.zeros((self.elements + 1, 3)))
        drawn = self.node_s * self.stretch
        return self._vectors(start + (self._shape.point(drawn) - start) / self.stretch, self.axes_at(self.node_s), 1.0,
                             self.stretch * self._shape.curvature(drawn))

    def _vectors(self, r: np.ndarray, axes: np.ndarray, stretch: float, r_xx: np.ndarray | None) -> np.ndarray:
        known: dict[str, Any] = {"r": r, "r_x": stretch * axes[:, 0], "r_y": axes[:, 1], "r_z": axes[:, 2],
                                 "r_xx": r_xx}
        return np.stack([known[name] for name in self.kind_of_element.nodal_vectors], axis=1)

    def nearest_s(self, point: np.ndarray) -> float:
        """Return the arc-length of the point of the drawn cable nearest to ``point``, in m."""
        return self._shape.nearest(point) / self.stretch

    def node(self, s: float) -> int:
        """Return the number of the node at arc-length ``s`` in m; a check has found that there is one."""
        node = self.node_at(s)
        assert node is not None, f"{self.where} has no node at {s}"
        return node

    def node_at(self, s: float) -> int | None:
        """Return the node at arc-length ``s``, None if there is none; an open cable will have one wherever one is
        asked for.
        """
        if self.is_open:
            return round(s / (EXACT * self.length))
        mesh, node_s = self.mesh, self.node_s
        node = round(s / self.length * self.elements) if mesh.is_even else int(mesh.nearest_node(s))
        on_node = 0 <= node <= self.elements and abs(node_s[node] - s) <= EXACT * self.length
        return node if on_node else None

    def element_at(self, s: float) -> int:
        """Return the number of the element that holds ``s``."""
        mesh = self.mesh
        return math.floor(s / self.length * self.elements) if mesh.is_even else int(mesh.element_at(s))
