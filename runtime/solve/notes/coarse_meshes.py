"""Meshes that are too coarse for the forces in a cable, by the axial strain within elements.

An element that cannot represent the shape of its cable has an axial strain that oscillates along its length. The energy
of this oscillation, E = 1/2 EA ∫(strain - its line of best fit)² ds, is an error of the mesh: a finer mesh has less of
it. In cables at rest, forces err by about 15 E/W, with the work of the tension W = ∫N ds - N c + ∫N²/EA ds, where c is
the distance of the supports. Measured on hanging lines of 1.1 to 3 times their span against the closed form: the worst
component of the force at the pin errs by a third to three times that, where it errs by 1 % to 50 %. At a point load the
rope has a corner; forces err by 45 E/W where it lies in the middle of an element, else by 9 E/W, against finer meshes.
The bending stiffness rounds the corner over b = sqrt(EI/N): elements of length h err by 1 + 25 b/h times less. Bending
and motion bear forces, too: half of their energies counts. The moment at the clamp of a strip that hangs down errs by
43, 11, 1.9 and 0.09 % with 2, 4, 8 and 16 elements; the note estimates 21, 8.2, 2.6 and 0.14 %.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ...engine import chord_lengths, moments_along, quadratic_forms, tension_work
from ...kernels.mesh import Mesh
from ...model.middle_strain import gauss_rule, strains_at
from ...model.model import CableModel, Model, per_grown
from ...model.states import element_coordinates
from ...parts.locations import attached
from ...parts.scene_data import SceneData
from .note import LineStiffness, Note, Rows

STRAIN_RULE = gauss_rule(5)
STRAIN_POSITIONS, STRAIN_WEIGHTS = (np.array(each) for each in STRAIN_RULE)
"""Gauss points and weights of the strain, as fractions of the length of an element."""
WORK_ERROR_FACTOR, ENERGY_ERROR_FACTOR = 15.0, 2.0
"""Error of forces over E/W, with W the work of the tension, and with W the energies of bending and of motion."""
FORCE_ERROR_LIMIT = 0.01
"""Relative error of forces above which a note reports the mesh."""
FORCE_ERROR_TARGET = 0.005
"""Relative error of forces with the mesh that a note recommends."""
SMOOTH_SHAPE_POWER, CORNER_POWER = 0.25, 1.0
"""Element length scales with the error to this power: along a smooth shape, and at a corner."""
MID_ELEMENT_FACTOR, NODE_FACTOR = 3.0, 0.6
"""Error at a corner over 15 E/W: for a corner in the middle of an element, and for one at or near a node."""
BENDING_LENGTH_FACTOR = 25.0
"""The bending length sqrt(EI/N) over the element length, times this factor, reduces the error at a corner."""
ENERGY_ROUNDING = 1e-22
"""Rounding error of the energy, as a fraction of EA times the length."""
ROW_INTERVAL = 8
"""The mesh is assessed in one of this number of output rows."""


class _Strains:
    """The axial strain of one cable, its energy, and the energies of bending and motion."""

    def __init__(self, scene: SceneData, model: Model, cable: CableModel):
        self.cable, self.part = cable, scene.cables[cable.name]
        self.EA, self.EI, *_ = LineStiffness.of(self.part, model.dim)
        self.h = cable.mesh.all_lengths
        self.half_stiffness = 0.5 * self.EA * self.h
        self.supported = sorted(self.part.boundary(each.s)
                                for each in scene.supports if each.cable == cable.name)
        self.is_slack_in_compression = cable.gives_way
        if self.part.is_curved:
            self.drawn = self._strain(self.part.rest_nodal_vectors[None])
        self.scene = scene

    @property
    def places(self) -> list[float]:
        """Return the arc-lengths in m at which supports, loads and other parts are attached."""
        return attached(self.scene, self.cable.name)

    def _strain(self, nodal: np.ndarray) -> np.ndarray:
        """Return (positions, T, elements); nodal: (T, nodes, vectors, dim)."""
        return strains_at(self.cable, nodal, STRAIN_RULE[0])

    def of(self, q: np.ndarray) -> np.ndarray:
        """Return (3, T, elements): the mean of the strain over each element, that of its square, and E in J."""
        strain = self._strain(self.cable.strained(q))
        if self.part.is_curved:
            strain -= self.drawn
        if self.is_slack_in_compression:
            np.maximum(strain, 0.0, out=strain)
        found = moments_along(strain, STRAIN_POSITIONS, STRAIN_WEIGHTS)
        found[2] *= self.half_stiffness
        return found

    def bending(self, q: np.ndarray, square: np.ndarray) -> np.ndarray:
        """Return (T,): the elastic energy at q (T, n) without that of the axial strain, whose mean square over each
        element is (T, elements), in J.
        """
        cable, e = self.cable, element_coordinates(self.cable, q)
        energy, h, A = cable.law_kernel("energy"), cable.mesh.lengths, cable.A
        if cable.growth >= 0:
            g = cable.growth_in(q)
            e, h = e * per_grown(cable.vectors, g), g * cable.mesh.all_lengths
            A = np.stack([np.broadcast_to(cable.constants_with(g[:, k], k), (len(e), A.shape[1]))
                          for k in range(len(self.h))], axis=1)
            whole = np.array([energy.rows(len(self.h), *each) for each in zip(h, e, A, strict=True)])
        elif len(h) == len(A) == 1:
            whole = energy.rows(e.shape[0] * e.shape[1], h[0], e.reshape(-1, *e.shape[2:]), A[0])
        else:
            h, A = np.broadcast_to(h, len(self.h)), np.broadcast_to(A, (len(self.h), A.shape[1]))
            whole = np.array([energy.rows(len(self.h), h, each, A) for each in e])
        bent = np.add.reduce(whole.reshape(len(e), -1), axis=1) - square @ self.half_stiffness
        return np.asarray(np.maximum(bent, 0.0))

    def motion(self, v: np.ndarray) -> np.ndarray:
        """Return (T,): the kinetic energy at rates v (T, n), in J."""
        cable, nodal = self.cable, self.cable.nodal(v)
        if not cable.mesh.doubled:
            return quadratic_forms(cable.m, nodal)
        ends = [0, *cable.mesh.doubled, cable.n_elements]
        return np.asarray(sum(quadratic_forms(cable.m[first:end], nodal[:, first + k : end + k + 1])
                              for k, (first, end) in enumerate(pairwise(ends))))


class _Line:
    """Cables that are tied or joined to each other: forces in one of them depend on the others."""

    def __init__(self, strains: list[_Strains]):
        self.strains, self.name = strains, strains[0].part.name
        self.EA, self.h = (np.concatenate(each) for each in zip(*((s.EA * np.ones_like(s.h), s.h) for s in strains),
                                                                strict=True))
        self.ends = sorted({0, strains[0].cable.n_elements, *strains[0].supported}) if len(strains) == 1 else [0]

    def of(self, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return E (T, elements) and its measure (T,) of unit error, both in J, and the tension (T, elements) in N, at
        coordinates q and rates v (T, n).
        """
        each = [one.of(q) for one in self.strains]
        mean, _, lost = each[0] if len(each) == 1 else np.concatenate(each, axis=2)
        measure = self._work(q, mean) / WORK_ERROR_FACTOR
        k = np.flatnonzero(np.add.reduce(lost, axis=1) > FORCE_ERROR_LIMIT / MID_ELEMENT_FACTOR * measure)
        if len(k):
            measure[k] += sum(one.bending(q[k], of[1, k]) + one.motion(v[k])
                              for one, of in zip(self.strains, each, strict=True)) / ENERGY_ERROR_FACTOR
        return lost, measure, self.EA * mean

    def _work(self, q: np.ndarray, mean: np.ndarray) -> np.ndarray:
        """Return (T,): the work of the tension at mean strains (T, elements), see above: of one cable between its ends
        and supports, of several between the two supports with the largest distance.
        """
        if len(self.strains) == 1:
            cable, ends = self.strains[0].cable, self.ends
            nodes = ends if cable.ends_of_elements is None else [cable.ends_of_elements[end] for end in ends]
            return tension_work(mean, self.EA, self.h, chord_lengths(cable.positions(q), nodes), ends[:-1])
        r = np.concatenate([each.cable.positions(q)[:, each.cable.mesh.first_node(np.array(each.supported, int))]
                            for each in self.strains], axis=1)
        apart = np.linalg.norm(r[:, :, None] - r[:, None], axis=-1).max(axis=(1, 2), initial=0.0)[:, None]
        return tension_work(mean, self.EA, self.h, apart, self.ends)

    def note(self, lost: np.ndarray, measure: float, tension: np.ndarray) -> str | None:
        """Return a note where E (elements,) is large beside its measure; tension: (elements,) in N."""
        stiffness = float(self.EA @ self.h)
        if lost.sum() <= max(FORCE_ERROR_LIMIT / MID_ELEMENT_FACTOR * measure, ENERGY_ROUNDING * stiffness):
            return None
        first = np.cumsum([0, *(each.cable.n_elements for each in self.strains)])
        worst = int(np.searchsorted(first, int(np.argmax(lost)), side="right")) - 1
        own = slice(int(first[worst]), int(first[worst + 1]))
        return _advice(self.strains[worst], lost[own], float(lost.sum()) / max(measure, 1e-300), tension[own])


