"""The drawn and the stress-free shape of a cable: curve, nodes, nodal vectors, and points along it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.rotations import cross
from ..kernels.element_line import ElementLine
from ..kernels.elements import LawTraits
from ..kernels.mesh import Mesh
from . import cable_drawing, cable_mesh, curves
from .cable_fields import CableFields
from .driven import GROWTH, Driven
from .piece import UniformPiece, boundaries
from .plane import Plane
from .section_stiffness import kernel_law, section_stiffness
from .signal import Signal, at_start
from .validation import LENGTH_TOLERANCE, Vector

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms

    Fields = CableFields
else:
    Fields = object  # pydantic reads the fields of each base class again, 1 % of the import

SAMPLES_WITHOUT_MESH = 257
"""Number of sample points along a cable whose elements are still to be chosen."""
MAX_ITERATIONS = 30
"""Of the search for the nearest point of a cable: three or four reach rounding for a point near it."""


class DrawnCable(Fields):
    """Base of a cable: its shape, nodes and nodal vectors."""

    @cached_property
    def _shape(self) -> curves.Line | curves.Spline:
        return curves.shape_through(self.drawn_through)

    @property
    def drawn_length(self) -> float:
        """Return the drawn length in m."""
        return self._shape.length

    @property
    def length(self) -> float:
        """Return the undeformed length in m, at t = 0 and without its temperature: the range of s."""
        if self.pieces is not None:
            return sum(piece.length for piece in self.pieces)
        return self.drawn_length if self.rest_length is None else at_start(self.rest_length)

    @property
    def stretch(self) -> float:
        """Return the drawn length over the undeformed length."""
        return 1.0 if self.rest_length is None and self.pieces is None else self.drawn_length / self.length

    @property
    def growth(self) -> tuple[Driven, ...]:
        """Return the factor of the stress-free length of each piece, by temperature and by a signal for the length."""
        return tuple(self._growth_of(piece.material.thermal_expansion or 0.0) for piece in self.uniform_pieces)

    def _growth_of(self, expansion: float) -> Driven:
        """Return the factor of the stress-free length of a material with this thermal expansion, 1/K."""
        warm = 0.0 if self.temperature is None else self.temperature
        if isinstance(warm, Signal) and expansion != 0.0:
            return Driven(warm, 1.0, expansion)
        by_heat = 1.0 + expansion * at_start(warm)
        if isinstance(self.rest_length, Signal):
            return Driven(self.rest_length, 0.0, by_heat / self.length)
        return Driven(None, by_heat)

    @property
    def grows(self) -> bool:
        """Return whether a signal prescribes its stress-free length."""
        return any(each.signal is not None for each in self.growth)

    def growth_at(self, time: np.ndarray) -> np.ndarray:
        """Return (T, elements): `growth` of its elements at times (T,) in s."""
        return self.repeated([each.at(time) for each in self.growth]).T

    def driven(self) -> dict[str, Driven]:
        """Return the quantities that signals prescribe, by name: the growth of its pieces, or of all of them if it is
        the same; none of a cable without a temperature and a signal. One at 0 K has them, as where that is adjusted.
        """
        if self.temperature is None and not self.grows:
            return {}
        return dict(zip(self.names_of_growth, self.growth, strict=True))

    @property
    def names_of_growth(self) -> list[str]:
        """Return the names of `growth` of its pieces."""
        each = self.growth
        return [GROWTH if driven == each[0] else f"{GROWTH} {k}" for k, driven in enumerate(each, start=1)]

    @property
    def is_curved(self) -> bool:
        """Return whether the stress-free shape is curved."""
        return self.rest == "drawn" and not self._shape.straight

    @property
    def plane(self) -> Plane | None:
        """Return the plane of planar elements; None for z = 0 and for spatial elements."""
        return cable_drawing.plane_of(self.drawn_through, self.up) if self.dim == 2 else None

    @property
    def normal(self) -> np.ndarray:
        """Return (3,): the unit normal of the plane of planar elements; their height is normal x tangent."""
        plane = self.plane
        return np.array([0.0, 0.0, 1.0]) if plane is None else plane.normal

    @property
    def mesh(self) -> Mesh:
        """Return its mesh. Raises SceneError where its elements are still to be chosen."""
        if self.pieces is not None:
            return self._mesh_of_pieces
        if self.nodes is None:
            return cable_mesh.even_mesh(self.length / self.elements, self.elements)
        return cable_mesh.mesh_of(self.nodes, self.length)

    @cached_property
    def _mesh_of_pieces(self) -> Mesh:
        assert self.pieces is not None, f"{self.where} has no pieces"
        return Mesh.of_nodes(boundaries(self.pieces), self.doubled)

    def lengths_by_piece(self) -> Iterator[tuple[UniformPiece, np.ndarray]]:
        """Yield its pieces with the lengths of their elements, in m: (1,) of equal elements of one piece."""
        lengths, pieces = self.mesh.lengths, self.uniform_pieces
        for piece in pieces:
            yield piece, lengths if len(pieces) == 1 else lengths[piece.first : piece.end]

    @property
    def mass(self) -> float:
        """Return its mass in kg."""
        lengths = [self.length] if self.pieces is None else [piece.length for piece in self.pieces]
        return sum(length * piece.material.density * float(piece.section.mass_moments()[0])
                   for length, piece in zip(lengths, self.uniform_pieces, strict=True))

    def piece_at(self, s: float) -> UniformPiece:
        """Return the piece at arc-length ``s`` in m; between two pieces the one that begins there."""
        pieces = self.uniform_pieces
        if len(pieces) == 1:
            return pieces[0]
        element = self.element_at(s)
        return next(piece for piece in pieces if element < piece.end)

    @property
    def doubled(self) -> tuple[int, ...]:
        """Return the elements that begin at a node of their own, see `Mesh`: those of a piece at a hinge, or whose
        strain under the forces of the piece before it, or by heat, is another one.
        """
        pieces = self.uniform_pieces
        if len(pieces) == 1:
            return ()
        stiffness = [section_stiffness(self.stiffness_law, piece.section, piece.material, self.dim) for piece in pieces]
        if self.kind_of_element.is_cable:
            stiffness = [np.delete(S, 1) for S in stiffness]  # EI
        expansion = [piece.material.thermal_expansion or 0.0 for piece in pieces]
        return tuple(piece.first for k, piece in enumerate(pieces[1:]) if piece.hinge
                     or expansion[k] != expansion[k + 1] or not np.array_equal(stiffness[k], stiffness[k + 1]))

    @property
    def hinges(self) -> tuple[int, ...]:
        """Return the elements that begin at a hinge."""
        return tuple(piece.first for piece in self.uniform_pieces if piece.hinge)

    @property
    def kernel_law(self) -> str:
        """Return the name of its law among the kernels of its element."""
        law = kernel_law(self.law)
        return (self.kind_of_element.law_for_curved_shape(law) or law) if self.is_curved else law

    @property
    def traits(self) -> LawTraits:
        """Return the properties of the law of its kernels."""
        return self.kind_of_element.laws[self.kernel_law]

    @property
    def gives_way(self) -> bool:
        """Return whether it resists hardly in compression."""
        if self.traits.membrane != "tabulated":
            return self.traits.membrane == "tension_only"
        tables = [piece.section.tension_table for piece in self.uniform_pieces]
        return all(table is not None and table.only_pulls for table in tables)

    def in_plane(self, vectors: np.ndarray) -> np.ndarray:
        """Return directions (..., 3) along the ground's axes as (..., dim) along those of its plane."""
        plane = self.plane
        return (vectors if plane is None else plane.into(vectors))[..., : self.dim]

    @property
    def height_direction(self) -> Vector:
        """Return ``up``, or the ground's axis most nearly across the cable where ``up`` lies along it."""
        if curves.has_height(self.drawn_through, self.up):
            return self.up
        least = int(np.argmin(np.abs(self._shape.tangent(0.0))))
        return float(least == 0), float(least == 1), float(least == 2)

    @property
    def node_s(self) -> np.ndarray:
        """Return (nodes,): arc-length of the nodes in m."""
        mesh = self.mesh
        return cable_mesh.even_nodes(self.length, self.elements) if mesh.is_even else mesh.node_s

    def divided(self, parts: int) -> np.ndarray:
        """Return (parts elements + 1,): arc-lengths in m of its nodes and of points that divide each element evenly."""
        mesh = self.mesh
        return np.linspace(0.0, self.length, parts * self.elements + 1) if mesh.is_even else mesh.divided(parts)

    def samples(self, parts: int) -> np.ndarray:
        """Return (n,): arc-lengths in m of sample points: `divided`, or even where its elements are still to be chosen.
        """
        return np.linspace(0.0, self.length, SAMPLES_WITHOUT_MESH) if self.is_open else self.divided(parts)

    @property
    def _has_exact_points(self) -> bool:
        """Return whether points come from its shape: elements along a curve interpolate between points of the curve."""
        return self._shape.straight or self.is_open

    def point(self, s: float) -> np.ndarray:
        """Return (3,): the point of the centreline at arc-length ``s``, in m, on the elements where they are chosen."""
        if self._has_exact_points:
            return self._shape.point(s * self.stretch)
        return self.point_between(self.nodal_vectors, s)

    def points_at(self, s: np.ndarray) -> np.ndarray:
        """Return (n, 3): the points of the centreline at arc-lengths ``s`` (n,), in m, see `point`."""
        if self._has_exact_points:
            return self._shape.point(s * self.stretch)
        line, plane = self._line(self.nodal_vectors), self.plane
        points = np.array([line.point(float(each)) for each in s])
        return points if plane is None else plane.points_out(points)

    def slope(self, s: float) -> np.ndarray:
        """Return (3,): r_x at arc-length ``s``, see `point`."""
        if self._has_exact_points:
            return self.stretch * self._shape.tangent(s * self.stretch)
        slope, plane = self._line(self.nodal_vectors).slope(s), self.plane
        return slope if plane is None else plane.out(slope)

    def height(self, s: float) -> np.ndarray:
        """Return (3,): r_y of the elements at ``s``, or the unit vector along the height where they have none."""
        if self._has_exact_points or not self.kind_of_element.director:
            return self.axes_at(s)[1]
        return self.point_between(self.nodal_vectors, s, y=1.0) - self.point(s)

    def width(self, s: float) -> np.ndarray:
        """Return (3,): r_z of the elements at ``s``, or the unit vector along the width where they have none."""
        if self._has_exact_points or "r_z" not in self.kind_of_element.nodal_vectors:
            return self.axes_at(s)[2]
        return self.point_between(self.nodal_vectors, s, z=1.0) - self.point(s)

    def point_between(self, nodal_vectors: np.ndarray, s: float, y: float = 0.0, z: float = 0.0) -> np.ndarray:
        """Return (3,) in m: the point at arc-length s, height y and width z of the section, by interpolation between
        nodal vectors (nodes, vectors, 3) along the ground's axes.
        """
        point, plane = self._line(nodal_vectors).point(s, y, z), self.plane
        return point if plane is None else plane.points_out(point)

    def _line(self, nodal_vectors: np.ndarray) -> ElementLine:
        """Return the line of its elements between nodal vectors (nodes, vectors, 3), in the axes of its plane."""
        vectors, plane = nodal_vectors, self.plane
        if plane is not None:
            vectors = vectors.copy()
            vectors[:, self.kind_of_element.nodal_vectors.index("r")] -= plane.origin
        return ElementLine(self.library, self.element, self.mesh, self.in_plane(vectors))

    def axes_at(self, s: ArrayLike) -> np.ndarray:
        """Return (..., 3, 3): unit vectors along axis, height and width, as rows, at arc-lengths ``s`` (...)."""
        s = np.asarray(s, dtype=float)
        if self._shape.straight:  # they are the same everywhere
            axes = self._axes_along(np.array([0.0, self.drawn_length]))[0]
            return np.tile(axes, (*s.shape, 1, 1))
        places, which = np.unique(np.append(s.ravel() * self.stretch, [0.0, self.drawn_length]), return_inverse=True)
        return self._axes_along(places)[which[: s.size]].reshape(*s.shape, 3, 3)

    def _axes_along(self, places: np.ndarray) -> np.ndarray:
        """Return (n, 3, 3): the axes at increasing arc-lengths of the drawn shape, from 0."""
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
        """Return (nodes, vectors, 3) as drawn: r in m, its gradients by the undeformed cable, r_xx in 1/m."""
        drawn, stretch = self.node_s * self.stretch, self.stretch
        bent = "r_xx" in self.kind_of_element.nodal_vectors
        return self._vectors(self._shape.point(drawn), self.axes_at(self.node_s), stretch,
                             stretch**2 * self._shape.curvature(drawn) if bent else None)

    @property
    def nodal_rates(self) -> np.ndarray:
        """Return (nodes, vectors, 3): the rates of `nodal_vectors` at the start, those of a rigid motion."""
        names = self.kind_of_element.nodal_vectors
        if not any((*self.velocity, *self.angular_velocity)):
            return np.zeros((self.mesh.n_nodes, len(names), 3))
        vectors, place = self.nodal_vectors, names.index("r")
        vectors[:, place] -= vectors[0, place]
        rates = cross(self.angular_velocity, vectors)
        rates[:, place] += self.velocity
        return rates

    @property
    def reference(self) -> np.ndarray | None:
        """Return (elements, 2 vectors, dim): stress-free nodal vectors of each element; None where the law needs none.
        """
        if not self.traits.takes_shape:
            return None
        rest = self.in_plane(self.rest_nodal_vectors)
        return np.concatenate([rest[self.mesh.first], rest[self.mesh.last]], axis=1)

    @property
    def rest_nodal_vectors(self) -> np.ndarray:
        """Return (nodes, vectors, 3): the nodal vectors of the stress-free cable, with start and direction as drawn."""
        start = self._shape.point(0.0)
        if self.rest == "straight":
            axes = np.broadcast_to(self.axes, (self.mesh.n_nodes, 3, 3))
            return self._vectors(start + self.node_s[:, None] * axes[:, 0], axes, 1.0, np.zeros((len(axes), 3)))
        drawn = self.node_s * self.stretch
        return self._vectors(start + (self._shape.point(drawn) - start) / self.stretch, self.axes_at(self.node_s), 1.0,
                             self.stretch * self._shape.curvature(drawn))

    def _vectors(self, r: np.ndarray, axes: np.ndarray, stretch: float, r_xx: np.ndarray | None) -> np.ndarray:
        known: dict[str, Any] = {"r": r, "r_x": stretch * axes[:, 0], "r_y": axes[:, 1], "r_z": axes[:, 2],
                                 "r_xx": r_xx}
        return np.stack([known[name] for name in self.kind_of_element.nodal_vectors], axis=1)

    def nearest_s(self, point: np.ndarray) -> np.ndarray:
        """Return the arc-lengths (n,) in m where the distance to ``point`` (3,) is a local minimum, the least first."""
        found = [self._nearest(float(s), point) for s in self._shape.nearest(point) / self.stretch]
        return np.array([s for _, s in sorted(found)])

    def _nearest(self, s: float, point: np.ndarray) -> tuple[float, float]:
        """Return the least distance to a point around s, and its arc-length, both in m, by the Gauss-Newton method."""
        away = point - self.point(s)
        distance, part = float(np.linalg.norm(away)), 1.0
        for _ in range(MAX_ITERATIONS):
            slope = self.slope(s)
            step = part * float(slope @ away / (slope @ slope))
            other = min(max(s + step, 0.0), self.length)
            beyond = point - self.point(other)
            if (shorter := float(np.linalg.norm(beyond))) < distance:
                s, away, distance, part = other, beyond, shorter, 1.0
            else:
                part /= 4
        return distance, s

    def node(self, s: float) -> int:
        """Return the number of the node at arc-length ``s`` in m, where checks have found one."""
        node = self.node_at(s)
        assert node is not None, f"{self.where} has no node at {s}"
        return node

    def boundary(self, s: float) -> int:
        """Return the number of the boundary of elements at arc-length ``s`` in m, where checks have found a node."""
        node = self.node(s)
        return node if self.is_open or not self.mesh.doubled else int(self.mesh.boundary_of_node[node])

    def node_at(self, s: float) -> int | None:
        """Return the number of the node at arc-length ``s`` in m, else None; a cable without mesh gets one anywhere."""
        if self.is_open:
            return round(s / (LENGTH_TOLERANCE * self.length))
        length, elements = self.length, self.elements
        if self.nodes is None and self.pieces is None:  # equal elements, whose nodes need no arrays
            node = round(s / length * elements)
            at = length * node / elements  # as in `node_s`
        else:
            mesh = self.mesh
            node = round(s / length * elements) if mesh.is_even else int(mesh.nearest_boundary(s))
            at = mesh.boundaries[node] if 0 <= node <= elements else 0.0
            if mesh.doubled:
                node, elements = int(mesh.first_node(node)) - (node in mesh.doubled), mesh.n_nodes - 1
        return node if 0 <= node <= elements and abs(at - s) <= LENGTH_TOLERANCE * length else None

    def element_at(self, s: float) -> int:
        """Return the number of the element at arc-length ``s`` in m."""
        mesh = self.mesh
        return math.floor(s / self.length * self.elements) if mesh.is_even else int(mesh.element_at(s))
