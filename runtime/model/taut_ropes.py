"""Models of ropes without mass: their points, and the ropes of one tension between those that hold them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import field
from itertools import pairwise
from math import atan2, pi
from typing import Protocol

import numpy as np

from ..base.deferred import dataclass
from ..checks.rope_carriers import carried_groove
from ..parts.rope import Rope
from ..parts.rope_items import SIDES, Drum, RouteItem, Sheave
from ..parts.rope_route import MIN_SPAN_RATIO, DrawnRoute
from ..parts.rope_route_space import groove_of
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingModel

KERNEL = "planar_taut_rope"
KERNELS_OF_PARTS = {2: "", 3: "taut_part"}
"""Kernels of the law of a rope, and of straight parts in space."""
KERNEL_OF_WHEELS = KERNELS_OF_PARTS[3]
"""Kernels with that of wheels that spin, in the plane, too."""


class TurningRope(Protocol):
    """What these models need of the coordinates of a rope, see `RopeModel`."""

    part: Rope
    route: DrawnRoute

    @property
    def turns(self) -> list[tuple[Sheave | Drum, int]]:
        """Return its wheels with the dofs of their rotations, -1 for none."""
        ...


@dataclass(eq=False, repr=False, kw_only=True)
class TautPointModel(CouplingModel):
    """A point of a rope without mass, an item of its route: fu_taut_point of the engine.

    angle, carrier: in the plane the angle of the straight part after it and that of what carries it as drawn; in space
    those of the parts after and before it in its groove, rad. before, after: the ropes of one tension on both sides,
    with its place in them; ends_run_by: of a drum. mouth, kink: of a sheave, see `SheaveModel`.
    """

    wheel: str = KERNEL_OF_WHEELS
    attachments: tuple[AttachmentModel]
    turn: int = -1
    radius: float = 0.0
    inertia: float = 0.0
    damping: float = 0.0
    torque_signal: int = -1
    torque: float = 0.0
    friction: float = 0.0
    store: float = 0.0
    angle: float = 0.0
    carrier: float = 0.0
    closing: float = 0.0
    mouth: float = 0.0
    kink: float = 0.0
    touches: int = 1
    in_space: bool = False
    is_end: bool = False
    ends_run_by: str = "error"
    before: tuple[TautRopeModel, int] | None = None
    after: tuple[TautRopeModel, int] | None = None

    @property
    def kernel_families(self) -> list[str]:
        """Return the names of the kernel families that it uses."""
        return [self.wheel]

    @property
    def holds(self) -> bool:
        """Return whether it is an end of ropes of one tension."""
        return self.is_end or self.friction > 0

    @property
    def ropes(self) -> list[int]:
        """Return the numbers of the ropes before and after it, -1 for none."""
        return [-1 if side is None else side[0].number for side in (self.before, self.after)]

    @property
    def places(self) -> list[int]:
        """Return its places in these ropes."""
        return [-1 if side is None else side[1] for side in (self.before, self.after)]

    @property
    def adjacent(self) -> list[np.ndarray]:
        """Return the dof of its rotation, in an array that is empty without one."""
        return [] if self.turn < 0 else [np.array([self.turn])]


@dataclass(eq=False, repr=False, kw_only=True)
class TautRopeModel(CouplingModel):
    """A rope of one tension between points that hold it: fu_taut_rope of the engine.

    pieces: those of the whole rope, it among them: where the rope slips, its tension depends on their places.
    """

    kernel: str = KERNEL
    part: str = ""
    of: list[TautPointModel]
    EA: float
    tau: float
    drawn_length: float
    free_length: float
    angles: tuple[float, float]
    held: float
    least_length: float
    pieces: list[TautRopeModel] = field(default_factory=list, repr=False, compare=False)

    @property
    def kernel_families(self) -> list[str]:
        """Return the names of the kernel families that it uses."""
        return [self.kernel, *([self.part] if self.part else [])]

    @property
    def n_pieces(self) -> int:
        """Return the number of ropes of one tension that the whole rope has."""
        return len(self.pieces)

    @property
    def points(self) -> np.ndarray:
        """Return the numbers of its points among all couplings."""
        return np.array([point.number for point in self.of])

    @property
    def n_points(self) -> int:
        """Return the number of its points."""
        return len(self.of)

    @property
    def carriers(self) -> tuple[float, float]:
        """Return the angles as drawn of what carries its first and its last point, rad: none in space, where angles are
        those in the grooves.
        """
        return (0.0, 0.0) if self.part else (self.of[0].carrier, self.of[-1].carrier)

    @property
    def ends(self) -> list[AttachmentModel]:
        """Return the attachments of the points of the whole rope."""
        return [point.attachments[0] for point in self._points_of_all()]

    @property
    def adjacent(self) -> list[np.ndarray]:
        """Return the dofs of the rotations of wheels that hold the whole rope."""
        turns = [point.turn for point in self._points_of_all() if point.turn >= 0]
        return [np.unique(turns)] if turns else []

    def _points_of_all(self) -> list[TautPointModel]:
        return list({id(point): point for piece in self.pieces for point in piece.of}.values())

    def ties_ends(self, dim: int) -> bool:
        """Return whether its tangent has entries between the attachments: those of straight parts."""
        return True


def taut_points(builder: ModelBuilder) -> Iterator[TautPointModel]:
    """Yield the points of all ropes without mass, in their order."""
    for rope in builder.ropes:
        if not rope.part.mass:
            yield from points_of(builder, rope)


def taut_ropes(builder: ModelBuilder) -> Iterator[TautRopeModel]:
    """Yield the ropes of one tension of all ropes without mass, in their order."""
    for rope in builder.ropes:
        if not rope.part.mass:
            yield from _pieces(rope, points_of(builder, rope))


def points_of(builder: ModelBuilder, rope: TurningRope) -> list[TautPointModel]:
    """Return the points of a rope, made once."""
    return builder.once(("taut points", rope.part.name), lambda builder: _points(builder, rope))


def _points(builder: ModelBuilder, rope: TurningRope) -> list[TautPointModel]:
    part, arcs = rope.part, iter(rope.route.sheaves)
    turns = {wheel.name: turn for wheel, turn in rope.turns}
    found = []
    for item in part.route:
        in_space = part.dim == 3
        made = TautPointModel(type="taut_point", name=getattr(item, "name", part.name), in_space=in_space,
                              attachments=(_attachment(builder, item, part.dim),),
                              carrier=0.0 if in_space else _carrier(builder, item))
        if isinstance(item, Sheave):
            arc = next(arcs)
            made.radius, made.friction, made.touches = arc.sense * arc.radius, item.coefficient, int(arc.wrap > 0)
            made.mouth, made.kink = item.mouth, item.max_fleet_angle
        else:
            made.is_end = True
        if isinstance(item, Drum):
            made.radius, made.store, made.ends_run_by = (SIDES[item.side] * item.radius, item.length_in_store,
                                                         item.at_end)
        if isinstance(item, Sheave | Drum):
            made.turn, made.inertia, made.damping = turns[item.name], item.inertia, item.damping
            made.has_inertia, made.is_damped = item.inertia > 0, item.damping > 0
            if item.torque is not None:
                made.torque_signal, made.torque = builder.signals.scale(item.torque)
        found.append(made)
    if part.dim == 3:
        _set_angles_in_space(rope, found)
    else:
        _set_angles(rope.route, found, part.closed)
    return found


def _attachment(builder: ModelBuilder, item: RouteItem, dim: int) -> AttachmentModel:
    """Return what holds a point; in space its axes are the plane of the groove and the axis of a wheel."""
    if dim == 2:
        return builder.attachment(item.end, np.eye(3))
    if not isinstance(item, Sheave | Drum):
        return builder.attachment(item.end)
    return builder.attachment(item.end, *carried_groove(builder.scene, item.end, groove_of(item.axis)))


def _set_angles_in_space(rope: TurningRope, points: list[TautPointModel]) -> None:
    """Set the angles of the straight parts after and before wheels as drawn, each in its groove: the angle of the foot
    and, with the sense of travel, a right angle.
    """
    arcs = iter(rope.route.sheaves)
    for k, (item, point) in enumerate(zip(rope.part.route, points, strict=True)):
        if isinstance(item, Sheave):
            arc = next(arcs)
            point.carrier, point.angle = (each + arc.sense * pi / 2 for each in (arc.angle_on, arc.angle_off))
        elif isinstance(item, Drum):
            x, y = rope.route.spans[-1 if k else 0].direction @ groove_of(item.axis)
            point.carrier = point.angle = atan2(y, x)  # a part lies across the radius at its foot


def _set_angles(route: DrawnRoute, points: list[TautPointModel], closed: bool) -> None:
    """Set the angles of the straight parts after points as drawn, counted over turns from the first part of a rope of
    one tension, and for a closed rope the angle by which they grow along it.
    """
    n = len(points)
    wraps = iter(arc.sense * arc.wrap for arc in route.sheaves)
    turns = [next(wraps) if closed or 0 < k < n - 1 else 0.0 for k in range(n)]
    first = next(k for k, point in enumerate(points) if point.holds)
    x, y = route.spans[first].direction.tolist()
    angle = atan2(y, x)
    for k in range(first, first + n):
        angle += turns[k % n] if k > first else 0.0
        points[k % n].angle = angle
    if closed:
        points[first].closing = sum(turns)


def _carrier(builder: ModelBuilder, item: RouteItem) -> float:
    """Return the angle as drawn of what carries an item, rad."""
    if item.end.on is None:
        return 0.0
    if item.end.on in builder.scene.cables:
        x, y, _ = builder.scene.cables[item.end.on].slope(item.end.arc_length)
        return atan2(y, x)
    w, _, _, z = builder.scene.bodies[item.end.on].frame[1]
    return 2 * atan2(z, w)


def _pieces(rope: TurningRope, points: list[TautPointModel]) -> Iterator[TautRopeModel]:
    """Yield the ropes of one tension between points that hold the rope, and set them at the points."""
    part, route, n = rope.part, rope.route, len(points)
    starts = [k for k, point in enumerate(points) if point.holds]
    arcs = iter(route.sheaves)
    wraps = [next(arcs).length if isinstance(item, Sheave) else 0.0 for item in part.route]
    pieces: list[TautRopeModel] = []
    for start, end in pairwise([*starts, starts[0] + n] if part.closed else starts):
        at = [k % n for k in range(start, end + 1)]
        first = points[at[0]]
        length = sum(route.spans[k].length for k in at[:-1]) + sum(wraps[k] for k in at[1:-1])
        mass = max(point.attachments[0].mass for point in points) or 1.0
        made = TautRopeModel(
            type="taut_rope", name=part.name, of=[points[k] for k in at], EA=part.stiffness[0],
            tau=part.material.damping_time, drawn_length=length, free_length=length / route.stretch,
            angles=(first.angle, points[at[-1]].carrier if part.dim == 3 else points[at[-2]].angle),
            part=KERNELS_OF_PARTS[part.dim],
            held=sum(points[k].store + wraps[k] / (2 * route.stretch) for k in (at[0], at[-1])), follows_law=True,
            least_length=max(MIN_SPAN_RATIO * max(abs(points[k].radius) for k in at), part.radius),
            is_damped=part.material.damping_time > 0, scale=[mass], pieces=pieces)
        pieces.append(made)
        for place, k in enumerate(at):
            if place:
                points[k].before = made, place
            if place < len(at) - 1:
                points[k].after = made, place
    yield from pieces


def points_of_rope(points: Iterable[TautPointModel], rope: str) -> list[TautPointModel]:
    """Return the points of a rope among those of a model, in its order."""
    return [point for point in points if rope in {side[0].name for side in (point.before, point.after) if side}]


# --- results --------------------------------------------------------------------------------------------------------

def wheel_results(outputs: dict[str, np.ndarray], point: TautPointModel) -> dict[str, np.ndarray]:
    """Return the results of a sheave or a drum from the outputs (T, ...) of its point."""
    none = np.zeros_like(outputs["angle"])
    shared = {name: outputs[name] for name in ("force", "material_speed", "normal_force", "angle")} | {"residual": none}
    if point.is_end:
        return shared | {"fleet_angle": outputs["fleet_angle_on"] + outputs["fleet_angle_off"],
                         "tension": outputs["tension_on"] + outputs["tension_off"], "torque": outputs["drive"],
                         "power": outputs["power"], "length_in_store": outputs["length_in_store"]}
    own = ("tension_on", "tension_off", "wrap_angle", "torque", "slip", "slip_angle", "fleet_angle_on",
           "fleet_angle_off")
    return shared | {name: outputs[name] for name in own}
