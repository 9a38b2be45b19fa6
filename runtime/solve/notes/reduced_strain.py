"""Compression of cables with a reduced axial strain beyond `STABILISATION`, up to which they are stable."""

from __future__ import annotations

import numpy as np

from ...model.middle_strain import gauss_rule, stretches
from ...model.model import CableModel
from ...parts.section_stiffness import STABILISATION, is_reduced
from .note import Note, Rows

GAUSS_RULE = gauss_rule(4)


class ReducedStrain(Note):
    """The largest compression of each cable with a reduced axial strain, of the mean strain of its elements, and its
    time in s.
    """

    measures = (CableModel,)
    assesses_rest = True

    def prepare(self) -> None:
        """Select the parts to measure."""
        self._cables = [cable for cable in self.model.cables if is_reduced(self.scene.cables[cable.name].law)]

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        for cable in self._cables:
            nodal = cable.strained(rows["q"])
            first, last = nodal[:, cable.mesh.first], nodal[:, cable.mesh.last]
            at_r = cable.vectors.index("r")
            strain = np.linalg.norm(last[:, :, at_r] - first[:, :, at_r], axis=-1) / cable.mesh.lengths - 1
            at = (strain < -STABILISATION).any(axis=1)  # of bent elements the chord is shorter than the centreline
            strain[at] = stretches(cable, first[at], last[at], np.arange(cable.n_elements), GAUSS_RULE) - 1
            k = int(np.argmin(strain.min(axis=1)))
            self.keep(cable.name, -strain[k].min(), rows["time"][k])

    def notes(self) -> list[str]:
        """Return a note for each cable that was compressed too much."""
        return [_note(name, "was", compression, f" at t = {time:.4g} s")
                for name, (compression, time) in self.found.items() if compression > STABILISATION]

    def notes_at_rest(self) -> list[str]:
        """Return a note for each cable that is compressed too much."""
        return [_note(name, "is", compression, "")
                for name, (compression, _) in self.found.items() if compression > STABILISATION]


def _note(name: str, verb: str, compression: float, when: str) -> str:
    return (f'cable "{name}" {verb} compressed by {compression:.2g} of its length{when}: membrane="reduced" keeps the '
            f'lengths of its slopes stable up to {STABILISATION:g} alone; take membrane="assumed" or "full"')
