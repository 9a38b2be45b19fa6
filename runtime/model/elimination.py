"""Symbolic analysis of the border: the order of its elimination, found once for a scene.

The nodes of the graph are groups of unknowns: of a body, of a coupling, of nodes of cables in the border. Eliminating a
group connects its neighbours. Minimum degree keeps them few: the operations for chains and trees of bodies are linear
in the number of bodies. Groups that are eliminated together are a front (engine/linear/fronts.h).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field
from functools import cached_property, lru_cache
from heapq import heapify, heappop, heappush
from typing import Any

import numpy as np

from ..base.deferred import dataclass
from .system_layout import SystemLayout

MAX_DENSE_BORDER = 60
"""Unknowns of a border up to which one front is as fast as several."""
FRONT_OVERHEAD = 500.0
"""Work of a front beside its arithmetic, in operations."""
MAX_DELAYED = 100
"""Pivots that a front of more unknowns may take from earlier ones, in the mean of all fronts; others may double."""
SOLVES_PER_FACTORISATION = 5
"""Approximate number of solves per factorisation."""


@dataclass(eq=False, repr=False)
class Elimination:
    """Fronts as in engine/linear/fronts.h; strips (n, 3): an unknown, a chain coupled to it, increasing, and 1 for
    memory that moves from one chain to another with a slide, after the others of its unknown; else 0.

    banded_front: a front without neighbours that may be a band in an order found by the engine, -1 for none.
    """

    m: int
    start: np.ndarray
    first: np.ndarray
    pivots: np.ndarray
    neighbours: np.ndarray
    unknown: np.ndarray
    in_parent: np.ndarray
    parent: np.ndarray
    child: np.ndarray
    sibling: np.ndarray
    front: np.ndarray
    place: np.ndarray
    strips: np.ndarray
    banded_front: int = -1
    _layouts: dict[tuple[bytes, int], SystemLayout] = field(default_factory=dict)

    def layout(self, chains: np.ndarray, beyond: int) -> SystemLayout:
        """Return the layout of a system with this border, once for all scenes of one topology; see `SystemLayout.of`.
        """
        key = chains.tobytes(), beyond
        if key not in self._layouts:
            self._layouts[key] = SystemLayout.of(self, chains, beyond)
        return self._layouts[key]

    @property
    def n(self) -> int:
        """Return the number of fronts."""
        return len(self.pivots)

    @property
    def sizes(self) -> np.ndarray:
        """Return (fronts,): the number of unknowns of each, neighbours included."""
        return np.asarray(self.pivots + self.neighbours)

    @property
    def most_sizes(self) -> np.ndarray:
        """Return (fronts,): unknowns for which each front has memory, delayed pivots included."""
        return np.asarray(self.sizes + np.minimum(self.sizes, MAX_DELAYED))

    def most_numbers(self, unpacked: int) -> float:
        """Return the memory of factors and Schur complements during a factorisation, in numbers.

        unpacked: unknowns of a front up to which its Schur complement stays beside its factors.
        """
        sizes = self.most_sizes.astype(float)
        moved = np.where(self.sizes > unpacked, (self.neighbours + sizes - self.sizes) ** 2, 0.0)
        has_parent = self.parent >= 0
        freed = np.bincount(self.parent[has_parent], moved[has_parent], self.n)
        before = np.cumsum(sizes**2 - freed) - (sizes**2 - freed)
        return float((before + sizes**2 + moved).max())

    @cached_property
    def size(self) -> int:
        """Return the number of entries of the matrix."""
        return int((self.pivots * (self.pivots + 2 * self.neighbours)).sum())

    @property
    def largest_last(self) -> int:
        """Return the largest front without neighbours, -1 of a single front."""
        last = np.flatnonzero(self.neighbours == 0)
        return int(last[np.argmax(self.pivots[last])]) if self.n > 1 else -1

    @property
    def operations(self) -> float:
        """Return the number of multiplications of a factorisation."""
        p, s = self.pivots.astype(float), self.neighbours.astype(float)
        return float((p**3 / 3 + p**2 * s + p * s**2).sum())

    @cached_property
    def solves(self) -> float:
        """Return the multiplications of a factorisation over those of a solve; 0 with a front that may be a band."""
        return self.operations / max(self.size, 1) if self.banded_front < 0 else 0.0

    @property
    def cost(self) -> float:
        """Return the operations of a factorisation and its solves, with the overhead of fronts."""
        return float(_cost(self.pivots.astype(float), self.neighbours.astype(float)).sum())

    def entries(self) -> tuple[np.ndarray, np.ndarray]:
        """Return (size,) each: the rows and columns of the entries in storage order."""
        rows, columns = [], []
        for first, p, s in zip(self.first, self.pivots, self.neighbours, strict=True):
            own, all_of_it = self.unknown[first : first + p], self.unknown[first : first + p + s]
            rows += [np.tile(all_of_it, p), np.tile(own, s)]
            columns += [np.repeat(own, p + s), np.repeat(all_of_it[p:], p)]
        none = np.zeros(0, dtype=int)
        return np.concatenate([none, *rows]), np.concatenate([none, *columns])


def dense(m: int, strips: np.ndarray) -> Elimination:
    """Return the elimination of m unknowns in one front; strips: see `Elimination`."""
    none, zero, every = np.array([-1]), np.array([0]), np.arange(m)
    return Elimination(m, zero, zero, np.array([m]), zero, every, 0 * every, none, none, none, 0 * every, every, strips)


@lru_cache(maxsize=64)
def dense_beside(m: int, chains: int) -> Elimination:
    """Return the elimination of m unknowns in one front, all coupled to each of a number of chains."""
    return dense(m, np.array([*np.divmod(np.arange(m * chains), max(chains, 1)), np.zeros(m * chains, dtype=int)]).T)


class BorderGraph:
    """Groups of the border's unknowns, their adjacency, and the chains of the band that are coupled to them.

    A constraint waits for its bodies: before their elimination its rows have no pivots.
    """

    def __init__(self) -> None:
        self.unknowns: list[np.ndarray] = []
        self.beside: list[set[int]] = []
        self.on_chain: dict[int, set[int]] = {}
        self.moving: dict[int, tuple[int, frozenset[int]]] = {}
        self.waits: dict[int, set[int]] = {}

    def group(self, unknowns: Iterable[int], waits: Iterable[int] | None = None) -> int:
        """Add a group of unknowns and return its number; waits: of a constraint, the groups of its bodies."""
        self.unknowns.append(np.array(list(unknowns), dtype=int))
        self.beside.append(set())
        if waits is not None:
            self.waits[len(self.beside) - 1] = set(waits)
        return len(self.beside) - 1

    def join(self, groups: Iterable[int]) -> None:
        """Make these groups neighbours of each other."""
        groups = set(groups)
        for group in groups:
            self.beside[group] |= groups
            self.beside[group].discard(group)

    def couple(self, group: int, chains: Iterable[int]) -> None:
        """Couple a group to chains, whose elimination connects all their groups."""
        for chain in chains:
            self.on_chain.setdefault(chain, set()).add(group)

    def follow(self, group: int, longest: int, chains: Iterable[int]) -> None:
        """Couple a group to chains with one of which at a time it has entries; longest: the one with most rows."""
        self.moving[group] = longest, frozenset(chains)

    def eliminate(self) -> Elimination:
        """Return the elimination: one front, or those of minimum degree where these save operations.

        Scenes with equal graphs, such as those of one topology, share the analysis and the arrays.
        """
        return eliminated(tuple(tuple(own.tolist()) for own in self.unknowns), tuple(map(frozenset, self.beside)),
                          _frozen(self.on_chain), tuple(sorted(self.moving.items())), _frozen(self.waits))

    def _eliminated(self) -> Elimination:
        memory = [(int(unknown), 0, chain) for chain, groups in self.on_chain.items() for group in groups
                  for unknown in self.unknowns[group]]
        memory += [(int(unknown), 1, longest) for group, (longest, _) in self.moving.items()
                   for unknown in self.unknowns[group]]
        strips = np.array(sorted(memory), dtype=int).reshape(-1, 3)[:, [0, 2, 1]]
        on_chain = {chain: set(groups) for chain, groups in self.on_chain.items()}
        for group, (_, chains) in self.moving.items():
            for chain in chains:
                on_chain.setdefault(chain, set()).add(group)
        for groups in on_chain.values():
            self.join(groups)
        sparse = self._laid_out(*self._merged(*self._fronts()), strips)
        return sparse if sparse.cost < _cost(sparse.m, 0) else dense(sparse.m, strips)

    def _fronts(self) -> tuple[list[list[int]], list[set[int]]]:
        """Return the groups and the neighbours of each front, in the order of elimination, by minimum degree."""
        graph = _Remaining([len(own) for own in self.unknowns], self.beside, self.waits)
        fronts: list[list[int]] = []
        neighbours: list[set[int]] = []
        while (pivot := graph.next_pivot()) is not None:
            together, around = graph.eliminate(pivot)
            fronts.append(together)
            neighbours.append(around)
        assert all(graph.gone), "a constraint waits for no body"
        return fronts, neighbours

    def _merged(self, fronts: list[list[int]], neighbours: list[set[int]]) -> tuple[list[list[int]], list[set[int]]]:
        """Return the fronts, merged where this saves operations."""
        p, s = ([sum(len(self.unknowns[group]) for group in part) for part in parts] for parts in (fronts, neighbours))
        children: list[list[int]] = [[] for _ in fronts]
        kept = [True] * len(fronts)
        for k, above in enumerate(_parents(fronts, neighbours)):
            waiting, children[k] = children[k], []
            while waiting:
                child = waiting.pop()
                if _cost(p[k] + p[child], s[k]) <= _cost(p[k], s[k]) + _cost(p[child], s[child]):
                    kept[child] = False
                    p[k] += p[child]
                    fronts[k] = fronts[child] + fronts[k]
                    waiting += children[child]
                else:
                    children[k].append(child)
            if above >= 0:
                children[above].append(k)
        return ([front for front, keep in zip(fronts, kept, strict=True) if keep],
                [front for front, keep in zip(neighbours, kept, strict=True) if keep])

    def _laid_out(self, fronts: list[list[int]], beside: list[set[int]], strips: np.ndarray) -> Elimination:
        """Return the arrays of fronts, given by their groups and neighbours."""
        def sorted_unknowns(groups: Iterable[int]) -> np.ndarray:
            return np.sort(np.concatenate([np.zeros(0, dtype=int), *(self.unknowns[group] for group in groups)]))

        own, around = [sorted_unknowns(part) for part in fronts], [sorted_unknowns(part) for part in beside]
        pivots, neighbours = np.array([len(part) for part in own]), np.array([len(part) for part in around])
        parent = np.array(_parents(fronts, beside))
        child, sibling = np.full(len(fronts), -1), np.full(len(fronts), -1)
        for k in reversed(range(len(fronts))):
            if parent[k] >= 0:
                sibling[k], child[parent[k]] = child[parent[k]], k
        m = int(pivots.sum())
        front, place = np.zeros(m, dtype=int), np.zeros(m, dtype=int)
        in_parent = []
        for k, (of, others) in enumerate(zip(own, around, strict=True)):
            front[of], place[of] = k, np.arange(len(of))
            in_parent += [np.zeros(len(of), dtype=int)]
            if len(others):
                above, beyond = own[parent[k]], around[parent[k]]
                at = np.searchsorted(above, others).clip(max=len(above) - 1)
                outside = len(above) + np.searchsorted(beyond, others)
                in_parent += [np.where(above[at] == others, at, outside)]
        lengths = pivots + neighbours
        starts = pivots * (pivots + 2 * neighbours)
        return Elimination(m, np.cumsum(starts) - starts, np.cumsum(lengths) - lengths, pivots, neighbours,
                           np.concatenate([part for pair in zip(own, around, strict=True) for part in pair]),
                           np.concatenate(in_parent), parent, child, sibling, front, place, strips)


class _Remaining:
    """A graph during elimination by minimum degree."""

    def __init__(self, size: list[int], beside: list[set[int]], waits: dict[int, set[int]]):
        self.size = size
        self.beside = [set(groups) for groups in beside]
        self.waits = {group: set(of) for group, of in waits.items()}
        self.gone = [False] * len(size)
        self.eliminations = 0
        self.degree = [self._degree(group) for group in range(len(size))]
        # among equal degrees the group that changed last: chains are eliminated from their ends
        self.waiting = [(of, 0, group) for group, of in enumerate(self.degree) if not self.waits.get(group)]
        heapify(self.waiting)

    def next_pivot(self) -> int | None:
        """Return a group of the least degree that waits for no other; None at the end."""
        while self.waiting:
            of, _, group = heappop(self.waiting)
            if not self.gone[group] and of == self.degree[group]:
                return group
        return None

    def eliminate(self, pivot: int) -> tuple[list[int], set[int]]:
        """Return the groups eliminated with a pivot, itself included, and the groups that become connected."""
        around = self.beside[pivot]
        constraints = [group for group in around if group in self.waits]
        if len(constraints) == 1:  # the last connection of eliminated groups
            self.waits[constraints[0]] = set()
        for group in around:
            self.beside[group] |= around
            self.beside[group] -= {group, pivot}
        together = [pivot, *sorted(group for group in around if self._costs_nothing(group, pivot, len(around)))]
        around = around.difference(together)
        for group in together:
            self.gone[group] = True
        for group in around:
            self._update(group, together)
        self.eliminations += 1
        return together, around

    def _costs_nothing(self, group: int, pivot: int, around: int) -> bool:
        """Return whether a neighbour of a pivot has only neighbours of the pivot, and waits for no other."""
        return len(self.beside[group]) == around - 1 and not self.waits.get(group, set()) - {pivot}

    def _update(self, group: int, gone: list[int]) -> None:
        """Remove eliminated groups from the neighbours of a group, and queue it unless it waits for others."""
        self.beside[group].difference_update(gone)
        self.degree[group] = self._degree(group)
        if group in self.waits:
            self.waits[group].difference_update(gone)
        if not self.waits.get(group):
            heappush(self.waiting, (self.degree[group], -self.eliminations, group))

    def _degree(self, group: int) -> int:
        """Return the number of unknowns of the neighbours of a group."""
        return sum(self.size[other] for other in self.beside[group])


def _frozen(sets: dict[int, set[int]]) -> tuple[tuple[int, frozenset[int]], ...]:
    return tuple((key, frozenset(sets[key])) for key in sorted(sets))


@lru_cache(maxsize=32)
def eliminated(unknowns: tuple[tuple[int, ...], ...], beside: tuple[frozenset[int], ...],
               on_chain: tuple[tuple[int, frozenset[int]], ...],
               moving: tuple[tuple[int, tuple[int, frozenset[int]]], ...],
               waits: tuple[tuple[int, frozenset[int]], ...]) -> Elimination:
    """Return the elimination of a `BorderGraph`, given by its attributes, cached."""
    graph = BorderGraph()
    graph.unknowns, graph.beside = [np.array(own, dtype=int) for own in unknowns], [set(groups) for groups in beside]
    graph.on_chain = {chain: set(groups) for chain, groups in on_chain}
    graph.moving, graph.waits = dict(moving), {group: set(groups) for group, groups in waits}
    return graph._eliminated()


def _parents(fronts: list[list[int]], neighbours: list[set[int]]) -> list[int]:
    """Return for each front the one that eliminates its first neighbour, -1 without neighbours."""
    of = {group: k for k, front in enumerate(fronts) for group in front}
    return [min((of[group] for group in around), default=-1) for around in neighbours]


def _cost(p: Any, s: Any) -> Any:
    """Return the operations of a front with p pivots and s neighbours, solves included."""
    return p**3 / 3 + p**2 * s + p * s**2 + SOLVES_PER_FACTORISATION * (p**2 + 2 * p * s) + FRONT_OVERHEAD
