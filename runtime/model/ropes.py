"""Models of ropes: their coordinates, spans, sheaves, drums, and ends on bodies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..checks.rope_carriers import may_turn
from ..parts.load import Force
from ..parts.locations import grips
from ..parts.rope import Rope
from ..parts.rope_items import SIDES, Anchor, Drum, RouteItem, Sheave
from ..parts.rope_route import MIN_SPAN_RATIO, MIN_WRAP, DrawnRoute
from ..parts.rope_route_space import groove_of
from ..parts.scene_data import SceneData
from ..parts.section_stiffness import section_stiffness
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel
from .signals import Signals
from .span_coordinates import PER_NODE, AlongSpan, SpanCoordinates
from .taut_ropes import taut_points, taut_ropes

LAW = "engineering_exact_assumed"
"""The law of the kernels of spans (derive/couplings/span.py)."""
JOINTS = {2: "joint_planar_spherical", 3: "joint_spherical"}
"""The kernel of an end on a body."""
MAX_SAG = 0.1
"""Limit of the sag of a chord, rad, up to which it is that of a parabola."""
LEAST_REACH = 8
"""Elements of a span in which a chord may end, at least."""
NO_WRAP = 1e-9
"""Length of the wrap of a rope that has left a sheave, over its radius, at most."""
CONDITIONS_BESIDE = 2
"""Conditions of a rope that has left a sheave beyond those of its tangent points and zones."""
NO_TENSION = 1e-12
"""Strain below which a tension is none; over 1 m."""


class Turning:
    """What has a rotation, the dof ``turn``, -1 for none."""

    turn: int

    @property
    def turns(self) -> list[int]:
        """Return the dof of the rotation in a list, which is empty without one."""
        return [] if self.turn < 0 else [self.turn]


@dataclass
class SheaveCoordinates(Turning):
    """The dofs of a sheave: material coordinates of the ends of its zones; its rotation, -1 for none."""

    s: np.ndarray
    turn: int


@dataclass
class DrumCoordinates(Turning):
    """The dofs of a drum: the end of the rope there, 0 or -1, its span, and the rotation, -1 for none."""

    end: int
    span: SpanCoordinates
    turn: int

    @property
    def node(self) -> slice:
        """Return the dofs of the node at its tangent point."""
        return self.span.node(self.end)

    @property
    def s(self) -> int:
        """Return the dof of the material coordinate there."""
        return self.span.s[self.end]


@dataclass
class RopeModel:
    """The coordinates of a rope, with their values as drawn.

    part, route: as drawn; spans, sheaves, drums: in its order; q (n,), weight (n,): of its coordinates from `first` on;
    fixed: those of ends at the ground, material coordinates at anchors, and prescribed rotations.
    """

    part: Rope
    route: DrawnRoute
    first: int
    spans: list[SpanCoordinates]
    sheaves: list[SheaveCoordinates]
    drums: list[DrumCoordinates]
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
        return np.concatenate([*places, *(span.s for span in self.spans), *(sheave.s for sheave in self.sheaves), []]
                              ).astype(int)

    @property
    def turns(self) -> list[tuple[Sheave | Drum, int]]:
        """Return its sheaves and drums with the dofs of their rotations, -1 for none."""
        sheaves: list[tuple[Sheave | Drum, int]] = [
            (item, at.turn) for item, at in zip(self.part.sheaves, self.sheaves, strict=True)]
        return sheaves + [(self.part.drums[drum.end], drum.turn) for drum in self.drums]

    @property
    def held(self) -> np.ndarray:
        """Return its dofs that stay as drawn: of anchors at the ground, and the material coordinates at anchors."""
        turning = {turn for _, turn in self.turns}
        return np.array([dof for dof in self.first + np.flatnonzero(self.fixed) if dof not in turning], dtype=int)

    @property
    def supply(self) -> int:
        """Return the dof of the stress-free length at an anchor, of both at the last one, which follows from a given
        tension; -1 of ropes with a given length, closed ones, and those between drums.
        """
        if self.part.closed or self.part.tension is None:
            return -1
        return next((self.spans[end].s[end] for end in (-1, 0) if self.spans and isinstance(self.part.route[end],
                                                                                            Anchor)), -1)

    def origin(self, q: np.ndarray) -> np.ndarray | float:
        """Return the material coordinate of the rope's first end in configurations (..., n_q): at an anchor (...)."""
        found: np.ndarray | float = q[..., self.spans[0].s[0]] if isinstance(self.part.route[0], Anchor) else 0.0
        return found

    @property
    def free_length(self) -> float:
        """Return its stress-free length with what is on drums, m."""
        return self.route.free_length + self.part.length_in_store

    @property
    def rho(self) -> float:
        """Return its mass per stress-free length, kg/m."""
        return float(self.part.material.density * self.part.section.mass_moments()[0])

    def mass_of_element(self, span: int) -> float:
        """Return the mass of an element of a span by its length as drawn, kg."""
        return self.rho * self.route.spans[span].length / self.part.elements_of_spans[span]

    @property
    def stiffness(self) -> np.ndarray:
        """Return EA in N, EI in N m², and EA of the upper modes of the assumed strain."""
        return section_stiffness(LAW, self.part.section, self.part.material, self.part.dim)


