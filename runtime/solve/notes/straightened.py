"""Cables that are drawn curved and free of stress, and bend to less than that: their errors grow.

A cable has no material frame. Its sections turn about its tangent as they like, and its bending energy is
1/2 EI (kappa - kappa0)², kappa and kappa0 the sizes of the curvatures (derive/laws/cable/curved.py). Across the plane
of a bend its stiffness is EI (1 - kappa0/kappa): negative where kappa is below kappa0, and without bound at a straight
point. What is small then grows as exp(rate t) with rate² + rate tau EI k⁴/m = (EI (kappa0/kappa - 1) k⁴ - N k²)/m, up
to the shortest waves that the mesh has, k = pi over the element's length.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...base.rotations import cross
from ...model.middle_strain import middle_strain, slopes
from ...model.model import CableModel, Model
from ...parts.cable import Cable
from ...parts.scene_data import SceneData
from .sensitivity import GROWTH_TEXT

CURVATURE_POSITIONS = (0.1, 0.5, 0.9)
"""Positions of the assessed curvatures, as fractions of the length of an element."""
SLOPE_DIFFERENCE = 1e-3
"""Half interval of the central difference of a slope, as a fraction of the length; exact for cubic elements."""
MIN_DRAWN_CURVATURE = 0.1
"""Curvatures below this fraction of the largest drawn curvature are neglected."""
MAX_CURVATURE_RATIO = 0.95
"""Ratio of the curvature to the drawn one below which errors grow; above it they grow slowly."""
GROWTH_EXPONENT_LIMIT = 10.0
"""Exponent of the growth above which a note reports it."""


class Straightened:
    """By what small differences grow where cables bend to less than their drawn curvature.

    found: by the cable's name, the exponents of its elements, the time in s until which they are summed, and the least
    part that was left of the drawn curvature.
    """

    def __init__(self, scene: SceneData, model: Model):
        self._cables = []
        for cable in model.cables:
            part = scene.cables[cable.name]
            if part.is_curved and part.traits.kind == "cable":
                self._cables.append((cable, part, _curvature(cable, part.rest_nodal_vectors[None])))
        self.found: dict[str, Any] = {}

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows."""
        for cable, part, drawn in self._cables:
            exponents, until, least = self.found.get(cable.name, ([0.0] * cable.n_elements, 0.0, 1.0))
            vectors = rows["q"][:, cable.coordinates].reshape(-1, *cable.shape)
            bends = drawn > MIN_DRAWN_CURVATURE * drawn.max()
            left = np.where(bends, _curvature(cable, vectors) / np.where(bends, drawn, 1.0), 1.0).min(axis=0)
            grown = _rates(cable, part, vectors, left) * np.diff(rows["time"], prepend=until)[:, None]
            self.found[cable.name] = [(np.array(exponents) + grown.sum(axis=0)).tolist(), float(rows["time"][-1]),
                                      min(least, float(left.min()))]

    def notes(self) -> list[str]:
        """Return a note for each cable in which differences grew far."""
        return [f'cable "{name}" is drawn curved and free of stress, and bends to less than that, to '
                f"{100 * left:.2g} % of its drawn curvature: a cable has no section axes, and its stiffness across "
                f"such a bend is negative: {GROWTH_TEXT} by exp({max(exponents):.2g}) in the run, and results "
                'depend on steps and mesh. Take element="beam24", which keeps its shape in space, or rest="straight"'
                for name, (exponents, _, left) in self.found.items() if max(exponents) > GROWTH_EXPONENT_LIMIT]


def _curvature(cable: CableModel, vectors: np.ndarray) -> np.ndarray:
    """Return (parts, T, elements): curvatures in 1/m with nodal vectors (T, nodes, vectors, 3)."""
    e = np.concatenate([vectors[:, :-1], vectors[:, 1:]], axis=2)

    def at(N: np.ndarray) -> np.ndarray:
        return np.einsum("ek,tekd->ted", np.broadcast_to(N, e.shape[1:3]), e)

    found = []
    for part in CURVATURE_POSITIONS:
        r_x = at(slopes(cable, part))
        r_xx = (at(slopes(cable, part + SLOPE_DIFFERENCE)) - at(slopes(cable, part - SLOPE_DIFFERENCE))) / (
            2 * SLOPE_DIFFERENCE * np.broadcast_to(cable.mesh.lengths, cable.n_elements)[:, None])
        size = np.linalg.norm(r_x, axis=-1)
        found.append(np.linalg.norm(cross(r_x, r_xx), axis=-1) / np.where(size > 0, size, 1.0) ** 3)
    return np.stack(found)


def _rates(cable: CableModel, part: Cable, vectors: np.ndarray, left: np.ndarray) -> np.ndarray:
    """Return (T, elements): rates of growth in 1/s, see above; left (T, elements) of the drawn curvature."""
    E, moments, lengths = part.material.youngs_modulus, part.section.moments(), cable.mesh.lengths
    mass = part.material.density * float(part.section.mass_moments()[0])
    k2 = (np.pi / lengths) ** 2
    stiffness = E * float(min(moments[1:3])) * k2**2 / mass
    tension = E * float(moments[0]) * middle_strain(cable, vectors) * k2 / mass
    square = np.where(left < MAX_CURVATURE_RATIO, stiffness * (1 / np.maximum(left, 1e-3) - 1) - tension, 0.0)
    damping = cable.tau * stiffness / 2
    return np.sqrt(np.maximum(square, 0.0) + damping**2) - damping
