"""Models of sheaves and drums, and of the points of wraps to which ropes stick."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import field
from typing import Any

import numpy as np

from ..base.deferred import dataclass
from ..checks.rope_carriers import carried_groove, may_turn
from ..parts.rope_items import SIDES, Drum, Sheave
from ..parts.rope_route import MIN_WRAP
from ..parts.rope_route_space import groove_of
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingModel
from .rope_model import DrumCoordinates, RopeModel, SheaveCoordinates
from .span_coordinates import SpanCoordinates

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


@dataclass(eq=False, repr=False, kw_only=True)
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


@dataclass(eq=False, repr=False, kw_only=True)
class SheaveModel(WheelModel):
    """A sheave between two spans: fu_sheave of the engine.

    mouth: half the width of the groove, m; kink: largest angle along the axis with which a rope leaves it, rad.
    """

    before: SpanCoordinates
    after: SpanCoordinates
    coordinates: SheaveCoordinates
    tangent_radius: tuple[float, float]
    tau: float
    friction: float
    slip_velocity: float
    closing: float
    mouth: float
    kink: float
    span_reach: tuple[int, int]
    sticks: bool = False
    points: list[WrapPointModel] = field(default_factory=list)

    @property
    def wrap_points(self) -> int:
        """Return the number of the first of its points where friction sticks, -1 where it is regularised."""
        return self.points[0].number if self.sticks else -1

    @property
    def least_wrap(self) -> float:
        """Return the least angle of a wrap that stretches, rad: of zones together."""
        return MIN_WRAP * self.n_zones

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


@dataclass(eq=False, repr=False, kw_only=True)
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
            scale += scale[:1] * (CONDITIONS_BESIDE + item.n_zones - 1)
            sheave = SheaveModel(
                type="sheave", name=item.name, kernel="planar_sheave", before=before, after=after,
                coordinates=rope.sheaves[k], radius=arc.radius, tangent_radius=arc.tangent_radius,
                sense=float(arc.sense), tau=rope.part.material.damping_time, scale=scale, n_multipliers=len(scale),
                **_wheel_of(builder, rope, item, arc.groove), has_inertia=True, friction=item.coefficient,
                span_reach=(_reach(rope, beside[0], arc.radius), _reach(rope, beside[1], arc.radius)),
                closing=rope.route.free_length * (rope.part.closed and k == 0), slip_velocity=item.slip_velocity,
                mouth=item.mouth, kink=item.max_fleet_angle,
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
    carried = carried_groove(builder.scene, item.end, groove) if tilts else None
    plane = groove if carried is None else carried.axes[:, :2]
    axes, up = carried or (np.eye(3) if dim == 2 else None, None)  # a cable turns
    return {"attachments": (builder.attachment(item.end, axes, up),), "plane": plane, "tilts": tilts,
            "g": gravity if tilts else _in_groove(plane, gravity), "rho": rope.rho, "A": rope.stiffness[:2],
            "weight": weight[: 3 * (dim == 3)],
            "limit": float(np.linalg.norm(weight)) / MAX_SAG + NO_TENSION * rope.stiffness[0],
            **_motion_of(builder, item)}


def _in_groove(plane: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Return a vector in the plane of a groove, and along its axis; in the plane itself."""
    return vector if len(plane) == 2 else np.array([*(vector @ plane), vector @ np.cross(*plane.T)])


def _reach(rope: RopeModel, k: int, radius: float) -> int:
    """Return the number of elements of a span in which a chord may end: twice those of its length as drawn, and
    `LEAST_REACH` of a span that becomes short.
    """
    n, span = rope.spans[k].n_elements, rope.route.spans[k]
    return min(n, max(LEAST_REACH, int(np.ceil(2 * radius * rope.route.stretch_of(k) * n / span.length))))


CELLS = 256
"""Parts of a rope over each of which what is wound on a drum has one stretch."""


@dataclass(eq=False, repr=False, kw_only=True)
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
                            tangent_radius=rope.route.reach[at.end], stretch=rope.route.stretch_of(at.end),
                            sense=float(SIDES[item.side]), ends_run_by=item.at_end,
                            **_wheel_of(builder, rope, item, groove_of(item.axis) if dim == 3 else np.eye(2)),
                            span_reach=_reach(rope, number, item.radius),
                            scale=[rope.mass_of_element(at.end)] * (dim + 1), n_multipliers=dim + 1,
                            has_inertia=True, is_damped=True)
