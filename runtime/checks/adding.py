"""What each kind of part is checked for when it is added to a scene, and completed by; see `Scene.add`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..errors import SceneError
from ..parts import Cable, Clamp, DistributedForce, Event, Force, Joint, Moment, Motion, Pin, Slide, Spring, Tie
from ..parts.scene_data import SceneData
from ..parts.validation import Part
from .event_placement import placed_event
from .joint_placement import placed_joint
from .placement import placed_between, placed_load, placed_spring, placed_support, placed_tie
from .planarity import check_plane
from .slide_placement import placed_slide


def placed_cable(scene: SceneData, cable: Cable) -> Cable:
    """Return the cable, sure to be of the dimension of the others and of what is there already."""
    for other in scene.cables.values():
        if other.dim != cable.dim:
            word = {2: "planar", 3: "spatial"}
            raise SceneError(
                cable.where, f'{cable.element} is {word[cable.dim]}, but the elements of cable "{other.name}" '
                f"({other.element}) are {word[other.dim]}", "take planar elements for all cables, or for none")
    scene.cables[cable.name] = cable
    try:
        check_plane(scene)
    finally:
        del scene.cables[cable.name]
    return cable


_CHECKS: dict[type[Part], Callable[[SceneData, Any], Part]] = {
    Cable: placed_cable, Pin: placed_support, Clamp: placed_support, Motion: placed_support, Tie: placed_tie,
    Joint: placed_joint, Slide: placed_slide, Force: placed_load, DistributedForce: placed_load, Moment: placed_load,
    Spring: placed_spring, Event: placed_event}


def check_of(part: Part) -> Callable[[SceneData, Any], Any]:
    """Return the function that checks such a part against a scene and returns it complete.

    Kinds without an entry have their attachments completed.
    """
    return _CHECKS.get(type(part), placed_between)
