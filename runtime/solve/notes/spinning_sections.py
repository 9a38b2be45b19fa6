"""Thin beams whose elements are too long for their torsion, in runs; `statics.spinning_sections` has states of rest.

Where an element bends by an angle a under the tension N, a twist between its nodes turns the half-way frame away from
the chord, which lets the element lengthen: N (a L)² times a small number, against the torsional stiffness GJ. In beams
far thinner than their elements are long, sections then spin though nothing twists them: an instability of the mesh,
which ends as elements become shorter.
"""

from __future__ import annotations

import numpy as np

from ...model.model import CableModel
from ...parts.cable import Cable
from .note import Note, Rows

STABLE_RATIO = 20.0
"""N (a L)²/GJ up to which sections rest: ropes of 0.1 to 10 mm over 100 m do so at 19 to 49, and spin at 120."""
UNSTABLE_RATIO = 60.0
"""N (a L)²/GJ above which a note reports a run."""
LAW = "structural"
"""The law whose half-way frame the twist turns; the laws of a continuum have none."""


class SpinningSections(Note):
    """The largest N (a L)²/GJ of each thin beam, and its time in s."""

    measures = (CableModel,)

    def prepare(self) -> None:
        """Select the parts to measure."""
        self._cables = {cable.name: cable for cable in self.model.cables
                        if has_sections(cable) and str(self.scene.cables[cable.name].law).startswith(LAW)}

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        for name, cable in self._cables.items():
            ratios = torsion_ratio(cable, self.scene.cables[name], cable.nodal(rows["q"]))
            k = int(np.argmax(ratios))
            self.keep(name, ratios[k], rows["time"][k])

    def notes(self) -> list[str]:
        """Return a note for each cable whose sections may spin."""
        return [f'cable "{name}": elements of {self._cables[name].mesh.lengths.max():.3g} m are too long for the '
                "torsion of so thin a beam: sections may spin, and errors may grow from rounding (N (a L)²/GJ reached "
                f"{ratio:.3g} at t = {time:.4g} s; up to {STABLE_RATIO:g} is stable); take elements of at most "
                f'{stable_length(self._cables[name], ratio):.2g} m, or element="cable12", which has no torsion'
                for name, (ratio, time) in self.found.items() if ratio > UNSTABLE_RATIO]


def has_sections(cable: CableModel) -> bool:
    """Return whether a cable has directors of its sections."""
    return {"r_y", "r_z"} <= set(cable.vectors)


def torsion_ratio(cable: CableModel, part: Cable, nodal: np.ndarray) -> np.ndarray:
    """Return (...): the largest N (a L)²/GJ of the elements at nodal vectors (..., nodes, vectors, 3)."""
    slope, mesh = nodal[..., cable.vectors.index("r_x"), :], cable.mesh
    stretch = np.linalg.norm(slope, axis=-1)
    tangent = slope / stretch[..., None]
    angle = np.arccos(np.clip((tangent[..., mesh.last, :] * tangent[..., mesh.first, :]).sum(axis=-1), -1.0, 1.0))
    strain = (stretch[..., mesh.last] + stretch[..., mesh.first]) / 2 - 1.0
    tension = part.of_elements(lambda piece: piece.material.youngs_modulus * piece.section.area) * strain
    torsion = part.of_elements(lambda piece: piece.material.lame()[1] * piece.section.torsion_constant)
    return np.asarray((tension * (angle * mesh.lengths) ** 2 / torsion).max(axis=-1))


def stable_length(cable: CableModel, ratio: float) -> float:
    """Return the longest stable element in m where the present ones have this ratio, which grows as the fourth power.
    """
    return float(cable.mesh.lengths.max()) * (STABLE_RATIO / ratio) ** 0.25 if ratio > 0.0 else np.inf
