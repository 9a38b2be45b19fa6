"""Elements that are folded onto themselves: their nodes are nearer to each other than their centreline is long.

A compressed element that cannot buckle in waves of its own length turns back on itself instead. Such a state is in
balance, and may be stable, but it belongs to the few shapes that an element has, and not to the cable.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..model.middle_strain import stretches
from ..model.model import CableModel, Model
from ..parts.scene_data import SceneData

FOLDED = 0.8
"""Of the length of the centreline: elements whose nodes are nearer to each other are folded: an arc of 130 degrees."""
PLACES, WEIGHTS = np.polynomial.legendre.leggauss(8)
GAUSS = (0.5 * (1 + PLACES)).tolist(), (0.5 * WEIGHTS).tolist()
"""Of the length of a centreline, whose slope turns round in a folded element."""


class Folds:
    """The element of each cable that was folded most, and when.

    An element that is short because it is compressed evenly is not folded, nor is one that is as bent without stress.
    Cables that give way in compression are left out: how they lie where they are slack is not known.

    found: ratio of the distance of nodes to the length of the centreline, element and time in s, by the cable's name.
    """

    def __init__(self, scene: SceneData, model: Model):
        self._cables: list[tuple[CableModel, np.ndarray]] = []
        for cable in model.cables:
            part = scene.cables[cable.name]
            if part.traits.membrane != "tension_only":
                lengths = np.broadcast_to(cable.mesh.lengths, cable.n_elements)
                self._cables.append((cable, lengths if not part.is_curved else
                                     _distances(part.rest_nodal_vectors[:, cable.vectors.index("r")])))
        self.found: dict[str, Any] = {}

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows."""
        for cable, apart in self._cables:
            vectors = rows["q"][:, cable.coordinates].reshape(-1, *cable.shape)
            chords = _distances(vectors[:, :, cable.vectors.index("r")])
            at, element = np.nonzero(chords <= FOLDED * apart)
            if not len(at):
                continue
            length = _arc_lengths(cable, vectors[at, element], vectors[at, element + 1], element)
            ratio = chords[at, element] / length * (cable.mesh.each_length(element) / apart[element])
            k = int(np.argmin(ratio))
            if ratio[k] <= self.found.get(cable.name, [FOLDED])[0]:
                self.found[cable.name] = [float(ratio[k]), int(element[k]), float(rows["time"][at[k]])]

    def notes(self) -> list[str]:
        """Return a note for each cable with a folded element."""
        return [f"{where} at t = {time:.4g} s: what follows is that of few elements, not of the cable. Take more "
                f"elements there, or {'a larger' if cable.tau else 'a'} damping_time in the material"
                for cable, where, time in self._worst()]

    def of_rest(self) -> list[str]:
        """Return the same of a state of rest."""
        return [f"{where}: the state may be none of the cable. Draw the scene nearer to its rest, take more elements, "
                "or begin from another state" for _, where, _ in self._worst()]

    def _worst(self) -> Iterator[tuple[CableModel, str, float]]:
        for cable, _ in self._cables:
            if cable.name in self.found:
                ratio, element, time = self.found[cable.name]
                start = cable.mesh.start(element)
                yield (cable, f'cable "{cable.name}" is folded onto itself in element {element}, from s = {start:.6g} '
                       f"m to {start + cable.mesh.length(element):.6g} m: its nodes are {ratio:.2g} of its length from "
                       "each other", time)


def folds(scene: SceneData, model: Model, q: np.ndarray) -> list[str]:
    """Return the notes on a state of rest at a configuration (n,)."""
    found = Folds(scene, model)
    found.see({"q": q[None], "time": np.zeros(1)})
    return found.of_rest()


def _distances(r: np.ndarray) -> np.ndarray:
    """Return (..., elements): how far nodes (..., nodes, dim) are from the next ones, in m."""
    return np.linalg.norm(np.diff(r, axis=-2), axis=-1)


def _arc_lengths(cable: CableModel, first: np.ndarray, last: np.ndarray, element: np.ndarray) -> np.ndarray:
    """Return (n,): lengths in m of the centrelines of elements (n,) with these vectors of nodes, (n, vectors, dim)."""
    stretch = stretches(cable, first, last, element, GAUSS)
    return np.maximum(stretch, np.finfo(float).tiny) * cable.mesh.each_length(element)
