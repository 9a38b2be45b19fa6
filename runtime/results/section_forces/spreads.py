"""Forces a length along the elements of cables, and the shape functions at their places."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...kernels.mesh import Mesh
from ...model.contacts import ContactModel
from ...model.drag_forces import Turning
from ...model.drags import DragModel
from ...model.loads import GAUSS
from ...model.model import CableModel, Kernel
from ...model.states import spatial
from ...parts.validation import EXACT

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, and for type checkers alone


@dataclass
class Spread:
    """A force a length along an element from x = start to stop (m).

    x (n,): places in between; density (T, n, 3) there, in N/m, a polynomial between them; f (T, vectors, dim).
    on_slope (T, n, 3), in N: what does work with the change of r_x, likewise a polynomial; None: nothing. couple
    (T, n, 3), in N: a moment a length, likewise. weights (n,) in m: of a rule that is better than the polynomial.
    """

    element: int
    start: float
    stop: float
    x: np.ndarray
    density: np.ndarray
    f: np.ndarray
    on_slope: np.ndarray | None = None
    couple: np.ndarray | None = None
    weights: np.ndarray | None = None

    def holds(self, x: np.ndarray, length: float) -> np.ndarray:
        """Return whether places x in its element, of this length, are on it; the element's ends, if it reaches them."""
        near = EXACT * length
        return ((x >= self.start) | (self.start < near)) & ((x < self.stop) | (self.stop > length - near))


@dataclass
class AddedMass:
    """Mass of a fluid that moves with a cable: M (T, elements, points, dim, dim), kg/m, where its drag has points."""

    M: np.ndarray
    drag: DragModel

    def matrices(self) -> np.ndarray:
        """Return (T, elements, n, n): mass matrices of the elements, n = vectors dim."""
        N = np.broadcast_to(self.drag.N, (self.M.shape[1], *self.drag.N.shape[1:]))
        found = np.einsum("eg,egk,tegij,egl->tekilj", np.broadcast_to(self.drag.weights, N.shape[:2]), N, self.M, N)
        n = N.shape[2] * self.M.shape[-1]
        return found.reshape(*found.shape[:2], n, n)

    def spreads(self, cable: CableModel, a: np.ndarray) -> Iterator[Spread]:
        """Yield the force of the fluid by the accelerations a (T, elements, vectors, dim) of the elements."""
        N = np.broadcast_to(self.drag.N, (self.M.shape[1], *self.drag.N.shape[1:]))
        return spread_along(cable, self.drag, spatial(-np.einsum("tegij,egk,tekj->tegi", self.M, N, a)))


def spread_along(cable: CableModel, of: DragModel | ContactModel, density: np.ndarray,
                 on_slope: np.ndarray | None = None, turning: Turning | None = None) -> Iterator[Spread]:
    """Yield what acts at the points of quadrature of a drag or contact on a cable, (T, elements, points, 3)."""
    for element in range(cable.n_elements):
        k, length = 0 if cable.mesh.is_even else element, cable.mesh.length(element)
        f = np.einsum("g,gk,tgd->tkd", of.weights[k], of.N[k], density[:, element, :, : cable.shape[2]])
        if isinstance(of, ContactModel):
            first = element * of.n_points
            places = of.arc[first : first + of.n_points] - cable.mesh.start(element)
        else:
            places = length / 2 * (1 + np.array(GAUSS[0]))
        slope = None if on_slope is None else on_slope[:, element]
        if slope is not None and isinstance(of, DragModel):
            f = f + np.einsum("g,gk,tgd->tkd", of.weights[k], of.N_x[k], slope[..., : cable.shape[2]])
        if turning is not None and isinstance(of, DragModel):
            for shape, forces in ((of.N_x, turning.on_slope), (of.N_chord, turning.on_chord)):
                f = f + np.einsum("g,gk,tgd->tkd", of.weights[k], shape[k], forces[:, element])
        couple = None if turning is None else turning.couple[:, element]
        yield Spread(element, 0.0, length, places, density[:, element], f, slope, couple)


def at_element(cable: CableModel, s: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Return the elements that arc-lengths s are in, and x in them; at a node the element that begins there."""
    return cable.mesh.place(s)


def shape_on_axis(cable: CableModel, element: ArrayLike, x: ArrayLike) -> np.ndarray:
    """Return (..., vectors): shape functions at places x (...) of the centrelines of elements (...)."""
    at = np.asarray(x, dtype=float)
    found = rows(cable.kernel("on_axis"), at.size, lengths_of_rows(cable.mesh, element, at.shape), at.ravel())[0]
    return found.reshape(*at.shape, -1)


def lengths_of_rows(mesh: Mesh, element: ArrayLike, shape: tuple[int, ...]) -> ArrayLike:
    """Return the lengths of elements (...) in m as `rows` takes them: one for all, or one for each entry of a shape."""
    return mesh.mean if mesh.is_even else np.broadcast_to(mesh.each_length(element), shape).ravel()


def rows(kernel: Kernel, n: int, *given: ArrayLike) -> Any:
    """Call a kernel n times and return its outputs; each argument has the kernel's shape, or that after n."""
    return kernel.rows(n, *given)