def _advice(of: _Strains, lost: np.ndarray, error: float, tension: np.ndarray) -> str | None:
    """Return the note on the cable whose elements have the largest E (elements,): where, and what to do; none where a
    corner is sharp by the bending stiffness, too.
    """
    mesh, k = of.cable.mesh, int(np.argmax(lost))
    where = np.flatnonzero(lost > 0.1 * lost[k])
    start, stop = mesh.start(int(where[0])), mesh.start(int(where[-1])) + mesh.length(int(where[-1]))
    here, h, power, least, corner = mesh.start(k), float(of.h[k]), SMOOTH_SHAPE_POWER, 0.0, ""
    near = [s for s in of.places if here - h < s < here + 2 * h and 0 < s < mesh.total]
    if near and tension[k] > 0:
        power, least = CORNER_POWER, float(np.sqrt(np.broadcast_to(of.EI, len(of.h))[k] / tension[k]))
        error *= _corner_factor(mesh, near[0]) / (1 + BENDING_LENGTH_FACTOR * least / h)
        corner = f"; what acts at s = {near[0]:.6g} m bends the cable over sqrt(EI/N) = {least:.2g} m"
    if error <= FORCE_ERROR_LIMIT:
        return None
    length = max(h * (FORCE_ERROR_TARGET / error) ** power, least)
    return (f'cable "{of.part.name}": elements of {h:.3g} m are too long between s = {start:.4g} and {stop:.4g} m: '
            f"the strain within them swings, by which forces may be {100 * error:.2g} % off{corner}. Take elements "
            f"of at most {length:.2g} m there, such as elements={np.ceil(of.part.length / length):.0f}")


