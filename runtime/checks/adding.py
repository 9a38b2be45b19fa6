"""Checks and completion of each kind of part as it is added to a scene; see `Scene.add`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import Any

import numpy as np

from ..errors import SceneError
from ..parts.branch import Branch
from ..parts.cable import Cable
from ..parts.contact import Contact
from ..parts.crossing import Crossing
from ..parts.drag import Drag
from ..parts.event import Event
from ..parts.fluid import Fluid
from ..parts.ice import Ice
from ..parts.joint import Joint
from ..parts.load import Load
from ..parts.part import Part
from ..parts.plane import called
from ..parts.point_force import PointForce
from ..parts.point_mass import PointMass
from ..parts.rope import Rope
from ..parts.scene_data import SceneData
from ..parts.slide import Slide
from ..parts.support import Support, Tie
from ..parts.surface import Surface
from ..parts.validation import show
from ..parts.working_curve import WorkingCurve
from . import rope_loads
from .branch_placement import placed_branch
from .contact_placement import placed_contact, placed_contacts, placed_surface
from .crossing_placement import placed_crossing
from .drag_placement import placed_drag, placed_fluid
from .ice_placement import placed_ice
from .joint_placement import placed_joint
from .placement import (
    placed_between,
    placed_event,
    placed_mass,
    placed_point_force,
    placed_support,
    placed_tie,
    warmed,
)
from .rope_placement import check_beside_ropes, placed_rope
from .slide_placement import placed_slide
from .whole_scene import check_plane
from .working_curve_placement import placed_working_curve


def placed_cable(scene: SceneData, cable: Cable) -> Cable:
    """Return the cable, drawn as it hangs, checked to have the dimension and the plane of the scene."""
    cable = warmed(scene, cable.hanging_under(scene.gravity))
    for other in scene.cables.values():
        if other.dim != cable.dim:
            word = {2: "planar", 3: "spatial"}
            raise SceneError(
                cable.where, f'{cable.element} is {word[cable.dim]}, but the elements of cable "{other.name}" '
                f"({other.element}) are {word[other.dim]}", "take planar elements for all cables, or for none")
        if cable.dim == 2 and not _lie_in_one_plane(cable, other):
            raise SceneError(
                cable.where, f'lies in {called(cable.plane)}, with the height at {show(cable.normal)} x tangent, '
                f'but cable "{other.name}" in {called(other.plane)}, with that at {show(other.normal)} x tangent',
                "draw both in one plane, and give up, on the same side of it")
    check_beside_ropes(scene, cable)
    if 2 in (cable.dim, scene.dim):
        others = scene.copied()
        others.put(cable)
        check_plane(others)
    return cable


def _lie_in_one_plane(cable: Cable, other: Cable) -> bool:
    """Return whether two planar cables lie in one plane, with one normal."""
    one, two = cable.plane, other.plane
    if one is None or two is None:
        return one is two
    return one.is_same(two) and two.contains(np.array(cable.drawn_through))


_CHECKS: dict[type[Part], Callable[[SceneData, Any], Part]] = {
    Cable: placed_cable, Support: placed_support, Tie: placed_tie, Rope: placed_rope, Joint: placed_joint,
    Slide: placed_slide, Load: rope_loads.placed, PointForce: placed_point_force, PointMass: placed_mass,
    Event: placed_event, Fluid: placed_fluid, Drag: placed_drag, Branch: placed_branch, Ice: placed_ice,
    WorkingCurve: placed_working_curve,
    Crossing: placed_crossing, Surface: placed_surface, Contact: placed_contact}


def check_of(part: Part) -> Callable[[SceneData, Any], Any]:
    """Return the function that checks such a part against a scene and returns it complete.

    It is that of its class or the nearest base class, by default the completion of its attachments.
    """
    return _check_of(type(part))


def check_all_of(scene: SceneData, part: Part, names: Iterable[Mapping[str, Any]]) -> list[Any]:
    """Check parts like this one but for their names, and return them complete."""
    if isinstance(part, Contact):
        return placed_contacts(scene, part, names)
    return [check_of(part)(scene, part.model_copy(update=each)) for each in names]


@cache
def _check_of(kind: type[Part]) -> Callable[[SceneData, Any], Any]:
    return next((_CHECKS[each] for each in kind.__mro__ if each in _CHECKS), placed_between)
