"""The model that the engine integrates: cables, bodies, couplings, and arrays over all of them.

Coordinates, unknowns and their order are those of engine/bodies/model.h.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import field
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Protocol, TypeVar, cast

import numpy as np

from ..base.deferred import dataclass
from ..kernels.libraries import kernels_of, of_library
from ..kernels.mesh import Mesh
from ..parts.body_shape import Shape
from ..parts.part import Part
from ..parts.plane_axes import PlaneAxes
from .attachments import AttachmentModel
from .branches import BranchModel
from .combinations import Combinations
from .contacts import ContactModel, HardContactModel, RopeContactModel
from .coupling import CouplingModel
from .crossings import CrossingModel
from .drags import DragModel
from .elimination import Elimination
from .ices import IceModel
from .joints import JointModel
from .loads import AnyLoadModel, DeadLoadModel, LineLoadModel, LoadModel
from .point_forces import PointForceModel
from .rope_model import RopeModel
from .rope_wheels import DrumModel, SheaveModel
from .ropes import SpanModel
from .signals import Signals
from .span_coordinates import AlongSpan, SpanCoordinates
from .unknowns import Node
from .working_curves import WorkingCurveModel


def orders_of(vectors: Sequence[str]) -> np.ndarray:
    """Return (vectors,): the orders of the derivatives by the arc-length that nodal vectors are."""
    return np.array([name.count("x") for name in vectors])


def per_grown(vectors: Sequence[str], growth: np.ndarray) -> np.ndarray:
    """Return (..., 2 vectors, 1): factors of the vectors of elements, and of the forces on them, that grow by factors
    (...): derivatives by the grown arc-length, see engine/bodies/growth.c.
    """
    return np.asarray(growth[..., None, None] ** -np.tile(orders_of(vectors), 2)[:, None].astype(float))


K = TypeVar("K", bound=CouplingModel)


class Kernel(Protocol):
    """A generated function, with the shapes of its arguments by name."""

    shapes: dict[str, tuple[int, ...]]

    def __call__(self, *arguments: Any) -> Any:
        """Return the outputs for one set of arguments."""

    def rows(self, n: int, *arguments: Any) -> Any:
        """Return the outputs for n sets of arguments: of each, n along the first axis, or one for all."""


class CablePiece(NamedTuple):
    """Elements of a cable, up to that of the number `end`, with one Kelvin-Voigt retardation time tau in s and one
    mass_damping in 1/s.

    doubled: nodes before them that the cable has twice; growth: dof of the growth factor of their stress-free length,
    -1 for none.
    """

    end: int
    tau: float
    mass_damping: float
    doubled: int = 0
    growth: int = -1


@dataclass(eq=False, repr=False)
class CableModel:
    """One cable: constants of its elements and the position of its coordinates.

    pieces: in their order. m: (1 or elements, nodal vectors, nodal vectors) of an element; A: (1 or elements,
    constants). share: (vectors,) `Hull.share`, None where no coupling needs it. growth: dof of the growth factor of the
    stress-free length of the first piece, -1 for none. Where a signal prescribes it (engine/bodies/growth.c),
    growth_constants: A with negative bending stiffness, of laws of cables, and growth_series: (1 or elements, numbers)
    `constants.series`, of others. gives_way: whether it resists hardly in compression.
    """

    name: str
    element: str
    law: str
    mesh: Mesh
    first: int
    pieces: tuple[CablePiece, ...]
    m: np.ndarray
    A: np.ndarray
    shape: tuple[int, int, int]
    vectors: tuple[str, ...]
    library: str | None
    share: np.ndarray | None = None
    growth: int = -1
    growth_constants: np.ndarray | None = None
    growth_series: np.ndarray | None = None
    gives_way: bool = False

    @property
    def n_elements(self) -> int:
        """Return the number of its elements."""
        return self.mesh.n_elements

    @property
    def ends_of_elements(self) -> list[int] | None:
        """Return (elements + 1): the number of a node at each end of the elements; None of all nodes."""
        return self.mesh.nodes_of_boundaries.tolist() if self.mesh.doubled else None

    @property
    def tau(self) -> float:
        """Return the largest Kelvin-Voigt retardation time of its pieces, s."""
        return max(piece.tau for piece in self.pieces)

    @property
    def mass_damping(self) -> float:
        """Return the largest mass-proportional damping of its pieces, 1/s."""
        return max(piece.mass_damping for piece in self.pieces)

    def of_elements(self, of_piece: Callable[[CablePiece], float]) -> np.ndarray:
        """Return (elements,): a number of the piece of each element."""
        ends = [0, *(piece.end for piece in self.pieces)]
        return np.repeat([of_piece(piece) for piece in self.pieces], np.diff(ends))

    @property
    def coordinates(self) -> slice:
        """Return the range of its coordinates in q, v and the dofs."""
        return slice(self.first, self.first + math.prod(self.shape))

    def dofs_of(self, element: int) -> slice:
        """Return the range of the coordinates of an element in q, v and the dofs."""
        size = math.prod(self.shape[1:])
        first = self.first + int(self.mesh.first_node(element)) * size
        return slice(first, first + 2 * size)

    @property
    def orders(self) -> np.ndarray:
        """Return (vectors,): orders of the derivatives by the arc-length that its nodal vectors are."""
        return orders_of(self.vectors)

    def growth_in(self, q: np.ndarray) -> np.ndarray:
        """Return the growth factor of its elements in configurations q (..., n): (..., elements)."""
        if self.growth < 0:
            return np.ones((*q.shape[:-1], self.n_elements))
        return q[..., self.of_elements(lambda piece: piece.growth)]

    def constants_with(self, growth: np.ndarray, element: int) -> np.ndarray:
        """Return the constants of an element with growth factors (T,): (constants,), or (T, constants) where they
        depend on it.
        """
        if self.growth_series is None:
            return np.asarray(self.A[element % len(self.A)])
        middle, scale, _, *series = self.growth_series[element % len(self.growth_series)]
        terms = np.reshape(series, (-1, self.A.shape[1]))
        return np.asarray(np.polynomial.chebyshev.chebval((growth - middle) * scale, terms).T)

    def strained(self, q: np.ndarray) -> np.ndarray:
        """Return `nodal` over the growth factor: the stretch of the centreline is the length of its slope."""
        vectors = self.nodal(q)
        return vectors if self.growth < 0 else vectors / self.growth_in(q)[..., self.mesh.element_of_node, None, None]

    def nodal(self, q: np.ndarray) -> np.ndarray:
        """Return its part of coordinates, rates or numbers of dofs (..., n) as (..., nodes, vectors, dim)."""
        return q[..., self.coordinates].reshape(*q.shape[:-1], *self.shape)

    def positions(self, q: np.ndarray) -> np.ndarray:
        """Return the positions of its nodes, (..., nodes, dim), in coordinates (..., n)."""
        return self.nodal(q)[..., self.vectors.index("r"), :]

    def kernel(self, name: str) -> Kernel:
        """Return a kernel of its element."""
        return cast(Kernel, getattr(kernels_of(self.library), f"{self.element}_{name}"))

    def law_kernel(self, name: str) -> Kernel:
        """Return a kernel of its law, the one that the engine uses."""
        kind = of_library(self.library)[self.element]
        return cast(Kernel, getattr(kernels_of(self.library), kind.law_kernel(self.element, self.law, name)))


@dataclass(eq=False, repr=False)
class ShapeModel:
    """Modes of a body: S (n + 1, dim), X (n + 1, n + 1, dim, dim), gravity (dim,)."""

    S: np.ndarray
    X: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    gravity: np.ndarray
    fields: Shape


@dataclass(eq=False, repr=False)
class BodyModel:
    """One body: kernels of its frame, inertia, position of its coordinates; `shape`: of a modal one.

    The engine's frame of a rigid body is at the mass centre, at `centre` in the axes and from the origin of the user.
    turns_alone: whether no equation couples its rotations with other unknowns.
    """

    name: str
    kernel: str
    mass: float
    inertia: np.ndarray
    centre: np.ndarray
    configuration: int
    dof: int
    shape: ShapeModel | None = None
    turns_alone: bool = False

    @property
    def modes(self) -> int:
        """Return the number of its modes, 0 of a rigid body."""
        return 0 if self.shape is None else len(self.shape.stiffness)

    @property
    def modal_kernel(self) -> str:
        """Return the name of the kernels of its modes."""
        return self.kernel.replace("rigid", "modal")


@dataclass(eq=False, repr=False)
class SlideModel(AlongSpan, CouplingModel):
    """One slide on a cable, or on a span of a rope; its first unknown is s.

    line: the cable or rope; cable: its number, -1 of a rope, with the coordinates of the span, and in words
    what the rope meets at both ends of it. rider_is_rigid: the kernels take the configuration of the rider; resistance:
    kernels of friction and buffers, or none; s (m), element, director: at the start.
    """

    reports_cost: ClassVar[bool] = True
    ties_adjacent: ClassVar[bool] = False
    kernel: str
    line: Part
    cable: int
    rider: AttachmentModel
    rider_is_rigid: bool
    s: float
    element: int
    director: np.ndarray
    resistance: str
    coordinates: SpanCoordinates | None = None
    beside: tuple[str, str] = ("", "")

    @property
    def kernel_families(self) -> list[str]:
        """Return the names of its kernels, of those of its resistance, and of those of its span."""
        return [*super().kernel_families, *([self.resistance] if self.resistance else [])]

    @property
    def ends(self) -> Sequence[AttachmentModel]:
        """Return the rider, its one end."""
        return (self.rider,)

    @property
    def along(self) -> Sequence[int]:
        """Return the number of its cable."""
        return () if self.cable < 0 else (self.cable,)

    def reached(self, end: int) -> str:
        """Return in words that it has come to the first end of its span, 0, or to the last one, 1."""
        return f'slide "{self.name}" on {self.line.where} reaches {self.beside[end]}'

    def ends_at(self, model: Model, q: np.ndarray) -> tuple[float, float]:
        """Return s in m at both ends of its cable, or of its span in a configuration q (n,)."""
        if self.coordinates is None:
            return 0.0, model.cables[self.cable].mesh.total
        first, last = self.coordinates.s
        return float(q[first]), float(q[last])

    def place_at(self, s: float, model: Model) -> None:
        """Move the slide to arc-length s (m) of its cable or rope; at a node it stays on its element."""
        if self.coordinates is not None:
            self.s, self.element = s, self.coordinates.element_of(model.q, s, self.element)
            return
        cable = model.cables[self.cable]
        mesh, self.s = cable.mesh, s
        if mesh.is_even:
            at = s / mesh.mean
            if not self.element <= at <= self.element + 1:
                self.element = min(max(int(at), 0), cable.n_elements - 1)
        elif not mesh.start(self.element) <= s <= mesh.start(self.element) + mesh.length(self.element):
            self.element = int(mesh.element_at(s))


@dataclass
class MotionModel:
    """A dof that follows a signal: base + linear f + cosine cos f + sine sin f."""

    dof: int
    signal: int
    base: float
    linear: float
    cosine: float
    sine: float


def _couplings_of(kind: type[K]) -> cached_property[list[K]]:
    """Return a property of a model: its couplings of a class, in their order."""
    return cached_property(lambda model: cast(Model, model).of(kind))


@dataclass(eq=False, repr=False)
class Model:
    """Arrays that the engine reads, explained in engine/bodies/model.h.

    couplings: in the order of the engine's sums, that of `kinds.COUPLINGS`. tables: addresses of kernels of libraries.
    newton, accelerations: eliminations of the borders of Newton's systems and of those of eq 38. plane_axes: the
    rotation of results into the ground's axes, None for a model in these axes. driven: the dofs of `DrivenDofs`.
    """

    dim: int
    cables: list[CableModel]
    ropes: list[RopeModel]
    bodies: list[BodyModel]
    couplings: list[CouplingModel]
    signals: Signals
    motions: list[MotionModel]
    q: np.ndarray
    v: np.ndarray
    weight: np.ndarray
    gravity: np.ndarray
    unknown_of_dof: np.ndarray
    combinations: Combinations
    n_band: int
    n_border_dof: int
    n_extra: int
    n_multipliers: int
    width: int
    chains: np.ndarray
    nodes: dict[str, list[Node]]
    tables: list[int] = field(default_factory=list)
    plane_axes: PlaneAxes | None = None
    driven: range = range(0)
    newton: Elimination = field(init=False)
    accelerations: Elimination = field(init=False)

    slides = _couplings_of(SlideModel)
    joints = _couplings_of(JointModel)  # first those between a rider's axes and its cable
    point_forces = _couplings_of(PointForceModel)
    drags = _couplings_of(DragModel)
    ices = _couplings_of(IceModel)
    branches = _couplings_of(BranchModel)
    working_curves = _couplings_of(WorkingCurveModel)
    crossings = _couplings_of(CrossingModel)
    spans = _couplings_of(SpanModel)
    sheaves = _couplings_of(SheaveModel)
    drums = _couplings_of(DrumModel)
    contacts = _couplings_of(ContactModel)
    rope_contacts = _couplings_of(RopeContactModel)
    hard_contacts = _couplings_of(HardContactModel)

    def of(self, *kinds: type[K]) -> list[K]:
        """Return the couplings of these classes, in their order."""
        return [cast(K, coupling) for coupling in self.couplings if type(coupling) in kinds]

    @cached_property
    def loads(self) -> list[AnyLoadModel]:
        """Return the loads among the couplings."""
        return self.of(DeadLoadModel, LoadModel, LineLoadModel)

    def place_slides(self, s: np.ndarray) -> None:
        """Put the slides at arc-lengths (slides,) in m."""
        for slide, at in zip(self.slides, s, strict=True):
            slide.place_at(float(at), self)

    def prescribed_at(self, t: float) -> dict[int, float]:
        """Return the prescribed values at the time t in s, by dof."""
        found: dict[int, float] = {}
        for m in self.motions:
            f = self.signals[m.signal].at(t)
            value = m.base + m.linear * f + m.cosine * np.cos(f) + m.sine * np.sin(f)
            found[m.dof] = found.get(m.dof, 0.0) + value
        return found

    def driven_in(self, time: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Return (T, driven): the driven quantities, or their rates, at times (T,) in s."""
        found = np.zeros((len(time), len(self.driven))) + (self.q[self.driven] if derivative == 0 else 0.0)
        for m in self.motions:
            if m.dof in self.driven:
                values = m.linear * self.signals[m.signal].value(time, derivative)
                found[:, m.dof - self.driven.start] = values + (m.base if derivative == 0 else 0.0)
        return found

    def results(self, part: str, found: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Return results of a part, by quantity, along the ground's axes."""
        axes = self.plane_axes
        return found if axes is None else {name: axes.out(part, name, values) for name, values in found.items()}

    def as_in_model(self, name: str, values: np.ndarray) -> np.ndarray:
        """Return a result by its name along the axes of the model, the inverse of `results`."""
        axes = self.plane_axes
        part, _, quantity = name.rpartition(".")
        return values if axes is None else axes.into(part, quantity, values)

    @property
    def is_damped(self) -> bool:
        """Return whether any force depends on velocities at rest."""
        return (any(cable.tau or cable.mass_damping for cable in self.cables) or any(body.modes for body in self.bodies)
                or any(coupling.is_damped for coupling in self.couplings))

    @property
    def n_q(self) -> int:
        """Return the length of the configuration."""
        return len(self.q)

    @property
    def n_dof(self) -> int:
        """Return the length of the velocities."""
        return len(self.v)

    @property
    def kernels(self) -> list[str]:
        """Return the names of the kernel families that the scene uses."""
        return sorted({c.element for c in self.cables} | {f"{c.element}_{c.law}" for c in self.cables}
                      | {name for coupling in self.couplings for name in coupling.kernel_families}
                      | {body.kernel for body in self.bodies}
                      | {body.modal_kernel for body in self.bodies if body.modes})