def _corner_factor(mesh: Mesh, s: float) -> float:
    """Return the error at a corner, at arc-length s in m, over that along a smooth line."""
    element = int(mesh.element_at(s))
    part = (s - mesh.start(element)) / mesh.length(element)
    return MID_ELEMENT_FACTOR if 0.3 < part < 0.7 else NODE_FACTOR


class CoarseMeshes(Note):
    """The energy of the axial strain within elements.

    found: by the name of a line's first cable the number of rows seen, and sums over them of E of its elements, of its
    measure, and of the tension of its elements, see `_Line.of`.
    """

    measures = (CableModel,)
    assesses_rest, row_interval = True, ROW_INTERVAL

    def prepare(self) -> None:
        """Select the lines of cables whose laws take the strain of the centreline: others average it along elements."""
        scene, groups = self.scene, {name: {name} for name in self.scene.cables}
        pairs: list[tuple[str | None, str | None]] = [(tie.cable, tie.to) for tie in scene.ties.values()]
        pairs += [(joint.a.on, joint.b.on) for joint in scene.joints.values()]
        for a, b in pairs:
            if a in groups and b in groups:
                whole = groups[a] | groups[b]
                groups |= dict.fromkeys(whole, whole)
        laws = {name: cable.traits for name, cable in scene.cables.items()}
        strains = {cable.name: _Strains(scene, self.model, cable) for cable in self.model.cables
                   if laws[cable.name].kind != "structural"
                   and laws[cable.name].membrane not in ("assumed", "tabulated")}
        lines = {id(group): [each for name, each in strains.items() if name in group] for group in groups.values()}
        self._lines = [_Line(line) for line in lines.values() if line]

    def see(self, rows: Rows) -> None:
        """Measure further output rows."""
        for line in self._lines:
            of = line.of(rows["q"], rows["v"])
            new = [len(rows["q"]), *(np.add.reduce(each).tolist() for each in of)]
            before = self.found.get(line.name)
            self.found[line.name] = new if before is None else [
                (np.array(one) + other).tolist() for one, other in zip(before, new, strict=True)]

    def notes(self) -> list[str]:
        """Return a note for each cable whose mesh is too coarse."""
        notes = []
        for line in self._lines:
            if line.name in self.found:
                count, lost, measure, tension = self.found[line.name]
                notes.append(line.note(np.array(lost), measure, np.array(tension) / count))
        return [note for note in notes if note]
