"""Checks of events against their scene."""

from __future__ import annotations

from ..errors import SceneError, near
from ..parts.event import Event
from ..parts.scene_data import SceneData
from .placement import node_at

AXES = ("x", "y", "z")
WATCHABLE = {"rigid_body": ("position", "velocity"), "modal_body": ("position", "velocity"),
             "cable": ("position", "velocity", "least_strain"), "slide": ("s", "s_rate", "traction")}
"""Quantities with thresholds, by kind of part."""
WHOLE = ("s", "s_rate", "traction", "least_strain")
"""Quantities without components and without a place on a cable."""


def _normal(scene: SceneData) -> tuple[float, ...]:
    """Return the normal of the plane of a planar scene."""
    return (0.0, 0.0, 1.0) if scene.plane is None else tuple(scene.plane.normal.tolist())


def placed_event(scene: SceneData, event: Event) -> Event:
    """Return the event, checked to watch a function or a quantity of the scene. Raises SceneError."""
    if event.quantity is None:
        return event
    name, _, quantity = event.quantity.partition(".")
    what, _, axis = quantity.partition(".")
    parts = {**scene.bodies, **scene.cables, **scene.slides}
    if name not in parts:
        raise SceneError(event.where, f'there is no body, cable or slide "{name}"', near(name, parts))
    part = parts[name]
    known = WATCHABLE[part.kind]
    if what not in known or (axis if what in WHOLE else axis not in AXES):
        forms = ", ".join(f"{name}.{k}" if k in WHOLE else f"{name}.{k}.x" for k in known)
        raise SceneError(event.where, f'"{event.quantity}" cannot be watched', f"{forms}, with x, y or z, can"
                         if part.kind != "slide" else f"{forms} can")
    if scene.dim == 2 and axis and abs(_normal(scene)[AXES.index(axis)]) == 1.0:
        same = "always 0" if scene.plane is None else "always the same"
        others = " or ".join(each for each in AXES if each != axis)
        raise SceneError(event.where, f'"{event.quantity}" is {same}: the scene is planar', f"watch {others}")
    if part.kind == "cable" and what not in WHOLE:
        if event.s is None:
            raise SceneError(event.where, "s is missing: where on the cable?", "give the s of a node")
        node_at(scene, name, event.where, event.s)
    elif event.s is not None:
        raise SceneError(event.where, f'"{event.quantity}" has no place s', "leave it out")
    return event
