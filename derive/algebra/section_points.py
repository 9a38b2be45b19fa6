"""Quadrature points of a section that reproduce the moments of its stiffness table up to the fourth.

They lie at the middle, on both axes and in the four corners of a rectangle: nine, or three of a planar section. The
distance y makes second and fourth moments exact: y^2 is the fourth moment over the second.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

HALF, QUARTER = Fraction(1, 2), Fraction(1, 4)

KINDS: tuple[tuple[int, int, tuple[Fraction | int, ...]], ...] = (
    (0, 0, (1, -1, -1, 1)),
    (1, 0, (0, HALF, 0, -HALF)),
    (0, 1, (0, 0, HALF, -HALF)),
    (1, 1, (0, 0, 0, QUARTER)),
)
"""Points at +-i times the distance along y, +-k times that along z: i, k, and the share of each of them in the elastic
constants, as coefficients of their integrals of 1, of y^2, of z^2 and of y^2 z^2, each over those squared distances."""


def table() -> list[list[Any]]:
    """Return the kinds for the manifest, in numbers that a file has exactly."""
    return [[i, k, [float(share) for share in shares]] for i, k, shares in KINDS]
