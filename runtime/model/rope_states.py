"""Results of ropes in states of a model."""

from __future__ import annotations

import numpy as np

from ..base.rotations import product, turned_by
from ..parts.rope import Rope
from ..parts.rope_drawing import drawn_anew
from ..parts.rope_route import DrawnArc, DrawnRoute
from .model import Model
from .rope_model import RopeModel
from .rope_wheels import DrumModel, SheaveModel
from .ropes import AnchorModel
from .span_coordinates import PER_NODE, SpanCoordinates, cubic_shapes
from .states import attachment_axes, attachment_points, spatial
from .taut_ropes import TautPointModel, points_of_rope

POINTS_OF_ELEMENT = 4
"""Points of an element beside its last one at which results have the rope's position."""
MOTION_STEP = 1e-5
"""Fraction of a motion by which it is differenced."""
WRAP_STEP = np.pi / 18
"""Largest angle between points of a wrap as drawn, rad."""
MIN_WRAP_POINTS = 19
"""Points of a wrap of a rope without mass, at least: for half a turn."""


def rope_state(model: Model, rope: RopeModel, q: np.ndarray) -> dict[str, np.ndarray]:
    """Return points along a rope in configurations (T, n_q): position (T, points, 3) in m, and their stress-free
    arc-length s (T, points) in m.
    """
    sheaves = {sheave.before.first: sheave for sheave in model.sheaves}
    places: list[np.ndarray] = []
    lengths: list[np.ndarray] = []
    for (_, number, _), span in zip(rope.route.sequence(), rope.spans, strict=True):
        position, s = _span_points(span, q)
        places.append(position)
        lengths.append(s)
        if number is not None:
            n = _wrap_count(rope.route.sheaves[number])
            on = _wrap_points(model, sheaves[span.first], q, n)
            zones = q[:, rope.sheaves[number].s]
            zones[:, -1] += sheaves[span.first].closing
            places.append(on)
            at = np.linspace(0, zones.shape[1] - 1, n)[1:-1]
            zone = at.astype(int)
            lengths.append(zones[:, zone] + (at - zone) * (zones[:, zone + 1] - zones[:, zone]))
    return {"position": spatial(np.concatenate(places, axis=1)),
            "s": np.concatenate(lengths, axis=1) - np.reshape(rope.origin(q), (-1, 1))}


def rope_motion(model: Model, rope: RopeModel, q: np.ndarray, dofs: np.ndarray) -> dict[str, np.ndarray]:
    """Return the displacement (n, points, 3) of points along a rope, and the changes (n, points) of s there, in small
    motions dofs (n, n_dof) about q: by central differences, with errors of `MOTION_STEP` squared. The
    displacement alone of a rope without mass that wheels hold: how the rope runs onto them is not a place of bodies.
    """
    if not rope.part.mass:
        return _motion_without_mass(model, rope, q, dofs)
    one, other = (rope_state(model, rope, moved(model, q, sign * MOTION_STEP * dofs)) for sign in (-1, 1))
    changes = {key: (other[key] - one[key]) / (2 * MOTION_STEP) for key in one}
    return {"displacement": changes["position"], "s": changes["s"]}


def _motion_without_mass(model: Model, rope: RopeModel, q: np.ndarray, dofs: np.ndarray) -> dict[str, np.ndarray]:
    """Return the displacement (n, points, 3) of points along a rope without mass, see `rope_motion`."""
    points = points_of_rope(model.of(TautPointModel), rope.part.name)
    counts, found = points_of_spans(rope.part, rope.route), []
    for sign in (-1, 1):
        at = moved(model, q, sign * MOTION_STEP * dofs)
        centres = np.stack([attachment_points(model, each.attachments[0], at) for each in points], axis=1)
        planes = [{point.name: plane for point, plane in zip(points, each, strict=True) if point.radius}
                  for each in zip(*(grooves(model, point, at) for point in points), strict=True)]
        found.append([as_drawn(rope.part, drawn_anew(rope.part, rope.route, *each), counts)
                      for each in zip(centres[..., : model.dim], planes, strict=True)])
    changes = {key: np.array([other[key] - one[key] for one, other in zip(*found, strict=True)]) / (2 * MOTION_STEP)
               for key in ("position", "s")}
    alone = {"displacement": changes["position"]}
    return alone if rope.part.holding_sheaves or rope.part.drums else alone | {"s": changes["s"]}


def grooves(model: Model, point: TautPointModel, q: np.ndarray) -> np.ndarray:
    """Return (T, dim, 2): the plane of the groove of a point in configurations (T, n_q); any plane of an anchor."""
    end = point.attachments[0]
    if point.in_space and point.radius and max(end.body, end.cable) >= 0:
        return attachment_axes(model, end, q)[..., :2]
    axes = np.eye(model.dim) if end.axes is None or not point.in_space else end.axes
    return np.tile(axes[:, :2], (len(q), 1, 1))


