"""From supports and joins to unknowns: every dof of the cables is linear in unknowns and in what motions prescribe.

Pins and clamps hold dofs; a cable clamped at a node keeps the direction of its slope and one unknown, its length;
joined nodes share the position, and rigidly joined ones the gradient of the deformation, so that slopes of one are
constant combinations of those of the other (Shabana, Computational Continuum Mechanics, ch. 6: structural
discontinuities).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from funicular.errors import SceneError
from funicular.scene import Scene
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import reverse_cuthill_mckee

PARALLEL = 1e-9
"""Tangents whose cross product is smaller than this are parallel."""


@dataclass
class Prescribed:
    """A part of a dof: base + linear f + cosine cos f + sine sin f of signal number `signal`."""

    signal: int
    base: float = 0.0
    linear: float = 0.0
    cosine: float = 0.0
    sine: float = 0.0

    def times(self, factor: float) -> Prescribed:
        """The same, scaled."""
        return Prescribed(self.signal, *(factor * x for x in (self.base, self.linear, self.cosine, self.sine)))


@dataclass
class Row:
    """What a dof is made of: coefficients over dofs that are unknowns, and prescribed parts."""

    free: dict[int, float] = field(default_factory=dict)
    prescribed: list[Prescribed] = field(default_factory=list)


@dataclass
class Reduction:
    """place[dof]: its unknown, -1 held, -2 - k the k-th row of `combinations`; the prescribed parts by dof."""

    place: np.ndarray
    combinations: csr_array
    n_unknowns: int
    prescribed: list[tuple[int, Prescribed]]


@dataclass
class Node:
    """A cable's node: its dofs by nodal vector and the vectors as drawn, in the dimension of the element."""

    where: str
    names: tuple[str, ...]
    first: int
    vectors: np.ndarray  # (names, dim)

    @property
    def dim(self) -> int:
        """Of the element."""
        return self.vectors.shape[1]

    @property
    def directors(self) -> list[str]:
        """The vectors that span the section."""
        return [name for name in ("r_y", "r_z") if name in self.names]

    def vector(self, name: str) -> np.ndarray:
        """As drawn."""
        return self.vectors[self.names.index(name)]

    def dofs(self, name: str) -> range:
        """Of a nodal vector."""
        at = self.first + self.names.index(name) * self.dim
        return range(at, at + self.dim)


