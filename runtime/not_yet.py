"""What a scene can say and the engine does not do yet: delete a line when it does, and the file with the last one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from funicular.errors import SceneError
from funicular.slides import Slide

if TYPE_CHECKING:
    from funicular.scene import Scene


def refuse_what_the_engine_lacks(scene: Scene) -> None:
    """Raise SceneError for the first such thing."""
    for slide in scene.slides.values():
        for what in _lacking(slide):
            raise SceneError(slide.where, f"{what} is not in the engine yet")


def _lacking(slide: Slide) -> Iterator[str]:
    if slide.friction is not None:
        yield "friction"
    for name in ("at_start", "at_end"):
        if getattr(slide, name) != "error":
            yield name
