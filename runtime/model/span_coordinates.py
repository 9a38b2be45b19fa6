"""The coordinates of spans of ropes, and places of material points in them."""

from __future__ import annotations

import numpy as np

from ..base.deferred import dataclass

KERNELS = {2: "span_cable8p", 3: "span_cable12"}
"""Kernels of spans, by the dimension of space."""
PER_NODE = 2
"""Vectors of a node: its place, and its slope by the stress-free arc-length."""


@dataclass(eq=False, repr=False)
class SpanCoordinates:
    """The dofs of a span: first of its nodes, shares of these in its length, and the two material coordinates."""

    first: int
    share: np.ndarray
    s: tuple[int, int]
    dim: int

    @property
    def n_elements(self) -> int:
        """Return the number of its elements."""
        return len(self.share) - 1

    def node(self, k: int) -> slice:
        """Return the dofs of node k, from the end where k is negative."""
        size = PER_NODE * self.dim
        first = self.first + size * (k % len(self.share))
        return slice(first, first + size)

    def places(self, q: np.ndarray) -> np.ndarray:
        """Return (nodes, dim): the places of its nodes in a configuration, m."""
        found: np.ndarray = q[self.nodes].reshape(len(self.share), PER_NODE, self.dim)[:, 0]
        return found

    def element_at(self, q: np.ndarray, s: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
        """Return the elements (T,) that hold a material coordinate, m, or one (T,) in each, in configurations q (T, n),
        and the material coordinates (T, 2) of their nodes.
        """
        first, last = q[:, self.s[0]], q[:, self.s[1]]
        element = np.clip(np.searchsorted(self.share, (s - first) / (last - first)) - 1, 0, self.n_elements - 1)
        return element, first[:, None] + np.stack([self.share[element], self.share[element + 1]], axis=1) * (
            last - first)[:, None]

    def element_of(self, q: np.ndarray, s: float, at: int) -> int:
        """Return the element that holds the material coordinate s, m, in a configuration q (n,): where s is at a node,
        the element `at` if it is beside it.
        """
        first, last = q[list(self.s)]
        share = (s - first) / (last - first)
        if self.share[at] <= share <= self.share[at + 1]:
            return at
        return int(np.clip(np.searchsorted(self.share, share, "right") - 1, 0, self.n_elements - 1))

    def point(self, q: np.ndarray, s: float) -> np.ndarray:
        """Return (T, dim): places of the material coordinate s, m, in configurations q (T, n)."""
        element, ends = self.element_at(q, s)
        nodal = q[:, self.nodes].reshape(len(q), len(self.share), PER_NODE, self.dim)
        length, rows = np.diff(ends), np.arange(len(q))
        values, slopes = cubic_shapes((s - ends[:, 0]) / length[:, 0])
        found: np.ndarray = sum((values[k][:, None] * nodal[rows, element + k, 0]
                                 + length * slopes[k][:, None] * nodal[rows, element + k, 1] for k in range(PER_NODE)),
                                np.zeros((len(q), self.dim)))
        return found

    @property
    def nodes(self) -> slice:
        """Return the dofs of all nodes."""
        return slice(self.first, self.first + PER_NODE * self.dim * len(self.share))


def cubic_shapes(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return shape functions of an element of unit length at x (n,), (2, n) each: of the places and slopes of nodes."""
    return (np.stack([1 - 3 * x**2 + 2 * x**3, 3 * x**2 - 2 * x**3]), np.stack([x - 2 * x**2 + x**3, x**3 - x**2]))


class AlongSpan:
    """Base of models of couplings along a span; without coordinates they are on none. Names are those of the engine,
    couplings/common/span_elements.h.
    """

    coordinates: SpanCoordinates | None

    @property
    def span_kernel(self) -> str:
        """Return the name of the kernels of the span, "" for none."""
        return KERNELS[self.coordinates.dim] if self.coordinates else ""

    @property
    def span_elements(self) -> int:
        """Return the number of its elements."""
        return self.coordinates.n_elements if self.coordinates else 0

    @property
    def span_first(self) -> int:
        """Return the first dof of its nodes."""
        return self.coordinates.first if self.coordinates else 0

    @property
    def span_s(self) -> tuple[int, int]:
        """Return the dofs of the material coordinates of its ends."""
        return self.coordinates.s if self.coordinates else (0, 0)

    @property
    def span_share(self) -> np.ndarray:
        """Return the shares of its nodes in its length."""
        return self.coordinates.share if self.coordinates else np.zeros(0)

    @property
    def adjacent(self) -> list[np.ndarray]:
        """Return the dofs of each element."""
        if (at := self.coordinates) is None:
            return []
        return [np.r_[at.node(k), at.node(k + 1), at.s] for k in range(at.n_elements)]

    @property
    def kernel_families(self) -> list[str]:
        """Return the names of the kernel families that it uses."""
        kernel = getattr(self, "kernel", "")
        return [each for each in (kernel, self.span_kernel) if each]
