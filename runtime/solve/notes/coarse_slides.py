"""Slides over which a taut cable turns more sharply than its elements can.

Under a force at a point a cable of tension N turns within sqrt(EI/N). A longer element cuts the corner, by more or less
as the point moves through it: that is a force along the cable, and none of the rope's. A rope in balance over an eyelet
without friction has one tension; with elements of h the two sides differ by up to 0.02 a² h/sqrt(EI/N), and not by more
than 0.08 a², a the angle in rad by which the rope turns. Measured for a of 2 to 90 degrees, EA/N of 100 to 10,000, and
h/sqrt(EI/N) of 0.5 to 8. While the rope slides, each node that passes the point is a shock.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...engine import outputs_by_name
from ...model.middle_strain import middle_strain
from ...model.model import Model, SlideModel
from ...parts.cable import Cable
from ...parts.scene_data import SceneData
from .coarse_meshes import FORCE_ERROR_LIMIT, ROW_INTERVAL

LENGTH_FACTOR, ANGLE_FACTOR = 0.02, 0.08
"""Difference of the tensions over the squared angle times h/sqrt(EI/N), and its upper bound over the squared angle."""


class CoarseSlides:
    """Sees how sharply cables turn at slides in the rows of a run; notes where elements are too long for that.

    found: by the slide's name the rows seen, sums over those looked at of the error, of the angle in rad and of the
    tension in N, and the length of the longest element in m.
    """

    def __init__(self, scene: SceneData, model: Model):
        self._scene, self._model = scene, model
        self.found: dict[str, Any] = {}

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows."""
        if self._model.slides:
            self.take(rows["q"], rows["s"], outputs_by_name("slide", rows["slide"])["force"])

    def take(self, q: np.ndarray, s: np.ndarray, force: np.ndarray, every: int = ROW_INTERVAL) -> None:
        """Take further states: coordinates (T, n), arc-lengths (T, slides) and forces on riders (T, slides, 3)."""
        for k, slide in enumerate(self._model.slides):
            seen, sums, longest = self.found.get(slide.name, (0, [0.0, 0.0, 0.0], 0.0))
            at = np.flatnonzero((seen + np.arange(len(q))) % every == 1 % every)
            if len(at):
                numbers, h = self._of(slide, q[at], s[at, k], np.linalg.norm(force[at, k], axis=-1))
                sums, longest = (np.array(sums) + numbers.sum(axis=0)).tolist(), max(longest, float(h.max()))
            self.found[slide.name] = [seen + len(q), sums, longest]

    def _of(self, slide: SlideModel, q: np.ndarray, s: np.ndarray, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return error, angle and tension (T, 3), see `found`, and lengths of elements (T,), at states q (T, n), s (T,)
        and forces in N (T,).
        """
        cable = self._model.cables[slide.cable]
        part, n, rows = self._scene.cables[cable.name], cable.n_elements, np.arange(len(q))
        vectors = q[:, cable.coordinates].reshape(-1, *cable.shape)
        element = np.array([int(cable.mesh.element_at(float(each))) for each in s])
        first, last = np.maximum(element - 1, 0), np.minimum(element + 2, n)
        slopes = vectors[:, :, cable.vectors.index("r_x")]
        one, other = slopes[rows, first], slopes[rows, last]
        lengths = np.linalg.norm(one, axis=-1) * np.linalg.norm(other, axis=-1)
        cosine = np.einsum("td,td->t", one, other) / np.where(lengths > 0, lengths, 1.0)
        half = np.maximum(np.arccos(np.clip(cosine, -1, 1)) / 2, np.finfo(float).eps)
        EA, EI = self._stiffness(part)
        mean = np.cumsum(np.pad(middle_strain(cable, vectors), ((0, 0), (1, 0))), axis=1)
        strain = (mean[rows, last] - mean[rows, first]) / (last - first)
        tension = np.maximum(np.maximum(EA * strain, force / (2 * np.sin(half))), 1e-300)
        angle = 2 * np.arcsin(np.minimum(force / (2 * tension), 1.0))
        h = np.broadcast_to(cable.mesh.lengths, n)[element]
        longer = h * np.sqrt(tension / EI)
        error = np.where(longer > 1, np.minimum(LENGTH_FACTOR * longer, ANGLE_FACTOR) * angle**2, 0.0)
        return np.stack([error, angle, tension], axis=1), h

    def _stiffness(self, part: Cable) -> tuple[float, float]:
        """Return EA in N and the larger EI in N m²."""
        E, moments = part.material.youngs_modulus, part.section.moments()
        return E * float(moments[0]), E * float(moments[1] if self._model.dim == 2 else max(moments[1:3]))

    def notes(self) -> list[str]:
        """Return a note for each slide at which errors are large, on the mean over what was looked at."""
        return self.told(ROW_INTERVAL)

    def told(self, every: int) -> list[str]:
        """Return the same of states of which each or each `every`-th was looked at."""
        notes = []
        for slide in self._model.slides:
            seen, sums, h = self.found.get(slide.name, (0, [0.0, 0.0, 0.0], 0.0))
            looked = (seen - 1 - 1 % every) // every + 1
            if looked <= 0 or sums[0] <= FORCE_ERROR_LIMIT * looked:
                continue
            part = self._scene.cables[self._model.cables[slide.cable].name]
            error, angle, tension = (each / looked for each in sums)
            bent = float(np.sqrt(self._stiffness(part)[1] / tension))
            notes.append(
                f'slide "{slide.name}": cable "{part.name}" turns there by {np.degrees(angle):.2g} degrees within '
                f"sqrt(EI/N) = {bent:.2g} m, which its elements of {h:.3g} m cannot follow: its tension may be "
                f"{100 * error:.2g} % off at rest, and far more as it slides from element to element. Take elements of "
                f"at most {bent:.2g} m where it slides, such as elements={np.ceil(part.length / bent):.0f}")
        return notes


def coarse_at_slides(scene: SceneData, model: Model, state: dict[str, np.ndarray]) -> list[str]:
    """Return the notes on a state of rest: coordinates q (n,), arc-lengths s and forces on riders of slides."""
    found = CoarseSlides(scene, model)
    found.take(state["q"][None], state["s"][None], state["slide"][None], every=1)
    return found.told(every=1)
