"""What a fluid with a surface does to the parts of a cable's elements that are wet, at one instant."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...model.model import CableModel
from ...model.states import spatial
from .spreads import Spread, lengths_of_rows, rows


@dataclass
class WetPart:
    """A part of an element between two cuts by surfaces, with n points of quadrature, their places and weights in m."""

    cable: CableModel
    element: int
    x: np.ndarray
    weights: np.ndarray
    N: np.ndarray
    N_x: np.ndarray

    @classmethod
    def of(cls, cable: CableModel, element: int, x: np.ndarray, weights: np.ndarray) -> WetPart:
        """Return the part with shape functions and their slopes (n, vectors)."""
        lengths = lengths_of_rows(cable.mesh, np.full(len(x), element), x.shape)
        N, N_x = rows(cable.kernel("on_axis"), len(x), lengths, x)
        return cls(cable, element, x, weights, N.reshape(len(x), -1), N_x.reshape(len(x), -1))

    def spread(self, density: np.ndarray, on_slope: np.ndarray | None = None) -> Spread:
        """Return a force a length (n, 3), N/m, and what acts on the slope (n, 3), N, along the part; its ends are where
        the weights have their sum, which are symmetrical.
        """
        dim, length = self.cable.shape[2], self.weights.sum()
        middle = self.weights @ self.x / length
        f = np.einsum("g,gk,gd->kd", self.weights, self.N, density[:, :dim])
        if on_slope is not None:
            f = f + np.einsum("g,gk,gd->kd", self.weights, self.N_x, on_slope[:, :dim])
        return Spread(self.element, middle - length / 2, middle + length / 2, self.x, density[None], f[None],
                      None if on_slope is None else on_slope[None], weights=self.weights)


@dataclass
class AddedOfParts:
    """Mass of fluids that moves with the wet parts of a cable: parts with M (n, dim, dim), kg/m, at their points."""

    cable: CableModel
    parts: list[tuple[WetPart, np.ndarray]]

    def matrices(self) -> np.ndarray:
        """Return (1, elements, n, n): mass matrices of the elements, n = vectors dim."""
        vectors, dim = 2 * self.cable.shape[1], self.cable.shape[2]
        found = np.zeros((1, self.cable.n_elements, vectors * dim, vectors * dim))
        for part, M in self.parts:
            of = np.einsum("g,gk,gij,gl->kilj", part.weights, part.N, M, part.N)
            found[0, part.element] += of.reshape(vectors * dim, -1)
        return found

    def spreads(self, cable: CableModel, a: np.ndarray) -> Iterator[Spread]:
        """Yield the force of the fluid by the accelerations a (1, elements, vectors, dim) of the elements."""
        for part, M in self.parts:
            yield part.spread(spatial(-np.einsum("gij,gk,kj->gi", M, part.N, a[0, part.element])))
