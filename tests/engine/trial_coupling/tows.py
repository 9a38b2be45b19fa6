"""Tows as the engine takes them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..parts.tow import Tow
from .attachments import AttachmentModel, ModelBuilder
from .coupling import CouplingKind, CouplingModel


@dataclass(kw_only=True)
class TowModel(CouplingModel):
    """fu_tow of the engine."""

    attachments: list[AttachmentModel]
    start: tuple[float, ...]
    velocity: tuple[float, ...]
    stiffness: float
    strength: float


def tow_models(builder: ModelBuilder) -> Iterator[TowModel]:
    """Yield the models of the tows of a scene."""
    for part in builder.scene.group("tows"):
        yield TowModel(type="tow", name=part.name, attachments=[builder.attachment(part.a)], start=part.start,
                       velocity=part.velocity, stiffness=part.stiffness, strength=part.strength)


KINDS = (CouplingKind("tow", Tow.group, tow_models, has_state=False),)
