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

OF_STIFFNESS = "stiffness", "tension", "energy"
"""Parameters in proportion to the stiffness."""
STARTS = {"longer": "length", "stiffer": "stiffness"}
"""Driven quantities of a part by the fields of a law for their values at the start."""


@dataclass
class ForceLaw:
    """The law of a force between two points.

    law: the name of its kernels; parameters: in the order of the kernels' arguments, for one linear segment after the
    other. bounds (n_segments - 1), in m: distances of the points between segments. senses (n_segments): whether a
    segment pulls, pushes, or has no force. compliance: of the stiffest segment, m/N. stiffnesses (n_parameters):
    nonzero for those in proportion to the stiffness. longer, stiffer: at the start, by how much lengths are longer, m,
    and the factor of the stiffness, of a law whose signals prescribe them.
    """

    law: str
    dim: int
    parameters: tuple[float, ...]
    n_segments: int = 1
    n_parameters: int = 0
    bounds: tuple[float, ...] = ()
    senses: tuple[int, ...] = (PULLS_AND_PUSHES,)
    compliance: float = 0.0
    stiffnesses: tuple[int, ...] = ()
    longer: float = 0.0
    stiffer: float = 1.0

    @classmethod
    def of(cls, part: PointForce, dim: int) -> ForceLaw:
        """Return the law of a complete part in `dim` dimensions."""
        name = ("planar_" if dim == 2 else "") + part.law
        names = list(point_law(name).parameters)
        given, driven = part.largest, part.driven()
        common: dict[str, Any] = {what: driven[entry].start for what, entry in STARTS.items() if entry in driven}
        common |= {"n_parameters": len(names), "stiffnesses": tuple(int(each in OF_STIFFNESS) for each in names)}
        if isinstance(given, Spring) and given.has_segments:
            return cls(name, dim, **common, **_pieces(given, names))
        return cls(name, dim, tuple(float(getattr(given, each)) for each in names), **common)

    def at_rest(self, gap: np.ndarray) -> np.ndarray:
        """Return the force (dim,) on the first point at rest, in N; gap (dim,): to the second point, m."""
        taken = self._taken(gap)
        parameters = self._at(taken)
        if parameters is None:
            return np.zeros(self.dim)
        return np.asarray(getattr(kernels_of(None), f"{self.law}_force")(parameters, taken, np.zeros(self.dim)))

    def tangent_at_rest(self, gap: np.ndarray) -> np.ndarray:
        """Return (dim, dim): the derivative of `at_rest` by the gap, N/m."""
        taken = self._taken(gap)
        parameters = self._at(taken)
        if parameters is None:
            return np.zeros((self.dim, self.dim))
        K = np.asarray(getattr(kernels_of(None), f"{self.law}_tangent")(parameters, taken, np.zeros(self.dim))[1])
        if self.longer == 0.0:
            return K
        along = taken / np.linalg.norm(taken)
        ratio = np.linalg.norm(taken) / np.linalg.norm(gap)
        return np.asarray(ratio * K + (1 - ratio) * np.outer(K @ along, along))

    def _taken(self, gap: np.ndarray) -> np.ndarray:
        """Return the gap that its kernels take, as in runtime/engine/couplings/force/segments.c."""
        return gap if self.longer == 0.0 else gap * (1 - self.longer / np.linalg.norm(gap))

    def _at(self, gap: np.ndarray) -> np.ndarray | None:
        """Return the parameters of the segment at a gap (dim,), None where it has no force."""
        segment = int(np.searchsorted(self.bounds, np.linalg.norm(gap)))
        if self.senses[segment] == HAS_NO_FORCE:
            return None
        found = np.array(self.parameters[segment * self.n_parameters :][: self.n_parameters])
        return found if self.stiffer == 1.0 else np.where(self.stiffnesses, self.stiffer, 1.0) * found


@dataclass(eq=False, repr=False, kw_only=True)
class PointForceModel(CouplingModel, ForceLaw):
    """A force between two points, whose unknowns are its components."""

    attachments: list[AttachmentModel]
    length_dof: int = -1
    stiffness_dof: int = -1

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
        driven: dict[str, Any] = {f"{entry}_dof": builder.driven[part.where, entry] for entry in part.driven()}
        yield PointForceModel(
            type="point_force", name=part.name or "", scale=[max(end.mass for end in ends)] * law.dim,
            is_damped=bool(damping) and getattr(part, damping) != 0, follows_law=True, attachments=ends, **vars(law),
            **driven)


def _pieces(part: Spring, names: list[str]) -> dict[str, Any]:
    """Return the fields of the linear segments of a spring that positive distances reach."""
    length = part.length
    assert isinstance(length, float), f"{part.where} has no number as its length"
    segments = [segment for segment in part.segments() if length + segment.end > 0]
    values = [{"stiffness": segment.stiffness, "damping": part.damping * (segment.sense != HAS_NO_FORCE),
               "reference": length + segment.at, "tension": segment.tension, "energy": segment.energy}
              for segment in segments]
    return {"parameters": tuple(float(of[name]) for of in values for name in names), "n_segments": len(segments),
            "bounds": tuple(length + segment.end for segment in segments[:-1]),
            "senses": tuple(segment.sense for segment in segments),
            "compliance": 1 / max((abs(segment.stiffness) for segment in segments), default=1.0)}


KINDS = (CouplingKind("point_force", PointForce.group, point_force_models),)