def rope_models(scene: SceneData, at: int, supplied: bool = False) -> list[RopeModel]:
    """Return the ropes in the scene's order, with coordinates from `at` on; supplied: their `supply` is free."""
    made = []
    for rope in scene.ropes.values():
        made.append(rope_model(rope, rope.drawn(scene.holders), at))
        if supplied and made[-1].supply >= 0:
            made[-1].fixed[made[-1].supply - at] = False
        at = made[-1].coordinates.stop
    return made


def rope_model(rope: Rope, route: DrawnRoute, first: int) -> RopeModel:
    """Return a rope along a drawn route, with coordinates from `first` on."""
    if not rope.mass:
        return _without_mass(rope, route, first)
    dim, at = rope.dim, first
    of_s = [s for ends in route.arc_lengths(rope.first_arc_length) for s in ends]
    spans: list[SpanCoordinates] = []
    values: list[np.ndarray] = []
    weight: list[np.ndarray] = []
    of_sheaves: list[np.ndarray] = []
    weight_of_sheaves: list[np.ndarray] = []
    for span, n in zip(route.spans, rope.elements_of_spans, strict=True):
        share = np.linspace(0.0, 1.0, n + 1)
        nodes = np.empty((n + 1, PER_NODE, dim))
        nodes[:, 0] = span.start + share[:, None] * (span.end - span.start)
        nodes[:, 1] = route.stretch * span.direction
        spans.append(SpanCoordinates(at, share, (0, 0), dim))
        values.append(nodes.ravel())
        weight.append(np.tile(np.repeat([1.0, span.length / n], dim), n + 1))
        at += nodes.size
    for k, each in enumerate(spans):
        each.s = (at + 2 * k, at + 2 * k + 1)
    at += len(of_s)
    sheaves: list[SheaveCoordinates] = []
    for k, (item, beside) in enumerate(zip(rope.sheaves, route.beside_sheaves, strict=True)):
        before, after = (spans[each] for each in beside)
        inner = at + np.arange(item.n_zones - 1)
        ends = np.array([of_s[before.s[1] - spans[0].s[0]], of_s[after.s[0] - spans[0].s[0]]])
        ends[1] += route.free_length * (rope.closed and k == 0)
        sheaves.append(SheaveCoordinates(np.r_[before.s[1], inner, after.s[0]], at + len(inner) if item.turns_round
                                         else -1))
        at += len(inner) + item.turns_round
        values_of_sheave = np.r_[np.linspace(ends[0], ends[1], item.n_zones + 1)[1:-1], np.zeros(int(item.turns_round))]
        of_sheaves.append(values_of_sheave)
        weight_of_sheaves.append(np.r_[np.ones(len(inner)), np.full(int(item.turns_round), item.radius)])
    drums: list[DrumCoordinates] = []
    for end, drum in rope.drums.items():
        drums.append(DrumCoordinates(end, spans[end], at if drum.turns_round else -1))
        at += drum.turns_round
        of_sheaves.append(np.zeros(int(drum.turns_round)))
        weight_of_sheaves.append(np.full(int(drum.turns_round), drum.radius))
    q = np.concatenate([*values, of_s, *of_sheaves])
    made = RopeModel(rope, route, first, spans, sheaves, drums, q,
                     np.concatenate([*weight, np.ones(len(of_s)), *weight_of_sheaves]), np.zeros(len(q), dtype=bool))
    for wheel, turn in made.turns:
        if wheel.prescribed is not None:
            made.fixed[turn - first] = True
    for of_end, end, anchor in anchored_ends(made):
        made.fixed[of_end.s[end] - first] = True
        if anchor.end.on is None:
            place = of_end.node(end).start - first
            made.fixed[place : place + dim] = True
    return made