class Supports:
    """Rows of T, made support by support; dofs that are not in `rows` are unknowns of their own."""

    def __init__(self) -> None:
        self.rows: dict[int, Row] = {}

    def hold(self, node: Node, names: Iterable[str]) -> None:
        """Fix nodal vectors as drawn."""
        for name in names:
            for dof in node.dofs(name):
                self.rows[dof] = Row()

    def clamp(self, node: Node, everything: bool) -> None:
        """Fix position and section: the directors, or the direction of the slope where there are none."""
        if everything:
            self.hold(node, node.names)
            return
        self.hold(node, ["r", *node.directors])
        if not node.directors:
            along = node.vector("r_x") / np.linalg.norm(node.vector("r_x"))
            unknown = int(np.argmax(np.abs(along)))
            for d, dof in enumerate(node.dofs("r_x")):
                ratio = float(along[d] / along[unknown])
                if d != unknown:
                    self.rows[dof] = Row({node.dofs("r_x")[unknown]: ratio} if ratio else {})

    def displace(self, node: Node, signals: Iterable[int]) -> None:
        """Position as drawn plus a signal an axis."""
        for dof, start, signal in zip(node.dofs("r"), node.vector("r"), signals, strict=False):
            self.rows[dof] = Row(prescribed=[Prescribed(signal, base=float(start), linear=1.0)])

    def rotate(self, node: Node, axis: np.ndarray, signal: int) -> None:
        """Section, or slope where there is none, turned about an axis."""
        for name in node.directors or ["r_x"]:
            drawn = np.zeros(3)
            drawn[: node.dim] = node.vector(name)
            along = axis * np.dot(axis, drawn)
            across, turned = drawn - along, np.cross(axis, drawn)
            for d, dof in enumerate(node.dofs(name)):
                self.rows[dof] = Row(prescribed=[Prescribed(signal, float(along[d]), 0.0, float(across[d]),
                                                            float(turned[d]))])

    def join(self, master: Node, slave: Node, rigid: bool) -> None:
        """Positions equal; rigid: slopes too, as they stand to each other at the start."""
        for dof, of in zip(slave.dofs("r"), master.dofs("r"), strict=True):
            self.rows[dof] = self._combined({of: 1.0})
        if rigid:
            names = [name for name in slave.names if name in ("r_x", "r_y", "r_z")]
            for name in names:
                for dof, combination in zip(slave.dofs(name), _slope(master, slave, name), strict=True):
                    self.rows[dof] = self._combined(combination)

    def _combined(self, combination: dict[int, float]) -> Row:
        row = Row()
        for dof, factor in combination.items():
            of = self.rows.get(dof, Row({dof: 1.0}))
            for k, value in of.free.items():
                row.free[k] = row.free.get(k, 0.0) + factor * value
            row.prescribed.extend(part.times(factor) for part in of.prescribed)
        return row

    def reduce(self, n_dof: int, elements: np.ndarray) -> Reduction:
        """Number the unknowns; elements (n, 2): first dof and number of dofs of each.

        Where combinations tie distant nodes, the order is that of reverse Cuthill and McKee if that is narrower.
        """
        unknown = np.ones(n_dof, dtype=bool)
        unknown[list(self.rows)] = False
        number = np.cumsum(unknown) - 1
        combined = {dof: row for dof, row in self.rows.items() if row.free}
        if any(row.prescribed for row in combined.values()):
            raise SceneError("scene", "a join ties a node that moves as prescribed to one that is partly free",
                             "prescribe displacement and rotation there, or join with rotation = \"free\"")
        if combined:
            number = _narrow(number, unknown, combined, elements)
        place = np.where(unknown, number, -1)
        rows, columns, values, count = [], [], [], 0
        for dof, row in sorted(combined.items()):
            if list(row.free.values()) == [1.0]:
                place[dof] = number[next(iter(row.free))]
                continue
            place[dof] = -2 - count
            rows += [count] * len(row.free)
            columns += [int(number[of]) for of in row.free]
            values += list(row.free.values())
            count += 1
        n = int(unknown.sum())
        combinations = csr_array((values, (rows, columns)), shape=(count, max(n, 1)))
        prescribed = [(dof, part) for dof, row in self.rows.items() for part in row.prescribed]
        return Reduction(place.astype(int), combinations, n, prescribed)


def _slope(master: Node, slave: Node, name: str) -> list[dict[int, float]]:
    """Rows over the master's slopes of the slave's nodal vector `name`, component by component."""
    drawn = slave.vector(name)
    slopes = [n for n in ("r_x", "r_y", "r_z") if n in master.names]
    if len(slopes) == master.dim:
        weights = np.linalg.solve(np.array([master.vector(n) for n in slopes]).T, drawn)
        return [{master.dofs(n)[d]: float(w) for n, w in zip(slopes, weights, strict=True) if w}
                for d in range(master.dim)]
    tangent = master.vector("r_x")
    square, at = float(tangent @ tangent), master.dofs("r_x")
    if master.dim == 2:  # turned and stretched: a product of complex numbers
        a = float(tangent @ drawn) / square
        b = float(tangent[0] * drawn[1] - tangent[1] * drawn[0]) / square
        return [{at[0]: a, at[1]: -b}, {at[0]: b, at[1]: a}]
    ratio = float(tangent @ drawn) / square
    if name != "r_x" or np.linalg.norm(np.cross(tangent, drawn)) > PARALLEL * square:
        raise SceneError(slave.where, "cables without a section of their own cannot be joined rigidly at an angle: "
                         "nothing holds their rotation about the tangent", 'take element="beam24", or rotation="free"')
    return [{at[d]: ratio} for d in range(3)]


