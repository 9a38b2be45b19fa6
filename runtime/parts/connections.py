"""Which cables and bodies of a scene act on each other, through joints, slides, springs, contacts and other parts."""

from __future__ import annotations

from collections.abc import Iterator

from .attachment import Attachment
from .event import Event
from .fluid import Fluid
from .part import Part
from .scene_data import SceneData
from .surface import Surface


def connected(scene: SceneData, name: str) -> set[str]:
    """Return the names of the cables and bodies that a cable or body is connected with, its own name included.

    Whatever names two of them connects them. The ground, its surfaces and fluids connect nothing.
    """
    acting = [part for part in scene.parts() if _acts(part)]
    names = {part.given_name for part in acting} - {None}
    links = [names & set(_texts(part)) for part in acting]
    found = {name}
    while more := [link for link in links if link & found and not link <= found]:
        found.update(*more)
    return {each for each in (*scene.cables, *scene.bodies) if each in found}


def _acts(part: Part) -> bool:
    """Return whether a part can connect others."""
    return not isinstance(part, Event | Fluid) and not (isinstance(part, Surface) and part.on is None)


def _texts(part: Part) -> Iterator[str]:
    """Yield the texts in the fields of a part, among which are its name and the names of what it acts on."""
    for _, value in part:
        if isinstance(value, Attachment):
            value = value.on
        if isinstance(value, str):
            yield value
