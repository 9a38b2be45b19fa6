"""Checks of ice against its scene."""

from __future__ import annotations

from ..errors import SceneError
from ..parts.contact import Contact
from ..parts.crossing import Crossing
from ..parts.drag import Drag
from ..parts.fluid import NO_SURFACE
from ..parts.ice import Ice
from ..parts.part import Part
from ..parts.scene_data import SceneData
from ..parts.stretches import overlap
from .placement import cable_of, check_between


def placed_ice(scene: SceneData, part: Ice) -> Ice:
    """Return the ice, checked to suit its cable and what acts on it. Raises SceneError."""
    if part.cable in scene.ropes:
        raise SceneError(part.where, f'grows on cables alone, but "{part.cable}" is a rope, whose material moves over '
                         "sheaves", "take a cable")
    cable = cable_of(scene, part.cable, part.where)
    check_between(scene, part, part.cable)
    if None in [part.diameter_of(piece.section) for piece in part.stretches(cable)]:
        raise SceneError(part.where, "diameter is missing, which the section does not tell",
                         "give diameter, in m: that of the cable under the ice")
    if other := next((each for each in scene.ices.values() if _on_same(each, part)), None):
        raise SceneError(part.where, f"there is the {other.where} already", "leave one of them out, or give them start "
                         "and stop")
    for drag in scene.drags.values():
        if drag.on == part.cable:
            _check_drag(scene, part, drag, part.where)
    beside: list[Contact | Crossing] = [*scene.contacts.values(), *scene.crossings.values()]
    for one in beside:
        if part.cable in (one.a, one.b):
            raise SceneError(part.where, *_beside(one))
    return part


def check_beside_ice(scene: SceneData, part: Part, cable: str) -> None:
    """Raise SceneError where a drag, a contact or a crossing of a cable does not know the ice on it."""
    for ice in scene.ices.values():
        if ice.cable == cable and isinstance(part, Drag):
            _check_drag(scene, ice, part, part.where)
        elif ice.cable == cable:
            raise SceneError(ice.where, *_beside(part))


def _beside(part: Part) -> tuple[str, str]:
    return f"is on a cable with the {part.where}, whose radius does not grow with it", "leave one of them out"


def _check_drag(scene: SceneData, ice: Ice, drag: Drag, where: str) -> None:
    """Raise SceneError where forces of a fluid do not grow with ice."""
    if not overlap((ice.start, ice.stop), (drag.start, drag.stop)):
        return
    fluids = scene.fluids_of(drag)
    cut = any(fluid.surface is not None or fluid.bottom(scene.fluids.values()) > -NO_SURFACE for fluid in fluids)
    what = ("added_mass" if drag.added_mass is not None else "a polar" if drag.polar is not None else
            "a fluid with a surface" if cut else None)
    if what is not None:
        other = drag.where if where == ice.where else ice.where
        raise SceneError(where, f"acts where the {other} does, but {what} of a drag does not know the ice",
                         "leave it out, or give them other parts of the cable by start and stop")


def _on_same(one: Ice, other: Ice) -> bool:
    return one.cable == other.cable and overlap((one.start, one.stop), (other.start, other.stop))
