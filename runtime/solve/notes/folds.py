"""Elements that are folded onto themselves, and those of states of rest that turn far.

A compressed element that cannot buckle in waves of its own length turns back on itself instead: its nodes are nearer to
each other than its centreline is long. Such a state is in balance, and may be stable, but it belongs to the few shapes
that an element has, and not to the cable. So does a state in which an element turns far. A rope of 30 m over a span of
10 m pulls by 34 % too little with four elements, of which two turn by 94 degrees, by 10 % with six (82 degrees), by 4 %
with eight (73 degrees), and by 0.1 % with 20 (43 degrees).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...engine import Engine, chord_lengths
from ...model.middle_strain import gauss_rule, slopes, slopes_at, stretches
from ...model.model import CableModel
from .note import Note, Rows, element_place

FOLDED_CHORD = 0.8
"""An element is folded where its chord is shorter than this fraction of its centreline: an arc of 130 degrees."""
MAX_ELEMENT_TURN = np.radians(75.0)
"""Turn of the tangent within an element, in rad, above which the element is too long for the shape at rest."""
ACCURATE_ELEMENT_TURN = np.radians(45.0)
"""Turn of the tangent within an element, in rad, up to which the shape is accurate to about 0.1 %."""
TANGENT_POSITIONS = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Positions of the compared tangents, as fractions of the length of an element."""
GAUSS_RULE = gauss_rule(8)
"""Rule for the length of a centreline whose slope reverses in a folded element."""


class Folds(Note):
    """The element of each cable that was folded most: 1 less the ratio of its chord to its length, the time in s, and
    the number of the element.

    An element that is short because it is compressed evenly is not folded, nor is one that is as bent without stress.
    Cables that give way in compression are left out: how they lie where they are slack is not known.
    """

    measures = (CableModel,)
    assesses_rest = True

    def prepare(self) -> None:
        """Select the cables, with the chords in m of their elements without stress."""
        self._turned: list[str] = []
        self._cables: list[tuple[CableModel, np.ndarray]] = []
        for cable in self.model.cables:
            part = self.scene.cables[cable.name]
            if not cable.gives_way:
                self._cables.append((cable, cable.mesh.all_lengths if not part.is_curved
                                     else chord_lengths(part.rest_nodal_vectors[None, :, cable.vectors.index("r")])[0]))

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        for cable, unstressed in self._cables:
            chords = chord_lengths(cable.positions(rows["q"]), cable.ends_of_elements)
            is_folded = chords <= FOLDED_CHORD * unstressed
            if not is_folded.any():
                continue
            at, element = np.nonzero(is_folded)
            nodal, lengths = cable.nodal(rows["q"]), cable.mesh.each_length(element)
            node = cable.mesh.first_node(element)
            stretch = stretches(cable, nodal[at, node], nodal[at, node + 1], element, GAUSS_RULE)
            arc = np.maximum(stretch, np.finfo(float).tiny) * lengths
            ratio = chords[at, element] / arc * (lengths / unstressed[element])
            k = int(np.argmin(ratio))
            if ratio[k] <= FOLDED_CHORD:
                self.keep(cable.name, 1 - ratio[k], rows["time"][at[k]], element[k])

    def see_rest(self, rows: Rows, engine: Engine) -> None:
        """Measure a state of rest, with the turns of its elements that are not folded."""
        self.see(rows)
        self._turned = [text for cable, _ in self._cables if cable.name not in self.found
                        for text in self._far_turns(cable, rows["q"])]

    def notes(self) -> list[str]:
        """Return a note for each cable with a folded element."""
        return [f"{where} at t = {time:.4g} s: what follows is that of few elements, not of the cable. Take more "
                f"elements there, or {'a larger' if cable.tau else 'a'} damping_time in the material"
                for cable, where, time in self._worst()]

    def notes_at_rest(self) -> list[str]:
        """Return a note for each cable with an element that is folded, or turns far."""
        return [*(f"{where}: the state may be none of the cable. Draw the scene nearer to its rest, take more "
                  "elements, or begin from another state" for _, where, _ in self._worst()), *self._turned]

    def _worst(self) -> Iterator[tuple[CableModel, str, float]]:
        for cable, _ in self._cables:
            if cable.name in self.found:
                fold, time, element = self.found[cable.name]
                yield (cable, f'cable "{cable.name}" is folded onto itself in {element_place(cable, int(element))}: '
                       f"its nodes are {1 - fold:.2g} of its length from each other", time)

    def _far_turns(self, cable: CableModel, q: np.ndarray) -> Iterator[str]:
        """Yield a note where an element at coordinates q (1, n) turns far beyond its shape without stress."""
        part, turns = self.scene.cables[cable.name], _turns(cable, cable.nodal(q))
        if part.is_curved:
            turns = turns - _turns(cable, part.rest_nodal_vectors[None])
        k = int(np.argmax(turns))
        if turns[k] > MAX_ELEMENT_TURN:
            length = cable.mesh.length(k) * ACCURATE_ELEMENT_TURN / turns[k]
            yield (f'cable "{cable.name}" turns by {np.degrees(turns[k]):.0f} degrees within '
                   f"{element_place(cable, k)}: the state is that of few elements, not of the cable. Take elements of "
                   f"at most {length:.2g} m there")


def _turns(cable: CableModel, nodal: np.ndarray) -> np.ndarray:
    """Return (elements,): the largest angle in rad between tangents of each element; nodal: (1, nodes, vectors, dim).
    """
    tangents = slopes_at(cable, nodal, slopes(cable, *TANGENT_POSITIONS))[:, 0]
    tangents /= np.maximum(np.linalg.norm(tangents, axis=-1, keepdims=True), np.finfo(float).tiny)
    cosines = np.einsum("aed,bed->eab", tangents, tangents).min(axis=(1, 2))
    return np.asarray(np.arccos(np.clip(cosines, -1, 1)))
