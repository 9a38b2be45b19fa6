"""Models of ropes: their coordinates, spans, sheaves, and ends on bodies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..parts.rope import Rope
from ..parts.rope_items import RouteItem, Sheave
from ..parts.rope_route import MIN_SPAN_RATIO, MIN_WRAP, DrawnRoute
from ..parts.scene_data import SceneData
from ..parts.section_stiffness import section_stiffness
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel
from .signals import Signals

LAW = "engineering_exact_assumed"
"""The law of the kernels of spans (derive/couplings/span.py)."""
PER_NODE = 2
"""Vectors of a node: its place, and its slope by the stress-free arc-length."""


@dataclass
class SpanCoordinates:
    """The dofs of a span: first of its nodes, shares of these in its length, and the two material coordinates."""

    first: int
    share: np.ndarray
    s: tuple[int, int]
    dim: int

    @property
    def n_elements(self) -> int:
        """Return the number of its elements."""
        return len(self.share) - 1

    def node(self, k: int) -> slice:
        """Return the dofs of node k, from the end where k is negative."""
        size = PER_NODE * self.dim
        first = self.first + size * (k % len(self.share))
        return slice(first, first + size)

    def places(self, q: np.ndarray) -> np.ndarray:
        """Return (nodes, dim): the places of its nodes in a configuration, m."""
        found: np.ndarray = q[self.nodes].reshape(len(self.share), PER_NODE, self.dim)[:, 0]
        return found

    @property
    def nodes(self) -> slice:
        """Return the dofs of all nodes."""
        return slice(self.first, self.first + PER_NODE * self.dim * len(self.share))


@dataclass
class SheaveCoordinates:
    """The dofs of a sheave: material coordinates of the ends of its zones; its rotation, -1 for none."""

    s: np.ndarray
    turn: int


@dataclass
class RopeModel:
    """The coordinates of a rope, with their values as drawn.

    part, route: as drawn; spans, sheaves: in its order; q (n,), weight (n,): of its coordinates from `first` on; fixed:
    those of ends at the ground.
    """

    part: Rope
    route: DrawnRoute
    first: int
    spans: list[SpanCoordinates]
    sheaves: list[SheaveCoordinates]
    q: np.ndarray
    weight: np.ndarray
    fixed: np.ndarray

    @property
    def coordinates(self) -> slice:
        """Return the range of its coordinates."""
        return slice(self.first, self.first + len(self.q))

    @property
    def lengths(self) -> np.ndarray:
        """Return its dofs that are lengths: places of nodes, and material coordinates."""
        places = [np.r_[node.start : node.start + span.dim] for span in self.spans
                  for node in map(span.node, range(span.n_elements + 1))]
        return np.concatenate([*places, *(span.s for span in self.spans), *(sheave.s for sheave in self.sheaves)]
                              ).astype(int)

    @property
    def rho(self) -> float:
        """Return its mass per stress-free length, kg/m."""
        return float(self.part.material.density * self.part.section.mass_moments()[0])

    @property
    def stiffness(self) -> np.ndarray:
        """Return EA in N, EI in N m², and EA of the upper modes of the assumed strain."""
        return section_stiffness(LAW, self.part.section, self.part.material, self.part.dim)


def rope_models(scene: SceneData, at: int) -> list[RopeModel]:
    """Return the ropes in the scene's order, with coordinates from `at` on."""
    made = []
    for rope in scene.ropes.values():
        made.append(_rope(rope, rope.drawn(scene.bodies), at))
        at = made[-1].coordinates.stop
    return made


