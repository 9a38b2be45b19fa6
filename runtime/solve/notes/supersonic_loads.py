"""Loads that move along a cable faster than its transverse waves: they run in a shock, with waves as short as the
bending stiffness allows.

Waves of wave number k along a cable of tension T, stretch a, bending stiffness B and mass m per unit length at rest
have the speed sqrt((T/a + B k²)/m) along it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...parts.cable import Cable
from ...parts.scene_data import SceneData

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers alone


def excess(cable: Cable, stretch: ArrayLike, speed: ArrayLike) -> np.ndarray:
    """Return m v² - T/a in N, which is positive where a point outruns the transverse waves of a cable: the largest of
    its pieces.

    stretch: of the cable; speed: of the point, in m/s of its arc-length at rest.
    """
    a = np.asarray(stretch)
    return np.asarray(np.max([piece.section.area * piece.material.density * np.square(speed)
                              - piece.tension_at(a - 1.0) / a for piece in cable.uniform_pieces], axis=0))


def outrunning(scene: SceneData) -> list[str]:
    """Return the slides whose bodies start faster than the transverse waves of a cable that is drawn taut; steps of
    genalpha damp the shock.
    """
    found = []
    for slide in scene.slides.values():
        cable, body = scene.cables.get(slide.along), scene.bodies.get(slide.body or "")
        if cable is None or body is None or cable.stretch <= 1.0:
            continue
        if excess(cable, cable.stretch, np.linalg.norm(body.velocity) / cable.stretch) > 0:
            found.append(slide.name)
    return found
