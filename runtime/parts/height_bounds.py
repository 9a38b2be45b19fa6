"""Bounds of the heights of a spline, of its slope and of its second derivatives.

On a piece of a cell each of them is a polynomial, which lies between the least and the largest of its coefficients in
Bernstein's form (Farouki 2012, doi:10.1016/j.cagd.2012.03.001). So these are bounds for all places, and not samples.
"""

from __future__ import annotations

from itertools import starmap
from math import comb

import numpy as np

PIECES = {1: 8, 2: 2}
"""Pieces of a cell along each of its axes, by the number of these: the more, the closer the bounds are."""
AT_ONCE = 10_000
"""Cells that are looked at together: the coefficients on their pieces take up to 5 kB of each."""


def _in_bernsteins_form(pieces: int, order: int) -> np.ndarray:
    """Return (4 pieces, 4): coefficients of a derivative on each piece of 0 to 1, from those of the powers there."""

    def entry(row: int, k: int) -> float:
        """Return the coefficient that a power, derived, has there, as a sum of powers of the way on the piece."""
        piece, i = divmod(row, 4)
        power = k - order
        if power < 0:
            return 0.0
        factor = float(np.prod(np.arange(power + 1, k + 1)))
        return factor * sum(comb(power, j) * (piece / pieces)**(power - j) / pieces**j * comb(i, j) / comb(3, j)
                            for j in range(min(i, power) + 1))

    return np.array(list(starmap(entry, np.ndindex(4 * pieces, 4)))).reshape(-1, 4)


def height_bounds(first: np.ndarray, second: np.ndarray | None, cells: np.ndarray) -> tuple[float, float, float]:
    """Return upper bounds of a spline's heights in m, of its slope, and of what that changes by along it, in 1/m.

    first (m), second (n) or None: its knots in m; cells (m - 1, n - 1, 4, 4), or (m - 1, 4) where there is no second:
    coefficients of powers of the way from a cell's first knots.
    """
    widths = np.diff(first)[:, None] ** np.arange(4)
    if second is None:
        forms = [_in_bernsteins_form(PIECES[1], order) for order in range(3)]
        height, slope, bend = ((cells * widths) @ form.T / widths[:, 1:2]**order for order, form in enumerate(forms))
        return float(height.max()), float(abs(slope).max()), float(abs(bend).max())
    across = np.diff(second)[:, None] ** np.arange(4)
    rows = max(1, AT_ONCE // len(across))
    found = [_bounds_of_two(cells[k:k + rows], widths[k:k + rows], across) for k in range(0, len(cells), rows)]
    highest, steepest, bend = (max(each) for each in zip(*found, strict=True))
    return highest, steepest, bend


def _bounds_of_two(cells: np.ndarray, along: np.ndarray, across: np.ndarray) -> tuple[float, float, float]:
    """Return the bounds of heights over two axes; along, across: powers of the widths of their cells."""
    pieces = PIECES[2]
    forms = [_in_bernsteins_form(pieces, order) for order in range(3)]
    scaled = cells * along[:, None, :, None] * across[None, :, None, :]

    def on_pieces(a: int, b: int) -> np.ndarray:
        """Return (cells, cells, pieces, 4, pieces, 4) coefficients of the derivative of these orders."""
        form = forms[a] @ scaled @ forms[b].T / (along[:, a, None] * across[None, :, b])[..., None, None]
        return form.reshape(*form.shape[:2], pieces, 4, pieces, 4)

    def squared(a: int, b: int) -> np.ndarray:
        """Return (cells, cells, pieces, pieces): the largest square of that derivative there."""
        return np.square(on_pieces(a, b)).max(axis=(3, 5))

    slope = squared(1, 0) + squared(0, 1)
    bend = squared(2, 0) + 2 * squared(1, 1) + squared(0, 2)
    return float(on_pieces(0, 0).max()), float(np.sqrt(slope.max())), float(np.sqrt(bend.max()))
