"""Slides over which a taut cable or rope turns more sharply than its elements can.

Under a force at a point a cable of tension N turns within sqrt(EI/N). A longer element cuts the corner, by more or less
as the point moves through it: that is a force along the cable, and none of the rope's. A rope in balance over an eyelet
without friction has one tension; with elements of h the two sides differ by up to 0.02 a² h/sqrt(EI/N), and not by more
than 0.08 a², a the angle in rad by which the rope turns. Measured for a of 2 to 90 degrees, EA/N of 100 to 10,000, and
h/sqrt(EI/N) of 0.5 to 8. While the rope slides, each node that passes the point is a shock.
"""

from __future__ import annotations

from operator import add
from typing import NamedTuple

import numpy as np

from ...base.rotations import sizes
from ...engine import around_elements, outputs_by_name, turned_tension
from ...model.middle_strain import middle_strain
from ...model.model import SlideModel
from ...model.span_coordinates import PER_NODE, SpanCoordinates
from ...parts.cable import Cable
from ...parts.rope import Rope
from .coarse_meshes import FORCE_ERROR_LIMIT, ROW_INTERVAL
from .note import LineStiffness, Note, Rows

LENGTH_FACTOR, ANGLE_FACTOR = 0.02, 0.08
"""Difference of the tensions over the squared angle times h/sqrt(EI/N), and its upper bound over the squared angle."""
ROUNDING = float(np.finfo(float).eps)
"""Lower bound of the angle, in rad."""


class _Beside(NamedTuple):
    """The cosine of the angle between the slopes of a line before and after a slide, its strain, (T,), and the length
    of the element that has the slide in m, (1 or T,).
    """

    cosine: np.ndarray
    strain: np.ndarray
    h: np.ndarray


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
        for slide, s, force in zip(self.model.slides, rows["s"].T, forces.T, strict=True):
            of, at = self._stiffness(slide), self._beside(slide, rows["q"], s)
            added = turned_tension(at.cosine, at.strain, force, at.h, of.EA, of.EI_strong, LENGTH_FACTOR, ANGLE_FACTOR,
                                   ROUNDING)
            count, sums, longest = self.found.get(slide.name, (0, [0.0, 0.0, 0.0], 0.0))
            self.found[slide.name] = [count + len(force), [*map(add, sums, added)], max(longest, float(at.h.max()))]

    def _beside(self, slide: SlideModel, q: np.ndarray, s: np.ndarray) -> _Beside:
        """Return the line beside a slide, at coordinates q (T, n) and arc-lengths s (T,)."""
        if slide.coordinates is not None:
            return _on_rope(slide.coordinates, q, s)
        cable = self.model.cables[slide.cable]
        nodal, element = cable.strained(q), cable.mesh.element_at(s)
        ends = nodal if not cable.mesh.doubled else nodal[:, cable.mesh.nodes_of_boundaries]
        cosine, strain = around_elements(ends, cable.vectors.index("r_x"), middle_strain(cable, nodal), element)
        return _Beside(cosine, strain, cable.mesh.lengths if cable.mesh.is_even else cable.mesh.lengths[element])

    def _line(self, slide: SlideModel) -> Cable | Rope:
        """Return the cable or rope of a slide."""
        name = self.scene.slides[slide.name].along
        return self.scene.cables[name] if slide.coordinates is None else self.scene.ropes[name]

    def _stiffness(self, slide: SlideModel) -> LineStiffness:
        """Return the least stiffness along the line of a slide."""
        return LineStiffness.of(self._line(slide), self.model.dim).least

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
