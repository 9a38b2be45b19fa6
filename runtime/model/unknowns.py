"""Unknowns of supports and ties: every dof of the cables is linear in the unknowns and in prescribed motions.

Pins and clamps fix dofs. A clamped cable keeps the direction of its slope; its length is one unknown. Joined nodes
share the position. Slopes of nodes joined rigidly in line, or in space, are constant combinations of each other: the
nodes share the deformation gradient (Shabana, Computational Continuum Mechanics, ch. 6: structural discontinuities).
Nodes joined at an angle in the plane share only the rotation of the section: with the gradient, the section of one beam
would be the tangent of the other, and a moment would shear its last element, the more the shorter it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import field
from typing import TYPE_CHECKING

import numpy as np

from ..base.deferred import dataclass
from ..errors import SceneError
from ..parts.scene_data import SceneData
from ..parts.signal import Signal
from .combinations import Combinations
from .cutting import MAX_ATTACHMENTS, cut
from .numbering import Numbering, as_drawn

if TYPE_CHECKING:
    from scipy.sparse import csr_array

PARALLEL_SINE = 1e-9
"""Sine of the angle below which tangents are parallel."""


@dataclass
class Prescribed:
    """A part of a dof: base + linear f + cosine cos f + sine sin f of signal number `signal`."""

    signal: int
    base: float = 0.0
    linear: float = 0.0
    cosine: float = 0.0
    sine: float = 0.0

    def times(self, factor: float) -> Prescribed:
        """Return this part of a dof multiplied by a factor."""
        return Prescribed(self.signal, *(factor * x for x in (self.base, self.linear, self.cosine, self.sine)))


@dataclass
class Row:
    """A dof as a combination: coefficients of dofs that are unknowns, and prescribed parts."""

    free: dict[int, float] = field(default_factory=dict)
    prescribed: list[Prescribed] = field(default_factory=list)


@dataclass(eq=False, repr=False)
class Reduction:
    """Dofs as functions of the unknowns.

    unknown_of_dof: number of its unknown, -1 for a fixed dof, -2 - k for row k of `combinations`. prescribed: parts of
    dofs given by signals.
    """

    unknown_of_dof: np.ndarray
    combinations: Combinations
    n_unknowns: int
    numbering: Numbering
    prescribed: list[tuple[int, Prescribed]]


def as_supports_leave(asked: np.ndarray, unknown_of_dof: np.ndarray, combinations: Combinations) -> np.ndarray:
    """Return changes of dofs (n,) that supports and ties admit: those of fixed dofs are zero.

    asked: the requested changes (n,), of which those of the unknowns count; the last one of dofs that share an unknown.
    unknown_of_dof, combinations: as in `Reduction`.
    """
    if not asked.any():
        return np.zeros(len(asked))
    free, tied = unknown_of_dof >= 0, unknown_of_dof < -1
    unknowns = np.zeros(max(unknown_of_dof.max(initial=-1), combinations.unknown.max(initial=-1)) + 1)
    unknowns[unknown_of_dof[free]] = asked[free]
    given = np.zeros(len(asked))
    given[free] = unknowns[unknown_of_dof[free]]
    if tied.any():
        given[tied] = combinations.times(unknowns)[-2 - unknown_of_dof[tied]]
    return given


def by_unknowns(unknown_of_dof: np.ndarray, combinations: Combinations, n: int) -> csr_array:
    """Return T (dofs, n unknowns), sparse: dofs = T unknowns + prescribed parts.

    unknown_of_dof (dofs,): of all dofs or of some; combinations: as in `Reduction`.
    """
    from scipy.sparse import csr_array  # slow to import, and runs do without

    free, tied = np.flatnonzero(unknown_of_dof >= 0), np.flatnonzero(unknown_of_dof < -1)
    place, unknown, factor = combinations.entries(-2 - unknown_of_dof[tied])
    rows = np.concatenate([free, tied[place]])
    columns = np.concatenate([unknown_of_dof[free], unknown])
    values = np.concatenate([np.ones(len(free)), factor])
    return csr_array((values, (rows, columns)), shape=(len(unknown_of_dof), n))


@dataclass(eq=False, repr=False)
class Node:
    """A node of a cable: its dofs by nodal vector and the vectors as drawn, in the dimension of the element."""

    where: str
    names: tuple[str, ...]
    first: int
    vectors: np.ndarray  # (names, dim)

    @property
    def dim(self) -> int:
        """Return the dimension of the element, 2 or 3."""
        return int(self.vectors.shape[1])

    @property
    def directors(self) -> list[str]:
        """Return the vectors that span the section."""
        return [name for name in ("r_y", "r_z") if name in self.names]

    def vector(self, name: str) -> np.ndarray:
        """Return a nodal vector (dim,) as drawn."""
        return np.asarray(self.vectors[self.names.index(name)])

    def dofs(self, name: str) -> range:
        """Return the numbers of the dofs of a nodal vector."""
        at = self.first + self.names.index(name) * self.dim
        return range(at, at + self.dim)


class Supports:
    """Rows of T, added support by support; dofs without a row are unknowns."""

    def __init__(self) -> None:
        self.rows: dict[int, Row] = {}

    def fix(self, node: Node, names: Iterable[str]) -> None:
        """Fix the nodal vectors of these names as drawn."""
        for name in names:
            for dof in node.dofs(name):
                self.rows[dof] = Row()

    def clamp(self, node: Node, everything: bool) -> None:
        """Fix position and section: the directors, or without these the direction of the slope."""
        if everything:
            self.fix(node, node.names)
            return
        self.fix(node, ["r", *node.directors])
        if not node.directors:
            along = node.vector("r_x") / np.linalg.norm(node.vector("r_x"))
            unknown = int(np.argmax(np.abs(along)))
            for d, dof in enumerate(node.dofs("r_x")):
                ratio = float(along[d] / along[unknown])
                if d != unknown:
                    self.rows[dof] = Row({node.dofs("r_x")[unknown]: ratio} if ratio else {})

    def displace(self, node: Node, signals: Iterable[int | None]) -> None:
        """Prescribe the position as drawn plus one signal per axis, None for a free axis."""
        for dof, start, signal in zip(node.dofs("r"), node.vector("r"), signals, strict=False):
            if signal is None:
                continue
            self.rows[dof] = Row(prescribed=[Prescribed(signal, base=float(start), linear=1.0)])

    def rotate(self, node: Node, axis: np.ndarray, signal: int) -> None:
        """Prescribe a rotation of the section, or of the slope of a node without directors, about an axis."""
        for name in node.directors or ["r_x"]:
            drawn = np.zeros(3)
            drawn[: node.dim] = node.vector(name)
            along = axis * np.dot(axis, drawn)
            across, turned = drawn - along, np.cross(axis, drawn)
            for d, dof in enumerate(node.dofs(name)):
                self.rows[dof] = Row(prescribed=[Prescribed(signal, float(along[d]), 0.0, float(across[d]),
                                                            float(turned[d]))])

    def join(self, master: Node, slave: Node, rotation: str) -> None:
        """Join the positions of two nodes; "rigid": also the slopes, or the rotations of the sections, as drawn;
        "section": also the directors.
        """
        for name in ["r", *(master.directors if rotation == "section" else [])]:
            for dof, of in zip(slave.dofs(name), master.dofs(name), strict=True):
                self.rows[dof] = self._combined({of: 1.0})
        if rotation == "rigid":
            for name, rows in _shared(master, slave).items():
                for dof, combination in zip(slave.dofs(name), rows, strict=True):
                    self.rows[dof] = self._combined(combination)

    def tie_nodes(self, ties: list[tuple[Node, Node, str]], supported: list[Node]) -> None:
        """Join the nodes of ties (node, node, rotation), starting from the supported nodes."""
        if not ties:
            return
        done = {node.first for node in supported}
        # a node with directors determines the slopes of one without, not vice versa
        starts = sorted((node for tie in ties for node in tie[:2] if node.first not in done),
                        key=lambda node: -len(node.directors))
        for root in [*supported, *starts]:
            waiting = [] if root.first in done and all(root is not node for node in supported) else [root]
            done.add(root.first)
            while waiting:
                node = waiting.pop()
                for a, b, rotation in ties:
                    for master, slave in ((a, b), (b, a)):
                        if master.first == node.first and slave.first not in done:
                            self.join(master, slave, rotation)
                            done.add(slave.first)
                            waiting.append(slave)

    def _combined(self, combination: dict[int, float]) -> Row:
        row = Row()
        for dof, factor in combination.items():
            of = self.rows.get(dof, Row({dof: 1.0}))
            for k, value in of.free.items():
                row.free[k] = row.free.get(k, 0.0) + factor * value
            row.prescribed.extend(part.times(factor) for part in of.prescribed)
        return row

    def reduce(self, n_dof: int, elements: np.ndarray, attached: np.ndarray) -> Reduction:
        """Number the unknowns, and return the dofs as functions of them. Raises SceneError.

        elements (n, 2): first dof and number of dofs of each; attached: elements at the ends of springs and joints.
        Where ties join distant nodes, the order is that of the fewest operations.
        """
        unknown = np.ones(n_dof, dtype=bool)
        unknown[list(self.rows)] = False
        free = unknown.nonzero()[0]
        n, drawn = len(free), np.full(n_dof, -1)
        drawn[free] = np.arange(n)
        combined = {dof: row for dof, row in self.rows.items() if row.free}
        if any(row.prescribed for row in combined.values()):
            raise SceneError("scene", "a tie joins a node that moves as prescribed to one that is partly free",
                             "prescribe displacement and rotation there, or tie with rotation = \"free\"")
        numbering = self._numbering(drawn, combined, elements, attached)
        unknown_of_dof = drawn.copy()
        unknown_of_dof[free] = numbering.number
        rows: list[dict[int, float]] = []
        for dof, row in sorted(combined.items()):
            if list(row.free.values()) == [1.0]:
                unknown_of_dof[dof] = unknown_of_dof[next(iter(row.free))]
                continue
            unknown_of_dof[dof] = -2 - len(rows)
            rows.append({int(unknown_of_dof[of]): factor for of, factor in row.free.items()})
        prescribed = [(dof, part) for dof, row in self.rows.items() for part in row.prescribed]
        return Reduction(unknown_of_dof, Combinations.of(rows), n, numbering, prescribed)

    def _numbering(self, drawn: np.ndarray, combined: dict[int, Row], elements: np.ndarray,
                   attached: np.ndarray) -> Numbering:
        """Return the numbering of the unknowns; drawn: their numbers as drawn; combined: rows of dependent dofs."""
        if not combined and len(attached) <= MAX_ATTACHMENTS:
            return as_drawn(elements, drawn)
        from .fewest_operations import cheapest, incidence_of  # imports SciPy, which most runs do without

        free = np.flatnonzero(drawn >= 0)
        shape = len(drawn), len(free)
        made_of = np.stack([free, drawn[free]], axis=1)
        if combined:
            of_rows = [(dof, drawn[of]) for dof, row in combined.items() for of in row.free]
            made_of = np.concatenate([made_of, of_rows])
        numbering = cheapest(elements, made_of, shape) if combined else as_drawn(elements, drawn)
        if len(attached) <= MAX_ATTACHMENTS:
            return numbering
        return cut(numbering, incidence_of(elements, made_of, shape), attached)


def _shared(master: Node, slave: Node) -> dict[str, list[dict[int, float]]]:
    """Return, for rigidly joined nodes, rows over the master's slopes by nodal vector and component of the slave."""
    names = [name for name in slave.names if name in ("r_x", "r_y", "r_z")]
    if master.dim == 3 or (master.directors and slave.directors and _in_line(master, slave)):
        return {name: _slope(master, slave, name) for name in names}
    turns, with_it = ((node.directors or ["r_x"])[0] for node in (master, slave))
    return {with_it: _turned(master.vector(turns), master.dofs(turns), slave.vector(with_it))}


