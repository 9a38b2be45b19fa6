"""Tows as the engine takes them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..parts.scene_data import SceneData
from .attachments import AttachmentBuilder, AttachmentModel
from .coupling import CouplingModel
from .loads import LoadBuilder


@dataclass(kw_only=True)
class TowModel(CouplingModel):
    """fu_tow of the engine."""

    attachments: list[AttachmentModel]
    start: tuple[float, ...]
    velocity: tuple[float, ...]
    stiffness: float
    strength: float


def tow_models(scene: SceneData, attachments: AttachmentBuilder, loads: LoadBuilder) -> Iterator[TowModel]:
    """Yield the models of the tows of a scene."""
    for part in scene.group("tows"):
        yield TowModel(type="tow", name=part.name, attachments=[attachments.model(part.a)], start=part.start,
                       velocity=part.velocity, stiffness=part.stiffness, strength=part.strength)
