"""Meshes that are too coarse for the forces in a cable, by the axial strain within elements.

An element that cannot follow the shape of its cable stretches in waves along its length. Their energy,
E = 1/2 EA ∫(strain - its line of best fit)² ds, is none of the cable: a finer mesh loses it, and forces change by what
the scene's motion makes of it. Of cables at rest, forces err by about 15 E/W, with the work of the tension
W = ∫N ds - N c + ∫N²/EA ds, where c is the distance of the supports. Measured on hanging lines of 1.1 to 3 times their
span against the closed form: the worst component of the force at the pin errs by a third to three times that, where it
errs by 1 % to 50 %. Below a load at a point, where the rope has a corner, it errs by 45 E/W where that is in the middle
of an element, else by 9 E/W, against finer meshes. There the bending stiffness rounds the corner, over b = sqrt(EI/N):
elements of h err by 1 + 25 b/h times less. Bending and motion bear forces, too: their energies count by a half. The
moment at the clamp of a strip that hangs down errs by 43, 11, 1.9 and 0.09 % with 2, 4, 8 and 16 elements; this tells
21, 8.2, 2.6 and 0.14 %.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...kernels.mesh import Mesh
from ...model.element_coordinates import element_coordinates
from ...model.middle_strain import strain_at
from ...model.model import CableModel, Model
from ...parts.locations import attached
from ...parts.scene_data import SceneData

GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(5)
STRAIN_POSITIONS, STRAIN_WEIGHTS = 0.5 * (1 + GAUSS_POINTS), 0.5 * GAUSS_WEIGHTS
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
    """The axial strain of one cable, and what its energy is measured by."""

    def __init__(self, scene: SceneData, model: Model, cable: CableModel):
        self.cable, self.part = cable, scene.cables[cable.name]
        E, moments = self.part.material.youngs_modulus, self.part.section.moments()
        self.EA, self.EI = E * float(moments[0]), E * float(moments[1] if model.dim == 2 else min(moments[1:3]))
        self.h = np.broadcast_to(cable.mesh.lengths, cable.n_elements)
        self.supported = sorted(self.part.node(each.s) for each in scene.supports if each.cable == cable.name)
        self.drawn = self._strain(self.part.rest_nodal_vectors[None]) if self.part.is_curved else 0.0
        self.places = attached(scene, cable.name)

    def _strain(self, vectors: np.ndarray) -> np.ndarray:
        """Return (places, T, elements); vectors: (T, nodes, vectors, dim)."""
        return np.stack([strain_at(self.cable, vectors, at) for at in STRAIN_POSITIONS])

    def vectors(self, q: np.ndarray) -> np.ndarray:
        """Return (T, nodes, vectors, dim) at coordinates q (T, n)."""
        return q[:, self.cable.coordinates].reshape(-1, *self.cable.shape)

    def positions(self, q: np.ndarray, nodes: list[int]) -> np.ndarray:
        """Return (T, n, dim): where nodes are at coordinates q (T, n)."""
        return self.vectors(q)[:, nodes, self.cable.vectors.index("r")]

    def of(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the strain (places, T, elements), its mean over each element (T, elements), and E (T, elements) in J.
        """
        strain = self._strain(self.vectors(q)) - self.drawn
        if self.part.traits.membrane == "tension_only":
            strain = np.maximum(strain, 0.0)
        mean = np.einsum("p,pte->te", STRAIN_WEIGHTS, strain)
        tilt = np.einsum("p,pte->te", 3 * STRAIN_WEIGHTS * GAUSS_POINTS, strain)
        waves = strain - mean - tilt * GAUSS_POINTS[:, None, None]
        return strain, mean, 0.5 * self.EA * self.h * np.einsum("p,pte->te", STRAIN_WEIGHTS, waves**2)

    def bending(self, q: np.ndarray, strain: np.ndarray) -> float:
        """Return the elastic energy at q (n,) without that of the axial strain (places, elements), in J."""
        cable, e = self.cable, element_coordinates(self.cable, q[None])[0]
        A = np.ascontiguousarray(np.broadcast_to(cable.A, (cable.n_elements, cable.A.shape[1])))
        whole = cable.law_kernel("energy").rows(cable.n_elements, np.ascontiguousarray(self.h),
                                                np.ascontiguousarray(e), A)
        axial = 0.5 * self.EA * np.einsum("p,pe,e->", STRAIN_WEIGHTS, strain**2, self.h)
        return max(float(np.sum(whole) - axial), 0.0)

    def motion(self, v: np.ndarray) -> float:
        """Return the kinetic energy with rates v (n,), in J."""
        e, m = element_coordinates(self.cable, v[None])[0], self.cable.m
        return 0.5 * float(np.einsum("eid,eij,ejd->", e, np.broadcast_to(m, (len(e), *m.shape[1:])), e))

