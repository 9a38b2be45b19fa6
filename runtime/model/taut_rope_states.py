"""Results of ropes without mass in states of a model."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..base.deferred import dataclass
from .model import Model
from .rope_model import RopeModel
from .rope_states import grooves, points_of_spans
from .states import attachment_points, spatial
from .taut_ropes import TautPointModel, TautRopeModel, points_of_rope

Outputs = Callable[[str, int], dict[str, np.ndarray]]
"""Returns the outputs of a coupling by its kind and its number among those of the kind."""


@dataclass(eq=False, repr=False)
class _Point:
    """A point of a rope in T states: centre of the rope's circle (T, dim) in m; the plane of its groove (T, dim, 2);
    the rope's angle before and after it, rad, (T,); radius with the sense as sign, m; whether the rope touches it (T,);
    where the rope runs on and off (T, dim), m.
    """

    centre: np.ndarray
    groove: np.ndarray
    before: np.ndarray
    after: np.ndarray
    radius: float
    touches: np.ndarray
    on: np.ndarray
    off: np.ndarray
    outputs: dict[str, np.ndarray]

    def on_circle(self, angle: np.ndarray, fleet: np.ndarray | float = 0.0) -> np.ndarray:
        """Return (T, dim): the tangent point of a straight part of an angle, and of a fleet angle, rad, in m."""
        out = self.radius / np.cos(fleet) * np.stack([np.sin(angle), -np.cos(angle)])
        made: np.ndarray = self.centre + np.einsum("tdk,kt->td", self.groove, out)
        return made


def taut_rope_state(model: Model, rope: RopeModel, q: np.ndarray, outputs: Outputs) -> dict[str, np.ndarray]:
    """Return points along a rope without mass in configurations (T, n_q): position (T, points, 3) in m and their
    stress-free arc-length s (T, points) in m; and the forces on what holds its ends (T, 3) in N.
    """
    models, pieces = model.of(TautPointModel), model.of(TautRopeModel)
    own = points_of_rope(models, rope.part.name)
    points = [_point(model, point, q, outputs("taut_point", models.index(point))) for point in own]
    n = len(points)
    _find_feet(points)
    count = points_of_spans(rope.part, rope.route)
    places, lengths = [], []
    s = _material(model, rope, own, points, pieces, outputs)
    for k, (span, wrap) in enumerate(count):
        one, other = points[k], points[(k + 1) % n]
        share = np.linspace(0, 1, span.stop - span.start)[:, None]
        places.append(one.off[:, None] + share * (other.on - one.off)[:, None])
        lengths.append(s[k][0][:, None] + share.T * (s[k][1] - s[k][0])[:, None])
        if wrap is None:
            continue
        share = np.linspace(0, 1, wrap[1].stop - wrap[1].start)[1:-1]
        for part in share:
            on_arc = other.on_circle(other.before + part * (other.after - other.before))
            places.append(np.where(other.touches[:, None], on_arc, other.on)[:, None])
            lengths.append((s[k][1] + part * (s[k][2] - s[k][1]))[:, None])
    none = np.zeros((len(q), 3))
    ends = {name: none if own[k].radius else points[k].outputs["force"] for name, k in (("start_force", 0),
                                                                                         ("end_force", -1))}
    return {"position": spatial(np.concatenate(places, axis=1)), "s": np.concatenate(lengths, axis=1)} | ends


def _point(model: Model, point: TautPointModel, q: np.ndarray, outputs: dict[str, np.ndarray]) -> _Point:
    centre = attachment_points(model, point.attachments[0], q)[:, : model.dim]
    before, after = outputs["angle_on"], outputs["angle_off"]
    groove = grooves(model, point, q)
    if point.in_space:
        centre = centre + np.cross(groove[..., 0], groove[..., 1]) * outputs["aside"][:, None]
    made = _Point(centre, groove, before, after, point.radius, outputs["touches"] > 0, centre, centre, outputs)
    made.on = made.on_circle(before, outputs["fleet_angle_on"])
    made.off = made.on_circle(after, outputs["fleet_angle_off"])
    made.after = after + point.closing
    return made


def _find_feet(points: list[_Point]) -> None:
    """Set where the rope passes points that it does not touch: on the straight part, nearest to their centres."""
    n = len(points)
    for k, point in enumerate(points):
        for t in np.flatnonzero(~point.touches):
            before = next(points[j % n] for j in range(k - 1, k - n, -1) if points[j % n].touches[t])
            after = next(points[j % n] for j in range(k + 1, k + n) if points[j % n].touches[t])
            start, end = before.off[t], after.on[t]
            length = float(np.linalg.norm(end - start))
            u = (end - start) / length
            along = min(max(float((point.centre[t] - start) @ u), 0.0), length)
            point.on[t] = point.off[t] = start + along * u


def _material(model: Model, rope: RopeModel, own: list[TautPointModel], points: list[_Point],
              pieces: list[TautRopeModel], outputs: Outputs) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Return the stress-free arc-lengths of both ends of each span and of the end of the wrap after it, (T,) in m."""
    n, route, closed = len(points), rope.route, rope.part.closed
    spans = n if closed else n - 1
    first = next(k for k, point in enumerate(own) if point.holds) if closed else 0
    s = points[first].outputs["length_in_store"] + sum(route.spans[k].length for k in range(first)) / route.stretch
    s = s + sum(route.sheaves[k].length for k in range(1, first + 1)) / route.stretch if closed else s
    found: dict[int, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}
    for k in range(first, first + spans):
        one, other = points[k % n], points[(k + 1) % n]
        piece = own[k % n].after
        assert piece is not None, f"{rope.part.where} has no rope after its point {k}"
        of = outputs("taut_rope", pieces.index(piece[0]))
        ratio = of["free_length"] / of["drawn_length"]
        s_on = s + ratio * np.linalg.norm(other.on - one.off, axis=1)
        arc = np.abs(other.radius * (other.after - other.before)) * other.touches
        held = own[(k + 1) % n].holds
        s_off = s_on + arc * (1 / route.stretch if held else ratio)
        past = route.free_length if k >= n else 0.0
        found[k % n] = s - past, s_on - past, s_off - past
        s = s_off
    return [found[k] for k in range(spans)]
