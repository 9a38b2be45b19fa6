"""The error of a mesh, from the differences of meshes, each of half the element length."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

ASSUMED_ORDER = 1.5
"""Order assumed of two meshes: between that of a kink under a rider, 1, and that of a smooth shape, 4."""

MIN_ORDER, MAX_ORDER = 0.7, 4.0
"""Bounds of the observed order: below, meshes do not yet converge; above, differences cancel by chance."""

MAX_REFINEMENT = {"assumed": 2.0, "once": 2.0, "twice": 4.0}
"""Ratio of refinement up to which an error is extrapolated, by how often its order was observed."""

ORDER_TOLERANCE = 0.7
"""Difference below which two orders count as equal."""

ORDER_MARGINS = {"assumed": 0.8, "once": 1.0, "twice": ORDER_TOLERANCE / 2}
"""Uncertainty of the order, by how often it was observed. Of 206 choices for random scenes, seven erred by 1.2 to 1.6
tol without it: the order was lower, by up to 1 (observed once)."""


@dataclass(frozen=True)
class MeshError:
    """The error of a mesh of ``level`` times the coarsest number of elements, ~ level to the power of -order.

    error: the best estimate; margin: the uncertainty of the order; trusted: the ratio of refinement up to which it
    holds; regular: whether all meshes converged, each difference below the one before by an order above the lowest.
    """

    level: int
    error: float
    order: float
    margin: float = 0.0
    trusted: float = MAX_REFINEMENT["once"]
    regular: bool = True

    @property
    def lowest(self) -> float:
        """Return the lowest order that is likely."""
        return max(self.order - self.margin, MIN_ORDER)

    @property
    def highest(self) -> float:
        """Return the highest order that is likely."""
        return min(self.order + self.margin, MAX_ORDER)

    def growth(self, level: float) -> float:
        """Return the largest likely error of a mesh of another level, over `error`."""
        at_own = (2**self.order - 1) / (2**self.lowest - 1)
        return float(at_own * (self.level / level) ** (self.lowest if level >= self.level else self.highest))

    def level_for(self, error: float) -> float:
        """Return the level whose error has this bound."""
        ratio = self.error * self.growth(self.level) / error
        return self.level * ratio ** (1 / (self.lowest if ratio > 1 else self.highest)) if ratio > 0 else 0.0


def mesh_error(levels: Sequence[int], differences: Sequence[float]) -> MeshError:
    """Return the error of the last of some levels, each twice the one before, from the differences of neighbours.

    Richardson's extrapolation: the ratio of two differences is 2 to the power of the order.
    """
    finite = [difference for difference in differences if np.isfinite(difference)]
    if not finite:
        return MeshError(levels[-1], np.inf, ASSUMED_ORDER, ORDER_MARGINS["assumed"])
    ratios = np.log2(np.divide(finite[:-1], np.maximum(finite[1:], 1e-300)))
    regular = bool(np.all(ratios >= MIN_ORDER))
    orders = np.clip(ratios[-2:], MIN_ORDER, MAX_ORDER)
    order = float(orders[-1]) if len(orders) else ASSUMED_ORDER
    if len(orders) > 1 and ratios[-2] < 0:  # differences grew just before: they fall by chance in part
        order = float(orders.mean())
    steady = len(orders) > 1 and float(np.ptp(orders)) < ORDER_TOLERANCE
    seen = "twice" if steady else "once" if len(orders) else "assumed"
    trusted = MAX_REFINEMENT[seen]
    if not regular and order > ASSUMED_ORDER:  # by chance: with this order the error of a whip was 2.0 tol
        order, seen = ASSUMED_ORDER, "twice"
    return MeshError(levels[-1], finite[-1] / (2**order - 1), order, ORDER_MARGINS[seen], trusted, regular)
