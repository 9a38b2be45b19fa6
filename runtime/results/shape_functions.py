"""Shape functions of cables at places of their axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..kernels.libraries import kernels_of
from ..model.model import CableModel
from ..parts.cable import Cable

if TYPE_CHECKING:
    from numpy.typing import ArrayLike  # 9 ms, for type checkers alone


def on_axis(cable: Cable | CableModel, element: ArrayLike, x: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Return the shape functions of positions and their derivatives by x, (..., vectors of two nodes).

    x: (...) in m from the start of the elements (...).
    """
    x = np.asarray(x, dtype=float)
    N, N_x = _rows(cable, "on_axis", element, x)
    return N.reshape(*x.shape, -1), N_x.reshape(*x.shape, -1)


def of_slopes(cable: Cable | CableModel, element: ArrayLike, x: ArrayLike) -> np.ndarray:
    """Return the shape functions (..., 3, vectors of two nodes) of r_x, r_y and r_z; x as for `on_axis`."""
    x = np.asarray(x, dtype=float)
    found: np.ndarray = _rows(cable, "slopes", element, x)[:, :, 0]
    return found.reshape(*x.shape, 3, -1)


def _rows(cable: Cable | CableModel, kernel: str, element: ArrayLike, x: np.ndarray) -> Any:
    lengths = np.broadcast_to(cable.mesh.each_length(element), x.shape).ravel()
    return getattr(kernels_of(cable.library), f"{cable.element}_{kernel}").rows(x.size, lengths, x.ravel())