def _without_mass(rope: Rope, route: DrawnRoute, first: int) -> RopeModel:
    """Return a rope without mass, whose coordinates are the rotations of its wheels alone."""
    nowhere, turning = SpanCoordinates(first, np.zeros(1), (first, first), rope.dim), [w for w in rope.wheels
                                                                                        if w.turns_round]
    turns = {wheel.name: first + k for k, wheel in enumerate(turning)}
    sheaves = [SheaveCoordinates(np.zeros(0, dtype=int), turns.get(sheave.name, -1)) for sheave in rope.sheaves]
    drums = [DrumCoordinates(end, nowhere, turns.get(drum.name, -1)) for end, drum in rope.drums.items()]
    return RopeModel(rope, route, first, [], sheaves, drums, np.zeros(len(turning)),
                     np.array([wheel.radius for wheel in turning]),
                     np.array([wheel.prescribed is not None for wheel in turning], dtype=bool))


def anchored_ends(rope: RopeModel) -> list[tuple[SpanCoordinates, int, RouteItem]]:
    """Return the spans at the anchors of a rope, 0 for its first end or -1 for its last, and the anchors."""
    return [(rope.spans[end], end, rope.part.route[end]) for end in (0, -1)
            if isinstance(rope.part.route[end], Anchor) and rope.spans]


def turn_motions(ropes: list[RopeModel], signals: Signals) -> list[tuple[int, int]]:
    """Return the dof and the signal of sheaves and drums whose rotation is prescribed."""
    return [(turn, signals.add(wheel.prescribed)) for rope in ropes for wheel, turn in rope.turns
            if wheel.prescribed is not None]


@dataclass(kw_only=True)
class SpanModel(AlongSpan, CouplingModel):
    """A span between two tangent points or ends: fu_span_coupling of the engine.

    held: material coordinates in m to which parts hold or on which they act, increasing, with the words of messages for
    that; beside: what the rope meets at both ends of the span.
    """

    coordinates: SpanCoordinates
    rho: float
    tau: float
    g: np.ndarray
    A: np.ndarray
    least_length: float
    held: list[tuple[float, str]] = field(default_factory=list)
    beside: tuple[str, str] = ("", "")

    @property
    def is_gripped(self) -> int:
        """Return whether anything holds to material points of it."""
        return int(bool(self.held))

    @property
    def grips(self) -> list[float]:
        """Return the first and the last material coordinate of these, m."""
        return [self.held[0][0], self.held[-1][0]] if self.held else []

    def reached(self, end: int) -> str:
        """Return in words that what holds to it has come to its first end, 0, or to its last one, 1."""
        s, part = self.held[-end]
        return f'{part} rope "{self.name}" at s = {s:.9g} m, which reaches {self.beside[end]}'

    def end_of_grips(self, q: np.ndarray) -> int | None:
        """Return the end, 0 or 1, that a material point to which a part holds has passed in a configuration q (n,)."""
        passed = [self.is_gripped and (2 * end - 1) * (self.grips[end] - q[self.span_s[end]]) > 0 for end in range(2)]
        return passed.index(True) if any(passed) else None