def moved(model: Model, q: np.ndarray, dofs: np.ndarray) -> np.ndarray:
    """Return the configurations (n, n_q) of flexible parts and bodies of a model moved by small dofs."""
    found = np.tile(q, (len(dofs), 1))
    n = min((body.dof for body in model.bodies), default=min(len(q), dofs.shape[1]))
    found[:, :n] += dofs[:, :n]
    for body in model.bodies:
        b, d, turn = body.configuration, body.dof, dofs[:, body.dof + model.dim]
        found[:, b : b + model.dim] += dofs[:, d : d + model.dim]
        if model.dim == 3:
            found[:, b + 3 : b + 7] = product(q[b + 3 : b + 7], turned_by(dofs[:, d + 3 : d + 6]))
            found[:, b + 7 : b + 7 + body.modes] += dofs[:, d + 6 : d + 6 + body.modes]
            continue
        found[:, b + 2] -= q[b + 3] * turn  # cosine and sine
        found[:, b + 3] += q[b + 2] * turn
        found[:, b + 4 : b + 4 + body.modes] += dofs[:, d + 3 : d + 3 + body.modes]
    return found


def _wrap_count(arc: DrawnArc, least: int = 2) -> int:
    """Return the number of points of a wrap, with both tangent points."""
    return max(least, int(np.ceil(arc.wrap / WRAP_STEP)) + 1)


def points_of_spans(rope: Rope, route: DrawnRoute) -> list[tuple[slice, tuple[int, slice] | None]]:
    """Return the points of each span among those of its rope, and of the wrap after it the number of its sheave and its
    points, with both tangent points; the last one of a closed rope is its first point again.
    """
    at, found = 0, []
    for (_, number, _), elements in zip(route.sequence(), rope.elements_of_spans, strict=True):
        span = slice(at, at + POINTS_OF_ELEMENT * elements + 1)
        at, wrap = span.stop, None
        if number is not None:
            least = 2 if rope.mass else MIN_WRAP_POINTS  # a wrap without mass may be absent as drawn
            wrap = number, slice(span.stop - 1, span.stop - 1 + _wrap_count(route.sheaves[number], least))
            at = wrap[1].stop - 1
        found.append((span, wrap))
    return found


def as_drawn(rope: Rope, route: DrawnRoute, points: list[tuple[slice, tuple[int, slice] | None]] | None = None
             ) -> dict[str, np.ndarray]:
    """Return position (points, 3) and s (points,) of `rope_state` for a rope as drawn, in m; points: by default those
    of `points_of_spans` for this route.
    """
    places, lengths, s = [], [], rope.first_arc_length
    for k, (span, wrap) in enumerate(points or points_of_spans(rope, route)):
        drawn, share = route.spans[k], np.linspace(0, 1, span.stop - span.start)
        places.append(drawn.start + share[:, None] * (drawn.end - drawn.start))
        lengths.append(s + share * route.free_span(k))
        s += route.free_span(k)
        if wrap is not None:
            arc, share = route.sheaves[wrap[0]], np.linspace(0, 1, wrap[1].stop - wrap[1].start)[1:-1]
            angle = arc.angle_on + share * (arc.angle_off - arc.angle_on)
            places.append(arc.centre + arc.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1) @ arc.groove.T)
            after = s + route.free_wrap(wrap[0])
            lengths.append(route.free_zones(wrap[0], s, after, len(share) + 1)[1:-1])
            s = after
    return {"position": spatial(np.concatenate(places)), "s": np.concatenate(lengths)}


def coordinates(rope: RopeModel, q: np.ndarray, v: np.ndarray) -> dict[str, np.ndarray]:
    """Return the coordinates of a rope and their rates, (T, n), in configurations q and rates v of a model."""
    return {"coordinates": q[:, rope.coordinates], "coordinate_rates": v[:, rope.coordinates]}


