"""Checks of drag against the scene that it joins."""

from __future__ import annotations

from ..errors import SceneError, near
from ..parts.attachment import Attachment
from ..parts.drag import OF_BODY, OF_CABLE, Drag
from ..parts.scene_data import SceneData
from .placement import placed_attachment


def placed_drag(scene: SceneData, drag: Drag) -> Drag:
    """Return the drag with its fluid and its place complete, sure to act on something. Raises SceneError."""
    drag = drag.completed({"fluid": _fluid(scene, drag)})
    if drag.on in scene.cables:
        _check_cable(scene, drag)
        return drag
    placed = placed_attachment(scene, Attachment(on=drag.on, at=drag.at), drag.where)
    _refuse(drag, OF_CABLE, "body")
    if drag.area * drag.coefficient == 0 and drag.volume == 0:
        raise SceneError(drag.where, "has neither drag nor buoyancy", "give an area with a coefficient, or a volume")
    return drag.completed({"at": placed.at})


def _fluid(scene: SceneData, drag: Drag) -> str:
    """Return the name of the fluid that a drag is in."""
    if drag.fluid is None and len(scene.fluids) == 1:
        return next(iter(scene.fluids))
    if drag.fluid is None:
        raise SceneError(drag.where, f"needs a fluid, of which the scene has {len(scene.fluids) or 'none'}",
                         "name it with fluid" if scene.fluids else "add one before: scene.fluid(density=...)")
    if drag.fluid not in scene.fluids:
        raise SceneError(drag.where, f'there is no fluid "{drag.fluid}"', near(drag.fluid, scene.fluids))
    return drag.fluid


def _check_cable(scene: SceneData, drag: Drag) -> None:
    """Raise SceneError where a drag does not suit its cable."""
    _refuse(drag, OF_BODY, "cable")
    cable = scene.cables[drag.on]
    if other := next((each for each in scene.drags.values() if each.on == drag.on), None):
        raise SceneError(drag.where, f'cable "{drag.on}" has the {other.where} already', "leave one of them out")
    if drag.normal == 0 and drag.tangential == 0:
        if drag.displaced(cable) == 0:
            raise SceneError(drag.where, "has neither drag nor buoyancy", "give normal, tangential or displaced_area")
        return
    try:
        drag.width(cable)
    except ValueError as error:
        raise SceneError(drag.where, str(error), "give diameter, in m: the width across the flow") from None


def _refuse(drag: Drag, names: tuple[str, ...], kind: str) -> None:
    """Raise SceneError where values are given that such a part does not take."""
    defaults = {name: field.default for name, field in Drag.model_fields.items()}
    for name in names:
        if getattr(drag, name) != defaults[name]:
            takes = OF_CABLE if kind == "cable" else OF_BODY
            raise SceneError(drag.where, f'acts on {kind} "{drag.on}" and takes no {name}', f"takes {', '.join(takes)}")