@dataclass(kw_only=True)
class WheelModel(CouplingModel):
    """What sheaves and drums share: fu_wheel of the engine.

    plane: (dim, 2), unit vectors of the plane of the groove; tilts: whether it turns with the body, in whose axes they
    are then, and g along the ground's. weight: half that of a length of the rope, N/m, by which chords sag; limit:
    tension over the length of a chord below which the sag has its limit, N/m.
    """

    kernel: str
    attachments: tuple[AttachmentModel]
    radius: float
    sense: float
    rho: float
    g: np.ndarray
    A: np.ndarray
    inertia: float
    damping: float
    torque_signal: int
    torque: float
    plane: np.ndarray
    tilts: bool
    weight: np.ndarray
    limit: float

    @property
    def kernel_families(self) -> list[str]:
        """Return the names of the kernel families that it uses."""
        return [self.kernel, *([self.foot] if self.foot else [])]

    @property
    def foot(self) -> str:
        """Return the kernel of its tangent points in space, none in the plane."""
        return "tangent_point" if len(self.plane) == 3 else ""

    @property
    def groove(self) -> list[float]:
        """Return the plane of the groove, in space."""
        return np.ravel(self.plane).tolist() if self.foot else []

    @property
    def axis(self) -> list[float]:
        """Return its axis in space."""
        return np.cross(*self.plane.T).tolist() if self.foot else []


@dataclass(kw_only=True)
class SheaveModel(WheelModel):
    """A sheave between two spans: fu_sheave of the engine."""

    before: SpanCoordinates
    after: SpanCoordinates
    coordinates: SheaveCoordinates
    tangent_radius: tuple[float, float]
    tau: float
    friction: float
    slip_velocity: float
    closing: float
    span_reach: tuple[int, int]
    sticks: bool = False
    points: list[WrapPointModel] = field(default_factory=list)

    @property
    def wrap_points(self) -> int:
        """Return the number of the first of its points where friction sticks, -1 where it is regularised."""
        return self.points[0].number if self.sticks else -1

    @property
    def least_wrap(self) -> float:
        """Return the least angle of a wrap that stretches, rad: with zones they have this angle each, as far as the
        rope may leave the sheave.
        """
        return MIN_WRAP * (self.n_zones if self.n_multipliers > 2 * self.before.dim else 1)

    @property
    def no_length(self) -> float:
        """Return the length of its wrap up to which the rope has left it, m."""
        return NO_WRAP * self.radius

    def has_contact(self, q: np.ndarray) -> bool:
        """Return whether the rope lies on it in a configuration of the model."""
        return abs(float(q[self.s[-1]] - q[self.s[0]]) + self.closing) > self.no_length

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
        found = [np.r_[self.before.node(-1), self.after.node(0), self.s, self.coordinates.turns].astype(int)]
        if self.foot:
            (one, other), n = self.span_reach, self.before.n_elements
            found += [np.r_[self.before.node(k), self.before.s] for k in range(n - one, n)]
            found += [np.r_[self.after.node(k), self.after.s] for k in range(1, other + 1)]
        return found

    # --- in space -------------------------------------------------------------------------------------------------

    @property
    def chord(self) -> tuple[float, float]:
        """Return the stress-free length of the chords at both tangent points, m."""
        return self.radius, self.radius

    @property
    def span_first(self) -> tuple[int, int]:
        """Return the first dofs of both spans."""
        return self.before.first, self.after.first

    @property
    def span_elements(self) -> tuple[int, int]:
        """Return the number of elements of both spans."""
        return self.before.n_elements, self.after.n_elements

    @property
    def span_s(self) -> list[int]:
        """Return the dofs of the material coordinates of the ends of both spans."""
        return [*self.before.s, *self.after.s]

    @property
    def share_before(self) -> np.ndarray:
        """Return the shares of the nodes of the span before it."""
        return self.before.share

    @property
    def share_after(self) -> np.ndarray:
        """Return the shares of the nodes of the span after it."""
        return self.after.share


