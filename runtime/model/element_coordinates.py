"""Coordinates of a cable by its elements, and which of them are positions."""

from __future__ import annotations

import numpy as np

from .model import CableModel


def element_coordinates(cable: CableModel, values: np.ndarray, element: np.ndarray | None = None) -> np.ndarray:
    """Return (T, elements, vectors, dim) of a cable from (T, n); with element (T,) those of one element each, (T,
    vectors, dim).
    """
    nodal = cable.nodal(values)
    if element is not None:
        rows = np.arange(len(values))
        return np.concatenate([nodal[rows, element], nodal[rows, element + 1]], axis=1)
    return np.concatenate([nodal[:, :-1], nodal[:, 1:]], axis=2)


def positions(cable: CableModel) -> np.ndarray:
    """Return (vectors,): which of an element's nodal vectors are positions."""
    return np.array([name == "r" for name in cable.vectors] * 2)
