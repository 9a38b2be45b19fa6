"""Models of the working curves of ropes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..base.deferred import dataclass
from ..base.quadrature import gauss
from ..parts.working_curve import WorkingCurve
from .attachments import ModelBuilder
from .coupling import CouplingKind, CouplingModel

KERNELS = {2: "planar_working_curve", 3: "working_curve"}
GAUSS_POINTS = 5
"""Points of an element: those of the law's axial force (derive/laws/cable/cable.py), so that both curves meet there."""


@dataclass(eq=False, repr=False, kw_only=True)
class WorkingCurveModel(CouplingModel):
    """The working curves of an element of a cable.

    permanent: permanent strain as a share of the highest one; highest (points,): highest strains before the start;
    weights (points,) in m; N_x (points, vectors): derivatives of the shape functions; first, shape: numbers of the
    tables of first loading and of the shape; remembers: whether the highest strains rise.
    """

    kernel: str
    cable: int
    element: int
    permanent: float
    highest: np.ndarray
    weights: np.ndarray
    N_x: np.ndarray
    first: np.ndarray
    shape: np.ndarray
    remembers: bool = True


def working_curve_models(builder: ModelBuilder) -> Iterator[WorkingCurveModel]:
    """Yield the models of the working curves of a scene, one for each element."""
    places, weights = gauss(GAUSS_POINTS)
    for part in builder.scene.working_curves.values():
        number, drawn = builder.cable_index[part.cable], builder.scene.cables[part.cable]
        cable, shape = builder.cables[number], part.shape()
        for piece in drawn.uniform_pieces:
            assert piece.section.tension_table is not None  # by the check of the part
            first = piece.section.tension_table.numbers()
            highest = np.full(GAUSS_POINTS, piece.section.tension_table.strain_at(part.highest_tension))
            for element in range(piece.first, piece.end):
                length = cable.mesh.length(element)
                shapes = np.array([cable.kernel("slopes")(length, length * (1 + x) / 2)[0][0] for x in places])
                yield WorkingCurveModel(type="working_curve", name=part.name or "", kernel=KERNELS[builder.scene.dim],
                                        cable=number, element=element, permanent=part.permanent_share,
                                        highest=highest.copy(), weights=length * weights / 2, N_x=shapes, first=first,
                                        shape=shape)


KINDS = (CouplingKind("working_curve", WorkingCurve.group, working_curve_models, has_state=False),)
