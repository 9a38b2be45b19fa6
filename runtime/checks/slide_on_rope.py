"""Checks of slides on ropes, and the cable or rope along which a slide runs."""

from __future__ import annotations

from ..errors import SceneError, near
from ..parts.cable import Cable
from ..parts.scene_data import SceneData
from ..parts.slide import Slide
from .placement import cable_at, check_has_mass
from .rope_line import RopeLine, rope_line

Line = Cable | RopeLine
"""A cable, or a rope as drawn."""


def line_of(scene: SceneData, slide: Slide) -> Line:
    """Return the cable or the rope along which a slide runs. Raises SceneError."""
    name = slide.along
    if name in scene.cables:
        return scene.cables[name]
    if name not in scene.ropes:
        lines = [*scene.cables, *scene.ropes]
        raise SceneError(slide.where, f'there is no cable or rope "{name}"', near(name, lines))
    check_has_mass(scene.ropes[name], slide.where, "along: ")
    return rope_line(scene, name)


def check_on_line(scene: SceneData, slide: Slide, line: Line, s: float) -> None:
    """Raise SceneError for an arc-length off the cable, or off the spans of the rope as drawn."""
    if isinstance(line, Cable):
        cable_at(scene, slide.along, slide.where, s)
        return
    try:
        line.rope.span_at(line.route, s)
    except ValueError as error:
        cause, *remedy = error.args
        raise SceneError(slide.where, f's of rope "{line.rope.name}" {cause}', *remedy) from None


def check_possible_on_rope(slide: Slide, line: RopeLine) -> None:
    """Raise SceneError for what slides on ropes do not have: a frame, and stops at ends."""
    if slide.frame != "point":
        raise SceneError(slide.where, f'frame "{slide.frame}" needs the axes of a cable, which {line.where} does not '
                         "have", 'take frame="point"')
    for name in ("at_start", "at_end"):
        if getattr(slide, name) != "error":
            raise SceneError(slide.where, f"{name}: {line.where} has no stops, its spans end at sheaves, drums and "
                             "anchors, where the run ends", "leave it out")
