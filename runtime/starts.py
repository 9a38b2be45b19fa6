"""Velocities that jump as a run starts, in words: motions whose rate is not that of the cable they move."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from funicular.scene import Scene
from funicular.supports import Motion
from funicular.validation import show

EQUAL = 1e-9
"""Rates that differ by less, relative to their size, are equal."""


def velocity_jumps(scene: Scene) -> list[str]:
    """A message for each motion that starts at another velocity than its node."""
    found = []
    for motion in scene.motions:
        for what, given, own, unit in _rates(scene, motion):
            if abs(given - own) > EQUAL * (abs(given) + abs(own)):
                found.append(
                    f"{motion.where} at s = {show(motion.s, 'm')}: {what} starts at {show(given, unit)}, but its node "
                    f"at {show(own, unit)}; this jump sends a shock along the cable, which depends on the mesh. Let "
                    "the signal start at the node's rate (a Ramp starts at 0), or give the cable that velocity")
    return found


def _rates(scene: Scene, motion: Motion) -> Iterator[tuple[str, float, float, str]]:
    """Name, prescribed rate and the node's own rate at t = 0, with the unit, of all that a motion prescribes."""
    cable = scene.cables[motion.cable]
    node, names = cable.node_at(motion.s), cable.kind_of_element.nodal_vectors
    own, drawn = cable.nodal_rates[node], cable.nodal_vectors[node]
    for k, signal in enumerate(motion.displacement or ()):
        if signal is not None:
            yield f"displacement {'xyz'[k]}", float(signal.value(0.0, 1)), float(own[names.index("r"), k]), "m/s"
    if motion.rotation is not None:
        axis, rate = np.array(motion.rotation.axis), float(motion.rotation.angle.value(0.0, 1))
        name = next((name for name in ("r_y", "r_z") if name in names and
                     np.linalg.norm(np.cross(axis, drawn[names.index(name)])) > 0.5), "r_x")
        across = np.cross(axis, drawn[names.index(name)])
        square = float(across @ across)
        yield "rotation", rate, float(across @ own[names.index(name)]) / square if square else rate, "rad/s"
