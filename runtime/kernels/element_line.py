"""A line of equal elements between nodes with given nodal vectors: its points and slopes, as the elements draw them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .libraries import kernels_of


class ElementLine:
    """Elements of one kind on nodes."""

    def __init__(self, library: str | None, element: str, length: float, nodal_vectors: np.ndarray):
        """length: of an element, in m; nodal_vectors: (nodes, vectors, dim)."""
        self.library, self.element, self.length, self.nodal_vectors = library, element, length, nodal_vectors

    def point(self, s: float, y: float = 0.0, z: float = 0.0) -> np.ndarray:
        """Return the point (3,) in m at arc-length ``s``, height ``y`` and width ``z`` of the section, all in m."""
        x, e = self._element_at(s)
        _, r = self._kernel("position")(self.length, np.array([x, y, z]), e)
        return np.pad(r, (0, 3 - len(r)))

    def slope(self, s: float) -> np.ndarray:
        """Return r_x (3,) at arc-length ``s`` in m."""
        x, e = self._element_at(s)
        _, N_x = self._kernel("on_axis")(self.length, x)
        r_x = N_x @ e
        return np.pad(r_x, (0, 3 - len(r_x)))

    def _element_at(self, s: float) -> tuple[float, np.ndarray]:
        """Return x in m within the element that holds ``s``, and its nodal vectors (2 vectors, dim)."""
        element = int(np.clip(np.floor(s / self.length), 0, len(self.nodal_vectors) - 2))
        return s - element * self.length, np.concatenate(self.nodal_vectors[element : element + 2])

    def _kernel(self, name: str) -> Callable:
        return getattr(kernels_of(self.library), f"{self.element}_{name}")