class _Line:
    """Cables that are tied or joined to each other: what bears in one of them depends on the others."""

    def __init__(self, strains: list[_Strains]):
        self.strains, self.name = strains, strains[0].part.name
        self.n_elements = sum(each.cable.n_elements for each in strains)

    def of(self, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return E (T, elements) and what it is measured by (T,), both in J, and the tension (T, elements) in N, at
        coordinates q and rates v (T, n).
        """
        strain, mean, each_lost = zip(*(each.of(q) for each in self.strains), strict=True)
        lost, tension = np.concatenate(each_lost, axis=1), [s.EA * e for s, e in zip(self.strains, mean, strict=True)]
        by = self._work(q, mean, tension) / WORK_ERROR_FACTOR
        for k in np.flatnonzero(lost.sum(axis=1) > FORCE_ERROR_LIMIT / MID_ELEMENT_FACTOR * by):
            by[k] += sum(each.bending(q[k], e[:, k]) + each.motion(v[k])
                         for each, e in zip(self.strains, strain, strict=True)) / ENERGY_ERROR_FACTOR
        return lost, by, np.concatenate(tension, axis=1)

    def _work(self, q: np.ndarray, mean: Sequence[np.ndarray], tension: Sequence[np.ndarray]) -> np.ndarray:
        """Return (T,): the work of the tension, see above: of one cable between its ends and supports, of several
        between the two supports that are farthest from each other.
        """
        found = sum(np.einsum("te,e->t", np.abs(N * e), each.h)
                    for each, N, e in zip(self.strains, tension, mean, strict=True))
        length = [each.h * (1 + e) for each, e in zip(self.strains, mean, strict=True)]
        bears = [np.abs(N) * part for N, part in zip(tension, length, strict=True)]
        if len(self.strains) == 1:
            one = self.strains[0]
            ends = sorted({0, one.cable.n_elements, *one.supported})
            bears, length = ([np.add.reduceat(each[0], ends[:-1], axis=1)] for each in (bears, length))
            apart = np.linalg.norm(np.diff(one.positions(q, ends), axis=1), axis=-1)
        else:
            bears, length = ([sum(part.sum(axis=1, keepdims=True) for part in each)] for each in (bears, length))
            r = np.concatenate([each.positions(q, each.supported) for each in self.strains], axis=1)
            apart = np.linalg.norm(r[:, :, None] - r[:, None], axis=-1).max(axis=(1, 2), initial=0.0)[:, None]
        whole, along = bears[0], length[0]
        return found + np.sum(np.maximum(whole - whole / np.where(along > 0, along, 1.0) * apart, 0.0), axis=1)

    def note(self, lost: np.ndarray, by: float, tension: np.ndarray) -> str | None:
        """Return a note where E (elements,) is large beside what it is measured by; tension: (elements,) in N."""
        stiffness = sum(each.EA * each.part.length for each in self.strains)
        if lost.sum() <= max(FORCE_ERROR_LIMIT / MID_ELEMENT_FACTOR * by, ENERGY_ROUNDING * stiffness):
            return None
        first = np.cumsum([0, *(each.cable.n_elements for each in self.strains)])
        worst = int(np.searchsorted(first, int(np.argmax(lost)), side="right")) - 1
        own = slice(int(first[worst]), int(first[worst + 1]))
        return _advice(self.strains[worst], lost[own], float(lost.sum()) / max(by, 1e-300), tension[own])


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
        power, least = CORNER_POWER, float(np.sqrt(of.EI / tension[k]))
        error *= _of_corner(mesh, near[0]) / (1 + BENDING_LENGTH_FACTOR * least / h)
        corner = f"; what acts at s = {near[0]:.6g} m bends the cable over sqrt(EI/N) = {least:.2g} m"
    if error <= FORCE_ERROR_LIMIT:
        return None
    length = max(h * (FORCE_ERROR_TARGET / error) ** power, least)
    return (f'cable "{of.part.name}": elements of {h:.3g} m are too long between s = {start:.4g} and {stop:.4g} m: '
            f"the strain within them swings, by which forces may be {100 * error:.2g} % off{corner}. Take elements "
            f"of at most {length:.2g} m there, such as elements={np.ceil(of.part.length / length):.0f}")


def _of_corner(mesh: Mesh, s: float) -> float:
    """Return by how much more the strain of an element errs at a corner, at arc-length s in m, than along a line."""
    element = int(mesh.element_at(s))
    part = (s - mesh.start(element)) / mesh.length(element)
    return MID_ELEMENT_FACTOR if 0.3 < part < 0.7 else NODE_FACTOR


def _lines(scene: SceneData, model: Model) -> list[_Line]:
    """Return the lines of cables whose laws take the strain of the centreline: others average it along elements."""
    groups = {name: {name} for name in scene.cables}
    pairs: list[tuple[str | None, str | None]] = [(tie.cable, tie.to) for tie in scene.ties.values()]
    pairs += [(joint.a.on, joint.b.on) for joint in scene.joints.values()]
    for a, b in pairs:
        if a in groups and b in groups:
            whole = groups[a] | groups[b]
            groups |= dict.fromkeys(whole, whole)
    laws = {name: cable.traits for name, cable in scene.cables.items()}
    strains = {cable.name: _Strains(scene, model, cable) for cable in model.cables
               if laws[cable.name].kind != "structural" and laws[cable.name].membrane != "assumed"}
    lines = {id(group): [each for name, each in strains.items() if name in group] for group in groups.values()}
    return [_Line(line) for line in lines.values() if line]


class CoarseMeshes:
    """Sees how much energy the strain within elements has in the rows of a run; notes meshes that are too coarse.

    found: by the name of a line's first cable the rows seen, and sums over those looked at: E of its elements, what it
    is measured by, and the tension of its elements, see `_Line.of`.
    """

    def __init__(self, scene: SceneData, model: Model):
        self._lines = _lines(scene, model)
        self.found: dict[str, Any] = {}

    def see(self, rows: dict[str, np.ndarray]) -> None:
        """Take further output rows."""
        for each in self._lines:
            n = each.n_elements
            seen, lost, by, tension = self.found.get(each.name, (0, [0.0] * n, 0.0, [0.0] * n))
            at = np.flatnonzero((seen + np.arange(len(rows["time"]))) % ROW_INTERVAL == 1)
            if len(at):
                more = each.of(rows["q"][at], rows["v"][at])
                lost, tension = ((np.array(old) + new.sum(axis=0)).tolist()
                                 for old, new in ((lost, more[0]), (tension, more[2])))
                by += float(more[1].sum())
            self.found[each.name] = [seen + len(rows["time"]), lost, by, tension]

    def notes(self) -> list[str]:
        """Return a note for each cable whose mesh is too coarse."""
        notes = []
        for each in self._lines:
            seen, lost, by, tension = self.found.get(each.name, (0, [], 0.0, []))
            looked = (seen - 2) // ROW_INTERVAL + 1  # of rows 1, 9, ...
            if looked > 0 and (note := each.note(np.array(lost), by, np.array(tension) / looked)):
                notes.append(note)
        return notes


def coarse(scene: SceneData, model: Model, q: np.ndarray) -> list[str]:
    """Return the notes on a state of rest at a configuration (n,)."""
    notes = []
    for each in _lines(scene, model):
        lost, by, tension = each.of(q[None], np.zeros((1, model.n_dof)))
        if note := each.note(lost[0], float(by[0]), tension[0]):
            notes.append(note)
    return notes
