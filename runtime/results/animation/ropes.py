"""Ropes in a picture: the line over their sheaves with marks of the material, and the sheaves as wheels that turn.

Between its tangent points the line of a wrap is drawn anew, as an arc about the sheave: a wrap may grow by turns.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...base.quadrature import gauss
from ...base.rotations import product, quaternion, rotate, turned_by
from ...model.rope_states import POINTS_OF_ELEMENT, as_drawn, points_of_spans
from ...parts.rope import Rope
from ...parts.rope_items import Drum, Sheave
from ...parts.rope_route import DrawnArc
from ...parts.rope_route_space import groove_of
from ...parts.scene_data import SceneData
from ...parts.section import Rectangle
from ...view.animation import BodyShape, CableShape, Quantity, section_sides
from .cables import CABLE_STATIONS, MAX_DIVISIONS, section_data
from .carried_wheels import axes_on_cable
from .frames import Frames, no_forces, one_or_all, place

WRAP_STEP = np.pi / 36
"""Largest angle between stations of a wrap, rad."""
MAX_WRAP_STATIONS = 400
MARKS = 40
"""Marks on the material of a rope, about."""
MIN_WIDTH = 0.15
"""Width of a wheel over its radius, at least."""
ROPES_IN_WIDTH = 1.5
"""Width of a wheel over that of its rope, at least."""
LAW_POINTS = 5
"""Points of Gauss by which the strain of an element is found."""
WHEEL_RESULTS = {"tension_on": ("tension on", "N"), "tension_off": ("tension off", "N"),
                 "wrap_angle": ("wrap angle", "rad"), "slip": ("slip", "m/s"), "slip_angle": ("slip angle", "rad"),
                 "tension": ("tension", "N"), "length_in_store": ("length in store", "m"), "power": ("power", "W")}
"""Results of sheaves and drums under the pointer, with their labels and units."""


def ropes_as_drawn(scene: SceneData) -> dict[str, np.ndarray]:
    """Return the results of ropes, sheaves and drums by name as the scene is drawn, of those that pictures need."""
    found: dict[str, np.ndarray] = {}
    for name, rope in scene.ropes.items():
        route = scene.route_of(rope)
        found |= {f"{name}.{key}": value for key, value in as_drawn(rope, route).items()}
        for arc in route.sheaves:
            found[f"{arc.name}.wrap_angle"] = np.array(arc.wrap)
        found |= {f"{wheel.name}.angle": np.array(0.0) for wheel in rope.wheels}
    return found


def stations_of(rope: Rope) -> int:
    """Return about the number of stations at which a rope is drawn."""
    return sum(n * _divisions(rope) for n in rope.elements_of_spans) + CABLE_STATIONS // 4 * len(rope.sheaves)


def _divisions(rope: Rope) -> int:
    """Return the stations per element, not below the points of results."""
    n = sum(rope.elements_of_spans)
    return int(np.clip(np.ceil(CABLE_STATIONS / n), POINTS_OF_ELEMENT, MAX_DIVISIONS))


def rope_shape(frames: Frames, name: str) -> CableShape:
    """Return a rope of the scene as a line over its sheaves."""
    rope = frames.scene.ropes[name]
    counts = _wrap_stations(frames, rope)
    line, still = _Line(frames, rope, counts), replace(frames, value=lambda key: frames.reference(key)[None])
    drawn = _Line(still, rope, counts)
    height = line.height() if isinstance(rope.section, Rectangle) else None
    quantities = () if frames.section_forces is no_forces else line.quantities()
    return CableShape(name, drawn.s[0], line.position, height, section_data(rope.section), drawn.position[0],
                      quantities, line.s, _spacing(rope, float(np.ptp(drawn.s[0]))))


def _spacing(rope: Rope, length: float) -> float:
    """Return the distance of marks in m: round, or of a closed rope a part of its length, so that it has no seam."""
    if rope.closed:
        return length / MARKS
    power = 10.0 ** np.floor(np.log10(length / MARKS))
    return float(max(factor * power for factor in (1, 2, 5) if factor * power <= length / MARKS))


def _wrap_stations(frames: Frames, rope: Rope) -> list[int]:
    """Return the numbers of stations of the wraps, with both ends: enough for the largest angle of all frames."""
    return [int(np.clip(np.ceil(frames.value(f"{sheave.name}.wrap_angle").max() / WRAP_STEP) + 1, 2, MAX_WRAP_STATIONS))
            for sheave in rope.sheaves]


class _Line:
    """A rope at T instants, at P stations: position (T, P, 3) in m, stress-free arc-length s (T, P) in m, and axial
    strain (T, P).
    """

    def __init__(self, frames: Frames, rope: Rope, counts: list[int]):
        """counts: of the stations of each wrap."""
        self.rope, route = rope, frames.scene.route_of(rope)
        points, s = (frames.value(f"{rope.name}.{key}") for key in ("position", "s"))
        if rope.closed:  # back to its first point
            points = np.concatenate([points, points[:, :1]], axis=1)
            s = np.concatenate([s, s[:, :1] + route.free_length], axis=1)
        parts = []
        for k, (span, wrap) in enumerate(points_of_spans(rope, route)):
            parts.append(_span(points[:, span], s[:, span], rope.elements_of_spans[k], _divisions(rope)))
            if wrap is not None:
                number, on = wrap
                parts.append(_wrap(frames, rope.sheaves[number], route.sheaves[number], points[:, on], s[:, on],
                                   counts[number]))
        if rope.closed:
            parts.append((points[:, -1:], s[:, -1:], parts[0][2][:, :1]))
        self.position, self.s, self.strain = (np.concatenate(each, axis=1) for each in zip(*parts, strict=True))

    def height(self) -> np.ndarray:
        """Return the unit vectors (T, P, 3) of the section's height, which lies in the plane; in space across the
        direction in which the rope extends least.
        """
        along, side = np.gradient(self.position, axis=1), np.array([0.0, 0.0, 1.0])
        if self.rope.dim == 3:
            side = np.linalg.svd(self.position[0] - self.position[0].mean(axis=0))[2][-1]
        across = np.cross(side, along)
        return np.asarray(across / np.linalg.norm(across, axis=-1, keepdims=True))

    def quantities(self) -> tuple[Quantity, ...]:
        """Return tension, by the elastic law, and strain."""
        return (Quantity("tension", "tension", "N", self.rope.stiffness[0] * self.strain),
                Quantity("strain", "axial strain", "1", self.strain))


def _span(points: np.ndarray, s: np.ndarray, elements: int, divisions: int) -> tuple[np.ndarray, ...]:
    """Return stations of a span: position (T, n, 3), s (T, n), strain (T, n); points (T, m, 3), s (T, m): its results.

    The position is cubic in an element, the strain linear, as in the elastic law: its lowest two Legendre modes.
    """
    first = POINTS_OF_ELEMENT * np.arange(elements)
    of_element = points[:, first[:, None] + np.arange(POINTS_OF_ELEMENT + 1)]
    fit = np.linalg.pinv(np.vander(np.linspace(0, 1, POINTS_OF_ELEMENT + 1), 4, increasing=True))
    x = np.arange(divisions) / divisions
    inside = np.einsum("jk,teki->teji", np.vander(x, 4, increasing=True) @ fit, of_element)
    length = s[:, first + POINTS_OF_ELEMENT] - s[:, first]
    at = s[:, first, None] + length[..., None] * x
    X, weight = gauss(LAW_POINTS)
    powers = np.arange(1, 4)
    derivative = (powers * ((X + 1) / 2)[:, None] ** (powers - 1)) @ fit[1:]
    slope = np.einsum("jk,teki->teji", derivative, of_element) / length[..., None, None]
    strain = np.linalg.norm(slope, axis=-1) - 1
    mean, tilt = strain @ weight / 2, strain @ (3 * weight * X) / 2
    along = mean[..., None] + tilt[..., None] * (2 * x - 1)
    between = (mean[:, :-1] + tilt[:, :-1] + mean[:, 1:] - tilt[:, 1:]) / 2
    along[:, 1:, 0] = between  # of both elements at a node
    return tuple(np.concatenate([values.reshape(len(s), -1, *values.shape[3:]), last], axis=1) for values, last in (
        (inside, points[:, -1:]), (at, s[:, -1:]), (along, (mean + tilt)[:, -1:])))


def _wrap(frames: Frames, sheave: Sheave, arc: DrawnArc, points: np.ndarray, s: np.ndarray, count: int
          ) -> tuple[np.ndarray, ...]:
    """Return the stations of a wrap, without its tangent points; arguments and results as of `_span`."""
    centre = place(frames, sheave.end)
    groove, sense = np.eye(3)[:, :2] if len(arc.groove) == 2 else arc.groove, arc.sense
    turned = _turned(frames, sheave, groove)
    on, off = (((points[:, k] - centre)[:, None] @ turned)[:, 0] for k in (0, -1))
    part = sense * np.arctan2(on[:, 0] * off[:, 1] - on[:, 1] * off[:, 0], np.sum(on * off, axis=1))
    wrap = part + 2 * np.pi * np.round((frames.value(f"{sheave.name}.wrap_angle") - part) / (2 * np.pi))
    share = np.linspace(0, 1, count)[1:-1]
    angle = np.arctan2(on[:, 1], on[:, 0])[:, None] + sense * wrap[:, None] * share
    around = np.stack([np.cos(angle), np.sin(angle)], axis=-1) @ turned.swapaxes(1, 2)
    given = np.linspace(0, 1, s.shape[1])
    touches = frames.value(f"{sheave.name}.wrap_angle") > 0
    length = np.where(touches[:, None], np.diff(s), 1.0)  # a wrap without contact has neither length nor strain
    strain = np.where(touches[:, None], sheave.radius * wrap[:, None] * np.diff(given) / length - 1, 0.0)
    middle = np.concatenate([strain[:, :1], (strain[:, :-1] + strain[:, 1:]) / 2, strain[:, -1:]], axis=1)

    def between(values: np.ndarray) -> np.ndarray:
        return values @ np.stack([np.interp(share, given, one) for one in np.eye(len(given))])

    radius = np.where(touches, sheave.radius, np.linalg.norm(on, axis=1))
    aside = (points[:, 0] - centre)[:, None] - on[:, None] @ turned.swapaxes(1, 2)  # of a rope beside the plane
    return centre[:, None] + radius[:, None, None] * around + aside, between(s), between(middle)


def _turned(frames: Frames, wheel: Sheave | Drum, groove: np.ndarray) -> np.ndarray:
    """Return (T, 3, 2): the plane of a groove as drawn, turned with the body or the cable that the wheel is on; else
    (1, 3, 2).
    """
    if wheel.end.on is None or frames.scene.dim == 2:
        return groove[None]
    if wheel.end.on in frames.scene.cables:
        return axes_on_cable(frames, wheel.end, groove)[..., :2]
    orientation, body = frames.value(f"{wheel.end.on}.orientation"), frames.scene.bodies[wheel.end.on]
    return np.stack([rotate(orientation, body.axes.T @ axis) for axis in groove.T], axis=-1)


def wheel_shape(frames: Frames, refs: Frames, rope: Rope, sheave: Sheave | Drum) -> BodyShape:
    """Return a sheave or a drum as a wheel below the rope; refs: see `references`.

    One without rotation keeps the axes of its carrier; in the plane the turn of a cable's section is left out.
    """
    height, width = section_sides(section_data(rope.section))
    shape = {"kind": "wheel", "radius": max(sheave.radius - height / 2, sheave.radius / 2),
             "width": max(MIN_WIDTH * sheave.radius, ROPES_IN_WIDTH * width), "offset": [0.0, 0.0, 0.0]}
    times = len(frames.time)
    position = np.broadcast_to(place(frames, sheave.end), (times, 3))
    turn = np.zeros((times, 3))
    turn[:, 2] = frames.value(f"{sheave.name}.angle")
    orientation = turned_by(turn)
    if rope.dim == 3:
        groove = groove_of(sheave.axis)
        drawn = np.column_stack([groove, np.cross(*groove.T)])
        if sheave.end.on in frames.scene.bodies:
            drawn = frames.scene.bodies[sheave.end.on].axes.T @ drawn
        carried = axes_on_cable(frames, sheave.end, groove) if sheave.end.on in frames.scene.cables else drawn[None]
        orientation = product(np.array([quaternion(axes) for axes in carried]), orientation)
    if sheave.end.on in frames.scene.bodies:
        orientation = product(frames.value(f"{sheave.end.on}.orientation"), orientation)
    found = {label: (unit, frames.value(f"{sheave.name}.{key}")) for key, (label, unit) in WHEEL_RESULTS.items()
             if frames.has(f"{sheave.name}.{key}") and frames.section_forces is not no_forces}
    return BodyShape(sheave.name, position, orientation, shape, one_or_all(place(refs, sheave.end)), found)
