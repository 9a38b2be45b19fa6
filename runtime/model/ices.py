"""Models of ice on cables."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..base.deferred import dataclass
from ..base.quadrature import gauss
from ..kernels.element_line import along_elements
from ..parts.ice import Ice
from ..parts.piece import UniformPiece
from ..parts.signal import Signal, signal
from .attachments import ModelBuilder
from .coupling import CouplingKind, CouplingModel
from .signals import SignalModel

GAUSS_POINTS = 6
"""Points on an element: exact for products of shape functions of degree 5."""


@dataclass(eq=False, repr=False, kw_only=True)
class IceModel(CouplingModel):
    """Ice on a stretch of a cable: fu_ice of engine/couplings/ice/ice.h.

    cable, first, n_elements: its elements. signal, factor (m): of the thickness. diameter, length (m), density
    (kg/m³), gravity (dim,). N, weights (m): quadrature on the elements, once where they are equal.
    """

    cable: int
    first: int
    n_elements: int
    signal: int
    factor: float
    thickness: SignalModel | None
    diameter: float
    density: float
    gravity: np.ndarray
    length: float
    stride: int
    N: np.ndarray
    weights: np.ndarray
    n_points: int = GAUSS_POINTS

    @property
    def products(self) -> np.ndarray:
        """Return (1 or elements, vectors, vectors): ∫ N N' over the elements, m."""
        return np.asarray(np.einsum("eg,egk,egl->ekl", self.weights, self.N, self.N))

    @property
    def shares(self) -> np.ndarray:
        """Return (1 or elements, vectors): ∫ N over the elements, m."""
        return np.asarray(np.einsum("eg,egk->ek", self.weights, self.N))

    def mass_at(self, time: np.ndarray) -> np.ndarray:
        """Return the mass of a length, kg/m, at times in s."""
        t = thickness_at(self.thickness, self.factor, time)
        return np.asarray(self.density * np.pi * t * (self.diameter + t))


def thickness_at(thickness: SignalModel | None, factor: float, time: np.ndarray) -> np.ndarray:
    """Return the thickness, m, at times in s: the signal, None for one, times a factor."""
    return factor * (np.ones(np.shape(time)) if thickness is None else thickness.value(time))


def signal_of(part: Ice, builder: ModelBuilder) -> tuple[int, float, SignalModel | None]:
    """Return the number of the signal of a thickness, -1 for one, its factor in m, and the signal."""
    given = part.thickness if isinstance(part.thickness, Signal) else signal(part.thickness)
    number, factor = builder.signals.scale(given)
    return number, factor, None if number < 0 else builder.signals[number]


def ice_models(builder: ModelBuilder) -> Iterator[IceModel]:
    """Yield the models of the ice of a scene, one for each stretch of a cable of one diameter."""
    for part in builder.scene.ices.values():
        for stretch in part.stretches(builder.scene.cables[part.cable]):
            yield _on(part, stretch, builder)


def _on(part: Ice, stretch: UniformPiece, builder: ModelBuilder) -> IceModel:
    number, factor, thickness = signal_of(part, builder)
    index = builder.cable_index[part.cable]
    cable, diameter = builder.cables[index], part.diameter_of(stretch.section)
    assert diameter is not None, f"{part.where} has no diameter"
    mesh, ends = cable.mesh, slice(stretch.first, stretch.end)
    lengths = mesh.lengths if mesh.is_even else mesh.lengths[ends]
    N, _, weights = along_elements(cable.kernel("on_axis"), lengths, gauss(GAUSS_POINTS))
    return IceModel(type="ice", name=part.name or "", has_inertia=True, cable=index, first=stretch.first,
                    n_elements=stretch.end - stretch.first, signal=number, factor=factor, thickness=thickness,
                    diameter=diameter, density=part.density,
                    gravity=np.array(builder.scene.gravity)[: builder.scene.dim],
                    length=float(mesh.boundaries[stretch.end] - mesh.boundaries[stretch.first]),
                    stride=0 if mesh.is_even else 1, N=N, weights=weights)


KINDS = (CouplingKind("ice", Ice.group, ice_models, has_state=False),)
