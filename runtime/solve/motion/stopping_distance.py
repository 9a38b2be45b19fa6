"""The distance over which the drag of a fluid stops a cable, for the choice of an integrator."""

from __future__ import annotations

import numpy as np

from ...parts.cable import Cable
from ...parts.drag import Drag
from ...parts.scene_data import SceneData
from ...parts.section import outer_radius_of


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
    fluids = scene.fluids.values() if drag.fluid is None else [scene.fluids[drag.fluid]]
    density = min(fluid.density for fluid in fluids)
    radius = outer_radius_of(cable.section) if drag.diameter is None else drag.diameter / 2
    if radius is None:
        return np.inf
    diameter, coefficient = 2 * radius, drag.added_mass
    added = density * np.pi / 4 * diameter**2 * coefficient if isinstance(coefficient, float) else 0.0
    mass = cable.material.density * float(cable.section.mass_moments()[0]) + added
    return float(2 * mass / (density * diameter * drag.normal))