@dataclass(kw_only=True)
class WrapPointModel(CouplingModel):
    """An end of a zone of a sheave where friction sticks: fu_wrap_point of the engine; place: in the wrap."""

    of: SheaveModel
    place: int

    @property
    def sheave(self) -> int:
        """Return the number of its sheave among all couplings."""
        return self.of.number

    @property
    def ends(self) -> Sequence[AttachmentModel]:
        """Return the centre of its sheave."""
        return self.of.attachments

    @property
    def adjacent(self) -> list[np.ndarray]:
        """Return the dofs of its sheave."""
        return self.of.adjacent


def span_models(builder: ModelBuilder) -> Iterator[SpanModel]:
    """Yield the spans of all ropes."""
    gravity = np.array(builder.scene.gravity)
    for rope in builder.ropes:
        held, labels = grips_of(builder.scene, rope), [_called(item) for item in rope.part.route]
        radii = [getattr(item, "radius", 0.0) for item in rope.part.route]
        radii += radii[: rope.part.closed]
        labels += labels[: rope.part.closed]
        for k, span in enumerate(rope.spans):
            least = max(MIN_SPAN_RATIO * max(radii[k : k + 2]), rope.part.radius)
            yield SpanModel(type="span", name=rope.part.name, coordinates=span,
                            rho=rope.rho, tau=rope.part.material.damping_time, g=gravity, A=rope.stiffness,
                            least_length=least, has_inertia=True, is_damped=rope.part.material.damping_time > 0,
                            held=held[k], beside=(labels[k], labels[k + 1]))


def grips_of(scene: SceneData, rope: RopeModel) -> list[list[tuple[float, str]]]:
    """Return for each span of a rope the arc-lengths at which parts of the scene hold it or act on it, m, and the words
    of messages for that.
    """
    found: list[list[tuple[float, str]]] = [[] for _ in rope.spans]
    for part, _, end in grips(scene):
        if end.on == rope.part.name:
            acts = "acts on" if isinstance(part, Force) else "holds"
            found[rope.part.span_at(rope.route, end.arc_length)].append((end.arc_length, f"{part.where} {acts}"))
    return [sorted(each) for each in found]


def _called(item: RouteItem) -> str:
    """Return an item of a route as messages name it."""
    return "an anchor" if isinstance(item, Anchor) else item.where


def sheave_models(builder: ModelBuilder) -> list[SheaveModel]:
    """Return the sheaves of all ropes, made once."""
    return builder.once("sheaves", lambda builder: list(_sheaves(builder)))


def wrap_points(builder: ModelBuilder) -> Iterator[WrapPointModel]:
    """Yield the points of all sheaves where friction sticks, in their order."""
    for sheave in sheave_models(builder):
        yield from sheave.points


