"""Checks of slides on ropes, and the cable or rope along which a slide runs."""

from __future__ import annotations

from ..errors import SceneError, near
from ..parts.cable import Cable
from ..parts.end_stops import Buffer, Stop
from ..parts.rope_items import Anchor, Drum
from ..parts.scene_data import SceneData
from ..parts.slide import Slide
from ..parts.validation import show
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
    """Raise SceneError for what a slide with s on a rope does not have: a section, and stops at some ends."""
    if slide.frame == "section":
        raise SceneError(slide.where, f'frame "section" needs section axes, but {line.where} has a tangent only',
                         'take frame="tangent"')
    number = line.rope.span_at(line.route, slide.arc_length)
    for name, item in zip(("at_start", "at_end"), line.rope.ends_of_spans[number], strict=True):
        stop = getattr(slide, name)
        if isinstance(stop, Stop) and not isinstance(item, Anchor):
            raise SceneError(slide.where, f"{name}: the span of {line.where} ends at {item.where}, where the material "
                             "runs past a stop", 'let the rider strike a surface there by a contact, or take "error", '
                             '"leave", or an event that stops the run')
        if isinstance(stop, Buffer) and stop.length > (length := line.route.spans[number].length):
            raise SceneError(slide.where, f"{name}: the buffer's length must not exceed that of its span of "
                             f'{line.where}, {show(length, "m")}, got {show(stop.length, "m")}')
        if stop != "error" and isinstance(item, Drum) and item.at_end == "leave":
            raise SceneError(slide.where, f"{name}: {item.where} lets the rope leave, and its free end has no stops",
                             f'leave {name} out, or give the drum at_end="stop"')
