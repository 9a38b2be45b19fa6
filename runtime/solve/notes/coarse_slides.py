"""Slides over which a taut cable or rope turns more sharply than its elements can.

Under a force at a point a cable of tension N turns within sqrt(EI/N). A longer element cuts the corner, by more or less
as the point moves through it: that is a force along the cable, and none of the rope's. A rope in balance over an eyelet
without friction has one tension; with elements of h the two sides differ by up to 0.02 a² h/sqrt(EI/N), and not by more
than 0.08 a², a the angle in rad by which the rope turns. Measured for a of 2 to 90 degrees, EA/N of 100 to 10,000, and
h/sqrt(EI/N) of 0.5 to 8. While the rope slides, each node that passes the point is a shock.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.rotations import sizes
from ...engine import around_elements, outputs_by_name
from ...model.middle_strain import middle_strain
from ...model.model import SlideModel
from ...model.span_coordinates import PER_NODE, SpanCoordinates
from ...parts.cable import Cable
from ...parts.rope import Rope
from .coarse_meshes import FORCE_ERROR_LIMIT, ROW_INTERVAL
from .note import LineStiffness, Note, Rows

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers alone

LENGTH_FACTOR, ANGLE_FACTOR = 0.02, 0.08
"""Difference of the tensions over the squared angle times h/sqrt(EI/N), and its upper bound over the squared angle."""
ROUNDING = float(np.finfo(float).eps)
"""Lower bound of the angle, in rad."""


class _Beside(NamedTuple):
    """The cosine of the angle between the slopes of a line before and after a slide, its strain, and the length of the
    element that has the slide in m, (T,).
    """

    cosine: np.ndarray
    strain: np.ndarray
    h: ArrayLike


def _on_rope(span: SpanCoordinates, q: np.ndarray, s: np.ndarray) -> _Beside:
    """Return the slopes of a span beside a slide; the strain is that at its ends, as the tension along it hardly
    differs.
    """
    rows, (element, ends) = np.arange(len(q)), span.element_at(q, s)
    slopes = q[:, span.nodes].reshape(len(q), span.n_elements + 1, PER_NODE, span.dim)[:, :, 1]
    before, after = slopes[rows, np.maximum(element - 1, 0)], slopes[rows, np.minimum(element + 2, span.n_elements)]
    cosine = np.einsum("td,td->t", before, after) / np.maximum(sizes(before) * sizes(after), np.finfo(float).tiny)
    return _Beside(cosine, np.linalg.norm(slopes[:, [0, -1]], axis=-1).min(axis=1) - 1, np.diff(ends)[:, 0])


class CoarseSlides(Note):
    """The number of rows seen at each slide, sums over them of the relative error of the tension, of the angle in rad
    and of the tension in N, and the length in m of the longest element.
    """

    measures = (SlideModel,)
    assesses_rest, row_interval = True, ROW_INTERVAL

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        if not self.model.slides:
            return
        forces = sizes(outputs_by_name("slide", rows["slide"])["force"])
        for k, (slide, force) in enumerate(zip(self.model.slides, forces.T, strict=True)):
            numbers, h = self._of(slide, rows["q"], rows["s"][:, k], force)
            count, sums, longest = self.found.get(slide.name, (0, [0.0, 0.0, 0.0], 0.0))
            self.found[slide.name] = [count + len(force), (sums + np.add.reduce(numbers, axis=1)).tolist(),
                                      max(longest, float(np.max(h)))]

    def _of(self, slide: SlideModel, q: np.ndarray, s: np.ndarray,
            force: np.ndarray) -> tuple[np.ndarray, ArrayLike]:
        """Return error, angle and tension (3, T), see `found`, and lengths of elements (T,), at coordinates q (T, n),
        arc-lengths s (T,) and forces on the rider (T,) in N.
        """
        at = self._on_cable(slide, q, s) if slide.coordinates is None else _on_rope(slide.coordinates, q, s)
        half = np.maximum(np.arccos(np.minimum(np.maximum(at.cosine, -1), 1)) / 2, ROUNDING)
        of = self._stiffness(slide)
        tension = np.maximum(np.maximum(of.EA * at.strain, force / (2 * np.sin(half))), 1e-300)
        angle = 2 * np.arcsin(np.minimum(force / (2 * tension), 1.0))
        longer = at.h * np.sqrt(tension / of.EI_strong)
        error = np.where(longer > 1, np.minimum(LENGTH_FACTOR * longer, ANGLE_FACTOR) * angle**2, 0.0)
        return np.array([error, angle, tension]), at.h

    def _on_cable(self, slide: SlideModel, q: np.ndarray, s: np.ndarray) -> _Beside:
        cable = self.model.cables[slide.cable]
        nodal, element = cable.nodal(q), cable.mesh.element_at(s)
        cosine, strain = around_elements(nodal, cable.vectors.index("r_x"), middle_strain(cable, nodal), element)
        return _Beside(cosine, strain, cable.mesh.each_length(element))

    def _line(self, slide: SlideModel) -> Cable | Rope:
        """Return the cable or rope of a slide."""
        name = self.scene.slides[slide.name].along
        return self.scene.cables[name] if slide.coordinates is None else self.scene.ropes[name]

    def _stiffness(self, slide: SlideModel) -> LineStiffness:
        return LineStiffness.of(self._line(slide), self.model.dim)

    def notes(self) -> list[str]:
        """Return a note for each slide with a large mean error."""
        notes = []
        for slide in self.model.slides:
            count, sums, h = self.found.get(slide.name, (0, [0.0, 0.0, 0.0], 0.0))
            error, angle, tension = (each / max(count, 1) for each in sums)
            if error <= FORCE_ERROR_LIMIT:
                continue
            part = self._line(slide)
            bent = float(np.sqrt(self._stiffness(slide).EI_strong / tension))
            such = f", such as elements={np.ceil(part.length / bent):.0f}" if isinstance(part, Cable) else ""
            notes.append(
                f'slide "{slide.name}": {part.where} turns there by {np.degrees(angle):.2g} degrees within '
                f"sqrt(EI/N) = {bent:.2g} m, which its elements of {h:.3g} m cannot follow: its tension may be "
                f"{100 * error:.2g} % off at rest, and far more as it slides from element to element. Take elements of "
                f"at most {bent:.2g} m where it slides{such}")
        return notes