def _span_points(span: SpanCoordinates, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return position (T, points, dim) and s (T, points) of points of a span: cubics between the nodes."""
    nodal = q[:, span.nodes].reshape(len(q), span.n_elements + 1, PER_NODE, span.dim)
    ends = q[:, list(span.s)]
    s = ends[:, :1] + span.share * (ends[:, 1:] - ends[:, :1])
    x = np.arange(POINTS_OF_ELEMENT) / POINTS_OF_ELEMENT
    values, slopes = cubic_shapes(x)
    length = np.diff(s)[..., None, None]
    inside = sum(values[e][:, None] * nodal[:, e : e + span.n_elements, None, 0]
                 + length * slopes[e][:, None] * nodal[:, e : e + span.n_elements, None, 1] for e in range(2))
    at = s[:, :-1, None] + np.diff(s)[..., None] * x
    count = span.n_elements * POINTS_OF_ELEMENT
    return (np.concatenate([inside.reshape(len(q), count, span.dim), nodal[:, -1:, 0]], axis=1),
            np.concatenate([at.reshape(len(q), count), s[:, -1:]], axis=1))


def _on_groove(model: Model, sheave: SheaveModel, q: np.ndarray
               ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return of a wrap in configurations (T, n_q) the tangent points from the centre in the plane of the groove (T, 2),
    m; the mean stretch of the spans beside it (T,); and the length of its material with this (T,), m.
    """
    centre = attachment_points(model, sheave.attachments[0], q)[:, : model.dim]
    on, off = (in_groove(model, sheave, q, q[:, node : node + model.dim] - centre) for node in sheave.nodes)
    slopes = (q[:, node + model.dim : node + 2 * model.dim] for node in sheave.nodes)
    stretch = np.mean([np.linalg.norm(slope, axis=1) for slope in slopes], axis=0)
    return on, off, stretch, stretch * (q[:, sheave.s[-1]] - q[:, sheave.s[0]] + sheave.closing)


def wrap_angle(model: Model, sheave: SheaveModel, q: np.ndarray) -> np.ndarray:
    """Return the angle of a wrap in configurations (T, n_q), with whole turns (T,), rad."""
    on, off, _, length = _on_groove(model, sheave, q)
    part = sheave.sense * np.arctan2(on[:, 0] * off[:, 1] - on[:, 1] * off[:, 0], np.sum(on * off, axis=1))
    found: np.ndarray = part + 2 * np.pi * np.round((length / sheave.radius - part) / (2 * np.pi))
    return found


def _wrap_points(model: Model, sheave: SheaveModel, q: np.ndarray, n: int) -> np.ndarray:
    """Return the inner ones of n points (T, n - 2, dim) at equal angles along a wrap."""
    centre = attachment_points(model, sheave.attachments[0], q)[:, : model.dim]
    on, _, stretch, length = _on_groove(model, sheave, q)
    wrap = wrap_angle(model, sheave, q)
    angle = (np.arctan2(on[:, 1], on[:, 0])[:, None]
             + sheave.sense * wrap[:, None] * np.linspace(0.0, 1.0, n)[1:-1])
    radius = np.where(length > stretch * sheave.no_length, sheave.radius, np.linalg.norm(on, axis=1))  # or it has left
    around = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    node = q[:, sheave.nodes[0] : sheave.nodes[0] + model.dim]
    aside = node - centre - _out_of_groove(model, sheave, q, on[:, None])[:, 0]  # of a rope beside the plane
    found: np.ndarray = (centre[:, None] + radius[:, None, None] * _out_of_groove(model, sheave, q, around)
                         + aside[:, None])
    return found


def _out_of_groove(model: Model, sheave: SheaveModel, q: np.ndarray, parts: np.ndarray) -> np.ndarray:
    """Return vectors (T, n, dim) of parts (T, n, 2) in the plane of the groove in configurations (T, n_q)."""
    if not sheave.tilts:
        return np.asarray(parts @ sheave.plane.T)
    return np.asarray(np.einsum("tdk,tnk->tnd", attachment_axes(model, sheave.attachments[0], q)[..., :2], parts))


def in_groove(model: Model, wheel: SheaveModel | DrumModel, q: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Return vectors (T, dim) in the plane of the groove of a wheel in configurations (T, n_q), (T, 2)."""
    if not wheel.tilts:
        return np.asarray(vectors @ wheel.plane)
    return np.asarray(np.einsum("td,tdk->tk", vectors, attachment_axes(model, wheel.attachments[0], q)[..., :2]))


def end_forces(model: Model, rope: RopeModel, reaction: np.ndarray, of_anchors: dict[int, np.ndarray],
               anchors: list[AnchorModel]) -> dict[str, np.ndarray]:
    """Return the force of a rope on what holds its start and its end, (T, 3) in N.

    reaction (T, n_dof): on fixed dofs; of_anchors: by number among the anchors their force on the body.
    """
    found = {}
    if rope.part.closed:
        return {"start_force": np.zeros((len(reaction), 3)), "end_force": np.zeros((len(reaction), 3))}
    for name, span, node in (("start_force", rope.spans[0], 0), ("end_force", rope.spans[-1], -1)):
        first = span.node(node).start
        held = next((k for k, anchor in enumerate(anchors) if anchor.attachments[0].node == first), None)
        found[name] = of_anchors[held] if held is not None else -spatial(reaction[:, first : first + model.dim])
    return found
