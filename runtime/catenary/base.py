"""What pantographs of all kinds stand on: a base that the train moves along the track."""

from __future__ import annotations

from ..parts.solids import Box
from ..scene.scene import Scene

RADIUS = 0.05
"""m: from the wire's axis to the middle of the collector where they touch; more than any penetration."""

COLLECTOR = (0.3, 2 * RADIUS, 1.6)
"""m: the collector as it is drawn, along the track, up, across."""

MASS = 1.0
"""kg: of the base, which moves as it is told."""

TURNING = 1.0
"""kg m²: moments of inertia of bodies that do not turn."""


def add_base(scene: Scene, name: str, place: tuple[float, float], speed: float) -> str:
    """Add the base of a pantograph at (x, y) in m, which moves along x at a speed (m/s); return its name."""
    base, middle = f"{name}_base", (*place, 0.0)
    scene.rigid_body(base, mass=MASS, inertia=(TURNING,) * 3, position=middle, velocity=(speed, 0, 0),
                     shape=Box(size=(0.8, 2 * RADIUS, 0.8)))
    scene.joint("prismatic", middle, base, axis=(1, 0, 0), velocity=speed, name=f"{name}_drive")
    return base
