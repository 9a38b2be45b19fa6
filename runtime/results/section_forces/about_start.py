"""Functions of configurations near one at the start, in runs by the linear model: their values there and derivatives.

Elastic forces of displaced nodes have terms of second order times EA, which the linear model does not have: the
square of a slope would be a false strain.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

SHARE = 1e-4
"""Of a displacement: the step of the central difference; its error is the square of it, its rounding 1e-12."""


def about(function: Callable[[np.ndarray], tuple[np.ndarray, ...]], start: np.ndarray | None, e: np.ndarray
          ) -> tuple[np.ndarray, ...]:
    """Return the values of a function at configurations e (n, ...), linear about the start (n, ...); None: as they are.
    """
    if start is None:
        return function(e)
    begin = np.broadcast_to(start, e.shape)
    step = SHARE * (e - begin)
    return tuple(at + (more - less) / (2 * SHARE) for at, more, less in zip(
        *(function(np.ascontiguousarray(place)) for place in (begin, begin + step, begin - step)), strict=True))
