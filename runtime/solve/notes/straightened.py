"""Cables that are drawn curved and free of stress, and bend to less than that: their errors grow.

A cable has no material frame. Its sections turn about its tangent as they like, and its bending energy is
1/2 EI (kappa - kappa0)², kappa and kappa0 the sizes of the curvatures (derive/laws/cable/curved.py). Across the plane
of a bend its stiffness is EI (1 - kappa0/kappa): negative where kappa is below kappa0, and without bound at a straight
point. What is small then grows as exp(rate t) with rate² + rate tau EI k⁴/m = (EI (kappa0/kappa - 1) k⁴ - N k²)/m, up
to the shortest waves that the mesh has, k = pi over the element's length.
"""

from __future__ import annotations

import numpy as np

from ...base.rotations import cross
from ...model.middle_strain import middle_strain, slopes, slopes_at
from ...model.model import CableModel
from .note import LineStiffness, Note, Rows
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


class Straightened(Note):
    """The exponents by which differences grow in the elements of each cable that bends to less than its drawn
    curvature, the time in s until which they are summed, and the smallest ratio of its curvature to the drawn one.
    """

    measures = (CableModel,)

    def prepare(self) -> None:
        """Select the cables that are drawn curved, with their curvatures and stiffness."""
        self._cables = []
        for cable in self.model.cables:
            part = self.scene.cables[cable.name]
            if part.is_curved and part.traits.kind == "cable":
                drawn = _curvature(cable, part.rest_nodal_vectors[None])
                self._cables.append((cable, drawn, LineStiffness.of(part, 3)))

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        for cable, drawn, stiffness in self._cables:
            exponents, until, smallest = self.found.get(cable.name, ([0.0] * cable.n_elements, 0.0, 1.0))
            nodal = cable.nodal(rows["q"])
            bends = drawn > MIN_DRAWN_CURVATURE * drawn.max()
            ratio = np.where(bends, _curvature(cable, nodal) / np.where(bends, drawn, 1.0), 1.0).min(axis=0)
            grown = _rates(cable, stiffness, nodal, ratio) * np.diff(rows["time"], prepend=until)[:, None]
            self.found[cable.name] = [(np.array(exponents) + grown.sum(axis=0)).tolist(), float(rows["time"][-1]),
                                      min(smallest, float(ratio.min()))]

    def notes(self) -> list[str]:
        """Return a note for each cable in which differences grew far."""
        return [f'cable "{name}" is drawn curved and free of stress, and bends to less than that, to '
                f"{100 * ratio:.2g} % of its drawn curvature: a cable has no section axes, and its stiffness across "
                f"such a bend is negative: {GROWTH_TEXT} by exp({max(exponents):.2g}) in the run, and results "
                'depend on steps and mesh. Take element="beam24", which keeps its shape in space, or rest="straight"'
                for name, (exponents, _, ratio) in self.found.items() if max(exponents) > GROWTH_EXPONENT_LIMIT]


def _curvature(cable: CableModel, nodal: np.ndarray) -> np.ndarray:
    """Return (positions, T, elements): curvatures in 1/m at nodal vectors (T, nodes, vectors, 3)."""
    r_x = slopes_at(cable, nodal, slopes(cable, *CURVATURE_POSITIONS))
    after, before = (slopes(cable, *(part + side for part in CURVATURE_POSITIONS))
                     for side in (SLOPE_DIFFERENCE, -SLOPE_DIFFERENCE))
    r_xx = slopes_at(cable, nodal, after - before) / (2 * SLOPE_DIFFERENCE * cable.mesh.lengths[:, None])
    size = np.linalg.norm(r_x, axis=-1)
    return np.asarray(np.linalg.norm(cross(r_x, r_xx), axis=-1) / np.where(size > 0, size, 1.0) ** 3)


def _rates(cable: CableModel, of: LineStiffness, nodal: np.ndarray, ratio: np.ndarray) -> np.ndarray:
    """Return (T, elements): rates of growth in 1/s, see above; ratio (T, elements): of curvature to the drawn one."""
    k2 = (np.pi / cable.mesh.lengths) ** 2
    stiffness = of.EI_weak * k2**2 / of.mass
    tension = of.EA * middle_strain(cable, nodal) * k2 / of.mass
    square = np.where(ratio < MAX_CURVATURE_RATIO, stiffness * (1 / np.maximum(ratio, 1e-3) - 1) - tension, 0.0)
    damping = cable.tau * stiffness / 2
    return np.asarray(np.sqrt(np.maximum(square, 0.0) + damping**2) - damping)