def _in_line(master: Node, slave: Node) -> bool:
    a, b = master.vector("r_x"), slave.vector("r_x")
    return bool(abs(a[0] * b[1] - a[1] * b[0]) <= PARALLEL_SINE * np.linalg.norm(a) * np.linalg.norm(b))


def _turned(vector: np.ndarray, at: range, drawn: np.ndarray) -> list[dict[int, float]]:
    """Return rows over a vector in the plane for one that rotates and stretches with it: a product of complex numbers.
    """
    square = float(vector @ vector)
    a = float(vector @ drawn) / square
    b = float(vector[0] * drawn[1] - vector[1] * drawn[0]) / square
    return [{at[0]: a, at[1]: -b}, {at[0]: b, at[1]: a}]


def _slope(master: Node, slave: Node, name: str) -> list[dict[int, float]]:
    """Return rows over the master's slopes for the slave's nodal vector `name`: both share the deformation gradient."""
    drawn = slave.vector(name)
    slopes = [n for n in ("r_x", "r_y", "r_z") if n in master.names]
    if len(slopes) == master.dim:
        weights = np.linalg.solve(np.array([master.vector(n) for n in slopes]).T, drawn)
        return [{master.dofs(n)[d]: float(w) for n, w in zip(slopes, weights, strict=True) if w}
                for d in range(master.dim)]
    tangent, at = master.vector("r_x"), master.dofs("r_x")
    square = float(tangent @ tangent)
    ratio = float(tangent @ drawn) / square
    if name != "r_x" or np.linalg.norm(np.cross(tangent, drawn)) > PARALLEL_SINE * square:
        raise SceneError(slave.where, "cables without a section of their own cannot be joined rigidly at an angle: "
                         "nothing fixes their rotation about the tangent", 'take element="beam24", or rotation="free"')
    return [{at[d]: ratio} for d in range(3)]