def _rope(rope: Rope, route: DrawnRoute, first: int) -> RopeModel:
    dim, s, at = rope.dim, 0.0, first
    spans: list[SpanCoordinates] = []
    values: list[np.ndarray] = []
    weight: list[np.ndarray] = []
    of_s: list[float] = []
    of_sheaves: list[np.ndarray] = []
    weight_of_sheaves: list[np.ndarray] = []
    offset = len(route.sheaves) - len(route.spans) + 1  # 1 where the first sheave is before the first span
    for k, (span, n) in enumerate(zip(route.spans, rope.elements_of_spans, strict=True)):
        share = np.linspace(0.0, 1.0, n + 1)
        nodes = np.empty((n + 1, PER_NODE, dim))
        nodes[:, 0] = span.start + share[:, None] * (span.end - span.start)
        nodes[:, 1] = route.stretch * span.direction
        spans.append(SpanCoordinates(at, share, (0, 0), dim))
        values.append(nodes.ravel())
        weight.append(np.tile(np.repeat([1.0, span.length / n], dim), n + 1))
        at += nodes.size
        of_s += [s, s + span.length / route.stretch]
        s = of_s[-1] + (route.sheaves[k + offset].length / route.stretch if k + offset < len(route.sheaves) else 0.0)
    for k, made in enumerate(spans):
        made.s = (at + 2 * k, at + 2 * k + 1)
    at += len(of_s)
    sheaves: list[SheaveCoordinates] = []
    for k, item in enumerate(rope.sheaves):
        before, after = spans[k - offset], spans[k - offset + 1]
        inner = at + np.arange(item.n_zones - 1)
        ends = np.array([of_s[before.s[1] - spans[0].s[0]], of_s[after.s[0] - spans[0].s[0]]])
        ends[1] += route.free_length * (rope.closed and k == 0)
        sheaves.append(SheaveCoordinates(np.r_[before.s[1], inner, after.s[0]], at + len(inner) if item.turns_round
                                         else -1))
        at += len(inner) + item.turns_round
        values_of_sheave = np.r_[np.linspace(ends[0], ends[1], item.n_zones + 1)[1:-1], np.zeros(int(item.turns_round))]
        of_sheaves.append(values_of_sheave)
        weight_of_sheaves.append(np.r_[np.ones(len(inner)), np.full(int(item.turns_round), item.radius)])
    q = np.concatenate([*values, of_s, *of_sheaves])
    fixed = np.zeros(len(q), dtype=bool)
    if not rope.closed:
        fixed[[spans[0].s[0] - first, spans[-1].s[1] - first]] = True
    for item, sheave in zip(rope.sheaves, sheaves, strict=True):
        if item.prescribed is not None:
            fixed[sheave.turn - first] = True
    for made, node, anchor in _ends(rope, spans):
        if anchor.end.on is None:
            place = made.node(node).start - first
            fixed[place : place + dim] = True
    return RopeModel(rope, route, first, spans, sheaves, q,
                     np.concatenate([*weight, np.ones(len(of_s)), *weight_of_sheaves]), fixed)


def _ends(rope: Rope, spans: list[SpanCoordinates]) -> list[tuple[SpanCoordinates, int, RouteItem]]:
    """Return the spans at the ends of a rope, the numbers of the nodes there, and the anchors."""
    return [] if rope.closed else [(spans[0], 0, rope.route[0]), (spans[-1], -1, rope.route[-1])]


def turn_motions(ropes: list[RopeModel], signals: Signals) -> list[tuple[int, int]]:
    """Return the dof and the signal of sheaves whose rotation is prescribed."""
    return [(sheave.turn, signals.add(item.prescribed)) for rope in ropes
            for item, sheave in zip(rope.part.sheaves, rope.sheaves, strict=True) if item.prescribed is not None]


@dataclass(kw_only=True)
class SpanModel(CouplingModel):
    """A span between two tangent points or ends: fu_span_coupling of the engine."""

    kernel: str
    coordinates: SpanCoordinates
    rho: float
    tau: float
    g: np.ndarray
    A: np.ndarray
    least_length: float

    @property
    def n_elements(self) -> int:
        """Return the number of its elements."""
        return self.coordinates.n_elements

    @property
    def first(self) -> int:
        """Return the first dof of its nodes."""
        return self.coordinates.first

    @property
    def s(self) -> tuple[int, int]:
        """Return the dofs of the material coordinates of its ends."""
        return self.coordinates.s

    @property
    def share(self) -> np.ndarray:
        """Return the shares of its nodes in its length."""
        return self.coordinates.share

    @property
    def adjacent(self) -> list[np.ndarray]:
        """Return the dofs of each element."""
        at = self.coordinates
        return [np.r_[at.node(k), at.node(k + 1), at.s] for k in range(at.n_elements)]