def _sheaves(builder: ModelBuilder) -> Iterator[SheaveModel]:
    for rope in builder.ropes:
        if not rope.part.mass:
            continue
        of_sheaves = zip(rope.part.sheaves, rope.route.sheaves, rope.route.beside_sheaves, strict=True)
        for k, (item, arc, beside) in enumerate(of_sheaves):
            before, after = (rope.spans[each] for each in beside)
            scale = [rope.mass_of_element(each) for each in beside for _ in range(rope.part.dim)]
            if rope.part.may_leave(item):
                scale += scale[:1] * (CONDITIONS_BESIDE + item.n_zones - 1)
            sheave = SheaveModel(
                type="sheave", name=item.name, kernel="planar_sheave", before=before, after=after,
                coordinates=rope.sheaves[k], radius=arc.radius, tangent_radius=(arc.tangent_radius,) * 2,
                sense=float(arc.sense), tau=rope.part.material.damping_time, scale=scale, n_multipliers=len(scale),
                **_wheel_of(builder, rope, item, arc.groove), has_inertia=True, friction=item.coefficient,
                span_reach=(_reach(rope, beside[0], arc.radius), _reach(rope, beside[1], arc.radius)),
                slip_velocity=item.slip_velocity, closing=rope.route.free_length * (rope.part.closed and k == 0),
                is_damped=rope.part.material.damping_time > 0 or item.coefficient > 0 or item.damping > 0,
                sticks=item.sticks)
            sheave.points = [WrapPointModel(type="wrap_point", name=item.name, of=sheave, place=place, scale=scale[:1],
                                            n_multipliers=1, is_damped=True)
                             for place in range(item.sticks * (item.n_zones + 1))]
            yield sheave


def _motion_of(builder: ModelBuilder, wheel: Sheave | Drum) -> dict[str, Any]:
    """Return the entries of a sheave or a drum about its axis: inertia, bearing, and the torque of its drive."""
    number, factor = (-1, 0.0) if wheel.torque is None else builder.signals.scale(wheel.torque)
    return {"inertia": wheel.inertia, "damping": wheel.damping, "torque_signal": number, "torque": factor}


def _wheel_of(builder: ModelBuilder, rope: RopeModel, item: Sheave | Drum, groove: np.ndarray) -> dict[str, Any]:
    """Return the entries of a wheel of a rope with mass, of a plane of the groove as drawn: what holds it, gravity and
    the rope, and those of `_motion_of`.
    """
    gravity, dim = np.array(builder.scene.gravity), rope.part.dim
    tilts, weight = dim == 3 and may_turn(builder.scene, item.end.on), rope.rho * gravity / 2
    plane = _on_body(builder.scene, item.end.on, groove) if tilts else groove
    axes = _axes_of(plane) if tilts else np.eye(3) if dim == 2 else None  # a cable turns
    return {"attachments": (builder.attachment(item.end, axes),), "plane": plane, "tilts": tilts,
            "g": gravity if tilts else _in_groove(plane, gravity), "rho": rope.rho, "A": rope.stiffness[:2],
            "weight": weight[: 3 * (dim == 3)],
            "limit": float(np.linalg.norm(weight)) / MAX_SAG + NO_TENSION * rope.stiffness[0],
            **_motion_of(builder, item)}


def _axes_of(plane: np.ndarray) -> np.ndarray:
    """Return (3, 3): the vectors of the plane of a groove, and its axis, as columns."""
    return np.column_stack([plane, np.cross(*plane.T)])


def _on_body(scene: SceneData, body: str | None, plane: np.ndarray) -> np.ndarray:
    """Return the plane of a groove as drawn in the axes of the body that carries it."""
    return plane if body is None else scene.bodies[body].axes.T @ plane


