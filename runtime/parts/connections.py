"""Which cables and bodies of a scene act on each other, through joints, slides, springs, contacts and other parts."""

from __future__ import annotations

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
    names = {part.given_name for part in acting if part.given_name is not None}
    links = [names & {part.given_name or "", *part.refers_to()} for part in acting]
    found = {name}
    while more := [link for link in links if link & found and not link <= found]:
        found.update(*more)
    return {each for each in (*scene.cables, *scene.bodies) if each in found}


def _acts(part: Part) -> bool:
    """Return whether a part can connect others."""
    return not isinstance(part, Event | Fluid) and not (isinstance(part, Surface) and part.on is None)
