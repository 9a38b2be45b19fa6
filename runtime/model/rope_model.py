"""Models of ropes: their coordinates, with their values as drawn."""

from __future__ import annotations

import numpy as np

from ..base.deferred import dataclass
from ..parts.rope import Rope
from ..parts.rope_items import Anchor, Drum, RouteItem, Sheave
from ..parts.rope_route import DrawnRoute
from ..parts.scene_data import SceneData
from ..parts.section_stiffness import section_stiffness
from .signals import Signals
from .span_coordinates import PER_NODE, SpanCoordinates

LAW = "engineering_exact_assumed"
"""The law of the kernels of spans (derive/couplings/span.py)."""


class Turning:
    """What has a rotation, the dof ``turn``, -1 for none."""

    turn: int

    @property
    def turns(self) -> list[int]:
        """Return the dof of the rotation in a list, which is empty without one."""
        return [] if self.turn < 0 else [self.turn]


@dataclass(eq=False, repr=False)
class SheaveCoordinates(Turning):
    """The dofs of a sheave: material coordinates of the ends of its zones; its rotation, -1 for none."""

    s: np.ndarray
    turn: int


@dataclass(eq=False, repr=False)
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


@dataclass(eq=False, repr=False)
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
        return float(self.part.warm_material.density * self.part.section.mass_moments()[0])

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
        made.append(rope_model(rope, scene.route_of(rope), at))
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
        nodes[:, 1] = route.stretch_of(len(spans)) * span.direction
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
        values_of_sheave = np.r_[route.free_zones(k, float(ends[0]), float(ends[1]), item.n_zones)[1:-1],
                                 np.zeros(int(item.turns_round))]
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
