"""Velocities that jump, in words: of motions that start at another rate than their cable, or whose rate jumps later."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..parts.scene_data import SceneData
from ..parts.signal import Signal
from ..parts.support import Motion
from ..parts.validation import show

SMALL = 1e-4
"""Of the largest rate in the run: a jump that is smaller sends a shock that is nothing beside the motion."""
SAMPLES = 200
"""Instants of the run at which rates are looked at."""


def velocity_jumps(scene: SceneData, duration: float) -> list[str]:
    """Return a message for each motion whose velocity jumps as the run starts, or within its duration, s."""
    found = []
    for motion in scene.motions:
        for what, signal, own, unit in _rates(scene, motion):
            rates = signal.value(np.linspace(0, duration, SAMPLES), 1)
            given, least = rates[0], SMALL * max(np.abs(rates).max(), abs(own))
            if abs(given - own) > least:
                found.append(
                    f"{motion.where} at s = {show(motion.s, 'm')}: {what} starts at {show(given, unit)}, but its node "
                    f"at {show(own, unit)}; this jump sends a shock along the cable, which depends on the mesh. Let "
                    "the signal start at the node's rate (a Ramp starts at 0), or give the cable that velocity")
            jumps = [(t, jump) for t, jump in jumps_of_rate(signal) if 0 < t < duration and abs(jump) > least]
            if jumps:
                t, jump = jumps[0]
                times = f", and at {len(jumps) - 1} later times" if len(jumps) > 1 else ""
                found.append(
                    f"{motion.where} at s = {show(motion.s, 'm')}: the rate of {what} jumps by {show(jump, unit)} at "
                    f"t = {show(t, 's')}{times}; each jump sends a shock along the cable, which depends on the mesh. "
                    "Take a signal of a continuous rate: a Ramp, or between its ends a TableSignal, "
                    'interpolation="cubic"')
    return found


def jumps_of_rate(signal: Signal) -> list[tuple[float, float]]:
    """Return the times, s, at which pieces of a signal meet, and by how much its rate jumps at each, 1/s."""
    breaks, coefficients = signal.pieces()
    powers = np.arange(1, coefficients.shape[1])
    before = np.sum(powers * coefficients[:-1, 1:] * np.diff(breaks)[:-1, None] ** (powers - 1), axis=1)
    return list(zip(breaks[1:-1].tolist(), (coefficients[1:, 1] - before).tolist(), strict=True))


def _rates(scene: SceneData, motion: Motion) -> Iterator[tuple[str, Signal, float, str]]:
    """Name, signal and the node's own rate at t = 0, with its unit, of all that a motion prescribes."""
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
