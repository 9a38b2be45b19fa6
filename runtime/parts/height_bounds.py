"""Bounds of the heights of a spline, of its slope and of its second derivatives.

On a piece of a cell each is a polynomial, which lies between its least and largest coefficient in Bernstein's form
(Farouki 2012, doi:10.1016/j.cagd.2012.03.001). The bounds hold everywhere, not only at samples.
"""

from __future__ import annotations

from itertools import starmap
from math import comb

import numpy as np

PIECES = {1: 8, 2: 2}
"""Pieces of a cell along each axis, by the number of axes; more pieces give closer bounds."""
CELLS_PER_BLOCK = 10_000
"""Each cell takes up to 5 kB for the coefficients on its pieces."""


def _in_bernsteins_form(pieces: int, order: int) -> np.ndarray:
    """Return (4 pieces, 4): the matrix from power coefficients on [0, 1] to those of a derivative on each piece."""

    def entry(row: int, k: int) -> float:
        """Return the coefficient of a differentiated power."""
        piece, i = divmod(row, 4)
        power = k - order
        if power < 0:
            return 0.0
        factor = float(np.prod(np.arange(power + 1, k + 1)))
        return factor * sum(comb(power, j) * (piece / pieces)**(power - j) / pieces**j * comb(i, j) / comb(3, j)
                            for j in range(min(i, power) + 1))

    return np.array(list(starmap(entry, np.ndindex(4 * pieces, 4)))).reshape(-1, 4)


def height_bounds(first: np.ndarray, second: np.ndarray | None, cells: np.ndarray) -> tuple[float, float, float]:
    """Return upper bounds of a spline's height in m, of its slope, and of its second derivatives in 1/m.

    first (m,), second (n,) or None: breakpoints in m; cells (m - 1, n - 1, 4, 4), or (m - 1, 4) without second:
    coefficients of powers of the distance from the first breakpoints of a cell.
    """
    widths = np.diff(first)[:, None] ** np.arange(4)
    if second is None:
        forms = [_in_bernsteins_form(PIECES[1], order) for order in range(3)]
        height, slope, bend = ((cells * widths) @ form.T / widths[:, 1:2]**order for order, form in enumerate(forms))
        return float(height.max()), float(abs(slope).max()), float(abs(bend).max())
    across = np.diff(second)[:, None] ** np.arange(4)
    rows = max(1, CELLS_PER_BLOCK // len(across))
    found = [_bounds_of_two(cells[k:k + rows], widths[k:k + rows], across) for k in range(0, len(cells), rows)]
    highest, steepest, bend = (max(each) for each in zip(*found, strict=True))
    return highest, steepest, bend


def _bounds_of_two(cells: np.ndarray, along: np.ndarray, across: np.ndarray) -> tuple[float, float, float]:
    """Return the bounds of heights over two axes; along, across: powers of the widths of the cells."""
    pieces = PIECES[2]
    forms = [_in_bernsteins_form(pieces, order) for order in range(3)]
    scaled = cells * along[:, None, :, None] * across[None, :, None, :]

    def on_pieces(a: int, b: int) -> np.ndarray:
        """Return (cells, cells, pieces, 4, pieces, 4): coefficients of a derivative of two orders."""
        form = forms[a] @ scaled @ forms[b].T / (along[:, a, None] * across[None, :, b])[..., None, None]
        return form.reshape(*form.shape[:2], pieces, 4, pieces, 4)

    def squared(a: int, b: int) -> np.ndarray:
        """Return (cells, cells, pieces, pieces): the largest square of a derivative."""
        return np.square(on_pieces(a, b)).max(axis=(3, 5))

    slope = squared(1, 0) + squared(0, 1)
    bend = squared(2, 0) + 2 * squared(1, 1) + squared(0, 2)
    return float(on_pieces(0, 0).max()), float(np.sqrt(slope.max())), float(np.sqrt(bend.max()))