def _narrow(number: np.ndarray, unknown: np.ndarray, combined: dict[int, Row], elements: np.ndarray) -> np.ndarray:
    """The numbering whose band is narrower: as it stands, or Cuthill and McKee's."""
    rows, columns = [], []
    for first, n in elements:
        touched: set[int] = set()
        for dof in range(first, first + n):
            if unknown[dof]:
                touched.add(int(number[dof]))
            elif dof in combined:
                touched.update(int(number[of]) for of in combined[dof].free)
        for k in touched:
            rows += [k] * len(touched)
            columns += list(touched)
    n = int(unknown.sum())
    pattern = coo_array((np.ones(len(rows)), (rows, columns)), shape=(n, n)).tocsr()
    order = reverse_cuthill_mckee(pattern, symmetric_mode=True)
    new = np.empty(n, dtype=int)
    new[order] = np.arange(n)
    r, c = pattern.nonzero()
    if np.max(np.abs(new[r] - new[c]), initial=0) >= np.max(np.abs(r - c), initial=0):
        return number
    return np.where(unknown, new[np.clip(number, 0, n - 1)], number)


def half_width(reduction: Reduction, elements: np.ndarray) -> int:
    """The largest distance between two unknowns of one element; elements as in `Supports.reduce`."""
    place = reduction.place
    low, high = np.where(place >= 0, place, np.iinfo(int).max), place.copy()
    start, columns = reduction.combinations.indptr, reduction.combinations.indices
    for dof in np.flatnonzero(place < -1):
        k = -2 - place[dof]
        of = columns[start[k] : start[k + 1]]
        low[dof], high[dof] = of.min(), of.max()
    widest = 0
    for n in np.unique(elements[:, 1]) if len(elements) else ():
        dofs = elements[elements[:, 1] == n, 0][:, None] + np.arange(n)
        top, bottom = high[dofs].max(axis=1), low[dofs].min(axis=1)
        widest = max(widest, int(np.max(np.where(top >= 0, top - bottom, 0))))
    return widest


def supports(scene: Scene, nodes: dict[str, list[Node]], signal) -> Supports:
    """The scene's supports and joins; nodes: of each cable; signal(s): number of a signal."""
    made = Supports()

    def at(cable: str, s: float) -> Node:
        return nodes[cable][scene.cables[cable].node_at(s)]

    rooted = []
    for pin in scene.pins:
        rooted.append(at(pin.cable, pin.s))
        made.hold(rooted[-1], ["r"])
    for clamp in scene.clamps:
        rooted.append(at(clamp.cable, clamp.s))
        made.clamp(rooted[-1], clamp.hold == "all")
    for motion in scene.motions:
        rooted.append(at(motion.cable, motion.s))
        if motion.displacement is not None:
            made.displace(rooted[-1], [signal(s) for s in motion.displacement])
        if motion.rotation is not None:
            made.rotate(rooted[-1], np.array(motion.rotation.axis), signal(motion.rotation.angle))
    links = [(at(join.cable, join.s), at(join.to, join.at), join.rotation == "rigid") for join in scene.joins.values()]
    done = {node.first for node in rooted}
    # a node with directors can give the slopes of one without, not the other way round
    starts = sorted((node for link in links for node in link[:2] if node.first not in done),
                    key=lambda node: -len(node.directors))
    for root in [*rooted, *starts]:
        waiting = [] if root.first in done and all(root is not r for r in rooted) else [root]
        done.add(root.first)
        while waiting:
            node = waiting.pop()
            for a, b, rigid in links:
                for master, slave in ((a, b), (b, a)):
                    if master.first == node.first and slave.first not in done:
                        made.join(master, slave, rigid)
                        done.add(slave.first)
                        waiting.append(slave)
    return made