def supports(scene: SceneData, nodes: dict[str, list[Node]], signal: Callable[[Signal], int]) -> Supports:
    """Return the supports and ties of a scene; nodes: of each cable; signal(s): number of a signal."""
    made = Supports()

    def at(cable: str, s: float) -> Node:
        return nodes[cable][scene.cables[cable].node(s)]

    supported = _support_nodes(made, scene, at, signal)
    joints = [(nodes[cable.name][node - 1], nodes[cable.name][node], "free" if element in cable.hinges else "section")
              for cable in scene.cables.values() if (elements := cable.mesh.doubled)
              for element, node in zip(elements, cable.mesh.first_node(elements).tolist(), strict=True)]
    made.tie_nodes([*joints, *((at(tie.cable, tie.s), at(tie.to, tie.at), tie.rotation)
                               for tie in scene.ties.values())], supported)
    return made


def _support_nodes(made: Supports, scene: SceneData, at: Callable[[str, float], Node],
                   signal: Callable[[Signal], int]) -> list[Node]:
    """Add pins, clamps and motions; at(cable, s): a node. Return the supported nodes."""
    rooted = []
    for pin in scene.pins:
        rooted.append(at(pin.cable, pin.s))
        made.fix(rooted[-1], ["r"])
    for clamp in scene.clamps:
        rooted.append(at(clamp.cable, clamp.s))
        made.clamp(rooted[-1], clamp.fix == "all")
    for motion in scene.motions:
        rooted.append(at(motion.cable, motion.s))
        if motion.displacement is not None:
            made.displace(rooted[-1], [None if s is None else signal(s) for s in motion.displacement])
        if motion.rotation is not None:
            made.rotate(rooted[-1], np.array(motion.rotation.axis), signal(motion.rotation.angle))
    return rooted
