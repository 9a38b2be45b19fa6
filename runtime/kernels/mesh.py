"""Meshes of cables: elements of equal or of individual lengths."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.deferred import dataclass

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers alone


@dataclass(frozen=True, eq=False)
class Mesh:
    """The elements of a cable.

    lengths: (1,) in m of equal elements, else (elements,); given: (elements + 1,) arc-lengths in m of the ends of
    unequal ones; doubled: elements, in their order, that begin at a node of their own at the place of the last node of
    the element before them.
    """

    n_elements: int
    lengths: np.ndarray
    given: np.ndarray | None = None
    doubled: tuple[int, ...] = ()

    @classmethod
    def even(cls, length: float, n_elements: int) -> Mesh:
        """Return the mesh of equal elements of a length, in m."""
        return cls(n_elements, np.array([length]))

    @classmethod
    def of_nodes(cls, node_s: np.ndarray, doubled: tuple[int, ...] = ()) -> Mesh:
        """Return the mesh with elements between arc-lengths (elements + 1,) in m, increasing from 0."""
        return cls(len(node_s) - 1, np.diff(node_s), node_s, doubled)

    @property
    def is_even(self) -> bool:
        """Return whether its elements are equal."""
        return self.given is None

    @property
    def n_nodes(self) -> int:
        """Return the number of its nodes."""
        return self.n_elements + 1 + len(self.doubled)

    @property
    def boundaries(self) -> np.ndarray:
        """Return (elements + 1,): arc-lengths of the ends of the elements, in m."""
        return self.lengths[0] * np.arange(self.n_elements + 1) if self.given is None else self.given

    @cached_property
    def element_of_node(self) -> np.ndarray:
        """Return (nodes,): the element that begins at each node, or the last one."""
        elements = np.full(self.n_nodes, -1)
        elements[self.last] = np.arange(self.n_elements)
        elements[self.first] = np.arange(self.n_elements)
        return elements

    @cached_property
    def boundary_of_node(self) -> np.ndarray:
        """Return (nodes,): the number of the boundary at which each node is."""
        return np.insert(np.arange(self.n_elements + 1), np.array(self.doubled, dtype=int), self.doubled)

    @property
    def nodes_of_boundaries(self) -> np.ndarray:
        """Return (elements + 1,): the number of a node at each end of the elements, of two the first."""
        return np.unique(self.boundary_of_node, return_index=True)[1]

    def at_node(self, node: int) -> range:
        """Return the numbers of the nodes at a place, by that of the first of them."""
        return range(node, node + 1 + bool(self.doubled and node + 1 in self.first_node(self.doubled)))

    @cached_property
    def first(self) -> Any:
        """Return the index, of an array of nodes, of the first nodes of the elements."""
        return self.first_node(np.arange(self.n_elements)) if self.doubled else slice(0, -1)

    @cached_property
    def last(self) -> Any:
        """Return the index, of an array of nodes, of the second nodes of the elements."""
        return self.first + 1 if self.doubled else slice(1, None)

    def first_node(self, element: ArrayLike) -> np.ndarray:
        """Return the numbers (...) of the first nodes of elements (...)."""
        element = np.asarray(element)
        return element + np.searchsorted(self.doubled, element, side="right") if self.doubled else element

    @property
    def total(self) -> float:
        """Return the length of the cable, in m."""
        return float(self.lengths[0] * self.n_elements if self.given is None else self.given[-1])

    @property
    def mean(self) -> float:
        """Return the mean length of an element, in m."""
        return float(self.lengths[0]) if self.is_even else self.total / self.n_elements

    @property
    def all_lengths(self) -> np.ndarray:
        """Return (elements,): the length of each element, in m."""
        return self.lengths.repeat(self.n_elements) if self.is_even else self.lengths

    @property
    def node_s(self) -> np.ndarray:
        """Return (nodes,): arc-lengths of the nodes, in m."""
        return self.boundaries[self.boundary_of_node] if self.doubled else self.boundaries

    def length(self, element: int) -> float:
        """Return the length of an element, in m."""
        return float(self.lengths[0 if self.is_even else element])

    def start(self, element: int) -> float:
        """Return the arc-length at which an element begins, in m."""
        return float(element * self.lengths[0] if self.given is None else self.given[element])

    def each_length(self, element: ArrayLike) -> ArrayLike:
        """Return the lengths of elements (...), in m: one for equal elements, else (...)."""
        return float(self.lengths[0]) if self.is_even else self.lengths[np.asarray(element)]

    def each_start(self, element: ArrayLike) -> np.ndarray:
        """Return the arc-lengths (...) at which elements (...) begin, in m."""
        element = np.asarray(element)
        starts: np.ndarray = element * self.lengths[0] if self.given is None else self.given[element]
        return starts

    def element_at(self, s: ArrayLike) -> np.ndarray:
        """Return the elements (...) at arc-lengths s (...); at a node the element that begins there."""
        s = np.asarray(s, dtype=float)
        found = s // self.lengths[0] if self.given is None else np.searchsorted(self.given, s, side="right") - 1
        return np.asarray(np.minimum(np.maximum(found, 0), self.n_elements - 1)).astype(int)

    def nearest_boundary(self, s: ArrayLike) -> np.ndarray:
        """Return the numbers (...) of the ends of elements nearest to arc-lengths s (...)."""
        s = np.asarray(s, dtype=float)
        if self.given is None:
            return np.asarray(np.clip(np.rint(s / self.lengths[0]), 0, self.n_elements).astype(int))
        return np.searchsorted((self.given[1:] + self.given[:-1]) / 2, s)

    def place(self, s: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Return the elements (...) at arc-lengths s (...), and x in them, in m."""
        element = self.element_at(s)
        return element, np.asarray(s, dtype=float) - self.each_start(element)

    def covered(self, start: float, stop: float) -> Iterator[tuple[int, float, float]]:
        """Yield the elements between two arc-lengths, with first and last x in each, m."""
        for element in range(self.n_elements):
            begin = self.start(element)
            first, last = max(start - begin, 0.0), min(stop - begin, self.length(element))
            if last > first:
                yield element, first, last

    def divided(self, parts: int) -> np.ndarray:
        """Return (parts elements + 1,): arc-lengths of nodes and of equidistant points of each element, m."""
        at, nodes = np.arange(parts * self.n_elements + 1) / parts, np.arange(self.n_elements + 1)
        return np.asarray(np.interp(at, nodes, self.boundaries))
