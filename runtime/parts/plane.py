"""What leaves the plane z = 0, in words, for scenes of planar elements."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .validation import show


def across(name: str, value: tuple[float, ...] | np.ndarray | None, unit: str = "") -> Iterator[str]:
    """Yield a quantity whose z component is not zero; None is none."""
    if value is not None and value[2]:
        yield f"{name} {show(value, unit)}"


def in_plane(name: str, axis: tuple[float, ...] | np.ndarray, value: tuple[float, ...] | np.ndarray,
             unit: str = "") -> Iterator[str]:
    """Yield a quantity whose axis is not along z."""
    if np.any(axis[:2]):
        yield f"{name} {show(value, unit)}"
