"""Initial rates of ropes whose rates are not given: a rope follows the bodies and cables that hold its ends, sheaves
and drums.

Its spans stay straight between their tangent points, it stays evenly stretched, and its stress-free length is kept. In
space its rates are differences of the route drawn a moment later and before. In the plane, with u and n along a span
and to the left of it, of length l between centres c_1 and c_2 and radii R_1 and R_2 with the senses of travel as signs,

    l w = (c_2' - c_1').n,   l' = (c_2' - c_1').u + w (R_2 - R_1),

where w is the rate of its direction. Its tangent points move by c' + w R u, and a wrap grows by R times the difference
of w of the spans beside it. A drum at the first end takes up sigma R (w - psi') = lambda u' (derive/couplings/drum.py),
at the last end the opposite.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..base.deferred import dataclass
from ..base.rotations import rotate
from ..errors import SceneError
from ..parts.rope_drawing import drawn_anew
from ..parts.rope_items import SIDES
from ..parts.rope_route import DrawnRoute
from ..parts.rope_route_space import groove_of
from .attachments import AttachmentModel
from .model import Model
from .rope_model import DrumCoordinates, RopeModel, rope_model
from .rope_states import moved, wrap_angle
from .rope_wheels import DrumModel, SheaveModel
from .ropes import AnchorModel
from .span_coordinates import SpanCoordinates
from .states import attachment_axes, attachment_points, body_state, spatial

RATE_STEP = 1e-5
"""Time by which a moving route in space is differenced, s."""


def follow(model: Model, rope: RopeModel) -> None:
    """Set the rates of a rope in a model, in its state, to those that follow from the velocities of bodies.

    Sheaves and drums turn relative to the body that they are on only where this is prescribed. A closed rope does not
    run around: the mean rate of its arc-lengths is zero. A rope of given lengths of spans does not slide on its
    sheaves; in space it must be at rest. Raises SceneError.
    """
    _set_turns(model, rope)
    if not rope.part.mass:
        return
    (_follow_in_plane if rope.part.dim == 2 else _follow_in_space)(model, rope)
    model.v[rope.held] = 0.0
    turning = np.array([turn - rope.first for _, turn in rope.turns if turn >= 0], dtype=int)
    if rope.part.dim == 3 and rope.route.free is not None and np.any(np.delete(model.v[rope.coordinates], turning)):
        raise SceneError(rope.part.where, "is in space and has lengths of spans, and what holds it moves as drawn: the "
                         "rates with which it starts are not known", "let it start at rest, or give "
                         f'"{rope.part.name}.coordinate_rates" in the state to start from')


def _follow_in_space(model: Model, rope: RopeModel) -> None:
    """Set the rates of a rope in space but those of rotations, by central differences."""
    steps = RATE_STEP * np.array([-1.0, 1.0])[:, None] * model.v
    held = [attachment if attachment is not None else AttachmentModel(node=node)
            for _, attachment, node in _items(model, rope)]
    beside = moved(model, model.q, steps)
    places = [attachment_points(model, each, beside) for each in held]
    grooves = {wheel.name: attachment_axes(model, wheel.attachments[0], beside)[..., :2]
               for wheel, _, _ in _items(model, rope) if wheel is not None and wheel.tilts}
    try:
        routes = [drawn_anew(rope.part, rope.route, centres, {name: both[k] for name, both in grooves.items()})
                  for k, centres in enumerate(np.stack(places, axis=1))]
    except ValueError as error:
        raise SceneError(rope.part.where, f"the rates with which it starts are not known: {error.args[0]}",
                         f'give "{rope.part.name}.coordinate_rates" in the state to start from') from None
    wound = _wound_in_space(model, rope, routes, [places[0], places[-1]], grooves)
    before, after = (_wound_along(rope, route, {end: sign * length for end, length in wound.items()})
                     for sign, route in zip((-1, 1), routes, strict=True))
    rates = (after - before) / (2 * RATE_STEP)
    turning = np.isin(np.arange(len(rates)), [turn - rope.first for _, turn in rope.turns])
    model.v[rope.coordinates] = np.where(turning, model.v[rope.coordinates], rates)


def _wound_in_space(model: Model, rope: RopeModel, routes: list[DrawnRoute], centres: list[np.ndarray],
                    grooves: dict[str, np.ndarray]) -> dict[int, float]:
    """Return the stress-free lengths in m that drums, by their ends, wind over `RATE_STEP`.

    routes: that time before the start and after; centres (2, 3) of the items at both ends, grooves (2, 3, 2), then.
    """
    found = {}
    for at in rope.drums:
        drum = rope.part.drums[at.end]
        planes = grooves.get(drum.name, np.broadcast_to(groove_of(drum.axis), (2, 3, 2)))
        feet = [route.spans[0].start if at.end == 0 else route.spans[-1].end for route in routes]
        angles = [np.arctan2(*((foot - centre) @ plane)[::-1])
                  for foot, centre, plane in zip(feet, centres[at.end], planes, strict=True)]
        angle = (angles[1] - angles[0] + np.pi) % (2 * np.pi) - np.pi
        turned = 2 * RATE_STEP * model.v[at.turn] if at.turn >= 0 else 0.0
        sense = SIDES[drum.side] * (1 if at.end == 0 else -1)
        found[at.end] = sense * drum.radius * (angle - turned) / (2 * rope.route.stretch_of(at.end))
    return found


def _wound_along(rope: RopeModel, route: DrawnRoute, wound: dict[int, float]) -> np.ndarray:
    """Return the coordinates of a rope along a route after its drums have wound these lengths, m, by their ends."""
    free = rope.route.free_length - sum(wound.values())
    found = rope_model(rope.part, replace(route, stretch=route.length / free), rope.first)
    ends = [*(np.array(span.s) for span in found.spans), *(sheave.s for sheave in found.sheaves)]
    found.q[np.unique(np.concatenate(ends).astype(int)) - rope.first] += wound.get(0, 0.0)
    return found.q


def _follow_in_plane(model: Model, rope: RopeModel) -> None:
    """Set the rates of a planar rope but those of rotations."""
    q = model.q
    holders = _joined(q, rope, list(_holders(model, rope)))
    spans = [_SpanRates.of(q, span, holders[k], holders[(k + 1) % len(holders)]) for k, span in enumerate(rope.spans)]
    (_slide_evenly if rope.route.free is None else _roll)(model, rope, holders, spans)


def _roll(model: Model, rope: RopeModel, holders: list[_Holder], spans: list[_SpanRates]) -> None:
    """Set the rates of the spans and zones of a planar rope that does not slide on its sheaves and drums.

    The stretch at a point of a wrap is that of the side from which the material comes (derive/couplings/
    sheave_friction.py).
    """
    q, v, n = model.q, model.v, len(holders)
    for at, span in zip(rope.spans, spans, strict=True):
        v[list(at.s)] = [holder.radius * (span.turning - holder.spin) / _slope(q, at, end)
                         for end, holder in zip((0, -1), span.holders, strict=True)]
    sheaves = {sheave.before.first: sheave for sheave in model.sheaves}
    for k, after in rope.route.beside_sheaves:
        sheave, holder = sheaves[rope.spans[k].first], holders[(k + 1) % n]
        s = q[sheave.s] + np.r_[np.zeros(sheave.n_zones), sheave.closing]
        wrap = float(wrap_angle(model, sheave, q[None])[0])
        stretch = np.r_[_slope(q, rope.spans[k], -1), sheave.radius * wrap / sheave.n_zones / np.diff(s),
                        _slope(q, rope.spans[after], 0)]
        along = holder.radius * (np.linspace(spans[k].turning, spans[after].turning, len(s)) - holder.spin)
        v[sheave.s] = along / np.where(along < 0, stretch[:-1], stretch[1:])
    for at, span in zip(rope.spans, spans, strict=True):
        start, end = v[list(at.s)]
        span.set(q, v, at, (span.growth - span.length / span.free * (end - start)) / span.free)


def _slope(q: np.ndarray, span: SpanCoordinates, end: int) -> float:
    """Return the stretch of a span at its first end, 0, or its last one, -1."""
    return float(np.linalg.norm(q[span.node(end)][span.dim :]))


def _slide_evenly(model: Model, rope: RopeModel, holders: list[_Holder], spans: list[_SpanRates]) -> None:
    """Set the rates of the spans of a planar rope that slides on its sheaves so that it stays evenly stretched."""
    q, v = model.q, model.v
    stretch = sum(span.length for span in spans) / sum(span.free for span in spans)
    pieces: list[tuple[float, float]] = []  # growth and stress-free length of spans, and of the wraps after them
    for k, number, after in rope.route.sequence():
        pieces.append((spans[k].growth, spans[k].free))
        if number is not None:
            at = rope.sheaves[number].s
            closing = rope.route.free_length * (rope.part.closed and number == 0)
            pieces.append((holders[(k + 1) % len(holders)].radius * (spans[after].turning - spans[k].turning),
                           float(q[at[-1]] - q[at[0]]) + closing))
    growth, free = np.array(pieces).T
    wound = {drum.end: _wound(q, drum, holders[drum.end], spans[drum.end].turning) for drum in rope.drums}
    rate = (growth.sum() + stretch * sum(wound.values())) / free.sum()  # of the stretch
    for_ends = wound.get(0, 0.0) + np.cumsum(np.append(0.0, (growth - free * rate) / stretch))
    if rope.part.closed:
        for_ends -= np.sum((for_ends[1:] + for_ends[:-1]) * free) / (2 * free.sum())
    for k, span in enumerate(rope.spans):
        v[list(span.s)] = for_ends[2 * k : 2 * k + 2]
        spans[k].set(q, v, span, rate)
    for sheave in rope.sheaves:
        v[sheave.s] = np.linspace(v[sheave.s[0]], v[sheave.s[-1]], len(sheave.s))


def _set_turns(model: Model, rope: RopeModel) -> None:
    """Set the rates of rotations, zero where they are not prescribed."""
    motions = {motion.dof: motion for motion in model.motions}
    for _, turn in rope.turns:
        if turn >= 0:
            motion = motions.get(turn)
            model.v[turn] = 0.0 if motion is None else motion.linear * float(
                model.signals[motion.signal].value(np.zeros(()), 1))


@dataclass(eq=False, repr=False)
class _Holder:
    """What holds an item of a route: velocity (dim,) in m/s, angular velocity of the item in rad/s, and radii in m to
    the axis of the rope and to its tangent points where it runs on and off, with the sense of travel as sign; 0 at an
    anchor. contact: whether
    the rope is held there; centre (dim,): of a sheave or drum, m.
    """

    velocity: np.ndarray
    spin: float = 0.0
    radius: float = 0.0
    reach: tuple[float, float] = (0.0, 0.0)
    contact: bool = True
    centre: np.ndarray | None = None


def _items(model: Model, rope: RopeModel
           ) -> Iterator[tuple[SheaveModel | DrumModel | None, AttachmentModel | None, int]]:
    """Yield of the items of the route the sheave or drum, none of an anchor; what holds it, none of an anchor at the
    ground; and the node of an anchor, -1 of others.
    """
    wheels: dict[str, SheaveModel | DrumModel] = {sheave.name: sheave for sheave in model.sheaves}
    wheels |= {drum.name: drum for drum in model.drums}
    anchors = {anchor.attachments[0].node: anchor.attachments[1] for anchor in model.of(AnchorModel)}
    ends = {0: rope.spans[0].node(0).start, len(rope.part.route) - 1: rope.spans[-1].node(-1).start}
    for k, item in enumerate(rope.part.route):
        if (name := getattr(item, "name", None)) is None:
            yield None, anchors.get(ends[k]), ends[k]
        else:
            yield wheels[name], wheels[name].attachments[0], -1


def _holders(model: Model, rope: RopeModel) -> Iterator[_Holder]:
    """Yield what holds the items of the route."""
    turns = {wheel.name: turn for wheel, turn in rope.turns}
    for wheel, held, _ in _items(model, rope):
        if wheel is None or held is None:
            yield _Holder(np.zeros(model.dim) if held is None else _motion(model, held)[0])
            continue
        velocity, spin = _motion(model, held)
        turn = turns[wheel.name]
        on, off = (wheel.sense * np.broadcast_to(wheel.tangent_radius, 2)).tolist()
        yield _Holder(velocity, spin + (model.v[turn] if turn >= 0 else 0.0), wheel.sense * wheel.radius,
                      (on, off), not isinstance(wheel, SheaveModel) or wheel.has_contact(model.q),
                      attachment_points(model, held, model.q[None])[0, : model.dim])


def _joined(q: np.ndarray, rope: RopeModel, holders: list[_Holder]) -> list[_Holder]:
    """Return what holds the items, where points of a straight line stand for sheaves without contact beside it: those
    next to the centres.
    """
    found, n = list(holders), len(holders)
    held = [k for k, holder in enumerate(holders) if holder.contact]
    for i, j in pairwise([*held, held[0] + n] if rope.part.closed else held):
        if j - i == 1:
            continue
        spans = [rope.spans[k % n] for k in range(i, j)]
        places = np.array([q[span.node(0)][: span.dim] for span in spans] + [q[spans[-1].node(-1)][: rope.part.dim]])
        way, one, other = places[-1] - places[0], holders[i], holders[j % n]
        length = float(np.linalg.norm(way))
        along = way / length
        turning = float((other.velocity - one.velocity) @ _left(along)) / length
        start = one.velocity + turning * one.reach[1] * along
        for k in range(i + 1, j):
            beside = holders[k % n]
            assert beside.centre is not None, "sheaves have centres"
            to, apart = beside.centre - places[0], beside.velocity - start
            runs = float(apart @ along + turning * (to @ _left(along)))  # along the line
            found[k % n] = _Holder(start + runs * along + float(to @ along) * turning * _left(along), contact=False)
    return found


def _motion(model: Model, attachment: AttachmentModel) -> tuple[np.ndarray, float]:
    """Return the velocity (dim,) of an attachment to a body, a cable or the ground in m/s, and its angular velocity in
    rad/s.
    """
    if attachment.cable >= 0:
        return _motion_on_cable(model, attachment)
    if attachment.body < 0:
        return np.zeros(model.dim), 0.0
    body, dim = model.bodies[attachment.body], model.dim
    velocity, spin = model.v[body.dof : body.dof + dim].copy(), float(model.v[body.dof + dim])
    x, y = (attachment_points(model, attachment, model.q[None])[0, :dim]
            - model.q[body.configuration : body.configuration + dim])
    velocity += spin * np.array([-y, x])
    if attachment.modal is not None:
        rates = model.v[body.dof + dim + 1 : body.dof + dim + 1 + body.modes]
        orientation = body_state(model, body, model.q[None])["orientation"][0]
        velocity += rotate(orientation, spatial(rates @ attachment.modal[1]))[:dim]
        spin += float(np.sum(rates @ attachment.modal[2]))
    return velocity, spin


def _motion_on_cable(model: Model, attachment: AttachmentModel) -> tuple[np.ndarray, float]:
    """Return the velocity (dim,) of an attachment to a cable in m/s, and in the plane with axes the angular velocity of
    its section in rad/s.
    """
    dofs = model.cables[attachment.cable].dofs_of(attachment.element)
    vectors, rates = (each[dofs].reshape(-1, model.dim) for each in (model.q, model.v))
    velocity = attachment.N @ rates
    if model.dim == 3 or attachment.axes is None:
        return velocity, 0.0
    along, swing = attachment.S[0] @ vectors, attachment.S[0] @ rates
    return velocity, float(_left(along) @ swing) / float(along @ along)


@dataclass(eq=False, repr=False)
class _SpanRates:
    """A span: what holds its ends, length and stress-free length in m, and the rates of its length and direction."""

    holders: tuple[_Holder, _Holder]
    length: float
    free: float
    growth: float
    turning: float

    @classmethod
    def of(cls, q: np.ndarray, span: SpanCoordinates, one: _Holder, other: _Holder) -> _SpanRates:
        """Return the rates of a span in a configuration."""
        along = (q[span.node(-1)] - q[span.node(0)])[: span.dim]
        length = float(np.linalg.norm(along))
        along = along / length
        apart = other.velocity - one.velocity
        turning = float(apart @ _left(along)) / length
        return cls((one, other), length, float(q[span.s[1]] - q[span.s[0]]),
                   float(apart @ along) + turning * (other.reach[0] - one.reach[1]), turning)

    def set(self, q: np.ndarray, v: np.ndarray, span: SpanCoordinates, stretching: float) -> None:
        """Set the rates of its nodes; stretching: the rate of its stretch."""
        slopes = q[span.nodes].reshape(-1, 2, span.dim)[:, 1]
        along = slopes / np.linalg.norm(slopes, axis=1, keepdims=True)
        ends = [holder.velocity + self.turning * holder.reach[1 + k] * along[k]
                for k, holder in zip((0, -1), self.holders, strict=True)]
        share = span.share[:, None]
        places, turned = (1 - share) * ends[0] + share * ends[1], stretching * along + self.turning * _left(slopes)
        v[span.nodes] = np.stack([places, turned], axis=1).ravel()


def _wound(q: np.ndarray, drum: DrumCoordinates, holder: _Holder, turning: float) -> float:
    """Return the stress-free length a second that a drum winds; turning: the rate of the direction of its span."""
    way = holder.radius * (turning - holder.spin) * (1 if drum.end == 0 else -1)
    return way / float(np.linalg.norm(q[drum.node][drum.span.dim :]))


def _left(vectors: np.ndarray) -> np.ndarray:
    """Return vectors (..., 2) turned to the left by 90 degrees."""
    return np.stack([-vectors[..., 1], vectors[..., 0]], axis=-1)
