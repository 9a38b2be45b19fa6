"""What moves along a cable faster than the waves of its tension: it runs in a shock, and makes waves as short as
bending lets them be.

Waves of wave number k along a cable of tension T, stretch a, bending stiffness B and mass m, all of a metre at rest,
have the speed sqrt((T/a + B k²)/m) along it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...parts.cable import Cable
from ...parts.scene_data import SceneData


def excess(cable: Cable, stretch: ArrayLike, speed: ArrayLike) -> np.ndarray:
    """Return m v² - T/a in N: above 0 where a point outruns the waves of a cable's tension.

    stretch: of the cable; speed: of the point, in m/s of its arc-length at rest.
    """
    a, area = np.asarray(stretch), float(cable.section.moments()[0])
    tension = cable.material.youngs_modulus * area * (a - 1.0)
    return cable.material.density * area * np.square(speed) - tension / a


def outrunning(scene: SceneData) -> list[str]:
    """Return the slides whose bodies start faster than the transverse waves of a cable that is drawn taut: the shock
    that they run in damps out in steps of genalpha.
    """
    found = []
    for slide in scene.slides.values():
        cable, body = scene.cables[slide.along], scene.bodies.get(slide.body or "")
        if body is None or cable.stretch <= 1.0:
            continue
        if excess(cable, cable.stretch, np.linalg.norm(body.velocity) / cable.stretch) > 0:
            found.append(slide.name)
    return found
