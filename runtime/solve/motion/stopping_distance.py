"""The distance over which the drag of a fluid stops a cable, for the choice of an integrator."""

from __future__ import annotations

import numpy as np

from ...parts.cable import Cable
from ...parts.drag import Drag
from ...parts.scene_data import SceneData
from ..notes.note import LineStiffness


def stopping_share(scene: SceneData) -> float:
    """Return the largest distance over which drag across a cable slows it to 1/e, over its length; infinite where a
    cable has no drag, or a rope is there.

    A mass m a length and its added mass, with the force ρ/2 d C w² a length, lose their velocity as exp(-x/L) over the
    distance x, with L = 2 m/(ρ d C).
    """
    if scene.ropes:
        return np.inf
    drags = {drag.on: drag for drag in scene.drags.values()}
    return max((_distance(scene, cable, drags.get(name)) / cable.length for name, cable in scene.cables.items()),
               default=np.inf)


def _distance(scene: SceneData, cable: Cable, drag: Drag | None) -> float:
    """Return the distance of one cable in m, in the lightest fluid that acts on it."""
    if drag is None or not drag.normal:
        return np.inf
    density = min(fluid.density for fluid in scene.fluids_of(drag))
    distances, heaviest = [], float(np.max(LineStiffness.of(cable, scene.dim).mass))
    for piece in drag.stretches(cable):
        mass = heaviest
        if drag.added_mass is not None:
            mass += density * drag.displaced(piece.section) * float(drag.added_of_cable()[0])
        distances.append(2 * mass / (density * drag.width(piece.section) * drag.normal))
    return max(distances)