def _in_groove(plane: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Return a vector in the plane of a groove, and along its axis; in the plane itself."""
    return vector if len(plane) == 2 else np.array([*(vector @ plane), vector @ np.cross(*plane.T)])


def _reach(rope: RopeModel, k: int, radius: float) -> int:
    """Return the number of elements of a span in which a chord may end: twice those of its length as drawn, and
    `LEAST_REACH` of a span that becomes short.
    """
    n, span = rope.spans[k].n_elements, rope.route.spans[k]
    return min(n, max(LEAST_REACH, int(np.ceil(2 * radius * rope.route.stretch * n / span.length))))


CELLS = 256
"""Parts of a rope over each of which what is wound on a drum has one stretch."""


@dataclass(kw_only=True)
class DrumModel(WheelModel):
    """A drum at an end of a rope: fu_drum of the engine.

    ends_run_by: "error" or "stop", where it has run empty; "leave" where the end of the rope is free then.
    """

    coordinates: DrumCoordinates
    cell: float
    direction: float
    end: float
    tangent_radius: float
    stretch: float
    ends_run_by: str
    span_reach: int
    n_cells: int = CELLS
    n_numbers: int = CELLS + 1

    @property
    def leaves(self) -> int:
        """Return whether the rope leaves it where it has run empty."""
        return int(self.ends_run_by == "leave")

    @property
    def node(self) -> int:
        """Return the first dof of the node at its tangent point."""
        first: int = self.coordinates.node.start
        return first

    @property
    def s(self) -> int:
        """Return the dof of the material coordinate there."""
        return self.coordinates.s

    @property
    def turn(self) -> int:
        """Return the dof of its rotation, -1 for none."""
        return self.coordinates.turn

    @property
    def adjacent(self) -> list[np.ndarray]:
        """Return its dofs, beside those of its centre."""
        found = [np.r_[self.coordinates.node, self.s, self.coordinates.turns].astype(int)]
        if self.foot:
            span, reach = self.coordinates.span, self.span_reach
            near = range(1, reach + 1) if self.direction > 0 else range(span.n_elements - reach, span.n_elements)
            found += [np.r_[span.node(k), span.s] for k in near]
        return found

    @property
    def chord(self) -> float:
        """Return the stress-free length of the chord at the tangent point, m."""
        return self.radius

    @property
    def span_first(self) -> int:
        """Return the first dof of its span."""
        return self.coordinates.span.first

    @property
    def span_elements(self) -> int:
        """Return the number of elements of its span."""
        return self.coordinates.span.n_elements

    @property
    def span_s(self) -> tuple[int, int]:
        """Return the dofs of the material coordinates of the ends of its span."""
        return self.coordinates.span.s

    @property
    def share(self) -> np.ndarray:
        """Return the shares of the nodes of its span."""
        return self.coordinates.span.share


def drum_models(builder: ModelBuilder) -> Iterator[DrumModel]:
    """Yield the drums of all ropes."""
    for rope in builder.ropes:
        for at in rope.drums if rope.part.mass else ():
            item, dim = rope.part.drums[at.end], rope.part.dim
            direction = 1.0 if at.end == 0 else -1.0
            number = at.end if at.end == 0 else len(rope.spans) - 1
            yield DrumModel(type="drum", name=item.name, kernel="planar_sheave", coordinates=at,
                            cell=rope.free_length / CELLS, direction=direction,
                            end=0.0 if at.end == 0 else rope.free_length, radius=item.radius,
                            tangent_radius=rope.route.reach[at.end], stretch=rope.route.stretch,
                            sense=float(SIDES[item.side]), ends_run_by=item.at_end,
                            **_wheel_of(builder, rope, item, groove_of(item.axis) if dim == 3 else np.eye(2)),
                            span_reach=_reach(rope, number, item.radius),
                            scale=[rope.mass_of_element(at.end)] * (dim + 1), n_multipliers=dim + 1,
                            has_inertia=True, is_damped=True)


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
        for span, node, item in anchored_ends(rope):
            if item.end.on is None:
                continue
            body = builder.attachment(item.end)
            yield AnchorModel(type="anchor", name=rope.part.name, kernel=JOINTS[rope.part.dim],
                              attachments=(AttachmentModel(node=span.node(node).start), body),
                              scale=[body.mass] * rope.part.dim, n_multipliers=rope.part.dim)


KINDS = (CouplingKind("anchor", Rope.group, anchor_models), CouplingKind("span", Rope.group, span_models),
         CouplingKind("sheave", Rope.group, sheave_models),
         CouplingKind("wrap_point", Rope.group, wrap_points), CouplingKind("drum", Rope.group, drum_models),
         CouplingKind("taut_point", Rope.group, taut_points), CouplingKind("taut_rope", Rope.group, taut_ropes))