@dataclass(kw_only=True)
class SheaveModel(CouplingModel):
    """A sheave between two spans: fu_sheave of the engine."""

    kernel: str
    attachments: tuple[AttachmentModel]
    before: SpanCoordinates
    after: SpanCoordinates
    coordinates: SheaveCoordinates
    radius: float
    tangent_radius: tuple[float, float]
    sense: float
    rho: float
    tau: float
    g: np.ndarray
    A: np.ndarray
    inertia: float
    friction: float
    slip_velocity: float
    closing: float
    damping: float
    torque_signal: int
    torque: float
    least_wrap: float = MIN_WRAP

    @property
    def nodes(self) -> tuple[int, int]:
        """Return the first dofs of the nodes at its tangent points."""
        return self.before.node(-1).start, self.after.node(0).start

    @property
    def s(self) -> np.ndarray:
        """Return the dofs of the material coordinates of the ends of its zones."""
        return self.coordinates.s

    @property
    def n_zones(self) -> int:
        """Return the number of its zones."""
        return len(self.coordinates.s) - 1

    @property
    def turn(self) -> int:
        """Return the dof of its rotation, -1 for none."""
        return self.coordinates.turn

    @property
    def adjacent(self) -> list[np.ndarray]:
        """Return its dofs, beside those of its centre."""
        turn = [] if self.turn < 0 else [self.turn]
        return [np.r_[self.before.node(-1), self.after.node(0), self.s, turn].astype(int)]


def span_models(builder: ModelBuilder) -> Iterator[SpanModel]:
    """Yield the spans of all ropes."""
    gravity = np.array(builder.scene.gravity)
    for rope in builder.ropes:
        radii = [sheave.radius for sheave in rope.part.sheaves]
        radii = [*radii, radii[0]] if rope.part.closed else [0.0, *radii, 0.0]
        for k, span in enumerate(rope.spans):
            least = max(MIN_SPAN_RATIO * max(radii[k : k + 2]), rope.part.radius)
            yield SpanModel(type="span", name=rope.part.name, kernel=f"span_{rope.part.element}", coordinates=span,
                            rho=rope.rho, tau=rope.part.material.damping_time, g=gravity, A=rope.stiffness,
                            least_length=least, has_inertia=True, is_damped=rope.part.material.damping_time > 0)


def sheave_models(builder: ModelBuilder) -> Iterator[SheaveModel]:
    """Yield the sheaves of all ropes."""
    gravity = np.array(builder.scene.gravity)
    for rope in builder.ropes:
        sheaves = [item for item in rope.part.route if isinstance(item, Sheave)]
        for k, (item, arc) in enumerate(zip(sheaves, rope.route.sheaves, strict=True)):
            one, other = (k - 1, k) if rope.part.closed else (k, k + 1)
            before, after = rope.spans[one], rope.spans[other]
            scale = [rope.rho * rope.route.spans[each].length / rope.part.elements_of_spans[each]
                     for each in (one, other) for _ in range(2)]
            centre = builder.attachment(item.end)
            number, factor = (-1, 0.0) if item.torque is None else builder.signals.scale(item.torque)
            yield SheaveModel(type="sheave", name=item.name, kernel="planar_sheave", attachments=(centre,),
                              before=before, after=after, coordinates=rope.sheaves[k], radius=arc.radius,
                              tangent_radius=(arc.tangent_radius,) * 2,
                              sense=float(arc.sense), rho=rope.rho, tau=rope.part.material.damping_time, g=gravity,
                              A=rope.stiffness[:2], scale=scale,
                              n_multipliers=len(scale), has_inertia=True, inertia=item.inertia,
                              friction=item.coefficient, slip_velocity=item.slip_velocity,
                              closing=rope.route.free_length * (rope.part.closed and k == 0), damping=item.damping,
                              torque_signal=number, torque=factor,
                              is_damped=rope.part.material.damping_time > 0 or item.coefficient > 0 or item.damping > 0)


@dataclass(kw_only=True)
class AnchorModel(CouplingModel):
    """An end of a rope on a body: a spherical joint, fu_joint of the engine."""

    kernel: str
    attachments: tuple[AttachmentModel, AttachmentModel]
    base: float = 0.0
    of_points: bool = True


def anchor_models(builder: ModelBuilder) -> Iterator[AnchorModel]:
    """Yield the ends of ropes on bodies; those at the ground are fixed dofs."""
    for rope in builder.ropes:
        for span, node, item in _ends(rope.part, rope.spans):
            if item.end.on is None:
                continue
            body = builder.attachment(item.end)
            yield AnchorModel(type="anchor", name=rope.part.name, kernel="joint_planar_spherical",
                              attachments=(AttachmentModel(node=span.node(node).start), body),
                              scale=[body.mass] * rope.part.dim, n_multipliers=rope.part.dim)


KINDS = (CouplingKind("anchor", Rope.group, anchor_models), CouplingKind("span", Rope.group, span_models),
         CouplingKind("sheave", Rope.group, sheave_models))
