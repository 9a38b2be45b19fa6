"""Models of crossings: contact of two lines at their closest points."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from ..base.deferred import dataclass
from ..engine import CROSSING_STICK
from ..parts.attachment import Attachment
from ..parts.crossing import Crossing
from ..parts.crossing_start import radii, sign_of, start_of
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel

MIN_PENETRATION = 1e-30
"""Lower bound of the size of a penetration under a root, m."""
KERNELS = {2: "planar_crossing", 3: "crossing"}


@dataclass(eq=False, repr=False)
class CrossingModel(CouplingModel):
    """Contact of a cable with another one, or with a bar at the one attachment.

    cables: their numbers, -1 for a bar; law: argument of the kernels, first the distance of the axes at contact, m;
    stiffness in N/m: scale from lengths to forces.
    """

    kernel: str
    cables: tuple[int, int]
    attachments: list[AttachmentModel]
    law: tuple[float, ...]
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
    lines = [builder.cables[k] for k in numbers if k >= 0]
    for k in numbers[: len(lines)]:
        builder.hull(k)
    if len(lines) == 1:  # a bar
        ends = [builder.attachment(Attachment(on=part.b, at=part.at))]
        half = math.inf if part.length is None else part.length
        low, high = -half, half
    else:
        ends, low, high = [], 0.0, lines[1].mesh.total
    axis = np.zeros(3) if part.axis is None else np.array(part.axis) / np.linalg.norm(part.axis)
    slopes = np.zeros(6)
    slopes[: dim * (dim - 1)] = start.slopes[: dim - 1, :dim].ravel()
    radius, linear, friction = radii(scene, part), part.exponent == 1, part.friction
    sliding = None if friction is None or friction.sticks else friction
    law = (radius, sign_of(part, start.normal, start.d), part.stiffness * linear, part.stiffness * (not linear),
           part.damping, MIN_PENETRATION, *((0.0, 1.0) if sliding is None else (sliding.coefficient, sliding.velocity)))
    masses = [piece.material.density * piece.section.area * line.mesh.mean
              for line in lines for piece in scene.cables[line.name].uniform_pieces]
    sticking = friction.coefficient if friction and part.has_friction_spring else 0.0
    return CrossingModel(
        type="crossing", name=part.name or "", kernel=KERNELS[dim], cables=numbers, attachments=ends, law=law,
        stiffness=part.stiffness * (1.0 if linear else math.sqrt(max(radius, 1e-3))),
        scale=[max(*masses, *(end.mass for end in ends), 0.0)] * (2 * dim - 1), follows_law=True,
        is_damped=part.damping > 0 or sliding is not None, n_numbers=CROSSING_STICK if sticking else 0,
        entries={"axis": axis, "low": (0.0, low), "high": (lines[0].mesh.total, high), "start": start.s,
                 "separation": start.d, "slopes": slopes, "friction": sticking,
                 "tangential": part.stiffness if part.tangential_stiffness is None else part.tangential_stiffness})


KINDS = (CouplingKind("crossing", Crossing.group,
                      lambda builder: [_crossing(part, builder) for part in builder.scene.crossings.values()]),)
