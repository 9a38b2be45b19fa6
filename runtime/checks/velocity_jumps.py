"""Notes on jumps of velocity: motions and driven slides whose rate differs from that of their cable or rider at the
start, or jumps later.
"""

from __future__ import annotations

from collections.abc import Container, Iterator

import numpy as np

from ..parts.attachment import Attachment
from ..parts.locations import velocity_of
from ..parts.scene_data import SceneData
from ..parts.signal import Signal
from ..parts.slide import Slide
from ..parts.support import Motion
from ..parts.validation import show
from .slide_on_rope import line_of

NEGLIGIBLE_JUMP = 1e-4
"""Negligible jump of a rate, as a fraction of the largest rate in the run."""
SAMPLES = 200
"""Instants of a run at which rates are evaluated."""
RATE = "the rate of s"
"""The quantity that is driven, as messages name it."""
VELOCITIES = "velocity", "angular_velocity", "nodal_velocity", "coordinate_rates"
"""Results that give velocities of bodies, cables and ropes."""


def velocity_jumps(scene: SceneData, duration: float, given: Container[str] = ()) -> list[str]:
    """Return a message for each motion and driven slide whose velocity jumps at the start or within the duration, s.

    given: names of results in the initial state of the run, which are not as drawn.
    """
    found = []
    for motion in scene.motions:
        where = f"{motion.where} at s = {show(motion.s, 'm')}"
        for what, signal, own, unit in _rates(scene, motion):
            rates = signal.value(np.linspace(0, duration, SAMPLES), 1)
            start, least = rates[0], NEGLIGIBLE_JUMP * max(np.abs(rates).max(), abs(own))
            if abs(start - own) > least:
                found.append(
                    f"{where}: {what} starts at {show(start, unit)}, but its node "
                    f"at {show(own, unit)}; this jump sends a shock along the cable, which depends on the mesh. Let "
                    "the signal start at the node's rate (a Ramp starts at 0), or give the cable that velocity")
            found += _later(where, f"the rate of {what}", signal, unit, duration, least)
    for slide in scene.slides.values():
        if slide.prescribed is not None:
            found += _of_slide(scene, slide, slide.prescribed, duration, given)
    return found


def _of_slide(scene: SceneData, slide: Slide, signal: Signal, duration: float, given: Container[str]) -> Iterator[str]:
    """Yield messages on jumps of the rate of a driven slide, at the start and later."""
    line, rates = line_of(scene, slide), signal.value(np.linspace(0, duration, SAMPLES), 1)
    riding, carried = (_velocity(scene, end) for end in (slide.rider, Attachment(on=slide.along, s=slide.s)))
    if riding is None or carried is None:
        yield from _later(slide.where, RATE, signal, "m/s", duration, NEGLIGIBLE_JUMP * np.abs(rates).max())
        return
    slope = line.slope(slide.arc_length)
    own = float((riding - carried) @ slope / (slope @ slope))
    least = NEGLIGIBLE_JUMP * max(np.abs(rates).max(), abs(own))
    as_drawn = not any(f"{part}.{name}" in given for part in (slide.body, slide.along) for name in VELOCITIES)
    if as_drawn and abs(jump := float(rates[0]) - own) > least:
        body = scene.bodies.get(slide.body or "")
        on = None if slide.body is None else scene.line(slide.body)
        rider = "the eyelet" if slide.body is None else f'body "{slide.body}"' if on is None else on.where
        begin = "Let"
        if body is not None:
            begin = f"Start {rider} at velocity {show(body.velocity + jump * slope, 'm/s')}, or let"
        yield (f'{slide.where}: moves along {line.where} at {show(float(rates[0]), "m/s")} from t = 0, but '
               f"{rider} is drawn at {show(own, 'm/s')} along it; this jump is a blow to rider and cable, which "
               f"depends on the mesh. {begin} the rate begin at {show(own, 'm/s')}, as that of a Ramp does")
    yield from _later(slide.where, RATE, signal, "m/s", duration, least)


def _velocity(scene: SceneData, end: Attachment) -> np.ndarray | None:
    """Return (3,): the velocity of an attachment as drawn, m/s; None of a rope, which follows from those of all that
    holds it, unless these and its wheels are at rest.
    """
    rope = scene.ropes.get(end.on or "")
    if rope is None:
        return velocity_of(scene, end)
    moves = any(wheel.prescribed is not None for wheel in rope.wheels) or any(
        velocity_of(scene, item.end).any() for item in rope.route)
    return None if moves else np.zeros(3)


def _later(where: str, what: str, signal: Signal, unit: str, duration: float, least: float) -> Iterator[str]:
    """Yield a message where a rate jumps by more than `least` within the duration, s."""
    jumps = [(t, jump) for t, jump in jumps_of_rate(signal) if 0 < t < duration and abs(jump) > least]
    if jumps:
        t, jump = jumps[0]
        times = f", and at {len(jumps) - 1} later times" if len(jumps) > 1 else ""
        yield (f"{where}: {what} jumps by {show(jump, unit)} at t = {show(t, 's')}{times}; each jump sends a shock "
               "along the cable, which depends on the mesh. Take a signal of a continuous rate: a Ramp, or between its "
               'ends a TableSignal, interpolation="cubic"')


def jumps_of_rate(signal: Signal) -> list[tuple[float, float]]:
    """Return the times between pieces of a signal, s, and the jumps of its rate, 1/s."""
    breaks, coefficients = signal.pieces()
    powers = np.arange(1, coefficients.shape[1])
    before = np.sum(powers * coefficients[:-1, 1:] * np.diff(breaks)[:-1, None] ** (powers - 1), axis=1)
    return list(zip(breaks[1:-1].tolist(), (coefficients[1:, 1] - before).tolist(), strict=True))


def _rates(scene: SceneData, motion: Motion) -> Iterator[tuple[str, Signal, float, str]]:
    """Yield name, signal, rate of the node at t = 0, and unit of each prescribed quantity of a motion."""
    cable = scene.cables[motion.cable]
    node, names = cable.node_at(motion.s), cable.kind_of_element.nodal_vectors
    own, drawn = cable.nodal_rates[node], cable.nodal_vectors[node]
    for k, signal in enumerate(motion.displacement or ()):
        if signal is not None:
            yield f"displacement {'xyz'[k]}", signal, float(own[names.index("r"), k]), "m/s"
    if motion.rotation is not None:
        axis, angle = np.array(motion.rotation.axis), motion.rotation.angle
        name = next((name for name in ("r_y", "r_z") if name in names and
                     np.linalg.norm(np.cross(axis, drawn[names.index(name)])) > 0.5), "r_x")
        across = np.cross(axis, drawn[names.index(name)])
        square = float(across @ across)
        if square:
            yield "rotation", angle, float(across @ own[names.index(name)]) / square, "rad/s"
