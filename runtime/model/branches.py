"""Models of branches beside the elastic laws of cables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..base.deferred import dataclass
from ..base.quadrature import gauss
from ..parts.branch import Branch
from .attachments import ModelBuilder
from .coupling import CouplingKind, CouplingModel

KERNELS = {2: "planar_branch", 3: "branch"}
GAUSS_POINTS = 2
"""Points of an element: those at which strain and curvature of a cubic element are most accurate. With more of them the
strain of a bent element, which its bending alone makes, would be stiff against bending."""


@dataclass(eq=False, repr=False, kw_only=True)
class BranchModel(CouplingModel):
    """A branch on an element of a cable.

    results: names of those of its part; stiffness: of strain and curvature, N, N m²; time: of a dashpot, s, 0 of a
    slider; limit: of a slider, N or N m; weights (points,) in m; N_x, N_xx (points, vectors): derivatives of the shape
    functions.
    """

    results: Sequence[str]
    kernel: str
    cable: int
    element: int
    stiffness: np.ndarray
    time: float
    limit: float
    weights: np.ndarray
    N_x: np.ndarray
    N_xx: np.ndarray


def branch_models(builder: ModelBuilder) -> Iterator[BranchModel]:
    """Yield the models of the branches of a scene, one for each element."""
    for part in builder.scene.branches.values():
        number, dim = builder.cable_index[part.cable], builder.scene.dim
        cable = builder.cables[number]
        n_curvature = 1 if dim == 2 else 3
        stiffness = part.stiffness * np.array([not part.bends, *[part.bends] * n_curvature], dtype=float)
        for element in range(cable.n_elements):
            length = cable.mesh.length(element)
            places, weights = gauss(GAUSS_POINTS)
            shapes = np.array([cable.kernel("slopes")(length, length * (1 + x) / 2)[0] for x in places])
            yield BranchModel(type="branch", name=part.name or "", results=[*part.results], kernel=KERNELS[dim],
                              cable=number, element=element, stiffness=stiffness, time=part.relaxation_time,
                              limit=part.limit, weights=length * weights / 2, N_x=shapes[:, 0], N_xx=shapes[:, 1])


KINDS = (CouplingKind("branch", Branch.group, branch_models, has_state=False),)
