"""Struts that a run left perfectly straight though they are compressed beyond their buckling load.

Without any disturbance across it a straight strut stays straight, at any load: a result of the model, and none of the
strut. Whether it would buckle is counted by the inertia of its stiffness, as in statics.
"""

from __future__ import annotations

import numpy as np

from ...engine import Engine, straight_rows
from ...model.model import CableModel, Model
from ...parts.cable import Cable
from ...parts.section_stiffness import compressive_stiffness
from ..linear.condensation import condensed
from .note import LineStiffness, Note, Rows

STRAIGHTNESS_TOLERANCE = 1e-9
"""Nodes lie on the line between the ends if their distance from it is below this fraction of the length."""

MIN_SQUARED_DEFLECTION = 1e-12
"""Lower bound of the squared deflection of the middle node of a bent strut, as a fraction of the squared length."""


class StraightStruts(Note):
    """Whether each cable is straight in the last row; of those that were perfectly straight at two consecutive output
    times the largest compression in N, with its time in s, the coordinates and the slides' arc-lengths.
    """

    measures = (CableModel,)

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        for cable in self.model.cables:
            part = self.scene.cables[cable.name]
            if part.is_curved:
                continue
            r = cable.positions(rows["q"])
            before, worst = self.found.get(cable.name, (False, None))
            straight = _straight(r, before)
            if straight.any() and len(at := np.flatnonzero(straight & np.append(before, straight[:-1]))):
                # at two times: else something bends it
                chord = r[at][:, cable.mesh.last] - r[at][:, cable.mesh.first]
                grown = cable.growth_in(rows["q"][at]) * cable.mesh.all_lengths
                shortening = 1 - np.linalg.norm(chord, axis=2) / grown
                forces = (_compressive_stiffness(part) * shortening).max(axis=1)
                k, force = at[np.argmax(forces)], float(forces.max())
                bearable = np.min(LineStiffness.of(part, 3).EI_weak) / cable.mesh.total**2
                # a cantilever buckles at 2.47 times what counts as bearable
                if force >= bearable and (worst is None or force > worst[0]):
                    worst = [force, float(rows["time"][k]), rows["q"][k].tolist(), rows["s"][k].tolist()]
            self.found[cable.name] = [bool(straight[-1]), worst]

    def notes(self) -> list[str]:
        """Return a note for each of them that would buckle at the time at which it is compressed most."""
        notes = []
        for cable in self.model.cables:
            _, worst = self.found.get(cable.name, (False, None))
            if worst is None:
                continue
            force, time, q, s = worst
            try:
                buckles = _unstable(self.model, cable, time, np.array(q), np.array(s))
            except ArithmeticError:  # no factorisation is accurate enough to count
                continue
            if buckles:
                notes.append(f'cable "{cable.name}" is perfectly straight at t = {time:.6g} s under a compression of '
                             f"{force:.4g} N, beyond its buckling load ({buckles} independent direction"
                             f"{'s lower' if buckles > 1 else ' lowers'} its energy): nothing in the scene bends it. "
                             "Draw it slightly bent, or add a small force across it")
        return notes


def _compressive_stiffness(part: Cable) -> np.ndarray:
    """Return (elements,): the axial stiffness in compression of each element, in N."""
    membrane = part.traits.membrane
    return part.of_elements(lambda piece: compressive_stiffness(membrane, piece.section, piece.material))


def _straight(r: np.ndarray, before: bool) -> np.ndarray:
    """Return (times,): whether nodes r (times, nodes, dim) lie in order on a line, also at the time before or after;
    before: whether they did so before the first time.

    The middle node excludes most states; all nodes are compared in the others only.
    """
    straight = straight_rows(r, MIN_SQUARED_DEFLECTION, before)
    if straight.any():
        straight[straight] = _on_line(r[straight])
    return straight


def _on_line(r: np.ndarray) -> np.ndarray:
    """Return (times,): whether all nodes r (times, nodes, dim) lie on the line through the first and the last."""
    chord = r[:, -1] - r[:, 0]
    length = np.linalg.norm(chord, axis=1)
    offset = r - r[:, :1]
    along = np.einsum("tnd,td->tn", offset, chord) / np.where(length > 0, length, 1.0)[:, None] ** 2
    off = np.linalg.norm(offset - along[:, :, None] * chord[:, None], axis=2).max(axis=1)
    return np.asarray((off <= STRAIGHTNESS_TOLERANCE * length) & np.all(np.diff(along, axis=1) > 0, axis=1))


def _unstable(model: Model, cable: CableModel, t: float, q: np.ndarray, s: np.ndarray) -> int:
    """Return the number of directions that lower the energy of a cable; all else is fixed, forces are left out."""
    from ..linear.inertia import inertia  # imports SciPy, which most runs do without

    engine = Engine(model)
    engine.set_state(t, q=q, s=s)
    K, C = condensed(engine.matrix(0.0, 0.0, 1.0), model)
    unknown = model.unknown_of_dof[cable.coordinates]
    own = np.unique(unknown[unknown >= 0])
    units = np.ones(K.shape[0])
    units[unknown[unknown >= 0]] = model.weight[cable.coordinates][unknown >= 0]
    K = K.tocsr()[own][:, own]
    return inertia((K + K.T) / 2, C.tocsc()[:, own], units[own]).negative
