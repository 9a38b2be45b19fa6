"""Modal bodies: a floating frame and a few modes of small deformation."""

import os
from collections.abc import Callable, Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, Self

import numpy as np
from pydantic import PrivateAttr, model_validator

from ..base.rotations import quaternion, rotate
from ..errors import SceneError
from .cable import Cable
from .material import Material
from .part import Part
from .rigid_body import Orientation, RigidBody
from .schemas import FileEntry, checked
from .section import AnySection
from .validation import LENGTH_TOLERANCE, Count, Flag, Name, Vector, not_negative, one_of, show, shown, xyz

if TYPE_CHECKING:
    from .body_shape import Shape


def _path(value: Any) -> str | None:
    if value is not None and not isinstance(value, str | os.PathLike):
        raise ValueError(f"must be a file, got {shown(value)}")
    return None if value is None else os.fspath(value)


class ModalBody(Part):
    """A body with small deformation in a few modes, and any motion of its frame (floating frame of reference).

    It is a straight beam from ``start`` to ``end``, with body axes along the beam, the height and the width, or it is
    read from ``data``. A run starts undeformed. Tension does not stiffen the modes, which are no model of a beam that
    spins about as fast as it vibrates. Modes of cable elements, which have no torsion, bend and stretch. The error of a
    frequency falls with about the third power of the number of modes where joints hold points, and with the first where
    they hold sections that the modes do not bend, as those of a free end.

    start, end: ends of the beam, m
    section: cross-section, as of a `Cable`
    material: material
    up: direction of the section's height
    elements: number of elements of the mesh of the modes
    element: their kind
    law: their law
    modes: number of lowest modes
    boundary: "free": free-free modes, the frame at the mass centre (the undeformed coupling M_rf vanishes), for a free
        body, or one held at points that its modes move. "attached": cantilever modes, the frame fixed to the section at
        ``start``, for a body held there
    data: an .npz or netCDF file of arrays in SI units, in body axes: ``nodes`` (N, 3) undeformed, ``modes`` (n, N, 3)
        displacements by a unit of each mode, ``masses`` (N,), ``stiffness`` (n, n), and for joints of sections
        ``rotations`` (n, N, 3) in rad by a unit of each mode
    orthogonal: whether the modes of a file are orthogonal in the mass; if not, their full mass matrix is used
    position: of the frame of ``data``, m
    orientation: of the frame of ``data``, a unit quaternion (w, x, y, z)
    damping_ratio: part of critical damping in every vibration with the frame held
    velocity: of the frame's origin, m/s
    angular_velocity: in body axes, rad/s
    """

    _of_mesh: "Callable[[ModalBody], Any] | None" = PrivateAttr(None)

    kind = "modal_body"
    group = "bodies"
    results = RigidBody.results
    name: Name
    start: Annotated[Vector | None, xyz("m")] = None
    end: Annotated[Vector | None, xyz("m")] = None
    section: AnySection | None = None
    material: Material | None = None
    up: Annotated[Vector, xyz()] = (0.0, 1.0, 0.0)
    elements: Count = 10
    element: str = "beam24"
    law: str | None = None
    modes: Count = 5
    boundary: Annotated[str, one_of(("free", "attached"))] = "free"
    data: Annotated[str | None, checked(_path, {"type": "string"}, FileEntry())] = None
    orthogonal: Flag = True
    position: Annotated[Vector | None, xyz("m")] = None
    orientation: Orientation = (1.0, 0.0, 0.0, 0.0)
    damping_ratio: Annotated[float, not_negative()] = 0.0
    velocity: Annotated[Vector, xyz("m/s")] = (0.0, 0.0, 0.0)
    angular_velocity: Annotated[Vector, xyz("rad/s", of="name")] = (0.0, 0.0, 0.0)

    @model_validator(mode="after")
    def _is_described(self) -> "ModalBody":
        drawn = {name: getattr(self, name) for name in ("start", "end", "section", "material")}
        if self.data is not None:
            if given := [name for name, value in drawn.items() if value is not None]:
                raise ValueError(f"has data and {given[0]}", "give the file, or the entries of a beam")
            if self.position is None:
                raise ValueError("position is missing: data needs that of its frame")
            self.shape  # noqa: B018  what the file says is checked here
            return self
        if missing := [name for name, value in drawn.items() if value is None]:
            raise ValueError(f"{missing[0]} is missing", "give start, end, section and material, or data")
        if self.position is not None or self.orientation != (1.0, 0.0, 0.0, 0.0):
            raise ValueError("has start and end, which define its frame",
                             "leave out position and orientation: they go with data")
        self._drawn  # noqa: B018
        return self

    @property
    def mesh(self) -> Cable:
        """Return the mesh of its modes, in body axes from its start."""
        return Cable(name=self.name, start=(0, 0, 0), end=(self._drawn.length, 0, 0), elements=self.elements,
                     element=self.element, law=self.law, section=self.section, material=self.material)

    @cached_property
    def _drawn(self) -> Cable:
        return Cable(name=self.name, start=self.start, end=self.end, up=self.up, elements=self.elements,
                     element=self.element, law=self.law, section=self.section, material=self.material)

    @property
    def offset(self) -> float:
        """Return the position of the frame's origin along the beam, in m."""
        return 0.0 if self.boundary == "attached" else self._drawn.length / 2

    @cached_property
    def shape(self) -> "Shape":
        """Return its modes and inertia, of its file, or of its mesh by way of its scene.

        Raises SceneError for the mesh of a body without scene.
        """
        if self.data is not None:
            from .body_shape import of_file  # slow to import

            return of_file(self.data, self.orthogonal)
        if self._of_mesh is None:
            raise SceneError(self.where, "has no modes yet: a scene makes them of its mesh",
                             "add it to a scene, and take what `Scene.add` returns")
        return self._of_mesh(self)

    def with_modes_by(self, of_mesh: "Callable[[ModalBody], Shape]") -> Self:
        """Return a copy whose modes ``of_mesh`` computes on the first access."""
        copy = self.model_copy()
        copy._of_mesh = of_mesh
        return copy

    @property
    def modes_in_words(self) -> str:
        """Return a description of its modes for the report of a run."""
        squares, _ = self.shape.vibrations
        hertz = np.sqrt(np.maximum(squares, 0)) / (2 * np.pi)
        kind = "of a file" if self.data is not None else {
            "free": "free-free", "attached": "of the beam attached at its start"}[self.boundary]
        mesh = "" if self.data is not None else f" on {self.elements} elements {self.element}"
        return f"{self.shape.n} modes, {kind}{mesh}, {hertz.min(initial=np.inf):.4g} to {hertz.max(initial=0):.4g} Hz"

    @property
    def frame(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the initial position (3,) in m and orientation (4,), a unit quaternion, of its frame."""
        if self.data is not None:
            return np.array(self.position), np.array(self.orientation)
        axes = self._drawn.axes.T
        return np.array(self.start) + self.offset * axes[:, 0], quaternion(axes)

    def attachment_modes(self, at: Vector) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the point ``at`` (m, body axes) for the engine: undeformed (3,), and its modes and rotations (n, 3).

        It is a node, or a point of the section at a node, of a beam any point across its axis there. Raises
        ValueError(cause, remedy).
        """
        shape, point = self.shape, np.array(at, dtype=float)
        distance = np.linalg.norm(shape.nodes - point, axis=1)
        node, size = int(np.argmin(distance)), max(float(np.ptp(shape.nodes, axis=0).max()), 1.0)
        arm = point - shape.nodes[node]
        along = abs(arm[0]) if self.data is None else 0.0 if shape.rotations.any() else distance[node]
        if along > LENGTH_TOLERANCE * size:
            raise ValueError(f"{show(point, 'm')} is no node of the body",
                             f"the nearest is at {show(shape.nodes[node], 'm')}")
        return point, shape.modes[:, node] + np.cross(shape.rotations[:, node], arm), shape.rotations[:, node]

    def point(self, at: Vector) -> np.ndarray:
        """Return (3,): the initial position of the point ``at`` (m, body axes), in m."""
        position, orientation = self.frame
        return position + rotate(orientation, at)

    @property
    def axes(self) -> np.ndarray:
        """Return (3, 3): its axes at the start, as columns."""
        return rotate(self.frame[1], np.eye(3)).T

    def located(self, at: Vector | None = None, s: float | None = None) -> Vector:
        """Return in body axes the point ``at``, or that of a beam at the arc-length s (m), by default the first node.

        Raises ValueError(cause, remedy).
        """
        if s is None:
            return tuple(self.shape.nodes[0].tolist()) if at is None else at
        if self.data is not None:
            raise ValueError("is given by a file and takes no arc-length s", "give a point in body axes")
        return (s - self.offset, 0.0, 0.0)

    @property
    def mass(self) -> float:
        """Return its mass in kg."""
        return self.shape.mass

    @property
    def inertia(self) -> np.ndarray:
        """Return (3, 3) in kg m², about the frame's origin, undeformed."""
        X = self.shape.X[0, 0]
        return X.trace() * np.eye(3) - X

    def off_plane(self) -> Iterator[str]:
        """Yield its quantities that leave the plane z = 0, see `Part.off_plane`."""
        yield from super().off_plane()
        if self.shape.modes[..., 2].any():
            yield f"mode {1 + int(np.argmax(self.shape.modes[..., 2].any(axis=1)))}"
