"""Models of forces between two points of a scene."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..base.deferred import dataclass
from ..kernels.elements import point_law
from ..kernels.libraries import kernels_of
from ..parts.force_segments import HAS_NO_FORCE, PULLS_AND_PUSHES
from ..parts.point_force import PointForce
from ..parts.spring import Spring
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel


@dataclass
class ForceLaw:
    """The law of a force between two points.

    law: the name of its kernels; parameters: in the order of the kernels' arguments, for one linear segment after the
    other. bounds (n_segments - 1), in m: distances of the points between segments. senses (n_segments): whether a
    segment pulls, pushes, or has no force. compliance: of the stiffest segment, m/N.
    """

    law: str
    dim: int
    parameters: tuple[float, ...]
    n_segments: int = 1
    n_parameters: int = 0
    bounds: tuple[float, ...] = ()
    senses: tuple[int, ...] = (PULLS_AND_PUSHES,)
    compliance: float = 0.0

    @classmethod
    def of(cls, part: PointForce, dim: int) -> ForceLaw:
        """Return the law of a complete part in `dim` dimensions."""
        name = ("planar_" if dim == 2 else "") + part.law
        names = list(point_law(name).parameters)
        if isinstance(part, Spring) and part.has_segments:
            return cls(name, dim, n_parameters=len(names), **_pieces(part, names))
        return cls(name, dim, tuple(float(getattr(part, each)) for each in names), n_parameters=len(names))

    def at_rest(self, gap: np.ndarray) -> np.ndarray:
        """Return the force (dim,) on the first point at rest, in N; gap (dim,): to the second point, m."""
        parameters = self._at(gap)
        if parameters is None:
            return np.zeros(self.dim)
        return np.asarray(getattr(kernels_of(None), f"{self.law}_force")(parameters, gap, np.zeros(self.dim)))

    def tangent_at_rest(self, gap: np.ndarray) -> np.ndarray:
        """Return (dim, dim): the derivative of `at_rest` by the gap, N/m."""
        parameters = self._at(gap)
        if parameters is None:
            return np.zeros((self.dim, self.dim))
        return np.asarray(getattr(kernels_of(None), f"{self.law}_tangent")(parameters, gap, np.zeros(self.dim))[1])

    def _at(self, gap: np.ndarray) -> np.ndarray | None:
        """Return the parameters of the segment at a gap (dim,), None where it has no force."""
        segment = int(np.searchsorted(self.bounds, np.linalg.norm(gap)))
        if self.senses[segment] == HAS_NO_FORCE:
            return None
        return np.array(self.parameters[segment * self.n_parameters :][: self.n_parameters])


@dataclass(eq=False, repr=False, kw_only=True)
class PointForceModel(CouplingModel, ForceLaw):
    """A force between two points, whose unknowns are its components."""

    attachments: list[AttachmentModel]

    @property
    def kernel_families(self) -> list[str]:
        """Return the name of the kernels of its law."""
        return [self.law, *super().kernel_families]


def point_force_models(builder: ModelBuilder) -> Iterator[PointForceModel]:
    """Yield the models of the forces between two points."""
    for part in builder.scene.point_forces.values():
        ends = [builder.attachment(part.a), builder.attachment(part.b)]
        law = ForceLaw.of(part, builder.scene.dim)
        damping = point_law(law.law).damping
        yield PointForceModel(
            type="point_force", name=part.name or "", scale=[max(end.mass for end in ends)] * law.dim,
            is_damped=bool(damping) and getattr(part, damping) != 0, follows_law=True, attachments=ends, **vars(law))


def _pieces(part: Spring, names: list[str]) -> dict[str, Any]:
    """Return the fields of the linear segments of a spring that positive distances reach."""
    assert part.length is not None, f"{part.where} is not complete"
    segments = [segment for segment in part.segments() if part.length + segment.end > 0]
    values = [{"stiffness": segment.stiffness, "damping": part.damping * (segment.sense != HAS_NO_FORCE),
               "reference": part.length + segment.at, "tension": segment.tension, "energy": segment.energy}
              for segment in segments]
    return {"parameters": tuple(float(of[name]) for of in values for name in names), "n_segments": len(segments),
            "bounds": tuple(part.length + segment.end for segment in segments[:-1]),
            "senses": tuple(segment.sense for segment in segments),
            "compliance": 1 / max((abs(segment.stiffness) for segment in segments), default=1.0)}


KINDS = (CouplingKind("point_force", PointForce.group, point_force_models),)
