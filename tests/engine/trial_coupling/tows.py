"""Models of tows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..parts.tow import Tow
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel


@dataclass(kw_only=True)
class TowModel(CouplingModel):
    """fu_tow of the engine."""

    law: str
    attachments: list[AttachmentModel]
    start: tuple[float, ...]
    velocity: tuple[float, ...]
    centre: tuple[float, ...]
    spring: tuple[float, float]
    rail: tuple[float, float]
    strength: float

    @property
    def kernel_families(self) -> list[str]:
        """Return the name of its law."""
        return [self.law]


def tow_models(builder: ModelBuilder) -> Iterator[TowModel]:
    """Yield the models of the tows of a scene."""
    for part in builder.scene.group("tows"):
        wheel = builder.attachment(part.a)
        yield TowModel(type="tow", name=part.name, law="planar_tow" if builder.scene.dim == 2 else "tow",
                       attachments=[wheel], start=part.start, velocity=part.velocity, centre=part.centre,
                       spring=(part.stiffness, 0.0), rail=(1 / part.radius, part.radius), strength=part.strength,
                       scale=[wheel.mass], n_multipliers=1)


KINDS = (CouplingKind("tow", Tow.group, tow_models),)
"""Where the trial coupling's models are made."""
