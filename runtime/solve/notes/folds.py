"""Elements that are folded onto themselves, and those of states of rest that turn far.

A compressed element that cannot buckle in waves of its own length turns back on itself instead: its nodes are nearer to
each other than its centreline is long. Such a state is in balance, and may be stable, but it belongs to the few shapes
that an element has, and not to the cable. So does a state in which an element turns far. A rope of 30 m over a span of
10 m pulls by 34 % too little with four elements, of which two turn by 94 degrees, by 10 % with six (82 degrees), by 4 %
with eight (73 degrees), and by 0.1 % with 20 (43 degrees).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ...model.middle_strain import slopes, stretches
from ...model.model import CableModel, Model
from ...parts.scene_data import SceneData

FOLDED_CHORD = 0.8
"""An element is folded where its chord is shorter than this fraction of its centreline: an arc of 130 degrees."""
MAX_ELEMENT_TURN = np.radians(75.0)
"""Turn of the tangent within an element, in rad, above which the element is too long for the shape at rest."""
ACCURATE_ELEMENT_TURN = np.radians(45.0)
"""Turn of the tangent within an element, in rad, up to which the shape is accurate to about 0.1 %."""
TANGENT_POSITIONS = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Positions of the compared tangents, as fractions of the length of an element."""
GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(8)
GAUSS_RULE = (0.5 * (1 + GAUSS_POINTS)).tolist(), (0.5 * GAUSS_WEIGHTS).tolist()
"""Gauss rule for the length of a centreline whose slope reverses in a folded element."""


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
            at, element = np.nonzero(chords <= FOLDED_CHORD * apart)
            if not len(at):
                continue
            length = _arc_lengths(cable, vectors[at, element], vectors[at, element + 1], element)
            ratio = chords[at, element] / length * (cable.mesh.each_length(element) / apart[element])
            k = int(np.argmin(ratio))
            if ratio[k] <= self.found.get(cable.name, [FOLDED_CHORD])[0]:
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
    return [*found.of_rest(), *_turned(scene, model, q, set(found.found))]


def _turned(scene: SceneData, model: Model, q: np.ndarray, folded: set[str]) -> Iterator[str]:
    """Yield a note for each cable, none that is folded, with an element that turns far beyond its shape without stress.
    """
    for cable in model.cables:
        part = scene.cables[cable.name]
        if cable.name in folded or part.traits.membrane == "tension_only":
            continue
        turns = _turns(cable, q[cable.coordinates].reshape(cable.shape))
        if part.is_curved:
            turns = turns - _turns(cable, part.rest_nodal_vectors)
        k = int(np.argmax(turns))
        if turns[k] > MAX_ELEMENT_TURN:
            start, length = cable.mesh.start(k), cable.mesh.length(k)
            yield (f'cable "{cable.name}" turns by {np.degrees(turns[k]):.0f} degrees within element {k}, from s = '
                   f"{start:.6g} m to {start + length:.6g} m: the state is that of few elements, not of the cable. "
                   f"Take elements of at most {length * ACCURATE_ELEMENT_TURN / turns[k]:.2g} m there")


def _turns(cable: CableModel, vectors: np.ndarray) -> np.ndarray:
    """Return (elements,): the largest angle in rad between tangents of each element; vectors: (nodes, vectors, dim)."""
    e = np.concatenate([vectors[:-1], vectors[1:]], axis=1)
    tangents = np.stack([np.einsum("ek,ekd->ed", np.broadcast_to(slopes(cable, part), e.shape[:2]), e)
                         for part in TANGENT_POSITIONS])
    tangents /= np.maximum(np.linalg.norm(tangents, axis=-1, keepdims=True), np.finfo(float).tiny)
    cosines = np.einsum("aed,bed->eab", tangents, tangents).min(axis=(1, 2))
    return np.arccos(np.clip(cosines, -1, 1))


def _distances(r: np.ndarray) -> np.ndarray:
    """Return (..., elements): how far nodes (..., nodes, dim) are from the next ones, in m."""
    return np.linalg.norm(np.diff(r, axis=-2), axis=-1)


def _arc_lengths(cable: CableModel, first: np.ndarray, last: np.ndarray, element: np.ndarray) -> np.ndarray:
    """Return (n,): lengths in m of the centrelines of elements (n,) with these vectors of nodes, (n, vectors, dim)."""
    stretch = stretches(cable, first, last, element, GAUSS_RULE)
    return np.maximum(stretch, np.finfo(float).tiny) * cable.mesh.each_length(element)
