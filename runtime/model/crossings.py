"""Lines that touch at their closest points, as the engine takes them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..parts.attachment import Attachment
from ..parts.crossing import Crossing
from ..parts.crossing_start import Start, radii, sign_of, start_of
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel

LEAST_PENETRATION = 1e-30
"""m: what the size of a penetration is not below under a root."""

GRIP_NUMBERS = 30
"""That a state keeps of friction that sticks: FU_CROSSING_STICK of engine/couplings/crossing/crossing.h."""
KERNELS = {2: "planar_crossing", 3: "crossing"}


@dataclass
class CrossingModel(CouplingModel):
    """Contact of a cable with another one, or with a bar at the one attachment.

    cables: their numbers, -1 for a bar; axis: of the bar, in the axes of what carries it; low, high: where the lines
    end, m; law: as the kernels take it; start, way, slopes: arc-lengths of the closest points as drawn, the way from
    the second to the first, m, and slopes of the lines that have one, flat; friction, tangential: of friction that
    sticks, its coefficient and its spring in N/m; stiffness in N/m: makes forces of lengths.
    """

    kernel: str
    cables: tuple[int, int]
    attachments: list[AttachmentModel]
    axis: tuple[float, ...]
    low: tuple[float, float]
    high: tuple[float, float]
    law: tuple[float, ...]
    start: tuple[float, ...]
    way: tuple[float, ...]
    slopes: tuple[float, ...]
    friction: float
    tangential: float
    stiffness: float

    keeps_forces: ClassVar[bool] = False

    @property
    def along(self) -> Sequence[int]:
        """Return the numbers of its cables."""
        return [number for number in self.cables if number >= 0]


def _crossing(part: Crossing, builder: ModelBuilder) -> CrossingModel:
    scene, dim = builder.scene, builder.scene.dim
    start = start_of(scene, part)
    numbers = (builder.cable_index[part.a], builder.cable_index.get(part.b or "", -1))
    of_lines = [builder.cables[k] for k in numbers if k >= 0]
    for k in numbers:
        if k >= 0:
            builder.hull(k)
    ends: list[AttachmentModel] = []
    low, high = 0.0, 0.0
    axis = (0.0, 0.0, 0.0)
    if numbers[1] < 0:
        ends = [builder.attachment(Attachment(on=part.b, at=part.at))]
        low, high = (-math.inf, math.inf) if part.length is None else (-part.length, part.length)
        if part.axis is not None:
            axis = tuple(np.array(part.axis) / np.linalg.norm(part.axis))
    else:
        high = of_lines[1].mesh.total
    masses = [scene.cables[line.name].material.density * scene.cables[line.name].section.area * line.mesh.mean
              for line in of_lines]
    radius = radii(scene, part)
    linear = part.exponent == 1
    law = (radius, sign_of(part, start.normal, start.d), part.stiffness * linear, part.stiffness * (not linear),
           part.damping, LEAST_PENETRATION, *((0.0, 1.0) if part.friction is None or part.friction.sticks
                                              else (part.friction.coefficient, part.friction.velocity)))
    sticking = part.friction.coefficient if part.friction and part.has_friction_spring else 0.0
    return CrossingModel(
        kernel=KERNELS[dim], cables=numbers, attachments=ends, axis=axis, low=(0.0, low),
        high=(of_lines[0].mesh.total, high), law=law, start=tuple(start.s),
        way=tuple(start.d), slopes=_slopes(start, dim), friction=sticking, n_numbers=GRIP_NUMBERS if sticking else 0,
        tangential=part.stiffness if part.tangential_stiffness is None else part.tangential_stiffness,
        stiffness=part.stiffness * (1.0 if linear else math.sqrt(max(radius, 1e-3))), type="crossing",
        name=part.name or "", scale=[max(*masses, *(end.mass for end in ends), 0.0)] * (2 * dim - 1),
        is_damped=part.damping > 0 or (part.friction is not None and not part.friction.sticks), follows_law=True)


def _slopes(start: Start, dim: int) -> tuple[float, ...]:
    """Return the slopes of the lines that have one, in the layout of the engine."""
    slopes = np.zeros(6)
    slopes[: dim * (dim - 1)] = start.slopes[: dim - 1, :dim].ravel()
    return tuple(slopes)


KINDS = (CouplingKind("crossing", Crossing.group,
                      lambda builder: [_crossing(part, builder) for part in builder.scene.crossings.values()]),)
