"""From supports and joins to unknowns: every dof of the cables is linear in unknowns and in what motions prescribe.

Pins and clamps fix dofs; a cable clamped at a node keeps the direction of its slope and one unknown, its length;
joined nodes share the position. Of rigidly joined ones in line, or in space, slopes of one are constant combinations of
those of the other: they share the gradient of the deformation (Shabana, Computational Continuum Mechanics, ch. 6:
structural discontinuities). At an angle in the plane they share the turn of the section alone: the gradient would make
the section of one beam the tangent of the other, where a moment shears its last element, the more the shorter that is.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import coo_array, csr_array, triu
from scipy.sparse.csgraph import reverse_cuthill_mckee

from ..errors import SceneError
from ..parts.scene_data import SceneData

PARALLEL = 1e-9
"""Tangents whose cross product is smaller than this are parallel."""

SOLVES = 30
"""That a factored matrix serves: about ten, times three since their numbers come from memory and not from the cache."""


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
    """What a dof is made of: coefficients over dofs that are unknowns, and prescribed parts."""

    free: dict[int, float] = field(default_factory=dict)
    prescribed: list[Prescribed] = field(default_factory=list)


@dataclass
class Numbering:
    """number[unknown]: first the band, in which unknowns of one element are at most `width` apart, then the border.

    chains: where rows of the band begin that nothing but the border ties to the rows before; and the end.
    """

    number: np.ndarray
    n_band: int
    width: int
    chains: np.ndarray
    operations: float


@dataclass
class Reduction:
    """How dofs are made of unknowns: `unknown_of_dof` has the number of its unknown, -1 where the dof is fixed, and
    -2 - k where it is the k-th row of `combinations`; `prescribed` lists the parts that signals add to a dof.
    """

    unknown_of_dof: np.ndarray
    combinations: csr_array
    n_unknowns: int
    numbering: Numbering
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
        """Return the dimension of the element, 2 or 3."""
        return self.vectors.shape[1]

    @property
    def directors(self) -> list[str]:
        """Return the vectors that span the section."""
        return [name for name in ("r_y", "r_z") if name in self.names]

    def vector(self, name: str) -> np.ndarray:
        """Return a nodal vector (dim,) as it is drawn."""
        return self.vectors[self.names.index(name)]

    def dofs(self, name: str) -> range:
        """Return the numbers of the dofs of a nodal vector."""
        at = self.first + self.names.index(name) * self.dim
        return range(at, at + self.dim)


class Supports:
    """Rows of T, made support by support; dofs that are not in `rows` are unknowns of their own."""

    def __init__(self) -> None:
        self.rows: dict[int, Row] = {}

    def fix(self, node: Node, names: Iterable[str]) -> None:
        """Fix the nodal vectors of these names as they are drawn."""
        for name in names:
            for dof in node.dofs(name):
                self.rows[dof] = Row()

    def clamp(self, node: Node, everything: bool) -> None:
        """Fix position and section: the directors, or the direction of the slope where there are none."""
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
        """Prescribe the position as drawn plus a signal an axis; None leaves it free."""
        for dof, start, signal in zip(node.dofs("r"), node.vector("r"), signals, strict=False):
            if signal is None:
                continue
            self.rows[dof] = Row(prescribed=[Prescribed(signal, base=float(start), linear=1.0)])

    def rotate(self, node: Node, axis: np.ndarray, signal: int) -> None:
        """Prescribe a turn of the section, or of the slope where there is none, about an axis."""
        for name in node.directors or ["r_x"]:
            drawn = np.zeros(3)
            drawn[: node.dim] = node.vector(name)
            along = axis * np.dot(axis, drawn)
            across, turned = drawn - along, np.cross(axis, drawn)
            for d, dof in enumerate(node.dofs(name)):
                self.rows[dof] = Row(prescribed=[Prescribed(signal, float(along[d]), 0.0, float(across[d]),
                                                            float(turned[d]))])

    def join(self, master: Node, slave: Node, rigid: bool) -> None:
        """Join the positions of two nodes; rigid: also the slopes, or what turns with the section, as they stand at the
        start.
        """
        for dof, of in zip(slave.dofs("r"), master.dofs("r"), strict=True):
            self.rows[dof] = self._combined({of: 1.0})
        if rigid:
            for name, rows in _shared(master, slave).items():
                for dof, combination in zip(slave.dofs(name), rows, strict=True):
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
        """Number the unknowns; return how dofs are made of them. elements (n, 2): first dof and number of dofs of each.

        Where joins tie distant nodes, in the order that takes the fewest operations.
        """
        unknown = np.ones(n_dof, dtype=bool)
        unknown[list(self.rows)] = False
        drawn = np.cumsum(unknown) - 1
        n = int(unknown.sum())
        combined = {dof: row for dof, row in self.rows.items() if row.free}
        if any(row.prescribed for row in combined.values()):
            raise SceneError("scene", "a tie joins a node that moves as prescribed to one that is partly free",
                             "prescribe displacement and rotation there, or tie with rotation = \"free\"")
        made_of = [(dof, drawn[of]) for dof, row in combined.items() for of in row.free]
        touches = _touches(elements, np.concatenate([np.stack([np.flatnonzero(unknown), np.arange(n)], axis=1),
                                                     np.array(made_of, dtype=int).reshape(-1, 2)]), (n_dof, n))
        numbering = _counted(touches, np.arange(n), n)
        if combined:
            others = (_counted(touches, *_near(touches)), _counted(touches, *_strung(touches)))
            numbering = min(numbering, *others, key=lambda one: one.operations)
        number = numbering.number[drawn.clip(0)] if n else drawn
        unknown_of_dof = np.where(unknown, number, -1)
        rows, columns, values, count = [], [], [], 0
        for dof, row in sorted(combined.items()):
            if list(row.free.values()) == [1.0]:
                unknown_of_dof[dof] = number[next(iter(row.free))]
                continue
            unknown_of_dof[dof] = -2 - count
            rows += [count] * len(row.free)
            columns += [int(number[of]) for of in row.free]
            values += list(row.free.values())
            count += 1
        combinations = csr_array((values, (rows, columns)), shape=(count, max(n, 1)))
        prescribed = [(dof, part) for dof, row in self.rows.items() for part in row.prescribed]
        return Reduction(unknown_of_dof.astype(int), combinations, n, numbering, prescribed)


def _shared(master: Node, slave: Node) -> dict[str, list[dict[int, float]]]:
    """Return, for rigidly joined nodes, rows over the master's slopes, by the slave's nodal vector and component."""
    names = [name for name in slave.names if name in ("r_x", "r_y", "r_z")]
    if master.dim == 3 or (master.directors and slave.directors and _in_line(master, slave)):
        return {name: _slope(master, slave, name) for name in names}
    turns, with_it = ((node.directors or ["r_x"])[0] for node in (master, slave))
    return {with_it: _turned(master.vector(turns), master.dofs(turns), slave.vector(with_it))}


def _in_line(master: Node, slave: Node) -> bool:
    a, b = master.vector("r_x"), slave.vector("r_x")
    return bool(abs(a[0] * b[1] - a[1] * b[0]) <= PARALLEL * np.linalg.norm(a) * np.linalg.norm(b))


def _turned(vector: np.ndarray, at: range, drawn: np.ndarray) -> list[dict[int, float]]:
    """Return rows over a vector in the plane of one that turns and stretches with it: a product of complex numbers."""
    square = float(vector @ vector)
    a = float(vector @ drawn) / square
    b = float(vector[0] * drawn[1] - vector[1] * drawn[0]) / square
    return [{at[0]: a, at[1]: -b}, {at[0]: b, at[1]: a}]


def _slope(master: Node, slave: Node, name: str) -> list[dict[int, float]]:
    """Return rows over the master's slopes of the slave's nodal vector `name`: the gradient of the deformation is one.
    """
    drawn = slave.vector(name)
    slopes = [n for n in ("r_x", "r_y", "r_z") if n in master.names]
    if len(slopes) == master.dim:
        weights = np.linalg.solve(np.array([master.vector(n) for n in slopes]).T, drawn)
        return [{master.dofs(n)[d]: float(w) for n, w in zip(slopes, weights, strict=True) if w}
                for d in range(master.dim)]
    tangent, at = master.vector("r_x"), master.dofs("r_x")
    square = float(tangent @ tangent)
    ratio = float(tangent @ drawn) / square
    if name != "r_x" or np.linalg.norm(np.cross(tangent, drawn)) > PARALLEL * square:
        raise SceneError(slave.where, "cables without a section of their own cannot be joined rigidly at an angle: "
                         "nothing fixes their rotation about the tangent", 'take element="beam24", or rotation="free"')
    return [{at[d]: ratio} for d in range(3)]


def _touches(elements: np.ndarray, made_of: np.ndarray, shape: tuple[int, int]) -> csr_array:
    """Return (elements, unknowns): 1 where an element has a share of an unknown; made_of (k, 2): a dof, an unknown of
    it.
    """
    counts = elements[:, 1]
    dofs = np.repeat(elements[:, 0] - np.cumsum(counts) + counts, counts) + np.arange(counts.sum())
    has = csr_array((np.ones(len(dofs)), dofs, np.append(0, np.cumsum(counts))), shape=(len(elements), shape[0]))
    touches = has @ coo_array((np.ones(len(made_of)), (made_of[:, 0], made_of[:, 1])), shape=shape).tocsr()
    touches.data[:] = 1.0
    return touches


def _near(touches: csr_array) -> tuple[np.ndarray, int]:
    """Return the number of each unknown and size of the band: all in the band, by reverse Cuthill and McKee."""
    order = reverse_cuthill_mckee((touches.T @ touches).tocsr(), symmetric_mode=True)
    return np.argsort(order), len(order)


def _strung(touches: csr_array) -> tuple[np.ndarray, int]:
    """Number of each unknown and size of the band: elements strung to chains, those first that share most unknowns.

    Unknowns that are shared by others than two that follow each other in a chain are the border: nodes where more than
    two ends meet, and one of each ring.
    """
    n_elements, n = touches.shape
    shared = triu(touches @ touches.T, 1).tocoo()
    beside: list[list[int]] = [[] for _ in range(n_elements)]
    chain = list(range(n_elements))

    def root(e: int) -> int:
        while chain[e] != e:
            chain[e] = e = chain[chain[e]]
        return e

    for k in np.lexsort((shared.col, shared.row, -shared.data)):
        a, b = int(shared.row[k]), int(shared.col[k])
        if len(beside[a]) < 2 and len(beside[b]) < 2 and root(a) != root(b):
            beside[a].append(b)
            beside[b].append(a)
            chain[root(a)] = root(b)
    string: list[int] = []
    at = np.full(n_elements, -1)
    for end in (e for e in range(n_elements) if len(beside[e]) < 2):
        following = [end] if at[end] < 0 else []
        while following:
            at[following[0]] = len(string)
            string.append(following[0])
            following = [e for e in beside[string[-1]] if at[e] < 0]
    entry = touches.tocoo()
    first, last = np.full(n, n_elements), np.full(n, -1)
    np.minimum.at(first, entry.col, at[entry.row])
    np.maximum.at(last, entry.col, at[entry.row])
    follows = np.array([b in beside[a] for a, b in zip(string, string[1:] + string[:1], strict=True)])
    border = (last > first + 1) | (last > first) & ~follows[first]
    return np.argsort(np.lexsort((np.arange(n), first, last, border))), n - int(border.sum())


def _counted(touches: csr_array, number: np.ndarray, n_band: int) -> Numbering:
    """Return a numbering's band, and the operations of its factorisation and solves (engine/linear/bordered.c)."""
    entry = touches.tocoo()
    element, at = entry.row, number[entry.col]
    inside = at < n_band
    low, high = np.full(touches.shape[0], n_band), np.full(touches.shape[0], -1)
    np.minimum.at(low, element[inside], at[inside])
    np.maximum.at(high, element[inside], at[inside])
    banded = high >= 0
    ties = np.zeros(n_band + 1, dtype=int)  # elements that tie a row to the one before
    np.add.at(ties, low[banded] + 1, 1)
    np.add.at(ties, high[banded] + 1, -1)
    chains = np.append(np.flatnonzero(np.cumsum(ties[:-1]) == 0), n_band)
    width = int(np.max(high[banded] - low[banded], initial=0))
    of = np.searchsorted(chains, low, "right") - 1
    outside = ~inside & banded[element]
    columns = np.unique(np.stack([at[outside], of[element[outside]]]), axis=1)  # of the border, by chain
    coupled, m = float(np.diff(chains)[columns[1]].sum()), len(number) - n_band
    factor = n_band * width**2 / 2 + 2 * width * coupled + m**3 / 3
    return Numbering(number, n_band, width, chains, factor + SOLVES * (2 * width * n_band + coupled + m**2))


def supports(scene: SceneData, nodes: dict[str, list[Node]], signal) -> Supports:
    """Return the scene's supports and joins; nodes: of each cable; signal(s): number of a signal."""
    made = Supports()

    def at(cable: str, s: float) -> Node:
        return nodes[cable][scene.cables[cable].node(s)]

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
    ties = [(at(tie.cable, tie.s), at(tie.to, tie.at), tie.rotation == "rigid") for tie in scene.ties.values()]
    done = {node.first for node in rooted}
    # a node with directors can give the slopes of one without, not the other way round
    starts = sorted((node for tie in ties for node in tie[:2] if node.first not in done),
                    key=lambda node: -len(node.directors))
    for root in [*rooted, *starts]:
        waiting = [] if root.first in done and all(root is not r for r in rooted) else [root]
        done.add(root.first)
        while waiting:
            node = waiting.pop()
            for a, b, rigid in ties:
                for master, slave in ((a, b), (b, a)):
                    if master.first == node.first and slave.first not in done:
                        made.join(master, slave, rigid)
                        done.add(slave.first)
                        waiting.append(slave)
    return made
