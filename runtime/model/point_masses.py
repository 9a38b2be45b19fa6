"""Point masses on cables: their part of the mass matrices of elements, and their weight."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..parts.point_mass import PointMass
from .model import CableModel


def with_masses(cable: CableModel, masses: Sequence[PointMass]) -> CableModel:
    """Return a cable whose mass matrices contain those of point masses on it: mass times N N' of the element."""
    if masses:
        m = np.repeat(cable.m, cable.n_elements // len(cable.m), axis=0)
        for mass, element, N in _at(cable, masses):
            m[element] += mass * np.outer(N, N)
        cable.m = m
    return cable


def with_weights(gravity: np.ndarray, cable: CableModel, masses: Sequence[PointMass],
                 acceleration: np.ndarray) -> np.ndarray:
    """Return the generalised gravity (coordinates,) of a cable with that of point masses; acceleration (dim,)."""
    if not masses:
        return gravity
    made = gravity.copy()
    for mass, element, N in _at(cable, masses):
        of, first = cable.dofs_of(element), cable.first
        made[of.start - first : of.stop - first] += mass * np.outer(N, acceleration).ravel()
    return made


def _at(cable: CableModel, masses: Sequence[PointMass]) -> Iterator[tuple[float, int, np.ndarray]]:
    """Yield masses in kg with the number of their element, and their shape functions there."""
    for part in masses:
        element, x = cable.mesh.place(min(max(part.s, 0.0), cable.mesh.total))
        yield part.mass, int(element), cable.kernel("on_axis")(cable.mesh.length(int(element)), float(x))[0]
