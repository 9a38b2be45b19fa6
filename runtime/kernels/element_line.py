"""Points and slopes of a line of elements with given nodal vectors."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .libraries import kernels_of
from .mesh import Mesh


class ElementLine:
    """Elements of one kind on nodes."""

    def __init__(self, library: str | None, element: str, mesh: Mesh, nodal_vectors: np.ndarray):
        """nodal_vectors: (nodes, vectors, dim)."""
        self.library, self.element, self.mesh, self.nodal_vectors = library, element, mesh, nodal_vectors

    def point(self, s: float, y: float = 0.0, z: float = 0.0) -> np.ndarray:
        """Return the point (3,) in m at arc-length ``s``, height ``y`` and width ``z`` of the section, all in m."""
        length, x, e = self._element_at(s)
        _, r = self._kernel("position")(length, np.array([x, y, z]), e)
        return np.pad(r, (0, 3 - len(r)))

    def slope(self, s: float) -> np.ndarray:
        """Return r_x (3,) at arc-length ``s`` in m."""
        length, x, e = self._element_at(s)
        _, N_x = self._kernel("on_axis")(length, x)
        r_x = N_x @ e
        return np.pad(r_x, (0, 3 - len(r_x)))

    def _element_at(self, s: float) -> tuple[float, float, np.ndarray]:
        """Return the length of the element at ``s`` and x in it, m, and its nodal vectors (2 vectors, dim)."""
        element = int(self.mesh.element_at(s))
        first = int(self.mesh.first_node(element))
        return (self.mesh.length(element), s - self.mesh.start(element),
                np.concatenate(self.nodal_vectors[first : first + 2]))

    def _kernel(self, name: str) -> Callable[..., Any]:
        kernel: Callable[..., Any] = getattr(kernels_of(self.library), f"{self.element}_{name}")
        return kernel


def along_elements(on_axis: Any, lengths: np.ndarray,
                   rule: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the shape functions of the axis and their slopes, (elements, points, vectors) each, by the kernel on_axis,
    and the weights (elements, points) in m.

    lengths (elements,) in m; rule: points and weights between -1 and 1, as of `gauss`.
    """
    places, weights = rule
    shapes = [[on_axis(length, length * (1 + x) / 2) for x in places] for length in lengths]
    N, N_x = (np.array([[shape[k] for shape in each] for each in shapes]) for k in range(2))
    return N, N_x, np.outer(lengths, weights) / 2
