"""What a reduced axial strain cannot bear: compression beyond its stabilisation, see `stiffness.STABILISATION`."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...model.middle_strain import stretches
from ...model.model import CableModel, Model
from ...parts.scene_data import SceneData
from ...parts.section_stiffness import STABILISATION, is_reduced

GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)
GAUSS_RULE = (0.5 * (1 + GAUSS_POINTS)).tolist(), (0.5 * GAUSS_WEIGHTS).tolist()
"""Gauss rule on an element, as fractions of its length."""


class ReducedStrain:
    """The largest compression of each cable with a reduced axial strain, of the mean strain of its elements.

    found: strain and time in s, by the cable's name.
    """

    def __init__(self, scene: SceneData, model: Model):
        self._cables = [cable for cable in model.cables if is_reduced(scene.cables[cable.name].law)]
        self.found: dict[str, Any] = {}

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows."""
        for cable in self._cables:
            nodes = rows["q"][:, cable.coordinates].reshape(-1, *cable.shape)[:, :, cable.vectors.index("r")]
            chords = np.linalg.norm(np.diff(nodes, axis=1), axis=-1) / cable.mesh.lengths - 1
            for row in np.flatnonzero((chords < -STABILISATION).any(axis=1)):  # of bent elements the chord is shorter
                chords[row] = _strain(cable, rows["q"][row])
            strain = chords.min(axis=1)
            k = int(np.argmin(strain))
            if cable.name not in self.found or strain[k] < self.found[cable.name][0]:
                self.found[cable.name] = [float(strain[k]), float(rows["time"][k])]

    def notes(self) -> list[str]:
        """Return a note for each cable that was compressed too much."""
        return [_note(name, "was", strain, f" at t = {time:.4g} s")
                for name, (strain, time) in self.found.items() if strain < -STABILISATION]


def _strain(cable: CableModel, q: np.ndarray) -> np.ndarray:
    """Return (elements,): by how much centrelines are longer than at rest, over that."""
    vectors = q[cable.coordinates].reshape(cable.shape)
    return stretches(cable, vectors[:-1], vectors[1:], np.arange(cable.n_elements), GAUSS_RULE) - 1


def compressed(scene: SceneData, model: Model, q: np.ndarray) -> list[str]:
    """Return a note for each cable that is compressed too much in a state of rest, q (n_q,)."""
    strains = ReducedStrain(scene, model)
    strains.see({"q": q[None], "time": np.zeros(1)})
    return [_note(name, "is", strain, "") for name, (strain, _) in strains.found.items() if strain < -STABILISATION]


def _note(name: str, verb: str, strain: float, when: str) -> str:
    return (f'cable "{name}" {verb} compressed by {-strain:.2g} of its length{when}: membrane="reduced" keeps the '
            f'lengths of its slopes stable up to {STABILISATION:g} alone; take membrane="assumed" or "full"')
